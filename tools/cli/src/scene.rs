//! Scenes: those that stand ready, and scene files.

mod apply;
mod read;
mod schema;

use std::io::Read as _;
use std::path::Path;

use tearmesh::cloth::{Axis, Frame, Scene};

pub(crate) use self::apply::threshold;
pub(crate) use self::read::SceneFile;
pub(crate) use self::schema::schema;
use self::schema::{AXES, NAMES};
use crate::args::SolverName;
use crate::input::{Input, cannot_read};
use crate::say::Fault;
use crate::session::Stop;
use crate::{Exit, Streams};

/// What `--scene` names.
#[derive(Clone, Debug)]
pub(crate) enum Source {
    /// A scene that stands ready.
    Ready(&'static str),
    File(Box<SceneFile>),
}

impl Source {
    /// Finds the scene, and reads it if it is a file.
    pub(crate) fn find(name: &str, streams: &mut Streams<'_>) -> Result<Source, Stop> {
        if let Some(ready) = NAMES.iter().find(|ready| **ready == name) {
            return Ok(Source::Ready(ready));
        }
        if !Path::new(name).exists() && !name.contains(['.', '/', '\\']) {
            let fault = Fault::error("E-SCENE-NAME", format!("there is no scene `{name}`"));
            let help = "scenes are hang, flag, rip, trouser, fall, and files such as scene.toml";
            return Err(Stop::new(Exit::Usage, fault.help(help)));
        }
        let unreadable = |fault| Stop::new(Exit::Input, fault);
        let file = Input::find(Path::new(name), streams.input).map_err(unreadable)?;
        let mut bytes = Vec::new();
        let read = file.open().map_err(unreadable)?.read_to_end(&mut bytes);
        read.map_err(|error| unreadable(cannot_read(&file.name, &error)))?;
        let Ok(text) = String::from_utf8(bytes) else {
            let message = format!("`{name}` is not a text in UTF-8");
            return Err(Stop::new(
                Exit::Usage,
                Fault::error("E-SCENE-SYNTAX", message),
            ));
        };
        match read::file(&file.name, &text) {
            Ok(file) => Ok(Source::File(Box::new(file))),
            Err(faults) => Err(Stop {
                exit: Exit::Usage,
                faults,
            }),
        }
    }

    /// As it is called in the report.
    pub(crate) fn name(&self) -> String {
        match self {
            Source::Ready(name) => (*name).to_owned(),
            Source::File(file) => file.source.path.clone(),
        }
    }

    /// Which way is up, as the scene says.
    pub(crate) fn up(&self) -> Axis {
        match self {
            Source::Ready(_) => Axis::Y,
            Source::File(file) => file.up(),
        }
    }

    /// The scene for a mesh with this frame; the method may be chosen on the command line.
    pub(crate) fn scene(&self, frame: &Frame, solver: Option<SolverName>) -> Result<Scene, Stop> {
        let mut scene = match self {
            Source::Ready(name) => base(name, frame),
            Source::File(file) => {
                let refused = |faults| Stop {
                    exit: Exit::Usage,
                    faults,
                };
                return file.scene(frame, solver).map_err(refused);
            }
        };
        if let Some(solver) = solver {
            scene.solver = solver.method();
        }
        Ok(scene)
    }
}

fn base(name: &str, frame: &Frame) -> Scene {
    match name {
        "hang" => Scene::hang(frame),
        "flag" => Scene::flag(frame),
        "rip" => Scene::rip(frame),
        "trouser" => Scene::trouser(frame),
        _ => Scene::fall(frame.up),
    }
}

/// Reads an axis.
pub(crate) fn axis(text: &str) -> Result<Axis, String> {
    let axis = match text.trim_start_matches('-') {
        "x" => Axis::X,
        "y" => Axis::Y,
        "z" => Axis::Z,
        _ => return Err(format!("expected one of {}", AXES.join(", "))),
    };
    Ok(match text.len() {
        1 => axis,
        2 => axis.opposite(),
        _ => return Err(format!("expected one of {}", AXES.join(", "))),
    })
}
