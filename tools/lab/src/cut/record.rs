//! Records of `tearmesh-bench cut`: the times and the accuracy of other programs.

use super::Row;
use crate::experiment::Status;

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
    let mut rows = Vec::new();
    for mesh in text.split("through cut of ").skip(1) {
        let head = mesh.split_once(" faces").map_or("", |(head, _)| head);
        let faces = head.rsplit(' ').next().and_then(|word| word.parse().ok());
        let Some(faces) = faces else { continue };
        let times = column(mesh, "ms");
        for (name, deviation) in column(mesh, "in edges") {
            let time = times.iter().find(|(other, _)| *other == name);
            rows.extend(time.map(|(_, ms)| Row {
                method: name.to_owned(),
                faces,
                status: Status::Ok,
                ns_per_face: Some(1e6 * ms / faces as f64),
                deviation_edges: Some(deviation),
                processor: Some(processor.to_owned()),
                ..Row::default()
            }));
        }
    }
    rows
}

/// The numbers of a column of the first table that has it, with the names of their rows.
fn column<'a>(text: &'a str, head: &str) -> Vec<(&'a str, f64)> {
    let lines = text.lines().map(|line| {
        let fields = line.split("  ").map(str::trim);
        fields.filter(|field| !field.is_empty()).collect()
    });
    let mut lines = lines.skip_while(|fields: &Vec<&str>| !fields.contains(&head));
    let heads = lines.next().unwrap_or_default();
    // The column of names has no head.
    let place = 1 + heads.iter().take_while(|other| **other != head).count();
    let rows = lines.take_while(|fields| fields.len() > 1);
    rows.filter_map(|fields| Some((fields[0], fields.get(place)?.parse().ok()?)))
        .collect()
}
