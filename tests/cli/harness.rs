//! Runs the command as a person would, in a folder of its own.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use tearmesh_cli::{Exit, Streams, run};

use crate::digest;

/// The repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A folder with the project's test meshes and scenes, removed at the end.
pub(crate) struct Folder {
    folder: tempfile::TempDir,
}

impl Folder {
    /// The meshes lie in the folder itself, and where a clone has them.
    pub(crate) fn new() -> Folder {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let data = folder.path().join("tests/data");
        fs::create_dir_all(&data).expect("a folder for data");
        for entry in fs::read_dir(root().join("tests/data")).expect("the project's data") {
            let path = entry.expect("an entry").path();
            let is_data = |extension| extension == "obj" || extension == "toml";
            if path.extension().is_some_and(is_data) {
                let name = path.file_name().expect("a name");
                fs::copy(&path, data.join(name)).expect("a copy");
                fs::copy(&path, folder.path().join(name)).expect("a copy");
            }
        }
        Folder { folder }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("a written file");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("a file with text")
    }

    /// The names of all files in the folder itself.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder");
        let mut names: Vec<_> = entries
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .to_string_lossy()
                    .into_owned()
            })
            .collect();
        names.sort();
        names
    }

    /// The digest of the names and bytes of all files, after what has this digest.
    pub(crate) fn digest(&self, digest: u64) -> u64 {
        let mut paths = vec![self.folder.path().to_owned()];
        let mut next = 0;
        while let Some(path) = paths.get(next).cloned() {
            next += 1;
            if path.is_dir() {
                let entries = fs::read_dir(&path).expect("a folder");
                paths.extend(entries.map(|entry| entry.expect("an entry").path()));
            }
        }
        paths.sort();
        let files = paths.iter().filter(|path| path.is_file());
        files.fold(digest, |digest, path| {
            let name = path.strip_prefix(self.folder.path()).expect("in here");
            let bytes = fs::read(path).expect("a file");
            digest::after(digest, name.to_string_lossy().bytes().chain(bytes))
        })
    }

    /// The command, ready to run in this folder, without a terminal.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tearmesh"));
        command
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .env_remove("NO_COLOR");
        command
    }

    /// Runs a line such as `tearmesh cut in.obj … > out.obj`.
    pub(crate) fn run(&self, line: &str) -> Output {
        let line = line.replace("cargo run --release --", "tearmesh");
        let words = shlex::split(&line).expect("words that a shell understands");
        let mut words = words.into_iter();
        assert_eq!(words.next().as_deref(), Some("tearmesh"), "{line}");
        let mut command = self.command();
        while let Some(word) = words.next() {
            let mut file = || self.path(&words.next().expect("the name of a file"));
            match word.as_str() {
                "<" => {
                    command.stdin(File::open(file()).expect("an input"));
                }
                ">" => {
                    command.stdout(File::create(file()).expect("an output"));
                }
                _ => {
                    command.arg(word);
                }
            }
        }
        command.output().expect("the command runs")
    }
}

/// Runs a command line on a mesh in memory: its exit status, its output, and what it says.
pub(crate) fn in_memory(typed: &str, mesh: &[u8], terminal: bool) -> (Exit, Vec<u8>, String) {
    let (mut output, mut error) = (Vec::new(), Vec::new());
    let streams = Streams {
        input: &mut &mesh[..],
        output: &mut output,
        error: &mut error,
        output_is_terminal: terminal,
        error_is_terminal: terminal,
    };
    let exit = run(typed.split(' ').map(Into::into), streams);
    let said = String::from_utf8(error).expect("words are text");
    (exit, output, said)
}

/// What a person sees: the words on standard error, those on standard output, and the exit
/// status unless it is 0.
pub(crate) fn seen(output: &Output) -> String {
    let mut text = String::from_utf8_lossy(&output.stderr).into_owned();
    text.push_str(&String::from_utf8_lossy(&output.stdout));
    match output.status.code() {
        Some(0) => {}
        Some(code) => text.push_str(&format!("(exit {code})\n")),
        None => text.push_str("(killed)\n"),
    }
    text
}

/// What a command leaves that is interrupted, as by Ctrl-C, as soon as there is this file.
#[cfg(unix)]
pub(crate) fn interrupted_at(command: &mut Command, file: &Path) -> Output {
    let child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let child = child.expect("a run");
    while !file.exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let id = child.id().to_string();
    let killed = Command::new("kill").args(["-INT", &id]).status();
    assert!(killed.expect("kill runs").success());
    child.wait_with_output().expect("an end")
}
