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
fn what_arcsim_says_of_a_vertex_stays_and_is_not_said_of_its_copies() {
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
fn a_vertex_with_several_fans_is_written_as_several() {
    // Six faces round vertex 7. Two opposite ones move to vertex 8: each is a fan there, and
    // 7 keeps two fans of two. Each torn spoke parts two faces that shared a vertex of the rim.
    let file = "v 1 0 0\nv 0.5 1 0\nv -0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0.5 -1 0\nv 0 0 0 0.125\n\
                f 7 1 2\nf 7 2 3\nf 7 3 4\nf 7 4 5\nf 7 5 6\nf 7 6 1\n";
    let summary = check(
        file,
        "split 6 0 3",
        "v 1 0 0\nv 0.5 1 0\nv -0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0.5 -1 0\nv 0 0 0 0.125\n\
         v 0 0 0 0.125\n\
         v 1 0 0\nv 0.5 1 0\nv -1 0 0\nv -0.5 -1 0\nv 0 0 0 0.125\nv 0 0 0 0.125\n\
         f 8 1 2\nf 7 10 3\nf 7 3 4\nf 14 11 5\nf 13 12 6\nf 13 6 9\n",
    );
    assert_eq!(
        summary,
        WriteSummary {
            vertices: 14,
            faces: 6,
            separated: 6,
            unspoken: 0,
        }
    );
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

#[test]
fn a_vertex_that_slides_takes_its_corners_with_it() {
    check(
        "v 0 0 0\nv 1 0 0 0.5\nv 0 1 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 9\n\
         f 1/1 2/2 3/3\nf 3/3 2/2 4/4\n",
        "slide 1 3 .5",
        "v 0 0 0\nv 1 0.5 0 0.75\nv 0 1 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 9\n\
         vt 1 0.5\nf 1/1 2/6 3/3\nf 3/3 2/6 4/4\n",
    );
}
