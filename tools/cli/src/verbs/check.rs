//! The verb `check`: a line for each file.

use std::path::{Path, PathBuf};

use serde::Serialize;
use tearmesh::Masses;
use tearmesh::unsewn::UnsewnSeams;
use tearmesh_obj::Level;

use crate::args::{CheckArgs, Format};
use crate::exit::{Exit, Stop};
use crate::files::one_stream;
use crate::input::Input;
use crate::input::named::named;
use crate::measure::{Bounds, Edges, Piece};
use crate::output;
use crate::report::{Entry, File};
use crate::say::{Fault, count, place, printable, short, shown};
use crate::session;
use crate::streams::Streams;
use crate::weld;

/// The code of an invariant that does not hold.
const BROKEN: &str = "E-BUG-INVARIANT";

/// The codes of files that cannot be opened or read.
const UNREADABLE: [&str; 3] = ["E-IO-DIRECTORY", "E-IO-MISSING", "E-IO-READ"];

/// How many pieces of a mesh are listed in words, the largest first.
const SHOWN: usize = 8;

/// Checks every file, whatever is wrong with those before it.
pub(crate) fn run(args: &CheckArgs, streams: &mut Streams<'_>) -> Exit {
    if let Err(stop) = one_stream(&args.inputs) {
        return streams.conclude(Err(stop), Vec::new(), args.color, args.verbose);
    }
    let files = named(&args.inputs, args.recursive);
    let names = files.iter().map(|file| match file {
        Ok(path) | Err((path, _)) => shown(path).chars().count(),
    });
    let width = names.max().unwrap_or(0);
    let mut exit = Exit::Done;
    for file in files {
        let found = Found::of(file, streams);
        let mut worst = [Exit::Input, Exit::Bug, Exit::NothingCut].into_iter();
        let worst = worst.find(|one| [exit, found.exit()].contains(one));
        exit = worst.unwrap_or(Exit::Done);
        if args.quiet && found.exit() == Exit::Done {
            continue;
        }
        let line = match args.format {
            Format::Text if args.verbose => found.line(width) + &found.size(width),
            Format::Text => found.line(width),
            Format::Json => found.json(),
        };
        match output::print(streams.output, |out| writeln!(out, "{line}")) {
            Ok(Some(())) => {}
            Ok(None) => return exit, // Nobody reads on.
            Err(fault) => return streams.fail(&fault, args.color, Exit::Output),
        }
        if args.verbose && args.format == Format::Text {
            streams.show(&found.faults, args.color, true);
        }
    }
    exit
}

/// What was found in a file.
struct Found {
    path: String,
    mesh: Option<Measured>,
    faults: Vec<Fault>,
}

/// A mesh, and how large it is.
#[derive(Serialize)]
struct Measured {
    #[serde(flatten)]
    file: File,
    bounds: Bounds,
    edges: Edges,
    /// By their smallest faces.
    pieces: Vec<Piece>,
}

/// A line of JSON.
#[derive(Serialize)]
struct Line<'f> {
    schema: &'static str,
    ok: bool,
    path: &'f str,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<&'f Measured>,
    diagnostics: Vec<Entry>,
}

impl Found {
    /// A file, or why there is none.
    fn of(file: Result<PathBuf, (PathBuf, Fault)>, streams: &mut Streams<'_>) -> Found {
        let mut faults = Vec::new();
        let (path, measured) = match file {
            Ok(path) => (
                path.display().to_string(),
                measure(&path, &mut faults, streams),
            ),
            Err((path, fault)) => (path.display().to_string(), Err(fault.into())),
        };
        let (mesh, why) = match measured {
            Ok(measured) => (Some(measured), Vec::new()),
            Err(stop) => (None, stop.faults),
        };
        faults.extend(why.into_iter().map(|fault| match fault.code {
            "E-IO-DIRECTORY" => fault.help("add -r, to check the OBJ files in it"),
            _ => fault,
        }));
        Found { path, mesh, faults }
    }

    fn errors(&self) -> impl Iterator<Item = &Fault> {
        let faults = self.faults.iter();
        faults.filter(|fault| fault.level == Level::Error)
    }

    fn exit(&self) -> Exit {
        let has = |codes: &[&str]| self.errors().any(|fault| codes.contains(&fault.code));
        match self.errors().next() {
            None => Exit::Done,
            Some(_) if has(&UNREADABLE) => Exit::Input,
            Some(_) if has(&[BROKEN]) => Exit::Bug,
            Some(_) => Exit::NothingCut,
        }
    }

    fn line(&self, width: usize) -> String {
        let path = printable(&self.path);
        match (self.errors().next(), &self.mesh) {
            (None, Some(mesh)) => {
                format!("{path:width$}  ok    {}", summary(&mesh.file, &self.faults))
            }
            (first, _) => {
                let first = first.map(Fault::line).unwrap_or_default();
                let more = match self.errors().map(|fault| 1 + fault.unlisted).sum::<usize>() {
                    0 | 1 => String::new(),
                    errors => format!(" and {} more", errors - 1),
                };
                format!("{path:width$}  FAIL  {first}{more}")
            }
        }
    }

    /// How large the mesh is, in lines below the first; nothing if there is none.
    fn size(&self, width: usize) -> String {
        let Some(mesh) = &self.mesh else {
            return String::new();
        };
        let (edges, pieces) = (&mesh.edges, &mesh.pieces);
        let (least, most) = (place(mesh.bounds.min), place(mesh.bounds.max));
        let [shortest, mean, longest] = [edges.shortest, edges.mean, edges.longest].map(short);
        let mut lines = vec![format!(
            "from {least} to {most}, edges {shortest} to {longest} long, {mean} on average"
        )];
        let mut largest: Vec<(usize, &Piece)> = pieces.iter().enumerate().collect();
        largest.sort_by(|(_, one), (_, other)| other.area.total_cmp(&one.area));
        for (number, piece) in largest.iter().take(SHOWN) {
            let faces = count(piece.faces, "face", "faces");
            let (number, area) = (number + 1, short(piece.area));
            lines.push(format!("piece {number}: {faces}, area {area}"));
        }
        let more = pieces.len().saturating_sub(SHOWN);
        if more > 0 {
            let more = count(more, "smaller piece", "smaller pieces");
            lines.push(format!("and {more}"));
        }
        let indented = lines.iter().map(|line| format!("\n{:width$}  {line}", ""));
        indented.collect()
    }

    fn json(&self) -> String {
        let line = Line {
            schema: "tearmesh.check/1",
            ok: self.exit() == Exit::Done,
            path: &self.path,
            mesh: self.mesh.as_ref(),
            diagnostics: self.faults.iter().map(Entry::new).collect(),
        };
        serde_json::to_string(&line).expect("strings and numbers are JSON")
    }
}

/// Measures a mesh. What there is to say of it goes to `faults`.
fn measure(
    path: &Path,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<Measured, Stop> {
    let input = Input::find(path, streams.input)?;
    let opened = session::open(&input, None, "or cut with", faults)?;
    let (mesh, positions) = (&opened.mesh, &opened.positions);
    faults.extend(weld::warning(&UnsewnSeams::find(mesh, positions)));
    // What no verb could weigh, none can cut.
    let masses = Masses::area(mesh, positions, 1.0);
    faults.extend(masses.err().map(Fault::from));
    // For a mesh that was just built a violation would be a bug of ours.
    let violations = mesh.check().into_iter();
    faults.extend(violations.map(|broken| Fault::error(BROKEN, broken.to_string())));
    Ok(Measured {
        bounds: Bounds::of(mesh, positions),
        edges: Edges::of(mesh, positions),
        pieces: Piece::all(mesh, positions),
        file: File::of(Some(input.name), mesh),
    })
}

/// Counts, and the codes of warnings and notes.
fn summary(mesh: &File, faults: &[Fault]) -> String {
    let mut parts = vec![
        count(mesh.vertices, "vertex", "vertices"),
        count(mesh.faces, "face", "faces"),
        count(mesh.boundary_loops, "boundary loop", "boundary loops"),
    ];
    if mesh.components != 1 {
        parts.push(count(mesh.components, "component", "components"));
    }
    let mut codes: Vec<&str> = Vec::new();
    for fault in faults {
        if !codes.contains(&fault.code) {
            codes.push(fault.code);
        }
    }
    if !codes.is_empty() {
        parts.push(format!("[{}]", codes.join(" ")));
    }
    parts.join(" ")
}
