//! What the log told, and how to undo it.

use tearmesh::{
    ChildFace, CornerSource, Edit, Edits, HalfEdgeId, InsertedPoint, Mesh, TornLink, VertexId,
};

/// A record of the log.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Told {
    Split {
        old: VertexId,
        new: VertexId,
        corners: Vec<HalfEdgeId>,
        torn: Vec<TornLink>,
    },
    Insert {
        points: Vec<InsertedPoint>,
        children: Vec<ChildFace>,
    },
    Merge {
        kept: VertexId,
        gone: VertexId,
        share: f64,
        corners: Vec<HalfEdgeId>,
        renumbered: Option<(VertexId, VertexId, Vec<HalfEdgeId>)>,
        sewn: Vec<TornLink>,
    },
    Slide {
        vertex: VertexId,
        toward: VertexId,
        t: f64,
        along: [Option<[HalfEdgeId; 2]>; 2],
        corners: Vec<HalfEdgeId>,
    },
}

impl Told {
    pub(crate) fn by(edit: &Edit<'_>) -> Told {
        match edit {
            Edit::Split(split) => Told::Split {
                old: split.old,
                new: split.new,
                corners: split.corners.to_vec(),
                torn: split.torn.to_vec(),
            },
            Edit::Insert(insert) => Told::Insert {
                points: insert.points.to_vec(),
                children: insert.children.to_vec(),
            },
            Edit::Merge(merge) => Told::Merge {
                kept: merge.kept,
                gone: merge.gone,
                share: merge.share,
                corners: merge.corners.to_vec(),
                renumbered: merge
                    .renumbered
                    .map(|it| (it.from, it.to, it.corners.to_vec())),
                sewn: merge.sewn.to_vec(),
            },
            Edit::Slide(slide) => Told::Slide {
                vertex: slide.vertex,
                toward: slide.toward,
                t: slide.t,
                along: slide.along,
                corners: slide.corners.to_vec(),
            },
        }
    }
}

pub(crate) fn told(edits: &Edits) -> Vec<Told> {
    edits.iter().map(|edit| Told::by(&edit)).collect()
}

pub(crate) fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    mesh.faces()
        .map(|f| mesh.face_vertices(f).map(u32::from))
        .collect()
}

/// The vertices and triangles that there were before all this, found from the records alone.
pub(super) fn undone(history: &[Told], mesh: &Mesh) -> (usize, Vec<[u32; 3]>) {
    let mut faces = triangles(mesh);
    let mut vertices = mesh.vertex_count();
    for told in history.iter().rev() {
        match told {
            Told::Split {
                old, new, corners, ..
            } => {
                vertices -= 1;
                assert_eq!(new.index(), vertices, "a split makes the last vertex");
                relabel(&mut faces, corners, *new, *old);
                assert!(!has(&faces, *new), "all corners of {new} are told");
            }
            Told::Insert { points, children } => {
                for point in points.iter().rev() {
                    vertices -= 1;
                    assert_eq!(point.vertex.index(), vertices, "the last vertices are new");
                }
                let mut parents = Vec::new();
                for child in children.iter().rev() {
                    if child.face != child.parent {
                        assert_eq!(
                            child.face.index() + 1,
                            faces.len(),
                            "the last faces are new"
                        );
                        faces.pop();
                    }
                    for (source, vertex) in child.sources.iter().zip(child.vertices) {
                        if let CornerSource::Corner(h) = source {
                            parents.push((*h, vertex));
                        }
                    }
                }
                for (h, vertex) in parents {
                    faces[h.face().index()][h.corner()] = vertex.into();
                }
                assert!(
                    faces
                        .as_flattened()
                        .iter()
                        .all(|&v| (v as usize) < vertices),
                    "all corners of divided faces are told"
                );
            }
            Told::Merge {
                kept,
                gone,
                corners,
                renumbered,
                ..
            } => {
                if let Some((from, to, corners)) = renumbered {
                    assert_eq!(
                        (from.index(), to),
                        (vertices, gone),
                        "the last takes the id"
                    );
                    relabel(&mut faces, corners, *to, *from);
                    assert!(!has(&faces, *to), "all corners of {from} are told");
                } else {
                    assert_eq!(gone.index(), vertices, "the last vertex is gone");
                }
                vertices += 1;
                relabel(&mut faces, corners, *kept, *gone);
                assert!(has(&faces, *kept), "{kept} had a corner of its own");
            }
            Told::Slide { .. } => {}
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
