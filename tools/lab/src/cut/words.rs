//! What a study says, in words.

use std::fmt::Write as _;

use super::Study;

/// Returns the main measures as a text table, one table per sheet.
#[must_use]
pub fn summary(study: &Study) -> String {
    let mut text = String::new();
    let mut sizes: Vec<usize> = study.rows.iter().map(|row| row.faces).collect();
    sizes.dedup();
    for faces in sizes {
        writeln!(
            text,
            "{} cuts of {faces} faces\n  {:<16} {:>8} {:>10} {:>8} {:>8} {:>7} {:>9} {:>7} {:>9} {:>6}",
            study.cuts,
            "",
            "ns/face",
            "deviation",
            "length",
            "divided",
            "crumbs",
            "inserted",
            "angle",
            "altitude",
            "step"
        )
        .expect("a string grows");
        for row in study.rows.iter().filter(|row| row.faces == faces) {
            let time = row
                .ns_per_face
                .map_or("–".to_owned(), |ns| format!("{ns:.2}"));
            writeln!(
                text,
                "  {:<16} {time:>8} {:>10.1e} {:>8.4} {:>8} {:>7.2} {:>9} {:>7.2} {:>9.1e} {:>6.3}",
                row.way,
                row.deviation_edges,
                row.length_ratio,
                row.divided,
                row.crumbs,
                row.inserted,
                row.angle_min_deg,
                row.altitude_ratio,
                row.step_ratio,
            )
            .expect("a string grows");
        }
    }
    text
}
