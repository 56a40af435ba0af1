//! Ways to split a vertex by a plane, which differ in how they find its faces.

use tearmesh::geometry::Plane;
use tearmesh::{Edits, Mesh, Point, VertexId, split};

/// A mesh that can be split in some way.
pub(super) trait Way {
    /// Its name in tables.
    fn name(&self) -> &'static str;

    /// A step begins: what is no part of a split is done here.
    fn begin(&mut self) {}

    /// Gives the faces of a vertex whose centres are behind a plane to a new vertex; nothing if all are on
    /// one side.
    fn split(&mut self, vertex: VertexId, plane: &Plane, places: &[Point]);

    /// The vertices of all triangles; `None` where there are none.
    fn indices(&self) -> Option<&[u32]>;
}

/// Makes a way of a mesh.
pub(super) type Make = fn(&Mesh) -> Box<dyn Way>;

/// All ways, after one that does nothing.
pub(super) fn all() -> [Make; 4] {
    [
        |_| Box::new(Nothing),
        |mesh| Box::new(Scan::new(mesh)),
        |mesh| Box::new(FaceLists::new(mesh)),
        |mesh| Box::new(GhostPairs::new(mesh)),
    ]
}

/// What it takes to look at the clock.
struct Nothing;

impl Way for Nothing {
    fn name(&self) -> &'static str {
        "nothing"
    }

    fn split(&mut self, _: VertexId, _: &Plane, _: &[Point]) {}

    fn indices(&self) -> Option<&[u32]> {
        None
    }
}

/// The half-edge with ghost pairs: the kernel's own split, with its log.
#[derive(Debug)]
pub(super) struct GhostPairs {
    mesh: Mesh,
    edits: Edits,
}

impl GhostPairs {
    /// Of such a mesh.
    pub(super) fn new(mesh: &Mesh) -> GhostPairs {
        GhostPairs {
            mesh: mesh.clone(),
            edits: Edits::new(),
        }
    }
}

impl Way for GhostPairs {
    fn name(&self) -> &'static str {
        "half-edge with ghost pairs"
    }

    fn begin(&mut self) {
        self.edits.clear();
    }

    fn split(&mut self, vertex: VertexId, plane: &Plane, places: &[Point]) {
        split::by_plane(&mut self.mesh, vertex, plane, places, &mut self.edits);
    }

    fn indices(&self) -> Option<&[u32]> {
        Some(self.mesh.indices())
    }
}

/// A list of triangles, all of which are looked at for those of a vertex.
#[derive(Debug)]
pub(super) struct Scan {
    triangles: Vec<[u32; 3]>,
    vertices: u32,
    behind: Vec<u32>,
}

impl Scan {
    /// Of such a mesh.
    pub(super) fn new(mesh: &Mesh) -> Scan {
        Scan {
            triangles: triangles(mesh),
            vertices: mesh.vertex_count() as u32,
            behind: Vec::new(),
        }
    }
}

impl Way for Scan {
    fn name(&self) -> &'static str {
        "scan of all triangles"
    }

    fn split(&mut self, vertex: VertexId, plane: &Plane, places: &[Point]) {
        let vertex = u32::from(vertex);
        self.behind.clear();
        let mut stays = false;
        for (f, &triangle) in self.triangles.iter().enumerate() {
            if triangle.contains(&vertex) {
                if is_behind(triangle, plane, places) {
                    self.behind.push(f as u32);
                } else {
                    stays = true;
                }
            }
        }
        if stays && !self.behind.is_empty() {
            for &f in &self.behind {
                relabel(&mut self.triangles[f as usize], vertex, self.vertices);
            }
            self.vertices += 1;
        }
    }

    fn indices(&self) -> Option<&[u32]> {
        Some(self.triangles.as_flattened())
    }
}

/// A list of triangles, and for each vertex one of those that have it, kept up to date.
#[derive(Debug)]
pub(super) struct FaceLists {
    triangles: Vec<[u32; 3]>,
    /// By vertex.
    faces: Vec<Vec<u32>>,
}

impl FaceLists {
    /// Of such a mesh.
    pub(super) fn new(mesh: &Mesh) -> FaceLists {
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

impl Way for FaceLists {
    fn name(&self) -> &'static str {
        "face lists of vertices"
    }

    fn split(&mut self, vertex: VertexId, plane: &Plane, places: &[Point]) {
        let triangles = &mut self.triangles;
        let list = &mut self.faces[vertex.index()];
        let is_behind = |f: u32| is_behind(triangles[f as usize], plane, places);
        let (behind, front): (Vec<u32>, Vec<u32>) = list.iter().partition(|&&f| is_behind(f));
        if behind.is_empty() || front.is_empty() {
            return;
        }
        *list = front;
        let new = self.faces.len() as u32;
        for &f in &behind {
            relabel(&mut triangles[f as usize], u32::from(vertex), new);
        }
        self.faces.push(behind);
    }

    fn indices(&self) -> Option<&[u32]> {
        Some(self.triangles.as_flattened())
    }
}

fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    mesh.indices().as_chunks().0.to_vec()
}

/// Whether the centre of a triangle is behind a plane. Corners are summed in ascending order, so that all
/// ways round alike.
fn is_behind(mut triangle: [u32; 3], plane: &Plane, places: &[Point]) -> bool {
    triangle.sort_unstable();
    let [a, b, c] = triangle.map(|v| plane.offset(places[v as usize]));
    a + b + c < 0.0
}

fn relabel(triangle: &mut [u32; 3], from: u32, to: u32) {
    let corners = triangle.iter_mut().filter(|corner| **corner == from);
    corners.for_each(|corner| *corner = to);
}
