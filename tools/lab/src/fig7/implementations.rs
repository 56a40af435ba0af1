//! Implementations of the split of a vertex by a plane, which differ in how they find its faces.

use tearmesh::geometry::Plane;
use tearmesh::{Edits, Mesh, Point, split};

use super::splits::Split;

/// A mesh whose vertices can be split.
pub(super) trait Implementation {
    /// Prepares for the splits of a step. It is not timed.
    fn begin(&mut self) {}

    /// Gives the faces of a vertex whose centres are behind a plane to a new vertex. Does nothing if all are on
    /// one side.
    fn split(&mut self, split: &Split, places: &[Point]);

    /// Returns the vertices of all triangles.
    fn indices(&self) -> &[u32];
}

/// Creates an implementation with a copy of a mesh.
type New = fn(&Mesh) -> Box<dyn Implementation>;

/// The name of the implementation that looks at all triangles.
pub(super) const SCAN: &str = "scan of all triangles";
/// The name of our own implementation.
pub(super) const GHOST_PAIRS: &str = "half-edge with ghost pairs";

/// The implementations with their names, after one that does nothing.
pub(super) const IMPLEMENTATIONS: [(&str, New); 4] = [
    ("nothing", |_| Box::new(Nothing)),
    (SCAN, |mesh| Box::new(Scan::new(mesh))),
    ("face lists of vertices", |mesh| {
        Box::new(FaceLists::new(mesh))
    }),
    (GHOST_PAIRS, |mesh| {
        let (mesh, edits) = (mesh.clone(), Edits::new());
        Box::new(GhostPairs { mesh, edits })
    }),
];

/// The overhead of reading the clock.
struct Nothing;

impl Implementation for Nothing {
    fn split(&mut self, _: &Split, _: &[Point]) {}

    fn indices(&self) -> &[u32] {
        &[]
    }
}

/// The half-edge with ghost pairs: the kernel's own split, with its log.
struct GhostPairs {
    mesh: Mesh,
    edits: Edits,
}

impl Implementation for GhostPairs {
    fn begin(&mut self) {
        self.edits.clear();
    }

    fn split(&mut self, split: &Split, places: &[Point]) {
        let Split { vertex, plane } = split;
        split::by_plane(&mut self.mesh, *vertex, plane, places, &mut self.edits);
    }

    fn indices(&self) -> &[u32] {
        self.mesh.indices()
    }
}

/// A list of triangles, all of which are searched for those of a vertex.
struct Scan {
    triangles: Vec<[u32; 3]>,
    vertices: u32,
    behind: Vec<u32>,
}

impl Scan {
    fn new(mesh: &Mesh) -> Scan {
        Scan {
            triangles: triangles(mesh),
            vertices: mesh.vertex_count() as u32,
            behind: Vec::new(),
        }
    }
}

impl Implementation for Scan {
    fn split(&mut self, split: &Split, places: &[Point]) {
        let vertex = u32::from(split.vertex);
        self.behind.clear();
        let mut has_front = false;
        for (f, &triangle) in self.triangles.iter().enumerate() {
            if triangle.contains(&vertex) {
                if is_behind(triangle, &split.plane, places) {
                    self.behind.push(f as u32);
                } else {
                    has_front = true;
                }
            }
        }
        if has_front && !self.behind.is_empty() {
            for &f in &self.behind {
                relabel(&mut self.triangles[f as usize], vertex, self.vertices);
            }
            self.vertices += 1;
        }
    }

    fn indices(&self) -> &[u32] {
        self.triangles.as_flattened()
    }
}

/// A list of triangles, and for each vertex a list of those that have it, kept up to date.
struct FaceLists {
    triangles: Vec<[u32; 3]>,
    /// By vertex.
    faces: Vec<Vec<u32>>,
}

impl FaceLists {
    fn new(mesh: &Mesh) -> FaceLists {
        let triangles = triangles(mesh);
        let mut faces = vec![Vec::new(); mesh.vertex_count()];
        for (f, triangle) in triangles.iter().enumerate() {
            for &v in triangle {
                faces[v as usize].push(f as u32);
            }
        }
        FaceLists { triangles, faces }
    }
}

impl Implementation for FaceLists {
    fn split(&mut self, split: &Split, places: &[Point]) {
        let triangles = &mut self.triangles;
        let list = &mut self.faces[split.vertex.index()];
        let is_behind = |f: u32| is_behind(triangles[f as usize], &split.plane, places);
        let (behind, front): (Vec<u32>, Vec<u32>) = list.iter().partition(|&&f| is_behind(f));
        if behind.is_empty() || front.is_empty() {
            return;
        }
        *list = front;
        let new = self.faces.len() as u32;
        for &f in &behind {
            relabel(&mut triangles[f as usize], u32::from(split.vertex), new);
        }
        self.faces.push(behind);
    }

    fn indices(&self) -> &[u32] {
        self.triangles.as_flattened()
    }
}

fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    mesh.indices().as_chunks().0.to_vec()
}

/// Whether the centre of a triangle is behind a plane. Corners are summed in ascending order, so that all
/// implementations round alike.
fn is_behind(mut triangle: [u32; 3], plane: &Plane, places: &[Point]) -> bool {
    triangle.sort_unstable();
    let [a, b, c] = triangle.map(|v| plane.offset(places[v as usize]));
    a + b + c < 0.0
}

fn relabel(triangle: &mut [u32; 3], from: u32, to: u32) {
    let corners = triangle.iter_mut().filter(|corner| **corner == from);
    corners.for_each(|corner| *corner = to);
}
