//! Vertices that cuts slid onto their plane: on record with what they were before, and put back to the
//! bit when the cut is undone.

use tearmesh::mend;

use super::random::Random;
use super::torn_record::survives;
use super::work::{Work, files, simplified_later, undone_later, vertex};
use super::{read, rewritten, text};

/// Two objects, with all kinds of corners, and with colours, which slide along.
const FLAG: &str = "o flag\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0.3 0 0 1\nv 1 1 0 1 1 1\n\
    v 2 0.5 0.1 0 0 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 0.3 0.7\nvn 0 0 1\nvn 0 0.6 0.8\n\
    f 1/1/1 2/2/2 3/3/1\nf 3/3/1 2/2/2 4/4/1\nf 2/5/1 5/1/2 4/4/1\n\
    o tile\nv 9 9 9\nv 8 9 9\nv 9 8 9\nvt 0.1\nf 6/6 7/6 8/6\n";

#[test]
fn merged_copies_keep_the_colours_of_the_one_kept() {
    let document = read(FLAG.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("split 1 0, slide 8 0 .5");
    assert!(text(&work.written()).contains("\nv 0.5 0 0 0.5 0.5 0\n"));
    work.edit(|mesh, _, edits| {
        mend::merge(mesh, vertex(8), vertex(1), [1.0; 2], edits).expect("two copies");
    });
    let written = text(&work.written());
    assert!(
        written.starts_with("o flag\nv 0 0 0 1 0 0\nv 0.75 0 0 0 1 0\n"),
        "{written}"
    );
}

/// A texture seam along an edge.
const SEAM: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 -1 0\nvt 0 0\nvt 1 0\nvt 0.75 0.5\nvt 0 1\n\
    f 1/1 2/3 3/4\nf 2/2 1/1 4/4\n";

/// Four faces round a vertex, each with texture coordinates of its own that are alike where faces meet.
const ALIKE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\n\
    vt 0 0\nvt 1 0\nvt 0 1\nvt 0 0\nvt 0 1\nvt -1 0\nvt 0 0\nvt -1 0\nvt 0 -1\nvt 0 0\nvt 0 -1\nvt 1 0\n\
    f 1/1 2/2 3/3\nf 1/4 3/5 4/6\nf 1/7 4/8 5/9\nf 1/10 5/11 2/12\n";

/// As values at corners do that are no file's. (Found by combinations of `--weld`, `--snap-move` and `vt`.)
#[test]
fn regression_corners_with_alike_values_slide_together() {
    let document = read(ALIKE.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("slide 0 1 .25");
    let written = read(&work.written());
    for triangle in 0..4 {
        let index = written.corner(triangle, 0).texture.expect("it has one");
        assert_eq!(written.texture(index as usize), [0.25, 0.0]);
    }
}

/// Slides, with what is done before and after; and whether nothing can be taken out while a split holds the
/// vertex: what was put beside it where it slid to holds it there, and what was put beside it before is
/// held by the slide, but nothing counts as edited.
#[test]
fn a_slide_is_undone_to_the_bit() {
    for (file, deeds, is_held) in [
        (FLAG, "slide 1 3 .3", false),
        (FLAG, "slide 0 1 .7", false),
        (FLAG, "slide 1 3 .3, slide 1 2 .1", false),
        (FLAG, "slide 1 3 .3, next, slide 1 3 .3", false),
        (FLAG, "slide 1 3 .3, split 1 0", false),
        (FLAG, "slide 1 3 .3, insert 1, insert 0", false),
        (FLAG, "insert 1, next, slide 1 3 .3", false),
        (FLAG, "insert 1, slide 1 3 .3, split 1 0", false),
        (
            FLAG,
            "insert 1, next, slide 8 1 .3, next, slide 1 8 .2",
            false,
        ),
        (FLAG, "insert 1, next, slide 1 3 .5, split 1 0", true),
        (FLAG, "insert 1, next, slide 1 3 .5, split 1 2", true),
        (FLAG, "slide 1 3 .5, next, insert 1, split 8 0", true),
        // The vertex takes other indices on either side of the seam; the parts of a face have both.
        (SEAM, "insert 5, next, slide 0 1 .25", false),
        (ALIKE, "slide 0 1 .25", false),
        (ALIKE, "slide 0 1 .25, next, slide 0 2 .5, split 0 1", false),
        (SEAM, "insert 5, next, slide 0 1 .25, split 0 0", true),
    ] {
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        work.deeds(deeds);
        let written = text(&work.written());
        assert_ne!(written, file, "{deeds}");
        assert_eq!(text(&rewritten(written.as_bytes())), written, "{deeds}");
        if is_held {
            assert_eq!(work.simplified(), (written.clone(), [0; 3]), "{deeds}");
        }
        assert_eq!(
            undone_later(written.as_bytes()),
            file,
            "{deeds}:\n{written}"
        );
        assert_eq!(work.undone(), file, "{deeds}");
    }
}

/// Only one end of the edge between vertices 1 and 2 is split; the other end slides. The edge is torn all the same.
#[test]
fn a_torn_edge_holds_the_slides_of_its_cut_and_of_earlier_ones() {
    for (deeds, is_held) in [
        ("slide 1 3 .3, split 2 1", true),
        ("slide 1 3 .3, next, split 2 1", true),
        ("split 2 1, next, slide 1 3 .3", false),
    ] {
        let document = read(FLAG.as_bytes());
        let mut work = Work::on(&document);
        work.deeds(deeds);
        let (_, counts) = work.simplified();
        assert_eq!(counts, [0, 0, usize::from(!is_held)], "{deeds}");
        assert_eq!(work.undone(), FLAG, "{deeds}");
    }
}

/// Edits a file in several sessions, each of which reads what the previous one wrote. Whoever
/// writes again what was read writes the same, and all is undone at last.
fn is_undone_after_sessions(
    name: &str,
    file: &[u8],
    sessions: u64,
    mut edit: impl FnMut(&mut Work<'_>),
) {
    let mut bytes = file.to_vec();
    for _ in 0..sessions {
        let document = read(&bytes);
        let mut work = Work::on(&document);
        edit(&mut work);
        assert!(work.mesh.check().is_empty(), "{name}");
        bytes = survives(&work, name);
    }
    assert_eq!(undone_later(&bytes), text(&rewritten(file)), "{name}");
}

/// Edits a line of a file.
fn edited(file: &str, from: &str, to: &str) -> String {
    assert_eq!(file.matches(from).count(), 1, "{from} in {file}");
    file.replace(from, to)
}

#[test]
fn edits_of_a_slid_vertex_are_kept_and_told() {
    let document = read(FLAG.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("slide 1 3 .5, slide 0 2 .5");
    let written = text(&work.written());
    assert_eq!(
        simplified_later(written.as_bytes()),
        (FLAG.to_owned(), [0, 0, 2])
    );
    for (from, to) in [
        ("v 1 0.5 0 0.5 1 0.5\n", "v 1 0.5 0.25 0.5 1 0.5\n"),
        ("v 1 0.5 0 0.5 1 0.5\n", "v 1 0.5 0 0.5 1 0.75\n"),
        ("v 1 0.5 0 0.5 1 0.5\n", "v 1 0.5 0\n"),
        ("vt 1 0.5\n", "vt 1 0.25\n"),
        ("vt 1 0.5\n", "vt 1\n"),
    ] {
        let file = edited(&written, from, to);
        let (after, counts) = simplified_later(file.as_bytes());
        assert_eq!(counts, [0, 1, 1], "{from} -> {to}");
        // The other vertex is back, and the edit is there.
        assert!(after.starts_with("o flag\nv 0 0 0 1 0 0\n"), "{after}");
        assert!(after.contains(to), "{to} in {after}");
        // It stays on record, so it is said again, and so on.
        let (again, counts) = simplified_later(after.as_bytes());
        assert_eq!((again, counts), (after, [0, 1, 0]));
    }
    // What the corner had before may be edited: the corner has it back, as it is now.
    let file = edited(&written, "vt 1 0\n", "vt 1 0.125\n");
    let (after, counts) = simplified_later(file.as_bytes());
    assert_eq!(counts, [0, 0, 2]);
    assert_eq!(after, FLAG.replace("vt 1 0\n", "vt 1 0.125\n"));
    // Other numbers of texture coordinates may be others altogether.
    let file = edited(&written, "vt 0.1\n", "vt 0.1\nvt 0.2\n");
    let document = read(file.as_bytes());
    let said = &document.diagnostics()[0].message;
    assert!(
        said.starts_with("2 vertices that slid stay where they are"),
        "{said}"
    );
    let (after, counts) = simplified_later(file.as_bytes());
    assert_eq!(counts, [0, 0, 0]);
    assert!(after.contains("v 1 0.5 0 0.5 1 0.5\n"), "{after}");
}

/// Random slides, splits, insertions and merges, through files: all undone at last, and whoever writes
/// again what was read writes the same.
#[test]
fn slides_among_all_other_edits_are_undone_to_the_byte() {
    let mut slid = 0;
    for (name, file) in files() {
        for seed in 0..if name == "late" { 300 } else { 12 } {
            let mut random = Random(88_000 + seed);
            is_undone_after_sessions(
                &format!("{name}, seed {seed}"),
                &file,
                1 + seed % 3,
                |work| {
                    for _ in 0..1 + random.below(3) {
                        // A cut slides vertices before it divides anything, as ours do.
                        for _ in 0..random.below(4) {
                            slid += usize::from(work.slide_anywhere(&mut random));
                        }
                        work.tear(&mut random, 5, true);
                        work.torn.next_cut();
                    }
                },
            );
        }
    }
    assert!(slid > 500, "{slid}");
}
