//! Rivals that cut in Python, each in a process of its own: `rivals/cut.py`.

use std::fs;
use std::io;
use std::path::Path;
use std::process::Command;

use tearmesh::{Mesh, Plane, Positions};

use crate::process::{Folder, Process};

/// A mesh and a plane as files.
pub(super) struct Handover(Folder);

impl Handover {
    pub(super) fn new(mesh: &Mesh, positions: &Positions, plane: &Plane) -> io::Result<Handover> {
        let folder = Folder::new()?;
        let floats = |points: &mut dyn Iterator<Item = [f64; 3]>| -> Vec<u8> {
            points.flatten().flat_map(f64::to_le_bytes).collect()
        };
        let points = floats(&mut positions.as_slice().iter().map(|p| [p.x, p.y, p.z]));
        fs::write(folder.path("points"), points)?;
        let corners = mesh.indices().iter().flat_map(|v| v.to_le_bytes());
        fs::write(folder.path("triangles"), corners.collect::<Vec<u8>>())?;
        let normal = plane.normal() / plane.normal().norm();
        let plane = [plane.point().coords, normal];
        let plane = floats(&mut plane.iter().map(|v| [v.x, v.y, v.z]));
        fs::write(folder.path("plane"), plane)?;
        Ok(Handover(folder))
    }
}

/// A rival that is ready to cut.
pub(super) struct Rival(Process);

/// What a rival's result is like.
pub(super) struct Facts {
    pub(super) faces: usize,
    /// Edges of the seam, on one side.
    pub(super) seam: usize,
    /// Edges of the seam of one side without a partner of the same bits on the other.
    pub(super) cracks: usize,
    /// The largest distance of a vertex of the seam from the plane.
    pub(super) deviation: f64,
    /// By how much the area changed, as a part of it.
    pub(super) area: f64,
}

impl Rival {
    /// Starts a rival; `None` if it is not installed.
    pub(super) fn start(name: &str, python: &str, handover: &Handover) -> Option<Rival> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("rivals/cut.py");
        let mut command = Command::new(python);
        command.arg(script).arg(name).arg(handover.0.path(""));
        Process::start(&mut command, "").map(Rival)
    }

    pub(super) fn version(&self) -> &str {
        &self.0.version
    }

    /// How many seconds the rival takes for a cut.
    pub(super) fn cut(&self) -> f64 {
        self.0.ask("cut").parse().expect("a number of seconds")
    }

    pub(super) fn check(&self) -> Facts {
        let answer = self.0.ask("check");
        let number = |key: &str| -> f64 {
            let mut words = answer.split_ascii_whitespace();
            let value = words.find_map(|word| word.strip_prefix(key)?.strip_prefix('='));
            let value = value.expect("every fact is told");
            value.parse().expect("facts are numbers")
        };
        Facts {
            faces: number("faces") as usize,
            seam: number("seam") as usize,
            cracks: number("cracks") as usize,
            deviation: number("deviation"),
            area: number("area"),
        }
    }
}
