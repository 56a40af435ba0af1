//! Files that appear whole or not at all, and standard output.
//!
//! A reader of a regular file sees the old one or the new one: a complete draft beside it is renamed
//! to it. Links are resolved first, so the link stays. A pipe or a device is written directly, since it
//! cannot be replaced.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::say::Fault;

/// The draft that was made last, which may be gone by now.
static DRAFT: Mutex<Option<PathBuf>> = Mutex::new(None);

fn last_draft() -> MutexGuard<'static, Option<PathBuf>> {
    DRAFT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the file that is being written, if any, and prevents later files from being completed.
/// Intended for a program that is about to exit.
pub fn abandon() {
    let mut last = last_draft();
    if let Some(path) = last.take() {
        // Whether or not it is still there, there is nothing more to do about it.
        let _ = fs::remove_file(path);
    }
    // Held for ever: a file that is just being finished waits, and ends with the program.
    std::mem::forget(last);
}

/// Writes a file, whole or not at all.
pub(crate) fn write<T>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> Result<T, Fault> {
    replace(path, fill).map_err(|error| cannot_write(path, &error))
}

fn replace<T>(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> io::Result<T> {
    let (path, existing) = place(path)?;
    if existing.as_ref().is_some_and(|found| !found.is_file()) {
        return filled(&File::options().write(true).open(&path)?, fill);
    }
    let draft = draft(&path)?;
    let filled = filled(draft.as_file(), fill)?;
    if let Some(existing) = existing {
        draft.as_file().set_permissions(existing.permissions())?;
    }
    draft.as_file().sync_all()?;
    // An interruption comes before or after the renaming.
    let _last = last_draft();
    draft.persist(&path).map_err(|failed| failed.error)?;
    Ok(filled)
}

fn filled<T>(file: &File, fill: impl FnOnce(&mut dyn Write) -> io::Result<T>) -> io::Result<T> {
    let mut out = BufWriter::new(file);
    let filled = fill(&mut out)?;
    out.flush()?;
    Ok(filled)
}

/// Whether a file could be written now: before work that takes long. Writes nothing, and does not
/// open a pipe, which might wait for a reader.
pub(crate) fn check(path: &Path) -> Result<(), Fault> {
    let drafted = place(path).and_then(|(path, existing)| match existing {
        Some(found) if !found.is_file() => Ok(()),
        _ => draft(&path).map(drop),
    });
    drafted.map_err(|error| cannot_write(path, &error))
}

/// Makes a folder where there is none.
pub(crate) fn make_folder(folder: &Path) -> Result<(), Fault> {
    match folder.is_dir() {
        true => Ok(()),
        false => fs::create_dir(folder).map_err(|error| cannot_write(folder, &error)),
    }
}

/// The file that is written for a path, with what is there, which is no folder.
fn place(path: &Path) -> io::Result<(PathBuf, Option<fs::Metadata>)> {
    // The names of open pipes, as /dev/stdout, look like links that lead nowhere.
    if let Ok(found) = fs::metadata(path)
        && !found.is_file()
        && !found.is_dir()
    {
        return Ok((path.to_owned(), Some(found)));
    }
    let path = resolve_links(path)?;
    let existing = fs::metadata(&path).ok();
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
        let message = "it is a directory";
        return Err(io::Error::new(io::ErrorKind::IsADirectory, message));
    }
    Ok((path, existing))
}

/// A draft of a file, whose folder must be there. It is removed when it is dropped.
fn draft(path: &Path) -> io::Result<NamedTempFile> {
    let folder = folder(path);
    if !folder.is_dir() {
        let message = format!("there is no folder `{}`", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, message));
    }
    let mut last = last_draft();
    let mut builder = tempfile::Builder::new();
    // A temporary file is secret unless it is opened here: this one gets the permissions of any new file.
    let draft = builder.suffix(".tmp").make_in(folder, |draft| {
        File::options().write(true).create_new(true).open(draft)
    })?;
    *last = Some(draft.path().to_owned());
    Ok(draft)
}

/// The folder that a path is in.
pub(crate) fn folder(path: &Path) -> &Path {
    let parent = path.parent().filter(|folder| *folder != Path::new(""));
    parent.unwrap_or(Path::new("."))
}

/// The file that a path leads to, which need not exist yet.
fn resolve_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    // As many links as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(target) => path = folder(&path).join(target),
            Err(_) => return Ok(path),
        }
    }
    let message = "it is a symbolic link that leads back to itself";
    Err(io::Error::other(message))
}

/// Whether two paths lead to the same file.
pub(crate) fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt as _;
        if let (Ok(a), Ok(b)) = (fs::metadata(a), fs::metadata(b)) {
            return (a.dev(), a.ino()) == (b.dev(), b.ino());
        }
    }
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Whether two paths name the same file, or would once both files exist.
pub(crate) fn is_same_place(a: &Path, b: &Path) -> bool {
    let folders = [a, b].map(folder);
    is_same_file(a, b) || (a.file_name() == b.file_name() && is_same_file(folders[0], folders[1]))
}

/// Writes a file, or prints on standard output where the path is `-`: nothing once nobody reads on.
pub(crate) fn write_or_print<T>(
    path: &Path,
    out: &mut dyn Write,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> Result<Option<T>, Fault> {
    match path == Path::new("-") {
        true => print(out, fill),
        false => write(path, fill).map(Some),
    }
}

/// Prints on standard output, to the end: what waits in a buffer could still be lost, and nobody
/// told. Whoever read it may have had enough: that is no failure.
pub(crate) fn print<T>(
    out: &mut dyn Write,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> Result<Option<T>, Fault> {
    match fill(out).and_then(|filled| out.flush().map(|()| filled)) {
        Ok(filled) => Ok(Some(filled)),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(None),
        Err(error) => Err(cannot_write(Path::new("-"), &error)),
    }
}

/// Prints a text, as far as anybody reads it.
pub(crate) fn print_text(out: &mut dyn Write, text: &str) -> Result<(), Fault> {
    print(out, |out| out.write_all(text.as_bytes())).map(|_| ())
}

/// Says that a file, or standard output where it is `-`, cannot be written.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Fault {
    let name = match path == Path::new("-") {
        true => "standard output".to_owned(),
        false => format!("`{}`", path.display()),
    };
    Fault::error("E-IO-WRITE", format!("cannot write {name}: {error}"))
}
