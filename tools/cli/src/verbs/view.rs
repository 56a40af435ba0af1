//! The verb `view`.

use std::path::{Path, PathBuf};

use tearmesh_obj::Repair;
use tearmesh_view::{Moment, Page};

use crate::args::{PlayArgs, ViewArgs};
use crate::exit::Stop;
use crate::input::named::named;
use crate::picture::no_camera;
use crate::say::{Fault, count, shown};
use crate::session;
use crate::streams::Streams;
use crate::{files, output, page};

/// Makes what is shown, and gives the summary; none if the page is on standard output.
pub(crate) fn run(
    args: &ViewArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<String, Stop> {
    // What was typed is refused before large files are read.
    let inputs = inputs(args)?;
    let unnamed = || named_like(&args.inputs[0]);
    let output = page::place(args.output.as_ref(), unnamed, &inputs)?;
    let options = match session::repair(args.look.repair, args.look.separate_fans) {
        Some(Repair::All) => " --repair",
        Some(Repair::SeparateFans) => " --separate-fans",
        None => "",
        _ => unreachable!("there is no other repair"),
    };
    let first = &args.inputs[0].display().to_string();
    let mut made = Page::new(page::title(Some(first)), args.up.coords);
    let (mut vertices, mut faces, mut pieces) = (Vec::new(), Vec::new(), 0);
    for path in &inputs {
        let (input, opened) = session::look(path, &args.look, faults, streams)?;
        let mesh = &opened.mesh;
        let moment = Moment {
            label: page::title(Some(&input.name)),
            cut: Some(page::cut_line(&input.name, options)),
            ..Moment::default()
        };
        let added = made.add(mesh, &opened.positions, moment);
        added.map_err(no_camera)?;
        vertices.push(mesh.vertex_count());
        faces.push(mesh.face_count());
        pieces = mesh.components().count();
    }
    output::write_or_print(&output, streams.output, |out| made.write(out))?;
    if output == Path::new("-") {
        return Ok(String::new());
    }
    let moments = match inputs.len() {
        1 => String::new(),
        many => format!("{many} meshes, "),
    };
    let (vertices, faces) = (
        span(&vertices, "vertex", "vertices"),
        span(&faces, "face", "faces"),
    );
    let (pieces, output) = (count(pieces, "piece", "pieces"), shown(&output));
    let words = format!("view: {moments}{vertices}, {faces}, {pieces} · wrote {output}");
    Ok(words)
}

/// The arguments of a page to play on.
pub(super) fn to_play(args: &ViewArgs) -> Result<PlayArgs, Stop> {
    let [input] = &inputs(args)?[..] else {
        let message = "a page to play on has one mesh";
        return Err(Stop::usage(message, "name one file, or leave out --play"));
    };
    Ok(PlayArgs {
        weld: None,
        input: Some(input.clone()),
        scene: "rip".to_owned(),
        up: None,
        output: args.output.clone(),
        look: args.look.clone(),
    })
}

/// The files that are shown.
fn inputs(args: &ViewArgs) -> Result<Vec<PathBuf>, Stop> {
    let files: Result<Vec<PathBuf>, _> = named(&args.inputs, true).into_iter().collect();
    let files = files.map_err(|(_, fault)| fault)?;
    files::one_stream(&files)?;
    Ok(files)
}

/// A page in the folder where we are, by the name of an input.
fn named_like(input: &Path) -> Result<PathBuf, Stop> {
    let whole = input.canonicalize();
    // A folder such as `.` has its name only in its whole path.
    let whole = whole.ok().filter(|_| input.file_name().is_none());
    let stem = whole.as_deref().unwrap_or(input).file_stem();
    let Some(stem) = stem.filter(|_| input != Path::new("-")) else {
        let message = "the page needs a name: the mesh has none".to_owned();
        return Err(Stop::usage(message, "name it with -o F.html"));
    };
    let mut name = stem.to_owned();
    name.push(".html");
    Ok(PathBuf::from(name))
}

/// The fewest and the most of something.
fn span(counts: &[usize], one: &str, many: &str) -> String {
    match (counts.iter().min(), counts.iter().max()) {
        (Some(fewest), Some(most)) if fewest < most => format!("{fewest} to {most} {many}"),
        (fewest, _) => count(fewest.copied().unwrap_or(0), one, many),
    }
}
