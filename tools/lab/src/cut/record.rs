//! Records of `tearmesh-bench cut`: the times and the accuracy of other programs.

use super::{Row, row};

/// Reads the rows of a record of `tearmesh-bench cut` that have both a time and a deviation; none if the text
/// is no such record.
///
/// For each mesh the record has a table of times, in the column `ms`, and a table of measurements, with the
/// column `in edges`. Columns are separated by two or more spaces. The processor is `unknown` if the record
/// does not name it.
#[must_use]
pub fn read_record(text: &str) -> Vec<Row> {
    let cpu = text.lines().find_map(|line| line.strip_prefix("CPU"));
    let processor = cpu.unwrap_or("unknown").trim();
    let (mut rows, mut faces) = (Vec::new(), None);
    let mut times: Vec<(&str, f64)> = Vec::new();
    let mut place: Option<usize> = None;
    for line in text.lines() {
        if let Some(head) = line.strip_prefix("through cut of ") {
            let words: Vec<&str> = head.split([' ', ',', ';']).collect();
            let at = words.iter().position(|word| *word == "faces");
            faces = at.and_then(|at| words[at.checked_sub(1)?].parse::<usize>().ok());
            (times, place) = (Vec::new(), None);
            continue;
        }
        let Some(faces) = faces else { continue };
        let columns = line.split("  ").map(str::trim);
        let columns: Vec<&str> = columns.filter(|column| !column.is_empty()).collect();
        if let Some(at) = columns.iter().position(|column| *column == "in edges") {
            // The column of names has no head.
            place = Some(at + 1);
        } else if columns.len() < 2 {
            place = None;
        } else if let Some(at) = place {
            let deviation = columns.get(at).and_then(|number| number.parse().ok());
            let time = times.iter().find(|(name, _)| *name == columns[0]);
            if let (Some(deviation), Some((name, ms))) = (deviation, time) {
                rows.push(Row {
                    ns_per_face: Some(1e6 * ms / faces as f64),
                    deviation_edges: Some(deviation),
                    processor: Some(processor.to_owned()),
                    ..row(name, faces, &[])
                });
            }
        } else if let Ok(ms) = columns[1].parse() {
            times.push((columns[0], ms));
        }
    }
    rows
}
