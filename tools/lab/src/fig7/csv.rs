//! The figures of a study as a table.

use std::fmt::Write as _;

use super::Study;
use crate::parts::{Missing, cell};

/// Returns the study as CSV: one line per patch, implementation and round. A missing patch has a line with its
/// name, and the reason in the last column.
#[must_use]
pub fn csv(study: &Study) -> String {
    let mut text = String::from(
        "cells,vertices,faces,splits,frames,frames_with_splits,simulation_s,way,round,sum_s,mean_s,median_s,\
         worst_frame_s,why\n",
    );
    for test in &study.tests {
        for timed in &test.ways {
            for (round, sum_s) in timed.sums_s.iter().enumerate() {
                writeln!(
                    text,
                    "{},{},{},{},{},{},{:.6},{},{round},{sum_s:.9},{:.9},{:.9},{:.9},",
                    test.cells,
                    test.vertices,
                    test.faces,
                    test.splits,
                    test.frames,
                    test.frames_with_splits,
                    test.simulation_s,
                    timed.way,
                    timed.mean_s,
                    timed.median_s,
                    timed.worst_frame_s,
                )
                .expect("a string grows");
            }
        }
    }
    for Missing { part, why } in &study.missing {
        writeln!(text, "{part},,,,,,,missing,,,,,,{}", cell(why)).expect("a string grows");
    }
    text
}
