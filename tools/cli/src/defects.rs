//! Diagnostics of the defects of a mesh, with the text of the faces concerned.
//!
//! The OBJ library knows the lines of the faces, but does not keep their text. The file is read
//! again once it has been refused.

use std::collections::BTreeMap;
use std::io::{BufRead as _, BufReader};

use tearmesh::{Defect, FaceId, Faces};
use tearmesh_obj::{Document, MeshError, Repair};

use crate::input::Input;
use crate::say::{Fault, count, excerpt};

/// How many faces of a defect are shown; its message has the lines of all.
const SHOWN: usize = 4;

/// How much of a long line is shown.
const WIDTH: usize = 160;

/// The first twenty defects; the last one says how many more there are, and which option would
/// repair them all, if one does: "or add --repair", with `or` in front.
pub(crate) fn faults(input: &Input, document: Document, error: &MeshError, or: &str) -> Vec<Fault> {
    let lines_of = |defect| lines_of(defect, |face| document.line_of_triangle(face.index()));
    let shown = || error.error().defects().iter().zip(error.shown());
    let wanted = shown().flat_map(|(defect, _)| lines_of(defect));
    let texts = read(input, wanted.map(|line| (line, String::new())).collect());
    let mut faults: Vec<Fault> = shown()
        .map(|(defect, diagnostic)| {
            let excerpt_of = |line: usize| {
                let text = texts.get(&line).filter(|text| !text.is_empty())?;
                let start = text.len() - text.trim_start().len();
                let span = start..text.trim_end().len();
                Some(excerpt(line, text, span, String::new()))
            };
            // The last face is where a reader noticed.
            let mut lines = lines_of(defect);
            let last = lines.pop();
            let mut fault = Fault::of_file(&input.name, diagnostic);
            if let Some((location, excerpt)) = last.and_then(excerpt_of) {
                (fault.location, fault.excerpt) = (Some(location), Some(excerpt));
            }
            fault.related = lines.into_iter().filter_map(excerpt_of).collect();
            fault
        })
        .collect();
    let more = error.error().count() - faults.len();
    if let Some(last) = faults.last_mut() {
        last.unlisted = more;
        if more > 0 {
            let more = count(more, "more defect", "more defects");
            last.message.push_str(&format!("; and {more}"));
        }
        if let (Some(option), Some(help)) = (option_that_repairs(document), &mut last.help) {
            help.push_str(&format!("; {or} {option}"));
        }
    }
    faults
}

/// The mildest option with which this document would have a mesh. Tried, not guessed: a
/// hint must work when it is typed.
///
/// What is left after the first try may go on to the second, so that no copy is needed: fans that
/// have vertices of their own are no obstacle to what is dropped, nor to which faces are.
fn option_that_repairs(document: Document) -> Option<&'static str> {
    let document = document.repaired(Repair::SeparateFans);
    if document.mesh().is_ok() {
        return Some("--separate-fans");
    }
    let document = document.repaired(Repair::All);
    document.mesh().is_ok().then_some("--repair")
}

/// The lines of a defect that are shown: the first ones, and the last.
fn lines_of(defect: &Defect, line_of: impl Fn(FaceId) -> usize) -> Vec<usize> {
    let mut lines = Vec::new();
    let visit = |face| {
        let line = line_of(face);
        if lines.last() == Some(&line) {
            return; // Triangles of one polygon.
        }
        if lines.len() == SHOWN {
            lines.pop();
        }
        lines.push(line);
    };
    match *defect {
        Defect::IndexOutOfRange { face, .. } | Defect::RepeatedVertex { face, .. } => {
            [face].into_iter().for_each(visit);
        }
        Defect::DuplicateFaces { ref faces, .. } | Defect::CrowdedEdge { ref faces, .. } => {
            faces.iter().for_each(visit);
        }
        Defect::Pillow { faces, .. } | Defect::FlippedFace { faces, .. } => {
            faces.into_iter().for_each(visit);
        }
        Defect::BowTie { ref fans, .. } => fans.iter().map(Faces::first).for_each(visit),
        _ => {}
    }
    lines
}

/// Fills in the texts of lines, as far as they can be read again.
fn read(input: &Input, mut texts: BTreeMap<usize, String>) -> BTreeMap<usize, String> {
    let Ok(bytes) = input.open() else {
        return texts;
    };
    let last = texts.keys().next_back().copied().unwrap_or(0);
    let mut number = 0;
    let lines = BufReader::new(bytes).split(b'\n').map_while(Result::ok);
    for line in lines {
        // A lone CR ends a line too.
        let line = line.strip_suffix(b"\r").unwrap_or(&line);
        for part in line.split(|&byte| byte == b'\r') {
            number += 1;
            if let Some(text) = texts.get_mut(&number) {
                let all = String::from_utf8_lossy(part);
                let clean = |c: char| match c.is_control() && c != '\t' {
                    true => '\u{fffd}',
                    false => c,
                };
                *text = all.chars().take(WIDTH).map(clean).collect();
            }
        }
        if number >= last {
            break;
        }
    }
    texts
}
