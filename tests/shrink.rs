//! Shrinking: what comes back fails, and nothing more can be left out of it.

use tearmesh::script::{Operation, Script, Shape};

use crate::cases::cases;
use crate::random::Random;

/// The words of a cut that cannot be left out, since the numbers after them are those of no other path.
const PATHS: [&str; 6] = [
    "parallel",
    "eye",
    "converging",
    "plane",
    "continued",
    "closed",
];

/// By the definition: no operation can be left out, and no shape that is listed smaller will do.
#[test]
fn shrunk_scripts_have_nothing_to_leave_out() {
    let mut random = Random(43);
    let mut shrunk = 0;
    let count = cases() / 15;
    for _ in 0..count {
        let script = Script::from_bytes(&random.bytes(600));
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
        let mut asked = 0;
        let least = script.shrink(|script| {
            asked += 1;
            fails(script)
        });
        assert!(asked < 10_000, "{asked} runs");
        if !fails(&script) {
            assert_eq!(least, script, "there is nothing to shrink");
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
            match operation {
                Operation::Insert { spots, chord, .. } => {
                    assert_eq!((spots.len(), *chord), (0, None));
                }
                Operation::Cut { .. } => {
                    let text = operation.to_string();
                    let mut words = text.split(' ').skip(1);
                    let is_least = words.all(|word| word == "0" || PATHS.contains(&word));
                    assert!(is_least, "{text}");
                }
                _ => {}
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
            Shape::Unsewn { .. } => panic!("the shape does without seams"),
            _ => {}
        }
        shrunk += 1;
    }
    assert!(2 * shrunk >= count, "{shrunk} of {count}");
}
