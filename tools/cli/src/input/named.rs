//! The files that inputs name: those of folders, and those of patterns, which the shells of Windows
//! do not expand.

use std::path::{Component, Path, PathBuf};

use walkdir::WalkDir;

use super::cannot_read;
use crate::say::Fault;

/// The files that inputs name, in the order of the inputs and each folder's by name; where there are
/// none, why, with what was typed.
pub(crate) fn named(inputs: &[PathBuf], recursive: bool) -> Vec<Result<PathBuf, (PathBuf, Fault)>> {
    let mut files = Vec::new();
    for input in inputs {
        let named = of_input(input, recursive);
        match named {
            Ok(named) => files.extend(named.into_iter().map(Ok)),
            Err(fault) => files.push(Err((input.clone(), fault))),
        }
    }
    files
}

fn of_input(input: &Path, recursive: bool) -> Result<Vec<PathBuf>, Fault> {
    let missing = |message: String| Fault::error("E-IO-MISSING", message);
    if recursive && input.is_dir() {
        let mut files = Vec::new();
        look_into(input, &mut files)?;
        if files.is_empty() {
            let message = format!("there is no OBJ file in `{}`", input.display());
            return Err(missing(message));
        }
        return Ok(files);
    }
    if !is_pattern(input) || input.exists() {
        return Ok(vec![input.to_owned()]);
    }
    let mut files = Vec::new();
    for path in matching(input) {
        match (path.is_dir(), recursive) {
            (true, true) => look_into(&path, &mut files)?,
            (true, false) => {}
            (false, _) => files.push(path),
        }
    }
    if files.is_empty() {
        return Err(missing(format!("no file matches `{}`", input.display())));
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
        if is_obj(entry.path()) && !entry.path().is_dir() {
            files.push(entry.into_path());
        }
    }
    Ok(())
}

fn is_obj(path: &Path) -> bool {
    let extension = path.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
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
    paths
        .filter(|path| are_wanted || !has_hidden(path))
        .collect()
}
