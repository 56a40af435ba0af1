//! The exhaustive small scope: every small mesh, every split of it, and every sequence of so many.
//!
//! A mesh here is a connected oriented gluing of N triangles that is an oriented
//! 2-manifold, up to isomorphism: any genus, any boundary. On each, every nonempty proper subset
//! of the faces of every vertex is split off, so many times in a row, and all properties
//! are checked after each split. What goes wrong at all goes wrong on a small mesh.

use tearmesh::{Edits, FaceId, Masses, Mesh, Positions, split};

use crate::lockstep::{self, Told, soup_of};
use crate::oracle::{Soup, is_strict, joined_sets};

#[test]
fn every_split_of_every_small_mesh() {
    assert_eq!(splits_of_meshes(7, 1), 10_294);
    assert_eq!(splits_of_meshes(6, 2), 78_094);
    assert_eq!(splits_of_meshes(4, 3), 28_186);
}

#[test]
#[ignore = "for release builds: cargo test --release -p tearmesh -- --ignored"]
fn every_split_of_every_larger_mesh() {
    assert_eq!(splits_of_meshes(9, 1), 248_782);
    assert_eq!(splits_of_meshes(7, 2), 444_082);
    assert_eq!(splits_of_meshes(5, 3), 191_658);
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

/// Checks all sequences of so many splits on all meshes of up to so many faces; returns how many
/// splits that were.
fn splits_of_meshes(faces_max: usize, in_a_row: usize) -> usize {
    let mut count = Count::default();
    for faces in 1..=faces_max {
        for_each_gluing(faces, &mut |opposite| {
            count.gluings += 1;
            if let Some((vertices, triangles)) = strict_mesh(opposite) {
                count.meshes += 1;
                State::new(vertices, &triangles).split_in_all_ways(in_a_row, &mut count);
            }
        });
    }
    println!("up to {faces_max} faces, {in_a_row} splits in a row: {count:?}");
    count.splits
}

#[derive(Default, Debug)]
struct Count {
    gluings: usize,
    meshes: usize,
    splits: usize,
    refused: usize,
}

#[derive(Clone)]
struct State {
    input: Mesh,
    mesh: Mesh,
    soup: Soup,
    unit: f64,
    edits: Edits,
    area: Masses,
    half: Masses,
}

impl State {
    fn new(vertices: usize, triangles: &[[u32; 3]]) -> State {
        let mesh = Mesh::build(vertices, triangles).expect("the oracle calls it a manifold");
        let points = (0..vertices as u32).map(|i| [i, i * i, 1].map(f64::from));
        let positions = Positions::new(points).expect("small numbers");
        let (soup, unit) = soup_of(&mesh, &positions);
        lockstep::the_mesh_agrees(&mesh, &soup);
        let masses = "no face is without area";
        State {
            input: mesh.clone(),
            soup,
            unit,
            edits: Edits::new(),
            area: Masses::area(&mesh, &positions, 1.0).expect(masses),
            half: Masses::half(&mesh, &positions, 1.0).expect(masses),
            mesh,
        }
    }

    fn split_in_all_ways(&self, depth: usize, count: &mut Count) {
        if depth == 0 {
            return;
        }
        for v in 0..self.soup.root.len() {
            let faces = self.soup.faces_of(v);
            for mask in 0..1usize << faces.len() {
                let moving: Vec<usize> = (0..faces.len())
                    .filter(|i| mask >> i & 1 == 1)
                    .map(|i| faces[i])
                    .collect();
                let mut after = self.clone();
                if after.split(v, &moving, self) {
                    count.splits += 1;
                    after.split_in_all_ways(depth - 1, count);
                } else {
                    count.refused += 1;
                }
            }
        }
    }

    /// Splits and checks everything; false if the split was refused.
    fn split(&mut self, v: usize, moving: &[usize], before: &State) -> bool {
        let vertex = self.mesh.vertices().nth(v).expect("a vertex");
        let faces: Vec<FaceId> = moving.iter().filter_map(|&f| FaceId::new(f)).collect();
        let expected = self.soup.split(v, moving);
        let split = match split::faces(&mut self.mesh, vertex, &faces, &mut self.edits) {
            Ok(split) => split,
            Err(refusal) => {
                assert_eq!(Err(lockstep::plain(refusal)), expected);
                assert_eq!(
                    self.mesh, before.mesh,
                    "a refused split leaves the mesh alone"
                );
                assert_eq!(self.edits.len(), before.edits.len(), "and the log");
                return false;
            }
        };
        assert_eq!(expected, Ok(()));
        lockstep::a_split_changes_nothing_else(&before.mesh, &self.mesh, &split);
        let told = Told::by(&split);
        self.edits.replay(&mut (&mut self.area, &mut self.half));
        let edit = self
            .edits
            .iter()
            .next_back()
            .expect("the split is in the log");
        let split = lockstep::split_of(edit);
        assert_eq!(Told::by(&split), told, "the log keeps what it returned");
        lockstep::a_split_conserves_mass(&before.area, &self.area, &split);
        lockstep::a_split_conserves_mass(&before.half, &self.half, &split);
        lockstep::every_vertex_weighs_what_its_faces_weigh(&self.area, &self.soup, self.unit);
        lockstep::halves_add_up(&self.half, &self.soup, self.unit);
        lockstep::the_mesh_agrees(&self.mesh, &self.soup);
        let history = lockstep::told(&self.edits);
        lockstep::undoing_every_split_gives_the_input_back(&self.mesh, &history, &self.input);
        true
    }
}

/// A side of a face that has no other side.
const BOUNDARY: usize = usize::MAX;

/// Shows every connected oriented gluing of so many triangles, up to isomorphism: for each side
/// (three a face) the side that it is glued to, or [`BOUNDARY`].
fn for_each_gluing(faces: usize, show: &mut impl FnMut(&[usize])) {
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

/// The same gluing, numbered from another side.
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

/// The vertices and triangles of a gluing, if they are a strict mesh whose links are those of
/// the gluing.
fn strict_mesh(opposite: &[usize]) -> Option<(usize, Vec<[u32; 3]>)> {
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
    let vertices = first_corners.len();
    if !is_strict(vertices, &triangles) {
        return None;
    }
    let points = vec![[0.0; 3]; vertices];
    let no_mass = vec![[0; 3]; triangles.len()];
    let links = Soup::new(&points, &triangles, &no_mass).links.len();
    let glued = opposite.iter().filter(|&&other| other != BOUNDARY).count();
    (2 * links == glued).then_some((vertices, triangles))
}
