//! Implementations of the split of a vertex by a plane, which differ in how they find its faces.

use tearmesh::geometry::Plane;
use tearmesh::{Edits, Mesh, Point, VertexId, split};

/// A split of a vertex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    pub(super) vertex: VertexId,
    /// The plane. Faces whose centres are behind it go to a new vertex.
    pub(super) plane: Plane,
}

/// A mesh whose vertices can be split.
pub(super) trait Implementation {
    /// Gives the faces of a vertex whose centres are behind a plane to a new vertex. Does nothing if all are on
    /// one side.
    fn split(&mut self, split: &Split, places: &[Point]);

    /// Returns the vertices of all triangles.
    fn indices(&self) -> &[u32];
}

/// Creates an implementation with a copy of a mesh.
pub(super) type New = fn(&Mesh) -> Box<dyn Implementation>;

/// The name of the implementation that does nothing. Its time is the overhead of reading the clock.
pub(super) const IDLE: &str = "nothing";
/// The name of the implementation that looks at all triangles.
pub(super) const SCAN: &str = "scan of all triangles";
/// The name of our own implementation.
pub(super) const GHOST_PAIRS: &str = "half-edge with ghost pairs";

/// The implementations with their names, after the idle one.
pub(super) const IMPLEMENTATIONS: [(&str, New); 4] = [
    (IDLE, |_| Box::new(())),
    (SCAN, |mesh| Box::new(Triangles::new(mesh, None))),
    ("face lists of vertices", |mesh| {
        let faces = mesh.vertices().map(|v| mesh.faces_of(v));
        let faces = faces.map(|of| of.map(u32::from).collect());
        Box::new(Triangles::new(mesh, Some(faces.collect())))
    }),
    (GHOST_PAIRS, |mesh| Box::new((mesh.clone(), Edits::new()))),
];

impl Implementation for () {
    fn split(&mut self, _: &Split, _: &[Point]) {}

    fn indices(&self) -> &[u32] {
        &[]
    }
}

/// The half-edge with ghost pairs: the kernel's own split, with its log, which is used again and again.
impl Implementation for (Mesh, Edits) {
    fn split(&mut self, split: &Split, places: &[Point]) {
        self.1.clear();
        split::by_plane(&mut self.0, split.vertex, &split.plane, places, &mut self.1);
    }

    fn indices(&self) -> &[u32] {
        self.0.indices()
    }
}

/// A list of triangles.
struct Triangles {
    triangles: Vec<[u32; 3]>,
    vertices: u32,
    /// For each vertex a list of the triangles that have it, kept up to date; `None` to search all triangles.
    faces: Option<Vec<Vec<u32>>>,
}

impl Triangles {
    fn new(mesh: &Mesh, faces: Option<Vec<Vec<u32>>>) -> Triangles {
        Triangles {
            triangles: mesh.indices().as_chunks().0.to_vec(),
            vertices: mesh.vertex_count() as u32,
            faces,
        }
    }
}

impl Implementation for Triangles {
    fn split(&mut self, split: &Split, places: &[Point]) {
        let (triangles, vertex) = (&mut self.triangles, u32::from(split.vertex));
        // Corners are summed in ascending order, so that all implementations round alike.
        let is_behind = |f: &u32| {
            let mut triangle = triangles[*f as usize];
            triangle.sort_unstable();
            let [a, b, c] = triangle.map(|v| split.plane.offset(places[v as usize]));
            a + b + c < 0.0
        };
        let faces: &mut dyn Iterator<Item = u32> = match &self.faces {
            Some(faces) => &mut faces[vertex as usize].iter().copied(),
            None => {
                let faces = triangles.iter().zip(0..);
                let faces = faces.filter(|(triangle, _)| triangle.contains(&vertex));
                &mut faces.map(|(_, f)| f)
            }
        };
        let (behind, front): (Vec<u32>, Vec<u32>) = faces.partition(is_behind);
        if behind.is_empty() || front.is_empty() {
            return;
        }
        for &f in &behind {
            let corners = triangles[f as usize].iter_mut();
            let corners = corners.filter(|corner| **corner == vertex);
            corners.for_each(|corner| *corner = self.vertices);
        }
        self.vertices += 1;
        if let Some(faces) = &mut self.faces {
            faces[vertex as usize] = front;
            faces.push(behind);
        }
    }

    fn indices(&self) -> &[u32] {
        self.triangles.as_flattened()
    }
}
