//! Input files and standard input.

pub(crate) mod named;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use tearmesh_obj::{Document, ReadError};

use crate::exit::Stop;
use crate::say::Fault;

/// How much of a file is read at once: what the reader of OBJ takes for a block.
const BUFFER: usize = 64 << 10;

/// The input, and how it is called in messages and in the report.
pub(crate) struct Input {
    pub(crate) name: String,
    source: Source,
}

enum Source {
    File(PathBuf),
    /// Standard input can be read only once, and a reproducer needs its bytes.
    Bytes(Vec<u8>),
}

impl Input {
    /// Finds the input; `-` is standard input.
    pub(crate) fn find(path: &Path, stdin: &mut dyn Read) -> Result<Input, Stop> {
        let name = path.display().to_string();
        if path == Path::new("-") {
            let mut bytes = Vec::new();
            let read = stdin.read_to_end(&mut bytes);
            read.map_err(|error| cannot_read("standard input", &error))?;
            return Ok(Input {
                name,
                source: Source::Bytes(bytes),
            });
        }
        let fault = match path.metadata() {
            Ok(found) if found.is_dir() => {
                let message = format!("`{name}` is a directory, not a file");
                Fault::error("E-IO-DIRECTORY", message)
            }
            Ok(_) => {
                let source = Source::File(path.to_owned());
                return Ok(Input { name, source });
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let fault = Fault::error("E-IO-MISSING", format!("there is no file `{name}`"));
                match similar(path) {
                    Some(near) => fault.help(format!("did you mean `{}`?", near.display())),
                    None => fault,
                }
            }
            Err(error) => cannot_read(&name, &error),
        };
        Err(fault.into())
    }

    /// The bytes, from the beginning.
    pub(crate) fn open(&self) -> Result<Box<dyn BufRead + '_>, Stop> {
        match &self.source {
            Source::Bytes(bytes) => Ok(Box::new(&bytes[..])),
            Source::File(path) => match File::open(path) {
                Ok(file) => Ok(Box::new(BufReader::with_capacity(BUFFER, file))),
                Err(error) => Err(cannot_read(&self.name, &error).into()),
            },
        }
    }

    /// The text in it, without a byte order mark.
    pub(crate) fn text(&self) -> Result<String, Stop> {
        let mut text = String::new();
        let read = self.open()?.read_to_string(&mut text);
        read.map_err(|error| cannot_read(&self.name, &error))?;
        Ok(text.trim_start_matches('\u{feff}').to_owned())
    }

    /// The document in it.
    pub(crate) fn document(&self) -> Result<Document, Stop> {
        let name = &self.name;
        let refused = |error: ReadError| match (error.diagnostic(), foreign(name)) {
            (Some(_), Some(fault)) => fault,
            (Some(diagnostic), None) => Fault::of_file(name, diagnostic),
            (None, _) => Fault::error("E-IO-READ", format!("`{name}`: {error}")),
        };
        Ok(Document::read(self.open()?).map_err(refused)?)
    }
}

/// That a file is of another format, if its name says so, and how it is converted.
fn foreign(name: &str) -> Option<Fault> {
    let format = tearmesh_obj::named_format(Path::new(name))?;
    let (stem, _) = name.rsplit_once('.')?;
    let options = match format {
        "an STL" => " -jiv`, which joins the corners that STL has once a face",
        _ => "`",
    };
    let help = format!("convert it first, as with `assimp export {name} {stem}.obj{options}");
    let message = format!("`{name}` is {format} file, not OBJ");
    Some(Fault::error("E-IO-FORMAT", message).help(help))
}

/// That something cannot be read.
pub(crate) fn cannot_read(name: &str, error: &io::Error) -> Fault {
    Fault::error("E-IO-READ", format!("cannot read `{name}`: {error}"))
}

/// The file of the same folder whose name is nearest, if it is near.
fn similar(path: &Path) -> Option<PathBuf> {
    let wanted = path.file_name()?.to_string_lossy();
    let folder = path.parent().filter(|folder| *folder != Path::new(""));
    let entries = folder.unwrap_or(Path::new(".")).read_dir().ok()?;
    let distances = entries.filter_map(|entry| {
        let name = entry.ok()?.file_name();
        let distance = strsim::damerau_levenshtein(&wanted, &name.to_string_lossy());
        Some((distance, name))
    });
    let near = distances.filter(|(distance, _)| 3 * distance <= wanted.chars().count());
    let (_, name) = near.min()?;
    Some(folder.unwrap_or(Path::new("")).join(name))
}
