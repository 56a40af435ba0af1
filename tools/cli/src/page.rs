//! Pages: what is on them, and where they go.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use tearmesh_view::{CutLine, is_page};

use crate::exit::Stop;
use crate::files;
use crate::say::quoted;

/// What a page is called that shows a file.
pub(crate) fn title(name: Option<&str>) -> String {
    let name = name.filter(|name| *name != "-").unwrap_or("mesh");
    let last = Path::new(name).file_name().unwrap_or(name.as_ref());
    last.to_string_lossy().into_owned()
}

/// How a file is cut, with these options.
pub(crate) fn cut_line(name: &str, options: &str) -> CutLine {
    // Whoever read it from a stream knows where it is.
    let name = if name == "-" { "mesh.obj" } else { name };
    let path = Path::new(name);
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let output = path.with_file_name(format!("{stem}-cut.obj"));
    CutLine {
        file: quoted(name),
        options: options.to_owned(),
        output: quoted(&output.display().to_string()),
    }
}

/// Where a page goes: where it was told to, or into the folder where we are, by a name that no file has but a
/// page of ours.
pub(crate) fn place(
    named: Option<&PathBuf>,
    unnamed: impl FnOnce() -> Result<PathBuf, Stop>,
    inputs: &[PathBuf],
) -> Result<PathBuf, Stop> {
    let path = named.map_or_else(unnamed, |path| Ok(path.clone()))?;
    if named.is_none() && path.is_file() && !is_page_there(&path) {
        let name = path.display();
        let message = format!("`{name}` is there already, and is no page of tearmesh");
        let help = format!("to replace it, add -o {name}");
        return Err(Stop::usage(message, help));
    }
    files::check_page(&path)?;
    files::check_shown(&path, inputs, "an input")?;
    Ok(path)
}

fn is_page_there(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = File::open(path).and_then(|file| file.take(1 << 12).read_to_end(&mut start));
    read.is_ok() && is_page(&start)
}
