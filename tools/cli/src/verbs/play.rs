//! The verb `play`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use tearmesh::CutMethod;
use tearmesh_cloth::scene::file::SceneFile;
use tearmesh_cloth::scene::{Frame, HeldVertices, Preset, Scene};
use tearmesh_obj::TornDocument;
use tearmesh_view::PlayPage;

use crate::args::PlayArgs;
use crate::choice::Choice as _;
use crate::exit::Stop;
use crate::say::{Fault, count, printable, shown};
use crate::scene::SceneSource;
use crate::session::{self, Opened};
use crate::streams::Streams;
use crate::{output, page, simulation, weld};

/// Makes what is shown, and gives the summary; none if the page is on standard output.
pub(crate) fn run(
    args: &PlayArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<String, Stop> {
    let unnamed = || Ok(PathBuf::from("play.html"));
    let source = SceneSource::find(&args.scene, streams)?;
    let is_file = Preset::of(source.name()).is_none();
    if is_file && args.input.is_none() {
        let message = "a scene file is of a mesh";
        return Err(Stop::usage(message, "name the OBJ file of the cloth"));
    }
    let path = page::place(args.output.as_ref(), unnamed, args.input.as_slice())?;
    let up = args.up.unwrap_or_else(|| source.up());
    let mut made = PlayPage {
        title: "Cloth".to_owned(),
        file: None,
        scene: page::title(Some(source.name())),
        plan: None,
        up: up.word().to_owned(),
    };
    let mut cloth = "a sheet of 1 m".to_owned();
    if let Some(input) = &args.input {
        let (input, mut opened) = session::look(input, &args.look, faults, streams)?;
        weld::seams(&mut opened, args.weld, &mut Vec::new(), faults)?;
        if is_file {
            module_reads(SceneFile::FORMAT, PlayPage::scene_format())?;
            let frame = Frame::new(&opened.mesh, opened.positions.as_slice(), up);
            let mut scene = source.scene(&frame, None)?;
            let mut vertices = BTreeMap::new();
            scene.rename_vertices(|named| {
                vertices.insert(named, simulation::vertex_of(&opened, named));
                named
            });
            simulation::tearing(false, &scene, &source)?;
            let run = simulation::begin(scene, &opened, &frame, &source)?;
            simulation::record_seams(&run, &mut opened, &source)?;
            faults.extend(left(run.scene()));
            let vertices = vertices.into_iter().filter(|(named, id)| named != id);
            let packed = source.packed(run.scene(), vertices.collect());
            made.plan = Some(serde_json::to_string(&packed).expect("it is data"));
        }
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
    let (scene, path) = (printable(&made.scene), shown(&path));
    let words = format!("play: {cloth}, scene {scene} · wrote {path}: open it in a browser");
    Ok(words)
}

/// Refuses a scene that the module of the page would misread, since it was built from another version.
fn module_reads(format: u32, known: u32) -> Result<(), Stop> {
    if format == known {
        return Ok(());
    }
    let message = format!(
        "the module of the page reads scenes of format {known}, and this program writes format {format}"
    );
    let help = "build the module with tools/view/play/build, and the program again";
    Err(Fault::error("E-PLAY-MODULE", message).help(help).into())
}

/// A warning of all that the page leaves to hands.
fn left(scene: &Scene) -> Option<Fault> {
    let holds = (1..).zip(&scene.holds);
    let holds = holds.filter(|(_, hold)| **hold != HeldVertices::still(hold.region.clone()));
    let cuts = (1..).zip(&scene.cuts);
    let cuts = cuts.filter(|(_, cut)| cut.at_s > 0.0 || cut.method != CutMethod::Exact);
    let mut names: Vec<String> = holds.map(|(number, _)| format!("hold {number}")).collect();
    names.extend(cuts.map(|(number, _)| format!("cut {number}")));
    let unpicks = scene.unpicks.iter();
    names.extend(unpicks.map(|(_, seam)| format!("seam `{seam}`")));
    let message = "the page leaves to the hand what moves, begins or ends later, or is not exact";
    let fault = Fault::warning("W-PLAY-HAND", format!("{message}: {}", names.join(", ")));
    (!names.is_empty()).then_some(fault)
}

/// The file that the page is given: as it was read, and repaired where that was wanted.
fn obj(opened: &Opened) -> Result<Vec<u8>, Stop> {
    let (vertices, most) = (opened.mesh.vertex_count(), PlayPage::VERTICES_MAX);
    if vertices > most {
        let message =
            format!("the mesh has {vertices} vertices, and a page plays with at most {most}");
        return Err(Fault::error("E-PLAY-VERTICES", message).into());
    }
    let mut bytes = Vec::new();
    let torn = TornDocument::new(&opened.document);
    let written = torn.write(&opened.mesh, &opened.positions, &mut bytes);
    written.expect("memory takes all that is written");
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_module_of_another_version_is_refused() {
        assert!(module_reads(SceneFile::FORMAT, PlayPage::scene_format()).is_ok());
        let refused = module_reads(3, 2).expect_err("another format");
        let message = &refused.faults[0].message;
        assert!(message.ends_with("format 2, and this program writes format 3"));
    }
}
