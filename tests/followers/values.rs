//! Values beside a mesh, kept by reading what each kind of record says, and nothing derived from it.

use tearmesh::{Edit, Mix, VertexId};

pub(crate) type Value = [f64; 2];

pub(super) fn between(a: Value, b: Value, t: f64) -> Value {
    [0, 1].map(|i| a[i] - (a[i] - b[i]) * t)
}

pub(super) fn weighted([a, b, c]: [Value; 3], w: [f64; 3]) -> Value {
    [0, 1].map(|i| a[i] * w[0] + b[i] * w[1] + c[i] * w[2])
}

/// A value for each vertex, each corner and each face, and the vertex of each corner.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Values {
    pub(crate) vertices: Vec<Value>,
    pub(crate) corners: Vec<Value>,
    pub(crate) faces: Vec<u16>,
    pub(crate) indices: Vec<u32>,
}

impl Values {
    pub(crate) fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => {
                self.vertices.push(self.vertices[split.old.index()]);
                for h in split.corners {
                    self.indices[h.index()] = split.new.index() as u32;
                }
            }
            Edit::Insert(insert) => {
                let at = |v: VertexId| self.vertices[v.index()];
                let new = insert.points.iter().map(|point| match point.at {
                    Mix::Copy(v) => at(v),
                    Mix::Between { ends: [a, b], t } => between(at(a), at(b), t),
                    Mix::Weighted { of, weights } => weighted(of.map(at), weights),
                    _ => unreachable!("there is no other mix"),
                });
                let new: Vec<Value> = new.collect();
                self.vertices.extend(new);
                let before = self.clone();
                for child in insert.children {
                    let face = child.face.index();
                    if face == self.faces.len() {
                        self.faces.push(0);
                        self.corners.extend([[0.0; 2]; 3]);
                        self.indices.extend([0; 3]);
                    }
                    self.faces[face] = before.faces[child.parent.index()];
                    for i in 0..3 {
                        let of = |h: usize| before.corners[h];
                        let parent = child.parent.index();
                        self.corners[3 * face + i] = match child.sources[i] {
                            Mix::Copy(h) => of(h.index()),
                            Mix::Between { ends: [a, b], t } => {
                                between(of(a.index()), of(b.index()), t)
                            }
                            Mix::Weighted { weights, .. } => {
                                weighted([0, 1, 2].map(|j| of(3 * parent + j)), weights)
                            }
                            _ => unreachable!("there is no other mix"),
                        };
                        self.indices[3 * face + i] = child.vertices[i].index() as u32;
                    }
                }
            }
            Edit::Merge(merge) => {
                let [kept, gone] = [merge.kept, merge.gone].map(VertexId::index);
                self.vertices[kept] =
                    between(self.vertices[kept], self.vertices[gone], 1.0 - merge.share);
                self.vertices.swap_remove(gone);
                for h in merge.corners {
                    self.indices[h.index()] = kept as u32;
                }
                for h in merge.renumbered.iter().flat_map(|last| last.corners) {
                    self.indices[h.index()] = gone as u32;
                }
            }
            Edit::Slide(slide) => {
                let [v, w] = [slide.vertex, slide.toward].map(VertexId::index);
                self.vertices[v] = between(self.vertices[v], self.vertices[w], slide.t);
                let before = self.corners.clone();
                let of = |h: usize| before[h];
                for h in slide.corners {
                    let along = slide.along.into_iter().flatten();
                    let along: Vec<[usize; 2]> =
                        along.map(|ends| ends.map(|h| h.index())).collect();
                    let own = along.iter().find(|[corner, _]| *corner == h.index());
                    let equal = || {
                        along
                            .iter()
                            .find(|[corner, _]| of(*corner) == of(h.index()))
                    };
                    if let Some(&[corner, toward]) = own.or_else(equal) {
                        self.corners[h.index()] = between(of(corner), of(toward), slide.t);
                    }
                }
            }
            _ => unreachable!("there is no other edit"),
        }
    }
}
