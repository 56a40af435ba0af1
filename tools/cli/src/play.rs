//! The verb `play`.

use std::path::{Path, PathBuf};

use tearmesh_obj::TornDocument;
use tearmesh_view::PlayPage;

use crate::args::PlayArgs;
use crate::choice::Choice as _;
use crate::exit::Stop;
use crate::say::{Fault, count};
use crate::session::{self, Opened};
use crate::streams::Streams;
use crate::{output, page};

/// Makes what is shown, and gives the summary; none if the page is on standard output.
pub(crate) fn run(
    args: &PlayArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<String, Stop> {
    let unnamed = || Ok(PathBuf::from("play.html"));
    let path = page::place(args.output.as_ref(), unnamed, args.input.as_slice())?;
    let mut made = PlayPage {
        title: "Cloth".to_owned(),
        file: None,
        scene: args.scene.clone(),
        up: args.up.word().to_owned(),
    };
    let mut cloth = "a sheet of 1 m".to_owned();
    if let Some(input) = &args.input {
        let (input, opened) = session::look(input, &args.look, faults, streams)?;
        made.title = page::title(Some(&input.name));
        made.file = Some((made.title.clone(), obj(&opened)?));
        let vertices = count(opened.mesh.vertex_count(), "vertex", "vertices");
        let faces = count(opened.mesh.face_count(), "face", "faces");
        cloth = format!("{vertices}, {faces}");
    }
    output::write_or_print(&path, streams.output, |out| made.write(out))?;
    if path == Path::new("-") {
        return Ok(String::new());
    }
    let (scene, path) = (&args.scene, path.display());
    let words = format!("play: {cloth}, scene {scene} · wrote {path}: open it in a browser");
    Ok(words)
}

/// The file that the page is given: as it was read, and repaired where that was wanted.
fn obj(opened: &Opened) -> Result<Vec<u8>, Stop> {
    let (vertices, most) = (opened.mesh.vertex_count(), PlayPage::VERTICES_MAX);
    if vertices > most {
        let message =
            format!("the mesh has {vertices} vertices, and a page plays with at most {most}");
        return Err(Fault::error("E-PLAY-VERTICES", message).into());
    }
    if opened.mesh.face_count() == 0 {
        return Err(Fault::error("E-VIEW-EMPTY", "there is no cloth to play with").into());
    }
    let mut bytes = Vec::new();
    let torn = TornDocument::new(&opened.document);
    let written = torn.write(&opened.mesh, &opened.positions, &mut bytes);
    written.expect("memory takes all that is written");
    Ok(bytes)
}
