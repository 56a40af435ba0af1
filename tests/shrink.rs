//! Shrinking: what comes back fails, and nothing more can be left out of it.

use std::collections::BTreeSet;

use tearmesh::script::{Operation, Script, Shape, Step};
use tearmesh::{Edit, VertexId};

use crate::cases::cases;
use crate::random::Random;

/// A kind of edit that a follower has forgotten.
type Forgotten = fn(&Edit<'_>) -> bool;

/// Whether a follower goes wrong that counts the faces of every vertex and has forgotten one kind of
/// edit: written as its author would, with no thought of shrinking.
fn goes_wrong(script: &Script, forgotten: Forgotten) -> bool {
    let mut wrong = false;
    let mut last: Option<Vec<usize>> = None;
    script.run(|world, step| {
        let count = |v: VertexId| world.mesh.faces_of(v).count();
        let truth: Vec<usize> = world.mesh.vertices().map(count).collect();
        let first = match step {
            Step::Split {
                outcome: Ok(first), ..
            }
            | Step::Plane {
                outcome: Some(first),
                ..
            }
            | Step::Insert {
                outcome: Ok(first), ..
            }
            | Step::Merge {
                outcome: Ok(first), ..
            } => Some(*first),
            Step::Sewn { first, .. } | Step::Cut { first, .. } => Some(*first),
            _ => None,
        };
        // Right as long as it follows, and then it has what was before.
        let forgets = first.is_some_and(|first| world.edits.since(first).any(|e| forgotten(&e)));
        wrong |= forgets && last.as_ref().is_some_and(|last| *last != truth);
        last = Some(truth);
    });
    wrong
}

/// Each with the fewest operations that show it.
const FORGOTTEN: [(&str, Forgotten, usize); 3] = [
    ("splits", |edit| matches!(edit, Edit::Split(_)), 1),
    ("insertions", |edit| matches!(edit, Edit::Insert(_)), 1),
    ("merges", |edit| matches!(edit, Edit::Merge(_)), 2),
];

fn random_script(random: &mut Random) -> Script {
    Script::from_bytes(&random.bytes(600))
}

/// The faces of the mesh with which a script begins.
fn faces(script: &Script) -> usize {
    script.shape.make().0.face_count()
}

#[test]
fn what_shows_a_wrong_follower_is_a_line_or_two() {
    let mut random = Random(41);
    let mut seen = [BTreeSet::new(), BTreeSet::new(), BTreeSet::new()];
    let (mut fewest, mut failing, mut asked_max) = (0, 0, 0);
    for _ in 0..cases(10_000) / 100 {
        let script = random_script(&mut random);
        for ((_, forgotten, operations), seen) in FORGOTTEN.iter().zip(&mut seen) {
            let mut asked = 0;
            let mut fails = |script: &Script| {
                asked += 1;
                goes_wrong(script, *forgotten)
            };
            if !fails(&script) {
                assert_eq!(script.shrink(fails), script, "there is nothing to shrink");
                continue;
            }
            let least = script.shrink(fails);
            assert!(goes_wrong(&least, *forgotten), "{least}");
            for i in 0..least.operations.len() {
                let mut shorter = least.clone();
                shorter.operations.remove(i);
                assert!(!goes_wrong(&shorter, *forgotten), "line {i} of\n{least}");
            }
            // Numbers are taken modulo what there is, so that an operation may be needed for that alone.
            fewest += usize::from(least.operations.len() == *operations);
            failing += 1;
            asked_max = asked_max.max(asked);
            assert!(faces(&least) <= faces(&script));
            seen.insert(least.to_string());
        }
    }
    println!("{fewest} of {failing} have the fewest operations; at most {asked_max} runs");
    assert!(10 * fewest >= 9 * failing && asked_max < 10_000);
    for ((what, ..), seen) in FORGOTTEN.iter().zip(&seen) {
        println!("{what}: {seen:#?}");
        assert!(seen.len() >= 2, "{what}: {seen:?}");
    }
}

/// By the definition: no operation can be left out, and no shape that is listed smaller will do.
#[test]
fn nothing_can_be_left_out_of_what_comes_back() {
    let mut random = Random(43);
    let mut shrunk = 0;
    for _ in 0..cases(10_000) / 100 {
        let script = random_script(&mut random);
        // No property of a mesh: any that operations have together will do.
        let wanted = random.below(6);
        let kinds = |script: &Script| {
            let kinds = script.operations.iter().map(std::mem::discriminant);
            kinds.fold(Vec::new(), |mut kinds, kind| {
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
                kinds
            })
        };
        let fails = |script: &Script| kinds(script).len() > wanted;
        let least = script.shrink(fails);
        if !fails(&script) {
            continue;
        }
        assert_eq!(least.operations.len(), wanted + 1);
        for i in 0..least.operations.len() {
            let mut shorter = least.clone();
            shorter.operations.remove(i);
            assert!(!fails(&shorter));
        }
        // None of it has a part that could be simpler.
        for operation in &least.operations {
            if let Operation::Insert { spots, chord, .. } = operation {
                assert_eq!((spots.len(), *chord), (0, None));
            }
        }
        match least.shape {
            Shape::Grid {
                columns,
                rows,
                rising,
            } => assert_eq!((columns, rows, rising), (1, 1, 0)),
            Shape::Grown(ref moves) => assert!(moves.is_empty()),
            Shape::Glued { faces, ref sides } => assert_eq!((faces, sides.len()), (1, 0)),
            Shape::Fan { faces, .. } => assert_eq!(faces, 3),
            _ => {}
        }
        shrunk += 1;
    }
    assert!(shrunk >= 50, "{shrunk}");
}
