//! What fuzzing found, and the seeds it started from, replayed.

use crate::differential::{self, Outcome};
use crate::inputs::seeds_and_finds;
use crate::random::Random;
use crate::same_bytes;

#[test]
fn seeds_and_regressions_survive() {
    let meshes = seeds_and_finds("obj_read").filter(|bytes| same_bytes::check_file(bytes, &[]));
    assert!(meshes.count() >= 5);
}

#[test]
fn torn_seeds_and_regressions_survive() {
    let meshes = seeds_and_finds("obj_roundtrip").filter(|bytes| same_bytes::check(bytes));
    assert!(meshes.count() >= 4);
}

/// The files of the seeds, every other time with two lines exchanged, torn, slid, divided and mended where
/// random bytes say.
#[test]
fn seeds_survive_random_deeds() {
    let mut random = Random(4);
    let mut meshes = 0;
    for bytes in seeds_and_finds("obj_roundtrip") {
        let file = bytes.split(|&byte| byte == 0).next().expect("a file");
        for round in 0..150 {
            let mut lines: Vec<&[u8]> = file.split_inclusive(|&byte| byte == b'\n').collect();
            if round % 2 == 1 {
                let [one, other] = [(); 2].map(|()| random.below(lines.len()));
                lines.swap(one, other);
            }
            let count = random.below(40);
            let deeds = random.bytes(count);
            meshes += usize::from(same_bytes::check_file(&lines.concat(), &deeds));
        }
    }
    assert!(meshes > 1000, "{meshes}");
}

#[test]
fn obj_rs_reads_the_seeds_as_we_do() {
    let inputs = seeds_and_finds("obj_differential");
    let outcomes: Vec<_> = inputs.map(|bytes| differential::check(&bytes)).collect();
    let count = |wanted| outcomes.iter().filter(|&&one| one == wanted).count();
    assert!(count(Outcome::Same) >= 4, "{outcomes:?}");
    assert!(count(Outcome::Refused) >= 2, "{outcomes:?}");
}

#[test]
fn files_that_obj_rs_reads_with_loss_are_left_out() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (more, outcome) in [
        ("", Outcome::Same),
        ("sp\ncurv 1 2\nfo 3 2 1\nnl 1\n", Outcome::Same),
        ("f 1 2 \\\n 3\n# \\\n", Outcome::Same),
        ("f 1 1 2\n", Outcome::Refused),
        ("g a b\n", Outcome::Lossy),
        ("v 1 2 1e39\n", Outcome::Lossy),
        ("v 1 2 nan\n", Outcome::Lossy),
        ("v 1 2 3.#INF\n", Outcome::Lossy),
        ("v 1 2 \u{a0}3\n", Outcome::Lossy),
        ("g a \\ \nf 1 2 3\n", Outcome::Lossy),
        ("g a\rf 1 2 3\n", Outcome::Lossy),
    ] {
        let file = format!("{triangle}{more}");
        assert_eq!(differential::check(file.as_bytes()), outcome, "{more:?}");
    }
    assert_eq!(differential::check(b"v 0 0 0\n"), Outcome::Refused);
}
