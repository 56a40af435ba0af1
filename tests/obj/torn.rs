//! Writing a mesh after splits.

use tearmesh_obj::WriteSummary;

use super::work::{Work, assert_is_read_again};
use super::{read, rewritten, text};

/// What is written after deeds, up to the record.
fn check(file: &str, deeds: &str, expected: &str) -> WriteSummary {
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    work.deeds(deeds);
    let mut written = Vec::new();
    let summary = work.torn.write(&work.mesh, &work.positions, &mut written);
    let all = text(&written);
    assert_eq!(all.split("#tearmesh record ").next(), Some(expected));
    assert_eq!(text(&rewritten(&written)), all, "written again");
    assert_is_read_again(&work, &read(&written), file);
    summary.expect("memory takes all")
}

// Where a vertex at the end of a torn edge lies on the boundary, the two faces no longer share
// an edge there: it gets a second `v`, too.

/// `ARCSim` reads these into the last `v` before them. They stay where they are, and of those about a
/// vertex that has copies now, or of a `v` that is another's now, the number is told.
#[test]
fn lines_of_arcsim_stay_with_the_vertex_alone() {
    let start = "v 0 0 0\nv 1 0 0\nnl 2 # pinned\nvt 0\nnv 1 \\\n2 3\ne 1 2\nv 0 1 0\nv 1 1 0\nnl 4\nea 5\n";
    let summary = check(
        &format!("{start}f 1 2 3\nf 3 2 4\n"),
        "split 1 1",
        &format!("{start}v 1 0 0\nv 0 1 0\nf 1 2 3\nf 6 5 4\n"),
    );
    assert_eq!(summary.unspoken, 2);
    let summary = check(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0\nvv 1 2 3\n# end\nf 1 2 3\nf 3 2 4\n",
        "split 1 1",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nvt 0\nvv 1 2 3\n# end\nf 1 2 3\nf 6 5 4\n",
    );
    assert_eq!(summary.unspoken, 1);
}

#[test]
fn the_triangles_of_a_quad_can_be_torn_apart() {
    check(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0\nvt 1\nvn 0 0 1\nf 1/1/1 2/2/1 3//1 4\n",
        "split 0 1",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv 1 1 0\nvt 0\nvt 1\nvn 0 0 1\n\
         f 1/1/1 2/2/1 3//1\nf 5/1/1 6//1 4\n",
    );
}
