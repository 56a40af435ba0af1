//! A folder with meshes, and the command run in this process.

use std::fs;
use std::path::{Path, PathBuf};

use tearmesh_cli::{Exit, Streams, run};

/// A folder, removed at the end.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The path as it is typed.
    pub(crate) fn name(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }

    /// Writes one of the project's meshes, each point moved.
    pub(crate) fn write(&self, to: &str, mesh: &str, moved: impl Fn([f64; 3]) -> [f64; 3]) {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data");
        let text = fs::read_to_string(data.join(mesh)).expect("a mesh");
        let mut written = String::new();
        for line in text.lines() {
            match line.strip_prefix("v ") {
                Some(numbers) => {
                    let [x, y, z] = moved(three(numbers));
                    written.push_str(&format!("v {x} {y} {z}\n"));
                }
                None => written.push_str(&format!("{line}\n")),
            }
        }
        fs::write(self.path(to), written).expect("a written mesh");
    }
}

/// The first three numbers of a line.
pub(crate) fn three(line: &str) -> [f64; 3] {
    let mut numbers = line
        .split_whitespace()
        .map(|x| x.parse().expect("a number"));
    [(); 3].map(|()| numbers.next().expect("three numbers"))
}

/// Runs a command: how it ended, and what it said.
pub(crate) fn typed(words: impl IntoIterator<Item = String>) -> (Exit, String) {
    let (mut output, mut error) = (Vec::new(), Vec::new());
    let streams = Streams {
        input: &mut std::io::empty(),
        output: &mut output,
        error: &mut error,
        output_is_terminal: false,
        error_is_terminal: false,
    };
    let exit = run(words.into_iter().map(Into::into), streams);
    error.extend(output);
    (exit, String::from_utf8(error).expect("words are text"))
}

/// Runs a command that has to be done.
pub(crate) fn done(words: &[&str]) {
    let (exit, said) = typed(words.iter().map(|&word| word.to_owned()));
    assert_eq!(exit, Exit::Done, "{words:?}\n{said}");
}
