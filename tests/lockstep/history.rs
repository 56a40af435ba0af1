//! Undoing the edits of a log.

use tearmesh::{Edit, HalfEdgeId, Mesh, Mix, VertexId};

pub(super) fn triangles(mesh: &Mesh) -> &[[u32; 3]] {
    mesh.indices().as_chunks().0
}

/// The vertices and triangles that there were before all this, found from the records alone.
pub(super) fn undone<'e>(
    last_first: impl Iterator<Item = Edit<'e>>,
    mesh: &Mesh,
) -> (usize, Vec<[u32; 3]>) {
    let mut faces = triangles(mesh).to_vec();
    let mut vertices = mesh.vertex_count();
    for edit in last_first {
        match edit {
            Edit::Split(split) => {
                vertices -= 1;
                let (old, new) = (split.old, split.new);
                assert_eq!(new.index(), vertices, "a split makes the last vertex");
                relabel(&mut faces, split.corners, new, old);
                assert!(!has(&faces, new), "all corners of {new} are told");
            }
            Edit::Insert(insert) => {
                for point in insert.points.iter().rev() {
                    vertices -= 1;
                    assert_eq!(point.vertex.index(), vertices, "the last vertices are new");
                }
                let mut parents = Vec::new();
                for child in insert.children.iter().rev() {
                    if child.face != child.parent {
                        faces.pop();
                        assert_eq!(child.face.index(), faces.len(), "the last are new");
                    }
                    for (source, vertex) in child.sources.iter().zip(child.vertices) {
                        if let Mix::Copy(h) = source {
                            parents.push((*h, vertex));
                        }
                    }
                }
                for (h, vertex) in parents {
                    faces[h.face().index()][h.corner()] = vertex.into();
                }
                let mut corners = faces.as_flattened().iter();
                let are_old = corners.all(|&v| (v as usize) < vertices);
                assert!(are_old, "all corners of divided faces are told");
            }
            Edit::Merge(merge) => {
                let (kept, gone) = (merge.kept, merge.gone);
                if let Some(it) = merge.renumbered {
                    assert_eq!((it.from.index(), it.to), (vertices, gone), "the last");
                    relabel(&mut faces, it.corners, it.to, it.from);
                    assert!(!has(&faces, it.to), "all corners of {} are told", it.from);
                } else {
                    assert_eq!(gone.index(), vertices, "the last vertex is gone");
                }
                vertices += 1;
                relabel(&mut faces, merge.corners, kept, gone);
                assert!(has(&faces, kept), "{kept} had a corner of its own");
            }
            Edit::Slide(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }
    (vertices, faces)
}

fn has(faces: &[[u32; 3]], v: VertexId) -> bool {
    faces.as_flattened().contains(&v.into())
}

fn relabel(faces: &mut [[u32; 3]], corners: &[HalfEdgeId], from: VertexId, to: VertexId) {
    for h in corners {
        let corner = &mut faces[h.face().index()][h.corner()];
        assert_eq!(*corner, u32::from(from), "{h} was moved");
        *corner = to.into();
    }
}
