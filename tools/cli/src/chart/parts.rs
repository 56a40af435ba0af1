//! Charts in parts: the commands that make them, on one machine or on several, and what is put together of
//! their files.
//!
//! A part is the same chart with fewer scenes, meshes or methods. So each line of a plan can be typed as it
//! stands, and its picture can be looked at before the others are there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use tearmesh_lab::Provenance;
use tearmesh_lab::parts::{Divided, Missing};

use super::files::Ended;
use crate::args::DrawArgs;
use crate::exit::Exit;
use crate::output;
use crate::say::{Fault, count, quoted};
use crate::streams::Streams;

/// A part of a chart.
pub(super) struct Part {
    /// Its name, of which the names of its files are made.
    pub(super) name: String,
    /// The command that makes it, without files, as its provenance says it. An ellipsis stands for a file.
    pub(super) command: String,
}

/// Prints the commands that make the parts, one a line, and makes the folder for their files.
pub(super) fn plan(parts: &[Part], draw: &DrawArgs, streams: &mut Streams<'_>) -> Ended<Exit> {
    if draw.output == Path::new("-") {
        let message = "the files of parts stand beside that of the chart, which is `-`".to_owned();
        let fault = Fault::error("E-USAGE", message).help("name a file: --plan -o chart.svg");
        return Err((Exit::Usage, fault));
    }
    let folder = draw.output.with_extension("parts");
    let made = std::fs::create_dir_all(&folder);
    made.map_err(|error| (Exit::Output, output::cannot_write(&folder, &error)))?;
    let lines: Vec<String> = parts.iter().map(|part| part.line(&folder)).collect();
    let printed = output::print(streams.output, |out| {
        out.write_all(lines.concat().as_bytes())
    });
    printed.map_err(|fault| (Exit::Output, fault))?;
    Ok(Exit::Done)
}

impl Part {
    fn file(&self, folder: &Path, ending: &str) -> PathBuf {
        folder.join(format!("{}.{ending}", self.name))
    }

    fn line(&self, folder: &Path) -> String {
        let file = |ending| quoted(&self.file(folder, ending).to_string_lossy());
        let command = self.command.replace('…', &file("time.svg"));
        let [svg, json] = ["svg", "json"].map(file);
        format!("{command} --threads 1 -q -o {svg} --json {json}\n")
    }

    /// The study of the part, or why there is none.
    fn read<S: Divided>(&self, folder: &Path) -> Result<S, String> {
        let path = self.file(folder, "json");
        let text = std::fs::read_to_string(&path);
        let text = text.map_err(|error| format!("{}: {error}", path.display()))?;
        let not = |error: &dyn std::fmt::Display| {
            format!("{} is no {}: {error}", path.display(), S::SCHEMA)
        };
        let value: serde_json::Value = serde_json::from_str(&text).map_err(|error| not(&error))?;
        let schema = value["schema"].as_str().unwrap_or("no schema");
        if schema != S::SCHEMA {
            return Err(not(&format_args!("it says {schema}")));
        }
        let study = S::deserialize(value).map_err(|error| not(&error))?;
        let command = &study.provenance().command;
        if *command != self.command {
            let path = path.display();
            return Err(format!("{path} was made by another command: {command}"));
        }
        Ok(study)
    }
}

/// The study of all parts in a folder, whose provenance has this command. What is not there is told as
/// missing.
pub(super) fn gather<S: Divided>(parts: &[Part], folder: &Path, command: String) -> Ended<S> {
    let (mut found, mut missing): (Vec<S>, Vec<Missing>) = (Vec::new(), Vec::new());
    for part in parts {
        match part.read::<S>(folder) {
            Ok(study) => {
                missing.extend_from_slice(study.missing());
                found.push(study);
            }
            Err(why) => missing.push(Missing {
                part: part.name.clone(),
                why,
            }),
        }
    }
    let provenance = common(&found, command);
    let first = missing.first().map_or(String::new(), |one| one.why.clone());
    S::merged(found, provenance, missing).ok_or_else(|| {
        let parts = count(parts.len(), "part", "parts");
        let message = format!("none of {parts} is in {}: {first}", folder.display());
        let help = "run the lines that --plan prints, and name the folder of their files";
        let fault = Fault::error("E-CHART-PARTS", message).help(help);
        (Exit::Input, fault)
    })
}

/// What the parts have in common, or all that they say.
fn common<S: Divided>(studies: &[S], command: String) -> Provenance {
    let all = |of: fn(&Provenance) -> Option<&String>| {
        let said: BTreeSet<&str> = studies
            .iter()
            .filter_map(|study| of(study.provenance()).map(String::as_str))
            .collect();
        said.into_iter().collect::<Vec<_>>().join(", ")
    };
    Provenance {
        command,
        version: all(|from| Some(&from.version)),
        commit: all(|from| Some(&from.commit)),
        compiler: all(|from| Some(&from.compiler)),
        processor: Some(all(|from| from.processor.as_ref())).filter(|all| !all.is_empty()),
    }
}

/// Warns of missing parts, and gives the exit status that says so.
pub(super) fn warn(missing: &[Missing], draw: &DrawArgs, streams: &mut Streams<'_>) -> Exit {
    let Some(first) = missing.first() else {
        return Exit::Done;
    };
    let message = format!(
        "{} missing: {}; the first: {}",
        count(missing.len(), "part is", "parts are"),
        names(missing),
        first.why
    );
    let help = "run their lines of --plan again, and gather once more";
    let fault = Fault::warning("W-CHART-PARTS", message).help(help);
    streams.fail(&fault, draw.color, Exit::Simulation)
}

/// The names of missing parts.
pub(super) fn names(missing: &[Missing]) -> String {
    let names: Vec<&str> = missing.iter().map(|one| one.part.as_str()).collect();
    names.join(", ")
}
