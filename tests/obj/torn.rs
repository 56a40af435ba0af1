//! Writing a mesh after splits.

use super::work::{Work, assert_is_read_again};
use super::{read, rewritten, text};

/// Rows of the table beside this file: what is done, of how many lines about vertices it is told, a file, and what is
/// written of it up to the record.
///
/// Where a vertex at the end of a torn edge lies on the boundary, the two faces no longer share an edge there: it
/// gets a second `v`, too. `ARCSim` reads some lines into the last `v` before them. They stay where they are, and of
/// those about a vertex that has copies now, or of a `v` that is another's now, the number is told.
#[test]
fn lines_of_arcsim_stay_with_the_vertex_alone() {
    for row in include_str!("torn.txt").lines() {
        let plain = row.replace("\\n", "\n");
        let [deeds, unspoken, file, expected] = plain.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        work.deeds(deeds);
        let mut written = Vec::new();
        let summary = work.torn.write(&work.mesh, &work.positions, &mut written);
        let all = text(&written);
        assert_eq!(all.split("#tearmesh record ").next(), Some(expected));
        assert_eq!(text(&rewritten(&written)), all, "written again");
        assert_is_read_again(&work, &read(&written), file);
        let told = summary.expect("memory takes all").unspoken;
        assert_eq!(told.to_string(), unspoken, "{row}");
    }
}
