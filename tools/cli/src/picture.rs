//! What all pictures of meshes need: a camera, and what is known of the surface.

use tearmesh::{Blend, Cursor, Edits, Mesh, Point};
use tearmesh_cloth::Collider;
use tearmesh_obj::{Corner, Document};
use tearmesh_view::CameraError;

use crate::say::Fault;

/// Why there is no such camera.
pub(crate) fn no_camera(error: CameraError) -> Fault {
    let fault = Fault::error("E-CAMERA", error.to_string());
    fault.help(match error {
        // No file without a face is read.
        CameraError::Empty => return Fault::error("E-BUG-INVARIANT", error.to_string()),
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

/// A cloth and the bodies and balls that it lies on, to be drawn as one mesh; the cloth alone where the faces of a body
/// form no manifold.
pub(crate) fn with_bodies(
    (mesh, points, texture): (&Mesh, &[Point], &Texture),
    colliders: &[Collider],
    elapsed_s: f64,
) -> (Mesh, Vec<Point>, Texture) {
    let (skin, sides) = Collider::skins(colliders, elapsed_s);
    if sides.is_empty() {
        return (mesh.clone(), points.to_vec(), texture.clone());
    }
    let first = points.len() as u32;
    let mut faces = mesh.indices().as_chunks::<3>().0.to_vec();
    faces.extend(sides.into_iter().map(|side| side.map(|v| first + v)));
    let (mut roots, mut texture) = (mesh.roots(), texture.clone());
    roots.extend((first..).take(skin.len()));
    if !texture.values.is_empty() {
        texture.values.resize(3 * faces.len(), [0.0; 2]);
    }
    match Mesh::build_torn(&faces, &roots) {
        Ok(mesh) => (mesh, [points, &skin].concat(), texture),
        Err(_) => (mesh.clone(), points.to_vec(), texture),
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

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use tearmesh::shapes;
    use tearmesh_cloth::Body;

    use super::*;

    #[test]
    fn a_cloth_is_drawn_with_its_body_and_without_planes() {
        let (cloth, at) = shapes::grid(3, 3);
        let (ball, skin) = shapes::octahedron();
        let faces = ball.indices().as_chunks::<3>().0;
        let body = Body::new(skin.as_slice(), faces, Some(0.1)).expect("a body");
        let plane = tearmesh::Plane::new(Point::origin(), tearmesh::Vector::z()).expect("a plane");
        let colliders = [Collider::plane(plane), Collider::body(Arc::new(body))];
        let texture = Texture {
            values: vec![[0.5; 2]; cloth.half_edge_count()],
            ..Texture::default()
        };
        let (drawn, points, drawn_texture) =
            with_bodies((&cloth, at.as_slice(), &texture), &colliders, 0.0);
        assert_eq!(drawn.face_count(), cloth.face_count() + ball.face_count());
        assert_eq!(
            (drawn.components().count(), points.len()),
            (2, at.len() + skin.len())
        );
        assert_eq!(drawn_texture.values.len(), drawn.half_edge_count());
        let alone = with_bodies((&cloth, at.as_slice(), &texture), &colliders[..1], 0.0);
        assert_eq!((&alone.0, alone.1.len()), (&cloth, at.len()));
    }
}
