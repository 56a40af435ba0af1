//! Pictures of the verb `render`, and pictures that other verbs write beside a mesh.

use std::path::Path;

use tearmesh::{Mesh, Place, Vector};
use tearmesh_obj::{Corner, Document};
use tearmesh_view::{ANGLE_OF_VIEW, CameraError, PictureSize, RenderOptions, fit, render};

use crate::output;
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

/// Writes a picture beside a mesh that has a face, by a camera that has to be found.
pub(crate) fn write_beside(
    path: &Path,
    mesh: &Mesh,
    place: &(impl Place + ?Sized),
    up: Vector,
    crease_deg: Option<f64>,
) -> Result<(), Fault> {
    let size = PictureSize::default();
    let camera = fit(mesh, place, up, ANGLE_OF_VIEW, size.as_f64()).map_err(no_camera)?;
    let options = RenderOptions {
        crease_deg,
        ground: Some(up),
        ..RenderOptions::default()
    };
    let picture = render(mesh, place, &camera, size, &options);
    output::write(path, |out| picture.write_png(out))
}

/// The texture coordinates of each corner of a document's triangles; empty if a corner has none.
pub(crate) fn texture(document: &Document) -> Vec<[f64; 2]> {
    let texture =
        corners(document).map(|corner| match document.texture(corner.texture? as usize) {
            &[u, v, ..] => Some([u, v]),
            _ => None,
        });
    texture.collect::<Option<Vec<_>>>().unwrap_or_default()
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
