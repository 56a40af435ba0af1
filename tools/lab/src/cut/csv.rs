//! The figures of a study as a table.

use std::fmt::Write as _;

use super::Study;
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per sheet and method, and one per row of a record. The latter has only
/// a name, a number of faces, a time, a deviation and its processor. What is missing has a line with its name,
/// and the reason in the last column.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "way,faces,ns_per_face,deviation_edges,deviation_edges_most,length_ratio,length_ratio_most,\
         divided,crumbs,lost,inserted,edits,angle_min_deg,altitude_ratio,step_ratio,step_ratio_least,\
         record\n",
    );
    for row in &study.rows {
        let time = row
            .ns_per_face
            .map_or(String::new(), |ns| format!("{ns:.3}"));
        writeln!(
            text,
            "{},{},{time},{:.3e},{:.3e},{:.6},{:.6},{},{},{},{},{},{:.4},{:.3e},{:.4},{:.4},",
            row.way,
            row.faces,
            row.deviation_edges,
            row.deviation_edges_most,
            row.length_ratio,
            row.length_ratio_most,
            row.divided,
            row.crumbs,
            row.lost,
            row.inserted,
            row.edits,
            row.angle_min_deg,
            row.altitude_ratio,
            row.step_ratio,
            row.step_ratio_least,
        )
        .expect("a string grows");
    }
    for rival in &study.rivals {
        writeln!(
            text,
            "{},{},{:.3},{:.3e},,,,,,,,,,,,,{}",
            rival.name.replace(',', ""),
            rival.faces,
            rival.ns_per_face,
            rival.deviation_edges,
            rival.processor.replace(',', ""),
        )
        .expect("a string grows");
    }
    for Missing { part, why } in &study.missing {
        let why = cell(&format!("missing: {why}"));
        writeln!(text, "{part},,,,,,,,,,,,,,,,{why}").expect("a string grows");
    }
    text
}
