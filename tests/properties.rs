//! Properties of random scripts and of random triangle lists.

use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};

use proptest::prelude::*;
use proptest::test_runner::{Config, TestError, TestRunner};
use tearmesh::script::Script;
use tearmesh::{Defect, FaceId, Faces, Mesh};

use crate::cases::cases;
use crate::lockstep::{self, Done};
use crate::oracle::{Fault, faults, is_strict};

/// Runs a property on random cases. Every property comes through here, so that a failure is
/// printed and never written to a file: what is worth keeping becomes a regression.
fn for_all<S: Strategy>(strategy: &S, property: impl Fn(S::Value)) -> u32
where
    S::Value: std::fmt::Display,
{
    match run(strategy, Config::default().max_shrink_iters, property) {
        Ok(cases) => cases,
        Err((reason, case)) => panic!("{reason}\nthe smallest failing case:\n{case}"),
    }
}

/// Runs a property on random scripts. What fails is made small by [`Script::shrink`], which knows what a
/// script is.
fn for_all_scripts(property: impl Fn(&Script)) -> u32 {
    let failed = match run(&any::<Script>(), 0, |script| property(&script)) {
        Ok(cases) => return cases,
        Err((_, script)) => script,
    };
    let least = failed.shrink(|script| {
        let property = AssertUnwindSafe(|| property(script));
        catch_unwind(property).is_err()
    });
    println!("the least script that fails:\n{least}");
    property(&least);
    panic!("fails at times only:\n{failed}");
}

/// The number of cases, or why one failed, and that one.
fn run<S: Strategy>(
    strategy: &S,
    max_shrink_iters: u32,
    property: impl Fn(S::Value),
) -> Result<u32, (String, S::Value)> {
    let cases = cases().try_into().expect("below 2^32");
    let config = Config {
        cases,
        failure_persistence: None,
        max_shrink_iters,
        ..Config::default()
    };
    let result = TestRunner::new(config).run(strategy, |case| {
        property(case);
        Ok(())
    });
    match result {
        Ok(()) => Ok(cases),
        Err(TestError::Fail(reason, case)) => Err((reason.to_string(), case)),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn every_step_agrees_with_the_oracle() {
    let sum = RefCell::new(Done::default());
    let cases = for_all_scripts(|script| sum.borrow_mut().add(lockstep::check(script)));
    let done = sum.take();
    let least = cases as usize / 10;
    assert!(done.splits > 10 * least && done.insertions > 10 * least && done.merges > 10 * least);
    assert!(done.slides > 10 * least && done.refused > 10 * least);
    assert!(done.cuts.iter().all(|&cuts| cuts > least), "{done:?}");
}

#[test]
fn a_script_survives_its_text_and_its_bytes() {
    for_all(&any::<Script>(), |script| {
        assert!(script.operations.len() <= Script::OPERATIONS_MAX);
        assert_eq!(script.to_string().parse().as_ref(), Ok(&script));
        assert_eq!(Script::from_bytes(&script.to_bytes()), script);
    });
}

/// Triangles over a number of vertices, valid or not.
#[derive(Clone, Debug)]
struct Triangles {
    vertices: usize,
    faces: Vec<[u32; 3]>,
}

impl std::fmt::Display for Triangles {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} vertices, {:?}", self.vertices, self.faces)
    }
}

/// The builder accepts what the oracle accepts, and names what the oracle names.
fn building_agrees_with_the_oracle(vertices: usize, triangles: &[[u32; 3]]) {
    let known = faults(vertices, triangles);
    assert_eq!(
        known.is_empty(),
        is_strict(vertices, triangles),
        "the oracle agrees with itself"
    );
    match Mesh::build(vertices, triangles) {
        Ok(mesh) => {
            assert_eq!(known, [], "refused by the oracle alone");
            assert_eq!(mesh.indices(), triangles.as_flattened());
            assert_eq!(mesh.vertex_count(), vertices);
            assert_eq!(mesh.check(), []);
        }
        Err(error) => {
            let mut named: Vec<Fault> = error.defects().iter().map(plain).collect();
            named.sort();
            assert_eq!(named, known, "what is wrong");
        }
    }
}

/// A defect, in the words of the oracle.
fn plain(defect: &Defect) -> Fault {
    let numbers = |faces: &Faces| faces.iter().map(|f| f.index()).collect();
    let both = |faces: [FaceId; 2]| faces.map(FaceId::index).to_vec();
    let (what, vertices, faces) = match *defect {
        Defect::IndexOutOfRange { face, corner, .. } => {
            return Fault(
                "out of range",
                vec![corner as u32],
                vec![vec![face.index()]],
            );
        }
        Defect::RepeatedVertex { face, vertex } => ("repeated", vec![vertex], vec![face.index()]),
        Defect::DuplicateFaces { ref faces, .. } => ("duplicate", vec![], numbers(faces)),
        Defect::Pillow { faces, .. } => ("pillow", vec![], both(faces)),
        Defect::CrowdedEdge { ends, ref faces } => ("crowded", ends.to_vec(), numbers(faces)),
        Defect::FlippedFace { from, to, faces } => ("flipped", vec![from, to], both(faces)),
        Defect::BowTie { vertex, ref fans } => {
            let fans = fans.iter().map(numbers).collect();
            return Fault("bow-tie", vec![vertex.into()], fans);
        }
        ref other => panic!("no small mesh has {other}"),
    };
    let vertices = vertices.into_iter().map(u32::from);
    Fault(what, vertices.collect(), vec![faces])
}

#[test]
fn damaged_shapes_are_built_as_the_oracle_says() {
    let damage = prop::collection::vec(any::<[u8; 3]>(), 0..=3);
    let triangles = (any::<Script>(), damage).prop_map(|(script, damage)| {
        let (mesh, _) = script.shape.make();
        let mut triangles = Triangles {
            vertices: mesh.vertex_count(),
            faces: mesh
                .faces()
                .map(|f| mesh.face_vertices(f).map(u32::from))
                .collect(),
        };
        for [kind, a, b] in damage {
            triangles.damage(kind, a.into(), b.into());
        }
        triangles
    });
    for_all(&triangles, |it| {
        building_agrees_with_the_oracle(it.vertices, &it.faces);
    });
}

impl Triangles {
    fn damage(&mut self, kind: u8, a: usize, b: usize) {
        let count = self.faces.len();
        let [f, g] = [a % count, b % count];
        let [i, j] = [a / 3 % 3, b / 3 % 3];
        match kind % 8 {
            0 => self.faces[f].swap(0, 1),       // flipped
            1 => self.faces.push(self.faces[f]), // twice
            2 => {
                let [x, y, z] = self.faces[f];
                self.faces.push([y, x, z]); // back to back
            }
            3 => {
                let [x, y, _] = self.faces[f];
                self.faces.push([y, x, self.faces[g][j]]); // a third face, or a bridge
            }
            4 => self.faces[f][i] = self.vertices as u32 + b as u32 % 2, // out of range
            5 => self.faces[f][i] = self.faces[f][(i + 1) % 3],          // a vertex twice
            6 => self.faces[f][i] = self.faces[g][j], // another vertex: a bow-tie, or worse
            _ => {
                let [from, to] = [self.faces[f][i], self.faces[g][j]];
                for v in self.faces.as_flattened_mut() {
                    if *v == from {
                        *v = to; // two vertices made one
                    }
                }
            }
        }
    }
}

/// Every list of up to three oriented triangles on six vertices, and of up to four on five.
#[test]
fn all_small_lists_are_built_as_the_oracle_says() {
    for (vertices, most) in [(6, 3), (5, 4)] {
        let mut all = Vec::new();
        for a in 0..vertices {
            for b in a + 1..vertices {
                for c in b + 1..vertices {
                    all.extend([[a, b, c], [a, c, b]]);
                }
            }
        }
        let mut list = Vec::new();
        all_lists(&all, most, &mut list, &mut |list| {
            building_agrees_with_the_oracle(vertices as usize, list);
        });
    }
}

/// Shows every list of up to `most` triangles, none later in `all` than the next.
fn all_lists(
    all: &[[u32; 3]],
    most: usize,
    list: &mut Vec<[u32; 3]>,
    show: &mut impl FnMut(&[[u32; 3]]),
) {
    show(list);
    if list.len() < most {
        for (i, &triangle) in all.iter().enumerate() {
            list.push(triangle);
            all_lists(&all[i..], most, list, show);
            list.pop();
        }
    }
}
