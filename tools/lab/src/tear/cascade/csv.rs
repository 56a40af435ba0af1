//! Each run of the ensembles as a table.

use std::fmt::Write as _;

use super::Cascade;
use crate::parts::{Missing, cell};

/// Returns all runs of the ensembles as CSV, one line per run and one per missing part. The last column is the
/// reason of a failure.
#[must_use]
pub fn csv(cascades: &[Cascade], missing: &[Missing]) -> String {
    let mut text = String::from(
        "scene,cells,method,parts,step_s,seed,status,first_tear_s,first_force_n,torn_m,pieces,\
         largest_force_n,work_j,visits,why\n",
    );
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    for cascade in cascades {
        for ensemble in &cascade.ensembles {
            for member in &ensemble.members {
                let seen = member.observed;
                writeln!(
                    text,
                    "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                    cascade.scene,
                    cascade.cells,
                    cascade.method,
                    ensemble.step_divisor,
                    ensemble.step_s,
                    member.seed,
                    member.status.name(),
                    number(seen.and_then(|seen| seen.first_tear_s)),
                    number(seen.and_then(|seen| seen.first_force_n)),
                    number(seen.map(|seen| seen.torn_m)),
                    number(seen.map(|seen| seen.pieces as f64)),
                    number(seen.and_then(|seen| seen.largest_force_n)),
                    number(seen.and_then(|seen| seen.work_j)),
                    number(seen.map(|seen| seen.visits as f64)),
                    cell(&member.why),
                )
                .expect("a string grows");
            }
        }
    }
    for Missing { part, why } in missing {
        writeln!(text, "{part},,,,,,missing,,,,,,,,{}", cell(why)).expect("a string grows");
    }
    text
}
