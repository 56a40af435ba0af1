//! The normals of vertices, for smooth shading.

use crate::edit::{Cursor, Edit, Follower};
use crate::geometry::{Vector, cross, length, scaled};
use crate::id::VertexId;
use crate::mesh::Mesh;
use crate::place::Place;

/// The unit normal of each vertex: the mean of its faces' normals, weighted by area. They are a
/// [`Follower`] of the mesh's log.
///
/// The sides of a tear have normals of their own, so a torn surface may bend apart there. A vertex
/// whose faces have no area, or that has no faces, has the normal zero.
///
/// ```
/// use tearmesh::engine::Normals;
/// use tearmesh::{CutMethod, Plane, Point, Scissor, Sheet, Vector, shapes};
///
/// let (mesh, positions) = shapes::grid(4, 4);
/// let normals = Normals::new(&mesh, &positions);
/// assert_eq!(normals.as_slice()[12], Vector::z());
///
/// let mut sheet = Sheet::new(mesh, positions).with(normals);
/// let plane = Plane::new(Point::new(0.4, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
/// sheet.cut(CutMethod::Exact, &Scissor::by_plane(plane))?;
///
/// let (mesh, positions) = (sheet.mesh().clone(), sheet.positions().clone());
/// let changed = sheet.values_mut().update(&mesh, &positions);
/// assert!(changed.len() < mesh.vertex_count());
/// assert_eq!(sheet.values().as_slice(), Normals::new(&mesh, &positions).as_slice());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Normals {
    normals: Vec<Vector>,
    /// The vertices that moved, or whose faces are others than they were.
    touched: Vec<VertexId>,
    seen: Cursor,
}

impl Normals {
    /// Creates the normals of a mesh. They have seen no edit yet. The cost is a walk round each vertex.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of a vertex.
    #[must_use]
    pub fn new(mesh: &Mesh, place: &(impl Place + ?Sized)) -> Normals {
        Normals {
            normals: mesh.vertices().map(|v| normal(mesh, place, v)).collect(),
            touched: Vec::new(),
            seen: Cursor::ASSUMED,
        }
    }

    /// Returns the normals of all vertices, indexed by vertex, as they were when they were last updated.
    #[must_use]
    pub fn as_slice(&self) -> &[Vector] {
        &self.normals
    }

    /// Notes that vertices moved, for the next [`update`](Normals::update). Edits of the log are noted
    /// by themselves. Where all vertices moved, as in a step of a simulation, make new normals instead.
    pub fn touch(&mut self, moved: impl IntoIterator<Item = VertexId>) {
        self.touched.extend(moved);
    }

    /// Computes the normals anew of the vertices that moved or that edits touched, and of their
    /// neighbours, and returns these vertices in ascending order.
    ///
    /// # Panics
    ///
    /// If `place` does not store the position of one of them.
    pub fn update(&mut self, mesh: &Mesh, place: &(impl Place + ?Sized)) -> Vec<VertexId> {
        let is_left = |v: &VertexId| v.index() < mesh.vertex_count();
        let touched = self.touched.drain(..).filter(is_left);
        let with_neighbours = |v| {
            let around = mesh.faces_of(v).flat_map(|f| mesh.face_vertices(f));
            around.chain([v])
        };
        let mut stale: Vec<VertexId> = touched.flat_map(with_neighbours).collect();
        stale.sort_unstable();
        stale.dedup();
        self.normals.resize(mesh.vertex_count(), Vector::zeros());
        for &v in &stale {
            self.normals[v.index()] = normal(mesh, place, v);
        }
        stale
    }
}

impl Follower for Normals {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Split(split) => self.touch([split.old, split.new]),
            Edit::Merge(merge) => {
                self.touch([merge.kept]);
                self.touch(merge.renumbered.map(|renumbered| renumbered.to));
            }
            Edit::Insert(insert) => self.touch(insert.points.iter().map(|point| point.vertex)),
            Edit::Slide(slide) => self.touch([slide.vertex]),
        }
    }
}

fn normal(mesh: &Mesh, place: &(impl Place + ?Sized), v: VertexId) -> Vector {
    let spanned = mesh.faces_of(v).map(|f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| place.at(v));
        cross(b - a, c - a)
    });
    match scaled(spanned.sum()) {
        Some(sum) => sum / length(sum),
        None => Vector::zeros(),
    }
}
