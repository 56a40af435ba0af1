//! What all pictures of meshes need: a camera, and what is known of the surface.

use tearmesh::{Blend, Cursor, Edits};
use tearmesh_obj::{Corner, Document};
use tearmesh_view::CameraError;

use crate::say::Fault;

/// Why there is no such camera.
pub(crate) fn no_camera(error: CameraError) -> Fault {
    let fault = Fault::error("E-CAMERA", error.to_string());
    fault.help(match error {
        CameraError::Empty => return Fault::error("E-VIEW-EMPTY", error.to_string()),
        CameraError::At => "aim it at another point",
        CameraError::Up => "name another direction with --up, as in --up 0,0,1",
        CameraError::Angle => {
            "it is the one from the lower edge of the picture to the upper, as in --fov 40"
        }
    })
}

/// The texture coordinates on which a weave is drawn, while the mesh is cut and torn.
#[derive(Clone, Default)]
pub(crate) struct Texture {
    /// Of each corner; empty if a corner of the document has none.
    pub(crate) values: Vec<[f64; 2]>,
    seen: Cursor,
}

impl Texture {
    pub(crate) fn of(document: &Document) -> Texture {
        let values =
            corners(document).map(|corner| match document.texture(corner.texture? as usize) {
                &[u, v, ..] => Some([u, v]),
                _ => None,
            });
        let values = values.collect::<Option<Vec<_>>>().unwrap_or_default();
        let seen = Cursor::START;
        Texture { values, seen }
    }

    pub(crate) fn follow(&mut self, edits: &Edits) {
        if !self.values.is_empty() {
            edits.replay_corners(&mut self.seen, &mut self.values, Blend::blend);
        }
    }
}

/// All corners of a document's triangles.
fn corners(document: &Document) -> impl Iterator<Item = Corner> {
    let triangles = 0..document.triangles().len();
    triangles.flat_map(|triangle| [0, 1, 2].map(|i| document.corner(triangle, i)))
}

/// The angle from which on a mesh has creases: those of a file whose normals differ at a vertex.
pub(crate) fn crease(document: &Document) -> Option<f64> {
    let mut of_vertex = vec![None; document.positions().len()];
    let differs = corners(document).any(|corner| {
        let Some(normal) = corner.normal else {
            return false;
        };
        let normal = document.normals()[normal as usize];
        *of_vertex[corner.vertex as usize].get_or_insert(normal) != normal
    });
    differs.then_some(CREASE)
}

/// In degrees.
const CREASE: f64 = 40.0;
