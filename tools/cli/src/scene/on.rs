//! The scene of a scene file for a mesh, with the bodies that the file names and does not hold.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;

use tearmesh::VertexId;
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::file::{BodyMesh, PackedScene, SceneFault};
use tearmesh_cloth::scene::{Axis, Frame, Scene};

use super::read::SceneSource;
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
        let mut unread = BTreeMap::new();
        let made = self.file.on(frame, typed, &mut |number, name| {
            self.body(number, name).map_err(|fault| {
                let message = fault.message.clone();
                unread.insert(number, fault);
                message
            })
        });
        made.map_err(|found| {
            let placed = |fault: SceneFault| {
                match (fault.table, fault.key) {
                    ("collider", "body") => unread.remove(&fault.number),
                    _ => None,
                }
                .unwrap_or_else(|| self.placed(fault))
            };
            let mut faults: Vec<Fault> = found.into_iter().map(placed).collect();
            faults.sort_by_key(|fault| fault.location);
            faults.into()
        })
    }

    /// The file, as JSON, with all that a scene that was made of it has from elsewhere.
    pub(crate) fn packed(&self, scene: &Scene, vertices: Vec<(VertexId, VertexId)>) -> PackedScene {
        let keys: serde_json::Value = toml::from_str(self.text.content()).expect("it was read");
        PackedScene::new(keys.to_string(), scene, vertices)
    }

    /// The body in a file, whose place is given as from the scene file.
    fn body(&self, number: usize, name: &str) -> Result<BodyMesh, Fault> {
        let path = Path::new(self.name()).with_file_name(name);
        let read = Input::find(&path, &mut io::empty()).and_then(|input| input.document());
        let document = read.map_err(|stop| {
            let found = stop.faults.into_iter().next().expect("a reason");
            match found.location {
                Some(_) => found,
                None => self.blame(
                    ("collider", number, "body"),
                    found.code,
                    found.message.clone(),
                ),
            }
        })?;
        Ok((document.positions().to_vec(), document.triangles().to_vec()))
    }
}
