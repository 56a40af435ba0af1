//! Surfaces to be cut, for the library and for the oracle of straight cuts.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use tearmesh::{Mesh, Positions, shapes};

use crate::delaunay;
use crate::oracle::straight::{Cut, Surface};
use crate::oracle::{joined_sets, naive_cut};
use crate::plain::Plain;
use crate::random::Random;
use crate::work::{Work, down, triangles};

/// What the oracle is to see of a mesh.
pub(crate) fn surface((mesh, positions): &(Mesh, Positions)) -> Surface {
    Surface {
        points: positions.as_slice().iter().map(|&p| p.into()).collect(),
        faces: triangles(mesh).to_vec(),
    }
}

/// The mesh of a surface. Edges that were torn are plain boundary in it.
pub(crate) fn built(surface: &Surface) -> (Mesh, Positions) {
    let mesh = Mesh::build(surface.points.len(), &surface.faces).expect("a manifold");
    let positions = Positions::new(surface.points.clone()).expect("finite");
    (mesh, positions)
}

impl Work {
    pub(crate) fn of(surface: &Surface) -> Work {
        Work::new(built(surface))
    }

    pub(crate) fn surface(&self) -> Surface {
        surface(&(self.mesh.clone(), self.positions.clone()))
    }
}

/// The numbers of the pieces that faces belong to, joined by shared vertices.
pub(crate) fn pieces_by_vertices(faces: &[[u32; 3]]) -> Vec<usize> {
    let mut first = BTreeMap::new();
    let mut joined = Vec::new();
    for (f, &face) in faces.iter().enumerate() {
        joined.extend(face.map(|v| [f, *first.entry(v).or_insert(f)]));
    }
    joined_sets(faces.len(), &joined)
}

pub(crate) fn jittered(n: u32, random: &mut Random) -> Surface {
    let mut sheet = surface(&shapes::grid_with_diagonals(n, n, |x, y| (x * y) % 3 == 1));
    let by = 0.48 / f64::from(n);
    for [x, y, z] in &mut sheet.points {
        if [*x, *y].iter().all(|c| *c > 0.0 && *c < 1.0) {
            *x += by * (random.next() - 0.5);
            *y += by * (random.next() - 0.5);
        }
        *z = 0.1 * (*x + 2.0 * *y * *x);
    }
    sheet
}

/// Random points in the unit square with so many on each side, and their triangles.
pub(crate) fn delaunay(count: usize, border: u32, random: &mut Random) -> Surface {
    let points = delaunay::points(count, border, 0.6 / (count as f64).sqrt(), random);
    let faces = delaunay::triangles(&points).into_iter();
    Surface {
        faces: faces.map(|t| t.map(|i| i as u32)).collect(),
        points: points.into_iter().map(|[x, y]| [x, y, 0.0]).collect(),
    }
}

/// An octahedron, subdivided and blown up.
pub(crate) fn sphere(times: usize) -> Surface {
    let mut sphere = surface(&shapes::octahedron());
    for _ in 0..times {
        let mut middles = BTreeMap::new();
        let mut faces = Vec::new();
        for [a, b, c] in sphere.faces {
            let [d, e, f] = [(b, c), (c, a), (a, b)].map(|(v, w)| {
                let edge = (v.min(w), v.max(w));
                *middles.entry(edge).or_insert_with(|| {
                    let [p, q] = [v, w].map(|v| sphere.points[v as usize]);
                    let sum = [p[0] + q[0], p[1] + q[1], p[2] + q[2]];
                    let size = sum.iter().map(|x| x * x).sum::<f64>().sqrt();
                    sphere.points.push(sum.map(|x| x / size));
                    sphere.points.len() as u32 - 1
                })
            });
            faces.extend([[a, f, e], [b, d, f], [c, e, d], [d, e, f]]);
        }
        sphere.faces = faces;
    }
    sphere
}

/// Surfaces with names. One was cut before, so that some of its edges are torn.
pub(crate) fn surfaces() -> Vec<(&'static str, Surface)> {
    let mut random = Random(11);
    let mut torn = jittered(9, &mut random);
    for (a, b) in [([0.21, 0.13], [0.69, 0.77]), ([-0.5, 0.61], [1.5, 0.43])] {
        torn = naive_cut::cut(&torn, &Cut::between([down(a), down(b)]));
    }
    vec![
        ("triangle", surface(&shapes::triangle())),
        ("grid", surface(&shapes::grid(9, 9))),
        ("jittered", jittered(10, &mut random)),
        ("random", delaunay(150, 9, &mut random)),
        ("torn", torn),
        ("sleeve", surface(&shapes::tube(12, 6))),
        ("sphere", sphere(2)),
        ("torus", surface(&shapes::torus(14, 9))),
    ]
}

/// Flat sheets on the unit square, regular and not; the second is bent a little.
pub(crate) fn sheets() -> [Surface; 3] {
    let mut random = Random(23);
    [
        surface(&shapes::grid(8, 8)),
        jittered(9, &mut random),
        delaunay(140, 9, &mut random),
    ]
}

/// The surface of a file.
pub(crate) fn read(path: &Path) -> Surface {
    let text = std::fs::read_to_string(path).expect("a file");
    let file = Plain::read(&text);
    Surface {
        points: (0..file.vertices.len()).map(|v| file.at(v)).collect(),
        faces: file.triangles(),
    }
}

/// The files of these names in the folder that `TEARMESH_CORPUS` names, if it names one.
pub(crate) fn corpus(names: &[&str]) -> Vec<PathBuf> {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        return Vec::new();
    };
    let path = |name| Path::new(&folder).join(name).with_extension("obj");
    names.iter().map(path).collect()
}

/// A sheet and its back, at one place.
pub(crate) fn doubled(sheet: &Surface) -> Surface {
    let mut both = sheet.clone();
    let first = both.points.len() as u32;
    both.points.extend(sheet.points.clone());
    both.faces.extend(
        sheet
            .faces
            .iter()
            .map(|&[a, b, c]| [c, b, a].map(|v| v + first)),
    );
    both
}

/// Gives some corners vertices of their own, so that seams come apart.
pub(crate) fn unsewn(whole: &Surface, part: f64, random: &mut Random) -> Surface {
    // Faces of one patch share vertices.
    let patches = 1 + random.below(6);
    let mut patch: Vec<usize> = whole.faces.iter().map(|_| random.below(patches)).collect();
    if random.next() < 0.7 {
        // Patches that hang together: by the place of the first corner.
        let cell = |f: &[u32; 3]| {
            let p = whole.points[f[0] as usize];
            (p[0] * 2.3).floor() as i64 + 3 * (p[1] * 1.7).floor() as i64
        };
        patch = whole
            .faces
            .iter()
            .map(|f| cell(f).rem_euclid(97) as usize)
            .collect();
    }
    if random.next() < part {
        patch = (0..whole.faces.len()).collect(); // A soup.
    }
    let mut known = BTreeMap::new();
    let mut parts = Surface::default();
    for (face, patch) in whole.faces.iter().zip(patch) {
        parts.faces.push(face.map(|v| {
            *known.entry((v, patch)).or_insert_with(|| {
                let mut p = whole.points[v as usize];
                for x in &mut p {
                    if *x == 0.0 && random.next() < 0.5 {
                        *x = -*x;
                    }
                }
                parts.points.push(p);
                parts.points.len() as u32 - 1
            })
        }));
    }
    separate_fans(&mut parts);
    parts
}

/// Gives each fan of a vertex a vertex of its own, so that the kernel accepts the surface.
fn separate_fans(surface: &mut Surface) {
    let mut edges: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (f, &[a, b, c]) in surface.faces.iter().enumerate() {
        for [a, b] in [[a, b], [b, c], [c, a]] {
            edges.entry([a.min(b), a.max(b)]).or_default().push(f);
        }
    }
    let mut corners: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (f, face) in surface.faces.iter().enumerate() {
        face.iter()
            .for_each(|&v| corners.entry(v).or_default().push(f));
    }
    for (v, faces) in corners {
        let mut joined = Vec::new();
        for (edge, of_edge) in edges.iter().filter(|(edge, _)| edge.contains(&v)) {
            let at = |f: &usize| faces.iter().position(|g| g == f);
            let ends: Vec<usize> = of_edge.iter().filter_map(at).collect();
            joined.extend(ends.windows(2).map(|two| [two[0], two[1]]));
            let _ = edge;
        }
        let fans = joined_sets(faces.len(), &joined);
        let mut vertices = BTreeMap::from([(fans[0], v)]);
        for (&f, fan) in faces.iter().zip(&fans) {
            let vertex = *vertices.entry(*fan).or_insert_with(|| {
                let p = surface.points[v as usize];
                surface.points.push(p);
                surface.points.len() as u32 - 1
            });
            let corner = surface.faces[f].iter_mut().find(|corner| **corner == v);
            *corner.expect("a face of the vertex") = vertex;
        }
    }
}
