//! A file of strengths: a line `vertex strength` each. Vertices count from 1, as in OBJ.

use std::path::Path;

use tearmesh::VertexId;
use tearmesh_cloth::scene::Region;
use tearmesh_obj::Document;

use crate::exit::Stop;
use crate::input::Input;
use crate::say::Fault;
use crate::streams::Streams;

/// Reads the strengths of the vertices of a document; those that are not named have 1.
pub(super) fn read(
    path: &Path,
    document: &Document,
    streams: &mut Streams<'_>,
) -> Result<Vec<(Region, f64)>, Stop> {
    let file = Input::find(path, streams.input)?;
    let text = file.text()?;
    let mut strengths = Vec::new();
    for (i, line) in text.lines().enumerate() {
        let words = line.split('#').next().unwrap_or_default();
        if words.trim().is_empty() {
            continue;
        }
        match entry(words, document) {
            Ok((vertex, strength)) => strengths.push((Region::Vertices(vec![vertex]), strength)),
            Err(label) => {
                let fault = Fault::error("E-STRENGTH", "a line is not `vertex strength`");
                let span = 0..words.trim_end().len();
                let fault = fault.at((&file.name, i + 1), line, span, label);
                let help = "as in `17 0.5`: vertex 17 bears half the threshold";
                return Err(fault.help(help).into());
            }
        }
    }
    Ok(strengths)
}

fn entry(words: &str, document: &Document) -> Result<(VertexId, f64), String> {
    let mut words = words.split_whitespace();
    let (Some(vertex), Some(strength), None) = (words.next(), words.next(), words.next()) else {
        return Err("expected two numbers".to_owned());
    };
    let number: usize = vertex
        .parse()
        .map_err(|_| "expected a whole number first".to_owned())?;
    let vertex = document.vertex_of_number(number);
    let Some(vertex) = vertex.and_then(VertexId::new) else {
        let last = document.vertex_statement_count();
        return Err(format!("the mesh has the vertices 1 to {last}"));
    };
    let strength = strength.parse().ok();
    match strength.filter(|x: &f64| *x > 0.0 && x.is_finite()) {
        Some(strength) => Ok((vertex, strength)),
        None => Err("expected a strength above 0".to_owned()),
    }
}
