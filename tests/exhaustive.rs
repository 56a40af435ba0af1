//! The exhaustive small scope: every small mesh, every edit of it, and every short sequence of
//! edits.
//!
//! A mesh here is a connected oriented gluing of N triangles that is an oriented 2-manifold, up to
//! isomorphism: any genus, any boundary. On each, every nonempty proper subset of the faces of
//! every vertex is split off, several times in a row; and on smaller ones splits take turns with
//! all merges of two copies and with insertions: on every edge, in every face, and two at once; and on the
//! smallest with chords, slides, splits by planes and sewing too. All properties are checked after each. What goes wrong at all goes wrong on a small mesh.

use tearmesh::insert::{ChordEnd, Plan, Point};
use tearmesh::script::{Operation, Step, World};
use tearmesh::{FaceId, HalfEdgeId, Mesh, Positions, VertexId};

use crate::lockstep::{Done, Model};
use crate::oracle::{Soup, is_strict, joined_sets};

#[test]
fn every_split_of_every_small_mesh() {
    let splits = |faces_max, in_a_row| edits_of_meshes(Kinds::Splits, faces_max, in_a_row).splits;
    assert_eq!(splits(7, 1), 10_294);
    assert_eq!(splits(6, 2), 78_094);
    assert_eq!(splits(4, 3), 28_186);
}

#[test]
#[ignore = "for release builds: cargo test --release -p tearmesh -- --ignored"]
fn every_split_of_every_larger_mesh() {
    let splits = |faces_max, in_a_row| edits_of_meshes(Kinds::Splits, faces_max, in_a_row).splits;
    assert_eq!(splits(9, 1), 248_782);
    assert_eq!(splits(7, 2), 444_082);
    assert_eq!(splits(5, 3), 191_658);
}

#[test]
fn every_edit_of_every_small_mesh() {
    assert_eq!(edits(6, 1), [2_454, 2_589, 0]);
}

#[test]
fn every_two_edits_of_every_small_mesh() {
    assert_eq!(edits(4, 2), [15_940, 16_210, 162]);
}

#[test]
fn every_three_edits_of_every_small_mesh() {
    assert_eq!(edits(2, 3), [50_006, 47_265, 554]);
}

/// Splits, insertions, merges and slides where chords, planes and sewing are tried as well.
#[test]
fn every_edit_of_every_kind_of_the_least_meshes() {
    let all = |faces_max, in_a_row| edits_of_meshes(Kinds::AndMore, faces_max, in_a_row);
    for (done, expected, slides) in [
        (all(5, 1), [620, 1_271, 0], 422),
        (all(3, 2), [5_176, 10_506, 68], 3_485),
    ] {
        assert_eq!((counts(done), done.slides), (expected, slides));
    }
}

#[test]
#[ignore = "for release builds: cargo test --release -p tearmesh -- --ignored"]
fn every_edit_of_every_larger_mesh() {
    assert_eq!(edits(8, 1), [50_654, 38_778, 0]);
    assert_eq!(edits(5, 2), [56_534, 52_563, 526]);
    assert_eq!(edits(3, 3), [305_500, 247_188, 3_386]);
}

/// The meshes without an inner vertex, handle or hole are the polygons, triangulated: up to
/// rotation there are 1, 1, 1, 4, 6, 19, 49, … of them (OEIS A001683).
#[test]
fn the_enumeration_finds_all_triangulated_polygons() {
    for (faces, expected) in [1, 1, 1, 4, 6, 19, 49].into_iter().enumerate() {
        let faces = faces + 1;
        let mut found = 0;
        for_each_gluing(faces, &mut |opposite| {
            let inner_edges = opposite.iter().filter(|&&other| other != BOUNDARY).count() / 2;
            let vertices = strict_mesh(opposite).map(|(vertices, _)| vertices);
            found += u32::from(vertices == Some(faces + 2) && inner_edges == faces - 1);
        });
        assert_eq!(
            found, expected,
            "triangulations of a polygon into {faces} triangles"
        );
    }
}

/// What is done to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kinds {
    Splits,
    All,
    /// Also chords, slides, splits by planes, and sewing.
    AndMore,
}

/// Splits, insertions and merges.
fn counts(done: Done) -> [usize; 3] {
    [done.splits, done.insertions, done.merges]
}

/// How many of each [`edits_of_meshes`] did, of all kinds.
fn edits(faces_max: usize, in_a_row: usize) -> [usize; 3] {
    counts(edits_of_meshes(Kinds::All, faces_max, in_a_row))
}

/// Checks all edit sequences of a given length on all meshes up to a given number of faces; returns
/// how many edits that were.
fn edits_of_meshes(kinds: Kinds, faces_max: usize, in_a_row: usize) -> Done {
    let mut count = Done::default();
    for faces in 1..=faces_max {
        for_each_gluing(faces, &mut |opposite| {
            if let Some((vertices, triangles)) = strict_mesh(opposite) {
                State::new(vertices, &triangles).edit_in_all_ways(kinds, in_a_row, &mut count);
            }
        });
    }
    count
}

#[derive(Clone)]
struct State {
    world: World,
    model: Model,
}

impl State {
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> State {
        let mesh = Mesh::build(vertices, triangles).expect("the oracle calls it a manifold");
        let points = (0..vertices as u32).map(|i| [i, i * i, 1].map(f64::from));
        let world = World::of(mesh, Positions::new(points).expect("small numbers"));
        let model = Model::new(&world);
        State { world, model }
    }

    fn edit_in_all_ways(&self, kinds: Kinds, depth: usize, count: &mut Done) {
        if depth == 0 {
            return;
        }
        self.split_in_all_ways(kinds, depth, count);
        if kinds != Kinds::Splits {
            self.insert_in_all_ways(kinds, depth, count);
            self.merge_in_all_ways(kinds, depth, count);
        }
        if kinds == Kinds::AndMore {
            self.cross_faces_in_all_ways(depth, count);
            self.edit_by_scripts(depth, count);
        }
    }

    /// Edits and checks everything, and goes on from there if it was not refused.
    fn then(
        &self,
        kinds: Kinds,
        depth: usize,
        count: &mut Done,
        edit: impl FnOnce(&mut World, &mut dyn FnMut(&World, &Step<'_>)),
    ) {
        let State {
            mut world,
            mut model,
        } = self.clone();
        model.done = Done::default();
        edit(&mut world, &mut |world, step| model.follow(world, step));
        model.undoing_everything_gives_the_input_back();
        let done = model.done;
        count.add(done);
        if done.refused == 0 {
            State { world, model }.edit_in_all_ways(kinds, depth - 1, count);
        }
    }

    fn split_in_all_ways(&self, kinds: Kinds, depth: usize, count: &mut Done) {
        for v in self.world.mesh.vertices() {
            let faces = self.model.soup().faces_of(v.index());
            for mask in 0..1usize << faces.len() {
                let moving: Vec<FaceId> = (0..faces.len())
                    .filter(|i| mask >> i & 1 == 1)
                    .filter_map(|i| FaceId::new(faces[i]))
                    .collect();
                self.then(kinds, depth, count, |world, observe| {
                    world.split(v, &moving, observe);
                });
            }
        }
    }

    /// On every edge, in every face, and some pairs in one face; a torn edge from both sides.
    fn insert_in_all_ways(&self, kinds: Kinds, depth: usize, count: &mut Done) {
        let mesh = &self.world.mesh;
        let inside = |f, weights| Point::Face { f, weights };
        let mut ways = Vec::new();
        for h in mesh.edges() {
            ways.push(vec![on(h, 0.5)]);
        }
        for face in mesh.faces() {
            let [a, b, c] = face.half_edges();
            let centre = inside(face, [1.0, 1.0, 1.0]);
            ways.push(vec![centre]);
            ways.push(vec![on(a, 0.25), on(b, 0.75)]);
            ways.push(vec![on(c, 0.5), on(c, 0.125)]);
            ways.push(vec![centre, on(b, 0.5)]);
            ways.push(vec![centre, inside(face, [2.0, 1.0, 1.0])]);
        }
        for points in ways {
            self.then(kinds, depth, count, |world, observe| {
                world.insert(&plan(&points, None), observe);
            });
        }
    }

    fn merge_in_all_ways(&self, kinds: Kinds, depth: usize, count: &mut Done) {
        let class = &self.model.soup().class;
        for one in 0..class.len() {
            for other in one + 1..class.len() {
                // One pair of strangers for each vertex, which must be refused.
                if class[one] == class[other] || other == one + 1 {
                    let [one, other] =
                        [one, other].map(|v| VertexId::new(v).expect("a small number"));
                    self.then(kinds, depth, count, |world, observe| {
                        world.merge(other, one, [1.0, 3.0], observe);
                    });
                }
            }
        }
    }
}

/// An end of a chord: a corner, or one of the points that are inserted.
#[derive(Clone, Copy)]
enum End {
    Corner(HalfEdgeId),
    Point(usize),
}

fn on(h: HalfEdgeId, t: f64) -> Point {
    let forward = true;
    Point::Edge { h, t, forward }
}

/// The plan of these points, and of a chord across a face.
fn plan(points: &[Point], chord: Option<(FaceId, [End; 2])>) -> Plan {
    let mut plan = Plan::new();
    let add = |point: &Point| match *point {
        Point::Edge { h, t, .. } => plan.on_edge(h, t),
        Point::Face { f, weights } => plan.in_face(f, weights),
    };
    let ids: Vec<_> = points.iter().map(add).collect();
    if let Some((face, ends)) = chord {
        let end = |end| match end {
            End::Corner(h) => ChordEnd::Corner(h),
            End::Point(i) => ChordEnd::Point(ids[i]),
        };
        plan.chord(face, ends.map(end));
    }
    plan
}

impl State {
    /// A chord across every face: between two points on its edges, from each corner to the edge opposite to
    /// it, and from each corner to a point inside; and one that is refused, as it is an edge already.
    fn cross_faces_in_all_ways(&self, depth: usize, count: &mut Done) {
        for face in self.world.mesh.faces() {
            let corners = face.half_edges();
            let weights = [1.0, 1.0, 2.0];
            let mut ways = vec![(vec![], [0, 1].map(|i| End::Corner(corners[i])))];
            for i in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|by| corners[(i + by) % 3]);
                let (corner, point) = (End::Corner(a), End::Point);
                ways.push((vec![on(a, 0.25), on(b, 0.75)], [point(0), point(1)]));
                ways.push((vec![on(b, 0.5)], [corner, point(0)]));
                let around = vec![Point::Face { f: face, weights }, on(c, 0.5)];
                ways.push((around, [point(0), point(1)]));
            }
            for (points, ends) in ways {
                self.then(Kinds::AndMore, depth, count, |world, observe| {
                    world.insert(&plan(&points, Some((face, ends))), observe);
                });
            }
        }
    }

    /// Every vertex split by planes through it and slid along each of its edges, and sewing of all copies
    /// and of those of every second vertex.
    fn edit_by_scripts(&self, depth: usize, count: &mut Done) {
        let mut operations = vec![
            Operation::Sew { mask: 0xffff },
            Operation::Sew { mask: 0x5555 },
        ];
        for v in self.world.mesh.vertices() {
            let vertex = v.index() as u16;
            for normal in [[1, 0, 0], [-3, 1, 0], [0, 1, 1]] {
                operations.push(Operation::Plane { vertex, normal });
            }
            let around = self.model.soup().faces_of(v.index()).len() as u16;
            for toward in 0..=around {
                let (any, part) = (false, 16);
                operations.push(Operation::Slide {
                    vertex,
                    toward,
                    any,
                    part,
                });
            }
        }
        for operation in operations {
            self.then(Kinds::AndMore, depth, count, |world, observe| {
                world.apply(&operation, observe);
            });
        }
    }
}

/// A side of a face that has no other side.
const BOUNDARY: usize = usize::MAX;

/// Shows every connected oriented gluing of `triangles` triangles, up to isomorphism: for each side
/// (three a face) the side that it is glued to, or [`BOUNDARY`].
pub(crate) fn for_each_gluing(faces: usize, show: &mut impl FnMut(&[usize])) {
    let mut opposite = vec![None; 3];
    decide(0, faces, &mut opposite, &mut |opposite| {
        let smallest = (1..opposite.len()).all(|root| *opposite <= *seen_from(opposite, root));
        if smallest {
            show(opposite);
        }
    });
}

/// Decides what side `side` is glued to, and all sides after it. Faces are numbered as they are
/// met, and a new face is met at its side 0: so each gluing with a first side comes once.
fn decide(
    side: usize,
    faces: usize,
    opposite: &mut Vec<Option<usize>>,
    show: &mut impl FnMut(&[usize]),
) {
    if side == opposite.len() {
        if opposite.len() == 3 * faces {
            let all: Vec<usize> = opposite.iter().flatten().copied().collect();
            show(&all);
        }
        return;
    }
    if opposite[side].is_some() {
        return decide(side + 1, faces, opposite, show);
    }
    opposite[side] = Some(BOUNDARY);
    decide(side + 1, faces, opposite, show);
    for other in side + 1..opposite.len() {
        // Glued to itself, or to the same face twice, a face is part of no strict mesh.
        let [f, g] = [side / 3, other / 3];
        let glued_already = (3 * f..3 * f + 3).any(|s| {
            let to = opposite[s].filter(|&to| to != BOUNDARY);
            to.is_some_and(|to| to / 3 == g)
        });
        if f == g || glued_already || opposite[other].is_some() {
            continue;
        }
        (opposite[side], opposite[other]) = (Some(other), Some(side));
        decide(side + 1, faces, opposite, show);
        (opposite[side], opposite[other]) = (None, None);
    }
    if opposite.len() < 3 * faces {
        let new = opposite.len();
        opposite[side] = Some(new);
        opposite.extend([Some(side), None, None]);
        decide(side + 1, faces, opposite, show);
        opposite.truncate(new);
    }
    opposite[side] = None;
}

/// A gluing, renumbered as seen from another side.
fn seen_from(opposite: &[usize], root: usize) -> Vec<usize> {
    let turn = |side: usize, by: usize| side / 3 * 3 + (side + by) % 3;
    let mut number = vec![None; opposite.len()];
    let mut order = vec![root, turn(root, 1), turn(root, 2)];
    let mut seen = Vec::new();
    for i in 0..3 {
        number[order[i]] = Some(i);
    }
    for i in 0..opposite.len() {
        let other = opposite[order[i]];
        if other != BOUNDARY && number[other].is_none() {
            for by in 0..3 {
                number[turn(other, by)] = Some(order.len());
                order.push(turn(other, by));
            }
        }
        seen.push(if other == BOUNDARY {
            BOUNDARY
        } else {
            number[other].expect("numbered just now")
        });
    }
    seen
}

/// The vertices and triangles of a gluing, which need not be a strict mesh.
pub(crate) fn glued(opposite: &[usize]) -> (usize, Vec<[u32; 3]>) {
    let end = |side: usize| side / 3 * 3 + (side + 1) % 3;
    let mut joined = Vec::new();
    for (side, &other) in opposite.iter().enumerate() {
        if other != BOUNDARY {
            joined.push([side, end(other)]);
        }
    }
    let corner_of = joined_sets(opposite.len(), &joined);
    let mut first_corners: Vec<usize> = corner_of.clone();
    first_corners.sort();
    first_corners.dedup();
    let vertex = |corner: usize| first_corners.binary_search(&corner_of[corner]);
    let triangles: Vec<[u32; 3]> = (0..opposite.len() / 3)
        .map(|f| [3 * f, 3 * f + 1, 3 * f + 2].map(|corner| vertex(corner).expect("known") as u32))
        .collect();
    (first_corners.len(), triangles)
}

/// The vertices and triangles of a gluing, if they are a strict mesh whose links are those of
/// the gluing.
fn strict_mesh(opposite: &[usize]) -> Option<(usize, Vec<[u32; 3]>)> {
    let (vertices, triangles) = glued(opposite);
    if !is_strict(vertices, &triangles) {
        return None;
    }
    let points = vec![[0.0; 3]; vertices];
    let no_mass = vec![[0; 3]; triangles.len()];
    let links = Soup::new(&points, &triangles, &no_mass).links.len();
    let glued = opposite.iter().filter(|&&other| other != BOUNDARY).count();
    (2 * links == glued).then_some((vertices, triangles))
}
