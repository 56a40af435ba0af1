//! Files that appear whole or not at all.
//!
//! A regular file is written under another name in the same folder and then renamed, so that
//! whoever looks sees the old file or the new one. Links are resolved first, so the link
//! stays. A pipe or a device is written directly: it cannot be renamed over.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

use crate::say::Fault;

/// The temporary file that is being written.
static TEMPORARY: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes the file that is being written, if any, and lets none be finished. For a
/// program that is about to end.
pub fn abandon() {
    let mut temporary = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(path) = temporary.take() {
        // Whether or not it is still there, there is nothing more to do about it.
        let _ = fs::remove_file(path);
    }
    // Held for ever: a file that is just being finished waits, and ends with the program.
    std::mem::forget(temporary);
}

/// Writes a file, whole or not at all.
pub(crate) fn write<T>(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> io::Result<T> {
    let (path, existing) = place(path)?;
    if existing.as_ref().is_some_and(|found| !found.is_file()) {
        let mut out = BufWriter::new(File::options().write(true).open(&path)?);
        let filled = fill(&mut out)?;
        out.flush()?;
        return Ok(filled);
    }
    let temporary = temporary(&path)?;
    let _registered = Registered::new(temporary.path());
    let mut out = BufWriter::new(temporary);
    let filled = fill(&mut out)?;
    let temporary = out.into_inner().map_err(io::IntoInnerError::into_error)?;
    if let Some(existing) = existing {
        temporary
            .as_file()
            .set_permissions(existing.permissions())?;
    }
    temporary.as_file().sync_all()?;
    let mut registry = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner);
    temporary.persist(&path).map_err(|error| error.error)?;
    *registry = None;
    Ok(filled)
}

/// Whether a file could be written now: before work that takes long. Writes nothing, and does not
/// open a pipe, which might wait for a reader.
pub(crate) fn check(path: &Path) -> io::Result<()> {
    let (path, existing) = place(path)?;
    match existing {
        Some(found) if !found.is_file() => Ok(()),
        _ => {
            let temporary = temporary(&path)?;
            let _registered = Registered::new(temporary.path());
            temporary.close()
        }
    }
}

/// The file that is written for a path, with what is there, which is no folder.
fn place(path: &Path) -> io::Result<(PathBuf, Option<fs::Metadata>)> {
    let path = resolve_links(path)?;
    let existing = fs::metadata(&path).ok();
    if existing.as_ref().is_some_and(fs::Metadata::is_dir) {
        return Err(io::Error::new(
            io::ErrorKind::IsADirectory,
            "it is a directory",
        ));
    }
    Ok((path, existing))
}

/// A file in the folder of this one.
fn temporary(path: &Path) -> io::Result<NamedTempFile> {
    let folder = folder(path);
    if let Some(missing) = folder.filter(|folder| !folder.is_dir()) {
        let message = format!("there is no folder `{}`", missing.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, message));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".tearmesh-").suffix(".tmp");
    #[cfg(unix)]
    {
        // What a file made in the ordinary way would have; the system applies the umask.
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder.unwrap_or(Path::new(".")))
}

/// Keeps the name of the temporary file known while it exists.
struct Registered;

impl Registered {
    fn new(path: &Path) -> Registered {
        let mut registry = TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner);
        *registry = Some(path.to_owned());
        Registered
    }
}

impl Drop for Registered {
    fn drop(&mut self) {
        // The mutex is free here, since `write` drops its guard first: guards are
        // dropped in the reverse order of their making.
        *TEMPORARY.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// The file that a path leads to, which need not exist yet.
fn resolve_links(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    // As many links as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&path) {
            Ok(target) => {
                path = path
                    .parent()
                    .map_or_else(|| target.clone(), |folder| folder.join(&target));
            }
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other(
        "it is a link that leads round in a circle",
    ))
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

/// The same for files that need not exist yet.
pub(crate) fn is_same_place(a: &Path, b: &Path) -> bool {
    let folders = [a, b].map(|path| folder(path).unwrap_or(Path::new(".")));
    is_same_file(a, b) || (a.file_name() == b.file_name() && is_same_file(folders[0], folders[1]))
}

/// The folder that a path names, if it names any.
fn folder(path: &Path) -> Option<&Path> {
    path.parent().filter(|folder| *folder != Path::new(""))
}

/// Prints on standard output, to the end: what waits in a buffer could still be lost, and nobody
/// told. Whoever read it may have had enough: that is no failure.
pub(crate) fn print<T>(
    out: &mut dyn Write,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<T>,
) -> Result<Option<T>, Fault> {
    let filled = fill(out).and_then(|filled| out.flush().map(|()| filled));
    match filled {
        Ok(filled) => Ok(Some(filled)),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(None),
        Err(error) => Err(cannot_write(Path::new("-"), &error)),
    }
}

/// Says that a file, or standard output where it is `-`, cannot be written.
pub(crate) fn cannot_write(path: &Path, error: &io::Error) -> Fault {
    let name = if path == Path::new("-") {
        "standard output".to_owned()
    } else {
        format!("`{}`", path.display())
    };
    Fault::error("E-IO-WRITE", format!("cannot write {name}: {error}"))
}
