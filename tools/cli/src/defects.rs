//! What is wrong with a mesh, shown with the text of the faces concerned.
//!
//! The OBJ library knows the lines of the faces, but does not keep their text. Once a
//! file has been refused there is time to read it again.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};

use tearmesh::{Defect, FaceId};
use tearmesh_obj::{Document, MeshError, Repair};

use crate::input::Input;
use crate::say::{Excerpt, Fault, count};

/// How many faces of a defect are shown; its message has the lines of all.
const SHOWN: usize = 4;

/// How much of a long line is shown.
const WIDTH: usize = 160;

/// The first twenty defects; the last one says how many more there are, and which option would
/// repair them all, if one does: "or add --repair", with `or` in front.
pub(crate) fn faults(
    input: &Input,
    document: &Document,
    error: &MeshError,
    or: &str,
) -> Vec<Fault> {
    let lines_of = |defect: &Defect| {
        let mut lines: Vec<usize> = faces(defect)
            .iter()
            .map(|f| document.line_of_triangle(f.index()))
            .collect();
        lines.dedup();
        lines
    };
    let shown = || error.defects().iter().zip(error.shown());
    let wanted = shown()
        .flat_map(|(defect, _)| lines_of(defect))
        .map(|line| (line, String::new()));
    let texts = read(input, wanted.collect());
    let mut faults: Vec<Fault> = shown()
        .map(|(defect, diagnostic)| {
            let excerpt = |line: usize| {
                let text = texts.get(&line).filter(|text| !text.is_empty())?;
                let start = text.len() - text.trim_start().len();
                Some(Excerpt {
                    path: input.name.clone(),
                    line,
                    text: text.clone(),
                    first_column: 1,
                    span: start..text.trim_end().len(),
                    label: String::new(),
                })
            };
            // The last face is where a reader noticed.
            let mut lines = lines_of(defect);
            let last = lines.pop();
            Fault {
                excerpt: last.and_then(excerpt).map(Box::new),
                related: lines
                    .into_iter()
                    .filter_map(excerpt)
                    .take(SHOWN - 1)
                    .collect(),
                ..Fault::of_file(&input.name, diagnostic)
            }
        })
        .collect();
    let more = error.defects().len() - faults.len();
    if let Some(last) = faults.last_mut() {
        if more > 0 {
            last.message.push_str(&format!(
                "; and {}",
                count(more, "more defect", "more defects")
            ));
        }
        if let (Some(option), Some(help)) = (option_that_repairs(document), &mut last.help) {
            help.push_str(&format!("; {or} {option}"));
        }
    }
    faults
}

/// The mildest option with which this document would have a mesh. Tried, not guessed: a
/// hint must work when it is typed.
fn option_that_repairs(document: &Document) -> Option<&'static str> {
    let options = [
        ("--separate-fans", Repair::SeparateFans),
        ("--repair", Repair::All),
    ];
    let works = |repair| document.clone().repaired(repair).mesh().is_ok();
    options
        .into_iter()
        .find(|&(_, repair)| works(repair))
        .map(|(option, _)| option)
}

/// The faces of a defect, ascending.
fn faces(defect: &Defect) -> Vec<FaceId> {
    let mut faces = match defect {
        Defect::IndexOutOfRange { face, .. } | Defect::RepeatedVertex { face, .. } => vec![*face],
        Defect::DuplicateFaces { faces, .. } | Defect::CrowdedEdge { faces, .. } => faces.clone(),
        Defect::Pillow { faces, .. } | Defect::FlippedFace { faces, .. } => faces.to_vec(),
        Defect::BowTie { fans, .. } => fans.iter().filter_map(|fan| fan.first().copied()).collect(),
        _ => Vec::new(),
    };
    faces.sort();
    faces
}

/// Fills in the texts of lines, as far as they can be read again.
fn read(input: &Input, mut texts: BTreeMap<usize, String>) -> BTreeMap<usize, String> {
    let Ok(bytes) = input.open() else {
        return texts;
    };
    let mut bytes = BufReader::new(bytes);
    let last = texts.keys().next_back().copied().unwrap_or(0);
    let mut number = 0;
    let mut line = Vec::new();
    while number < last && matches!(bytes.read_until(b'\n', &mut line), Ok(1..)) {
        let end = if line.ends_with(b"\n") {
            line.len() - 1
        } else {
            line.len()
        };
        let end = if line[..end].ends_with(b"\r") {
            end - 1
        } else {
            end
        };
        // A lone CR ends a line too.
        for part in line[..end].split(|&byte| byte == b'\r') {
            number += 1;
            if let Some(text) = texts.get_mut(&number) {
                let all = String::from_utf8_lossy(part);
                let clean = |c: char| {
                    if c.is_control() && c != '\t' {
                        '\u{fffd}'
                    } else {
                        c
                    }
                };
                *text = all.chars().take(WIDTH).map(clean).collect();
            }
        }
        line.clear();
    }
    texts
}
