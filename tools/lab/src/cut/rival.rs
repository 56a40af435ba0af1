//! What other programs take for a cut, from a record of `tearmesh-bench cut`.

use std::fmt;

use serde::Serialize;

/// A row of a record: the time and the accuracy of a cut by some program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rival {
    /// The name of the program, or of a method of tearmesh.
    pub name: String,
    /// The number of faces of the mesh before the cut.
    pub faces: usize,
    /// The CPU time of the cut in ns, divided by `faces`.
    pub ns_per_face: f64,
    /// The largest distance of the seam from the plane, in mean edge lengths.
    pub deviation_edges: f64,
    /// The processor, as named in the record; `unknown` if the record does not name it.
    pub processor: String,
}

/// The error for a text that has no cut with both a time and a deviation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoRecord;

impl fmt::Display for NoRecord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("there is no cut with a time and a deviation in it")
    }
}

impl std::error::Error for NoRecord {}

/// Reads the rows of a record of `tearmesh-bench cut` that have both a time and a deviation.
///
/// For each mesh the record has a table of times, in the column `ms`, and a table of measures, with the
/// column `in edges`. Columns are separated by two or more spaces.
///
/// # Errors
///
/// [`NoRecord`] if there is no such row.
pub fn rivals(text: &str) -> Result<Vec<Rival>, NoRecord> {
    let cpu = text.lines().find_map(|line| line.strip_prefix("CPU"));
    let processor = cpu.unwrap_or("unknown").trim().to_owned();
    let (mut rivals, mut faces) = (Vec::new(), None);
    let mut times: Vec<(&str, f64)> = Vec::new();
    let mut place: Option<usize> = None;
    for line in text.lines() {
        if let Some(head) = line.strip_prefix("through cut of ") {
            let words: Vec<&str> = head.split([' ', ',', ';']).collect();
            let at = words.iter().position(|word| *word == "faces");
            faces = at.and_then(|at| words[at.checked_sub(1)?].parse::<usize>().ok());
            times.clear();
            place = None;
            continue;
        }
        let Some(faces) = faces else { continue };
        let columns = columns(line);
        if let Some(at) = columns.iter().position(|column| *column == "in edges") {
            place = Some(at + 1);
        } else if columns.len() < 2 {
            place = None;
        } else if let Some(at) = place {
            let deviation = columns.get(at).and_then(|number| number.parse().ok());
            let time = times.iter().find(|(name, _)| *name == columns[0]);
            if let (Some(deviation_edges), Some((name, ms))) = (deviation, time) {
                rivals.push(Rival {
                    name: (*name).to_owned(),
                    faces,
                    ns_per_face: 1e6 * ms / faces as f64,
                    deviation_edges,
                    processor: processor.clone(),
                });
            }
        } else if let Ok(ms) = columns[1].parse() {
            times.push((columns[0], ms));
        }
    }
    match rivals.is_empty() {
        true => Err(NoRecord),
        false => Ok(rivals),
    }
}

fn columns(line: &str) -> Vec<&str> {
    let parts = line.split("  ").map(str::trim);
    parts.filter(|part| !part.is_empty()).collect()
}
