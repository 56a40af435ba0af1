//! The meshes that scripts start with.

use crate::edit::Edits;
use crate::id::{FaceId, HalfEdgeId};
use crate::mesh::Mesh;
use crate::place::Positions;
use crate::shapes;
use crate::split;

/// A small mesh with positions, defined by a few numbers.
///
/// Scripts from bytes and text respect the limits on the numbers. [`Shape::make`] does not enforce
/// the upper limits.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shape {
    /// A grid of cells, with one bit for the direction of each diagonal: see
    /// [`shapes::grid_with_diagonals`].
    Grid {
        /// The number of columns, 1 to 5.
        columns: u8,
        /// The number of rows, 1 to 5.
        rows: u8,
        /// The diagonals: bit `(row * columns + column) % 64` is set if the diagonal of that cell rises.
        rising: u64,
    },
    /// A fan of triangles around a vertex: see [`shapes::fan`].
    Fan {
        /// The number of faces, 3 to 16.
        faces: u8,
        /// Whether the fan is a full disc.
        closed: bool,
    },
    /// A saddle that one plane cuts into four arcs: see [`shapes::saddle`].
    Saddle,
    /// A tube that is open at both ends: see [`shapes::tube`].
    Tube {
        /// The number of cells in a ring, 3 to 8.
        around: u8,
        /// The number of rings, 1 to 4.
        along: u8,
    },
    /// A torus: see [`shapes::torus`].
    Torus {
        /// The number of cells the long way around, 3 to 5.
        around: u8,
        /// The number of cells the short way around, 3 to 5.
        across: u8,
    },
    /// A tetrahedron whose faces are subdivided into four, repeatedly.
    Tetrahedron {
        /// The number of repetitions, 0 or 1.
        subdivisions: u8,
    },
    /// An octahedron whose faces are subdivided into four, repeatedly.
    Octahedron {
        /// The number of repetitions, 0 or 1.
        subdivisions: u8,
    },
    /// A triangulation of a disc, a sphere or a surface with holes, grown from one triangle by up
    /// to 48 moves. Modulo 4, each byte inserts a vertex in a face, adds a triangle to a
    /// boundary edge, flips an edge, or closes the gap between two boundary edges. The rest of the
    /// byte selects the place. A move that would not leave a manifold is skipped.
    Grown(
        /// The moves, in order.
        Vec<u8>,
    ),
    /// Separate triangles whose sides are glued in pairs, with any genus and any number of
    /// components, and one vertex without a face. A gluing that would not leave a manifold is
    /// skipped.
    Glued {
        /// The number of triangles, 1 to 24.
        faces: u8,
        /// The pairs of sides, up to 48, each number modulo three times `faces`.
        sides: Vec<[u8; 2]>,
    },
    /// A shape that is taken apart along seams whose two sides coincide, as exporters write meshes: the
    /// vertices of both sides are at equal places, but the mesh does not know that they belong together.
    /// Text: `unsewn FACES SHAPE`, as in `unsewn 0b0110 grid 2 2 0b0`.
    Unsewn {
        /// The faces on one side of the seams: bit `i % 64` is set if face `i` is.
        faces: u64,
        /// The shape, which is sewn.
        shape: Box<Shape>,
    },
}

/// The largest number of moves of a grown mesh, and of gluings of a glued one.
pub(super) const GROWN_MAX: usize = 48;

impl Shape {
    /// Creates the mesh of this shape and the positions of its vertices.
    ///
    /// # Panics
    ///
    /// If a number is below the lower limit given for its shape.
    #[must_use]
    pub fn make(&self) -> (Mesh, Positions) {
        match *self {
            Shape::Grid {
                columns,
                rows,
                rising,
            } => {
                let bit = |column, row| (row * u32::from(columns) + column) % 64;
                shapes::grid_with_diagonals(columns.into(), rows.into(), |column, row| {
                    rising >> bit(column, row) & 1 == 1
                })
            }
            Shape::Fan { faces, closed } => shapes::fan(faces.into(), closed),
            Shape::Saddle => shapes::saddle(),
            Shape::Tube { around, along } => shapes::tube(around.into(), along.into()),
            Shape::Torus { around, across } => shapes::torus(around.into(), across.into()),
            Shape::Tetrahedron { subdivisions } => subdivided(shapes::tetrahedron(), subdivisions),
            Shape::Octahedron { subdivisions } => subdivided(shapes::octahedron(), subdivisions),
            Shape::Grown(ref moves) => on_a_lattice(grown(moves)),
            Shape::Glued { faces, ref sides } => on_a_lattice(glued(faces, sides)),
            Shape::Unsewn { faces, ref shape } => unsewn(shape.make(), faces),
        }
    }
}

/// Tears a mesh between the faces that are chosen and the others, and forgets that it was whole.
fn unsewn((mut mesh, mut positions): (Mesh, Positions), faces: u64) -> (Mesh, Positions) {
    let mut edits = Edits::new();
    let mut take = |mesh: &mut Mesh, v, faces: &[FaceId]| {
        // It is refused where all faces are taken, or none.
        _ = split::vertex(mesh, v, faces, &mut edits);
    };
    for v in mesh.vertices() {
        let chosen = mesh
            .faces_of(v)
            .filter(|f| faces >> (f.index() % 64) & 1 == 1);
        let chosen: Vec<FaceId> = chosen.collect();
        take(&mut mesh, v, &chosen);
    }
    // What touches at a point alone is apart as well.
    for v in mesh.vertices() {
        let fans: Vec<HalfEdgeId> = mesh.fans(v).skip(1).collect();
        for h in fans {
            let fan: Vec<FaceId> = mesh.fan(h).map(HalfEdgeId::face).collect();
            take(&mut mesh, v, &fan);
        }
    }
    edits.replay(&mut positions);
    let mesh = Mesh::build(mesh.vertex_count(), mesh.indices().as_chunks().0);
    let positions = Positions::new(positions.as_slice().iter().copied());
    (
        mesh.expect("each vertex has one fan"),
        positions.expect("they were usable"),
    )
}

/// Divides each face into four, `times` times, by new vertices at the middles of the edges.
fn subdivided((mesh, positions): (Mesh, Positions), times: u8) -> (Mesh, Positions) {
    if times == 0 {
        return (mesh, positions);
    }
    let mut points = positions.as_slice().to_vec();
    let mut middle = vec![0; mesh.half_edge_count()];
    for h in mesh.edges() {
        let [p, q] = [mesh.origin(h), mesh.target(h)].map(|v| positions.at(v));
        for side in [Some(h), mesh.pair(h)].into_iter().flatten() {
            middle[side.index()] = points.len() as u32;
        }
        points.push(((p.coords + q.coords) / 2.0).into());
    }
    let mut triangles = Vec::new();
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(u32::from);
        let [ab, bc, ca] = f.half_edges().map(|h| middle[h.index()]);
        triangles.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    let mesh = Mesh::build(points.len(), &triangles).expect("a subdivided manifold is one");
    let positions = Positions::new(points).expect("middles are finite");
    subdivided((mesh, positions), times - 1)
}

/// Small whole coordinates, so that planes through one vertex often pass through others. The
/// first 77 points differ already by their first two.
fn on_a_lattice(mesh: Mesh) -> (Mesh, Positions) {
    let points = (0..mesh.vertex_count() as u32).map(|i| {
        let [x, y, z] = [3 * i % 7, 5 * i % 11, i * i % 13].map(f64::from);
        [x - 3.0, y - 5.0, z - 6.0]
    });
    let positions = Positions::new(points).expect("whole numbers are finite");
    (mesh, positions)
}

fn grown(moves: &[u8]) -> Mesh {
    let mut vertices = 3;
    let mut triangles = vec![[0, 1, 2]];
    let mut mesh = Mesh::build(vertices, &triangles).expect("a triangle is a manifold");
    for &code in moves {
        let Some((more, trial)) = moved(&mesh, &triangles, code) else {
            continue;
        };
        if let Ok(grown) = Mesh::build(vertices + more, &trial) {
            (mesh, triangles, vertices) = (grown, trial, vertices + more);
        }
    }
    mesh
}

/// The triangles after a move, and how many vertices it adds; `None` if there is no place for it.
fn moved(mesh: &Mesh, triangles: &[[u32; 3]], code: u8) -> Option<(usize, Vec<[u32; 3]>)> {
    let (place, new) = (usize::from(code / 4), mesh.vertex_count() as u32);
    // A half-edge with a pair, or one without, by number modulo how many there are.
    let nth = |paired: bool| {
        let wanted = |h: &HalfEdgeId| mesh.pair(*h).is_some() == paired;
        let count = mesh.half_edges().filter(wanted).count();
        mesh.half_edges().filter(wanted).nth(place % count.max(1))
    };
    let ends = |h: HalfEdgeId| [mesh.origin(h), mesh.target(h)].map(u32::from);
    let mut trial = triangles.to_vec();
    match code % 4 {
        0 => {
            let [a, b, c] = trial[place % triangles.len()];
            trial[place % triangles.len()] = [a, b, new];
            trial.extend([[b, c, new], [c, a, new]]);
        }
        1 => {
            let [a, b] = ends(nth(false)?);
            trial.push([b, a, new]);
        }
        2 => {
            let h = nth(true)?;
            let g = mesh.pair(h)?;
            let ([a, b], [c, _], [d, _]) = (ends(h), ends(h.prev()), ends(g.prev()));
            trial[h.face().index()] = [a, d, c];
            trial[g.face().index()] = [d, b, c];
        }
        _ => {
            let h = nth(false)?;
            let ([a, b], [_, c]) = (ends(h), ends(mesh.boundary_loop(h).nth(1)?));
            trial.push([a, c, b]);
        }
    }
    Some((usize::from(code % 4 < 2), trial))
}

fn glued(faces: u8, sides: &[[u8; 2]]) -> Mesh {
    let corners = 3 * u32::from(faces);
    let mut triangles: Vec<[u32; 3]> = (0..u32::from(faces))
        .map(|f| [3 * f, 3 * f + 1, 3 * f + 2])
        .collect();
    for pair in sides {
        let [[a, b], [c, d]] = pair.map(|side| {
            let (face, corner) = (usize::from(side) / 3, usize::from(side) % 3);
            let triangle = triangles[face % usize::from(faces)];
            [triangle[corner], triangle[(corner + 1) % 3]]
        });
        let mut trial = triangles.clone();
        for v in trial.as_flattened_mut() {
            let glued = [(d, a), (c, b)].into_iter().find(|(of, _)| of == v);
            *v = glued.map_or(*v, |(_, to)| to);
        }
        if Mesh::build(corners as usize, &trial).is_ok() {
            triangles = trial;
        }
    }
    let mut number = vec![None; corners as usize];
    let mut vertices = 0;
    for v in triangles.as_flattened_mut() {
        *v = *number[*v as usize].get_or_insert_with(|| {
            vertices += 1;
            vertices - 1
        });
    }
    Mesh::build(vertices as usize + 1, &triangles).expect("renumbering keeps a manifold")
}
