//! What fuzzing found, and the seeds it started from, replayed.

use std::fs;
use std::path::Path;

use tearmesh_obj::Document;

use crate::{rewritten, text};

/// Bytes that can be read are written, and read and written again, the same.
fn survive(bytes: &[u8]) -> bool {
    let Ok(document) = Document::read(bytes) else {
        return false;
    };
    if document.mesh().is_err() {
        return false;
    }
    let written = rewritten(bytes);
    assert_eq!(text(&rewritten(&written)), text(&written));
    true
}

#[test]
fn seeds_and_regressions_survive() {
    let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz");
    let mut survived = 0;
    for folder in ["seeds/obj_read", "regressions/obj_read"] {
        for entry in fs::read_dir(fuzz.join(folder)).expect("a folder of inputs") {
            let path = entry.expect("an entry").path();
            survived += usize::from(survive(&fs::read(path).expect("an input")));
        }
    }
    assert!(survived >= 5);
}

#[test]
fn regression_a_backslash_at_the_end_of_the_file_joins_nothing() {
    for end in ["0\\", "0\\\n", "0 \\\r\n", "0\\\n\\", "\\", "0\\\n\t\\\n"] {
        assert!(
            survive(format!("f 1 2 3\nv 5 5 5\nv 6 5 0\nv 1 0 0\n{end}").as_bytes()),
            "{end:?}"
        );
        assert!(
            survive(format!("v 5 5 5\nv 6 5 0\nv 1 0 0\nf 1 2 3\n{end}").as_bytes()),
            "{end:?}"
        );
    }
    let kept = "v 5 5 5\nv 6 5 0\nv 1 0 0\nf 1 2 3\n# C:\\cloth\\\n";
    assert_eq!(text(&rewritten(kept.as_bytes())), kept);
}
