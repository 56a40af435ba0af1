//! The files that inputs name: those of folders, and those of patterns, which the shells of Windows
//! do not expand.

use std::path::{Component, Path, PathBuf};

use walkdir::WalkDir;

use super::cannot_read;
use crate::say::Fault;

/// The files that inputs name, in the order of the inputs and each folder's by name; where there are
/// none, why, with what was typed.
pub(crate) fn named(inputs: &[PathBuf], recursive: bool) -> Vec<Result<PathBuf, (PathBuf, Fault)>> {
    let of = |input: &PathBuf| match of_input(input, recursive) {
        Ok(named) => named.into_iter().map(Ok).collect(),
        Err(fault) => vec![Err((input.clone(), fault))],
    };
    inputs.iter().flat_map(of).collect()
}

fn of_input(input: &Path, recursive: bool) -> Result<Vec<PathBuf>, Fault> {
    let (paths, missing) = if recursive && input.is_dir() {
        (vec![input.to_owned()], "there is no OBJ file in")
    } else if is_pattern(input) && !input.exists() {
        (matching(input), "no file matches")
    } else {
        return Ok(vec![input.to_owned()]);
    };
    let mut files = Vec::new();
    for path in paths {
        match (path.is_dir(), recursive) {
            (true, true) => look_into(&path, &mut files)?,
            (true, false) => {}
            (false, _) => files.push(path),
        }
    }
    if files.is_empty() {
        let message = format!("{missing} `{}`", input.display());
        return Err(Fault::error("E-IO-MISSING", message));
    }
    Ok(files)
}

/// Finds the OBJ files of a folder and of those in it, sorted. Links to folders are not followed, so
/// there is an end.
fn look_into(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Fault> {
    for entry in WalkDir::new(folder).sort_by_file_name() {
        let entry = entry.map_err(|error| {
            let error = error.into_io_error();
            let error = error.expect("a loop takes links, and none are followed");
            cannot_read(&folder.display().to_string(), &error)
        })?;
        let ending = entry.path().extension();
        let is_obj = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
        if is_obj && !entry.path().is_dir() {
            files.push(entry.into_path());
        }
    }
    Ok(())
}

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?'])
}

/// The paths that match a pattern, sorted. Names that begin with a dot have to be asked for.
fn matching(pattern: &Path) -> Vec<PathBuf> {
    let is_hidden = |part: Component<'_>| match part {
        Component::Normal(name) => name.to_string_lossy().starts_with('.'),
        _ => false,
    };
    let has_hidden = |path: &Path| path.components().any(is_hidden);
    // Brackets stand for themselves, as in the names of many files.
    let paths = glob::glob(&pattern.to_string_lossy().replace('[', "[[]"));
    let paths = paths.into_iter().flatten().flatten();
    // The crate's own option hides such names even from those who ask for them.
    let are_wanted = has_hidden(pattern);
    let wanted = paths.filter(|path| are_wanted || !has_hidden(path));
    wanted.collect()
}
