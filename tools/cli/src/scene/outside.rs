//! The reader of rays and bodies, which scene files name and do not hold.

use std::io;
use std::path::Path;

use tearmesh::{Point, Ray};
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::file::Outside;
use tearmesh_cloth::scene::{Axis, Frame, Scene};

use super::read::{SceneSource, none_of};
use crate::exit::Stop;
use crate::input::Input;
use crate::say::Fault;

impl SceneSource {
    /// Which way is up.
    pub(crate) fn up(&self) -> Axis {
        self.file.up()
    }

    /// The metres for 1 of `vt`, if texture coordinates are the shape at rest.
    pub(crate) fn vt_m(&self) -> Option<f64> {
        let fabric = self.file.fabric.as_ref()?;
        fabric.vt_m.as_deref().copied()
    }

    /// The scene for a mesh with this frame, or all that is wrong; the method may be chosen on the command line.
    pub(crate) fn scene(&self, frame: &Frame, typed: Option<&Method>) -> Result<Scene, Stop> {
        let mut beside = Beside {
            source: self,
            faults: Vec::new(),
        };
        let made = self.file.on(frame, typed, &mut beside);
        made.or_else(|found| {
            let mut faults = beside.faults;
            faults.extend(found.into_iter().map(|fault| self.placed(fault)));
            none_of(faults)?;
            unreachable!("what is refused has a reason")
        })
    }
}

/// A reader of what a scene file names, and what is wrong with that.
struct Beside<'s> {
    source: &'s SceneSource,
    faults: Vec<Fault>,
}

impl Outside for Beside<'_> {
    fn rays(&mut self, texts: &[String], number: usize) -> Option<[Ray; 2]> {
        let rays = self.source.rays(texts, number);
        rays.map_err(|fault| self.faults.push(fault)).ok()
    }

    /// The body in a file, whose place is given as from the scene file.
    fn body(&mut self, name: &str, number: usize) -> Option<(Vec<Point>, Vec<[u32; 3]>)> {
        let path = Path::new(self.source.name()).with_file_name(name);
        let read = Input::find(&path, &mut io::empty()).and_then(|input| input.document());
        let document = read.map_err(|stop| {
            let found = stop.faults.into_iter().next().expect("a reason");
            self.faults.push(match found.location {
                Some(_) => found,
                None => {
                    let at = ("collider", number, "body");
                    self.source.blame(at, found.code, found.message.clone())
                }
            });
        });
        let document = document.ok()?;
        let points = document.positions().to_vec();
        Some((points, document.triangles().to_vec()))
    }
}
