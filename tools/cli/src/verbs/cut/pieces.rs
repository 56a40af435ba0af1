//! Pieces: numbered OBJ files, the largest first, and a list of them.

use std::cmp::Reverse;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use tearmesh::{DerivedMesh, ExactSum, Mesh, Positions};
use tearmesh_obj::{PieceWriter, TornDocument};

use crate::args::CutArgs;
use crate::exit::Stop;
use crate::files::Names;
use crate::measure::area;
use crate::say::{Fault, count, printable};
use crate::{output, report};

/// Where pieces go.
pub(super) struct Pieces {
    folder: PathBuf,
    /// The files of an earlier run, which are replaced or removed.
    old: Vec<String>,
}

/// The name of the list.
const LIST: &str = "pieces.json";

/// The schema of the list.
const SCHEMA: &str = "tearmesh.pieces/1";

/// The list of the pieces.
#[derive(Serialize)]
struct List {
    schema: &'static str,
    pieces: Vec<Entry>,
    /// As long as they are being written, the files of this run and of an earlier one: so whatever ends a run, the
    /// next one knows whose they are.
    #[serde(skip_serializing_if = "BTreeSet::is_empty")]
    unfinished: BTreeSet<String>,
}

impl List {
    fn write(&self, folder: &Path) -> Result<(), Fault> {
        let json = serde_json::to_string_pretty(self);
        let json = json.expect("a list of strings and finite numbers is JSON") + "\n";
        output::write(&folder.join(LIST), |out| out.write_all(json.as_bytes()))
    }
}

#[derive(Serialize)]
struct Entry {
    file: String,
    vertices: usize,
    faces: usize,
    area: f64,
    /// What the input calls its faces.
    objects: Vec<String>,
    groups: Vec<String>,
    materials: Vec<String>,
}

impl Pieces {
    /// Refuses to replace files other than the pieces of an earlier run, if pieces are wanted.
    pub(super) fn of(args: &CutArgs, names: &Names<'_>) -> Result<Option<Pieces>, Stop> {
        let Some(folder) = args.pieces.clone().filter(|_| !args.files.dry_run) else {
            return Ok(None);
        };
        if folder == Path::new("-") {
            let help = "name a folder that exists or can be created";
            return Err(Stop::usage("`--pieces` takes the name of a folder", help));
        }
        let is_piece = |name: &str| name.starts_with("piece_") && name.ends_with(".obj");
        let is_ours = |name: &str| is_piece(name) || name == LIST;
        names.keep_from(&folder, ("a piece", "pieces"), is_ours)?;
        let entries = fs::read_dir(&folder).into_iter().flatten().flatten();
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        let mut old: Vec<String> = names.filter(|name| is_ours(name)).collect();
        old.sort();
        // Pieces of two runs in one folder could not be told apart, and those without a list may be anybody's.
        let listed = listed(&folder);
        if let Some(strange) = old.iter().find(|name| !listed.contains(name)) {
            let path = folder.join(strange);
            let message = format!("`{}` is not of an earlier run of --pieces", path.display());
            let help = "name another folder, or remove it first";
            return Err(Stop::usage(message, help));
        }
        Ok(Some(Pieces { folder, old }))
    }

    /// Writes the pieces, each whole or not at all, and removes those of an earlier run that had more. Before that,
    /// writes a list of the files that it will touch, and after it that of the pieces. Makes the folder where there
    /// is none.
    pub(super) fn write(
        &self,
        torn: &TornDocument<'_>,
        mesh: &Mesh,
        positions: &Positions,
    ) -> Result<report::Pieces, Fault> {
        let folder = &self.folder;
        output::make_folder(folder)?;
        let mut pieces = mesh.pieces(&mesh.components());
        // Of equal ones the one with the lowest face comes first, as it does now.
        pieces.sort_by_key(|piece| Reverse(piece.faces.len()));
        let writer = PieceWriter::new(torn);
        let new: BTreeSet<String> = (0..pieces.len()).map(name).collect();
        let mut list = List {
            schema: SCHEMA,
            pieces: Vec::with_capacity(pieces.len()),
            unfinished: new
                .iter()
                .chain(self.old.iter().filter(|old| *old != LIST))
                .cloned()
                .collect(),
        };
        list.write(folder)?;
        for (number, piece) in pieces.iter().enumerate() {
            let file = name(number);
            let path = folder.join(&file);
            let written = output::write(&path, |mut out| writer.write(piece, positions, &mut out))?;
            let names = writer.names(piece);
            list.pieces.push(Entry {
                file,
                vertices: written.vertices,
                faces: written.faces,
                area: area_of(piece, positions),
                objects: names.objects,
                groups: names.groups,
                materials: names.materials,
            });
        }
        let is_gone = |old: &&String| *old != LIST && !new.contains(*old);
        for old in self.old.iter().filter(is_gone) {
            let path = folder.join(old);
            fs::remove_file(&path).map_err(|error| output::cannot_write(&path, &error))?;
        }
        list.unfinished.clear();
        list.write(folder)?;
        let count = pieces.len();
        let folder = folder.display().to_string();
        Ok(report::Pieces { folder, count })
    }
}

/// The files of an earlier run in a folder, by its list there, and the list itself.
fn listed(folder: &Path) -> Vec<String> {
    let text = fs::read(folder.join(LIST)).unwrap_or_default();
    let list: serde_json::Value = serde_json::from_slice(&text).unwrap_or_default();
    if list["schema"] != SCHEMA {
        return Vec::new();
    }
    let of = |key: &str| list[key].as_array().into_iter().flatten();
    let pieces = of("pieces").map(|piece| &piece["file"]);
    let files = pieces.chain(of("unfinished"));
    let files = files.filter_map(|file| Some(file.as_str()?.to_owned()));
    files.chain([LIST.to_owned()]).collect()
}

/// The line of the summary.
pub(super) fn words(written: &report::Pieces) -> String {
    let pieces = count(written.count, "piece", "pieces");
    format!("{pieces} written into {}", printable(&written.folder))
}

/// The area of a piece, rounded once for each face and once as a whole.
fn area_of(piece: &DerivedMesh, positions: &Positions) -> f64 {
    let mesh = &piece.mesh;
    let areas = mesh.faces().map(|f| {
        let corners = mesh.face_vertices(f);
        area(corners.map(|v| positions.at(piece.vertices[v.index()])))
    });
    areas.collect::<ExactSum>().to_f64()
}

fn name(number: usize) -> String {
    format!("piece_{number:05}.obj")
}
