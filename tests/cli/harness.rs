//! Runs the command as a person would, in a folder of its own, but in this process.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;
use tearmesh::{Mesh, Positions};

use crate::digest;
use crate::in_process::in_memory;

/// The repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What a command left.
#[derive(Debug)]
pub(crate) struct Answer {
    /// The exit status; -1 if it was killed.
    pub(crate) exit: i32,
    pub(crate) output: Vec<u8>,
    pub(crate) error: String,
}

impl Answer {
    /// What a person sees: the words on standard error, those on standard output, and the exit
    /// status unless it is 0.
    pub(crate) fn seen(&self) -> String {
        let text = self.error.clone() + &self.text();
        match self.exit {
            0 => text,
            -1 => text + "(killed)\n",
            exit => text + &format!("(exit {exit})\n"),
        }
    }

    /// What is on standard output.
    pub(crate) fn text(&self) -> String {
        String::from_utf8_lossy(&self.output).into_owned()
    }

    /// The JSON on standard output.
    pub(crate) fn json(&self) -> Value {
        let json = serde_json::from_slice(&self.output);
        json.unwrap_or_else(|error| panic!("{error}\n{}", self.seen()))
    }
}

impl From<Output> for Answer {
    fn from(output: Output) -> Answer {
        Answer {
            exit: output.status.code().unwrap_or(-1),
            output: output.stdout,
            error: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
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

    /// Writes a file, and makes its folder.
    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("its folder");
        fs::write(path, content).expect("a written file");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).expect("text")
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        let bytes = fs::read(self.path(name));
        bytes.unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.bytes(name)).expect("JSON")
    }

    /// Adds the files that stand in a text of the repository, each between `@ name` and `@`.
    pub(crate) fn add_files(&self, text: &str) {
        let text = fs::read_to_string(root().join(text)).expect("a text");
        let mut lines = text.lines();
        while let Some(line) = lines.next() {
            if let Some(name) = line.strip_prefix("@ ") {
                self.add_file(name, &mut lines);
            }
        }
    }

    /// Writes a file of the lines up to `@`.
    pub(crate) fn add_file<'t>(&self, name: &str, lines: &mut impl Iterator<Item = &'t str>) {
        let content = lines.take_while(|line| *line != "@");
        let content = content.map(|line| format!("{line}\n"));
        self.write(name, content.collect::<String>());
    }

    /// The names of all files in a folder in here, sorted.
    pub(crate) fn list(&self, name: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(name)).expect("a folder");
        let names = entries.map(|entry| entry.expect("an entry").file_name());
        let mut names: Vec<_> = names
            .map(|name| name.to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// The digest of the names and bytes of all files, after what has this digest.
    pub(crate) fn digest(&self, digest: u64) -> u64 {
        files_in(self.folder.path()).fold(digest, |digest, path| {
            let name = path.strip_prefix(self.folder.path()).expect("in here");
            let bytes = fs::read(&path).expect("a file");
            digest::after(digest, name.to_string_lossy().bytes().chain(bytes))
        })
    }

    /// The command as a process of its own, ready to run in this folder, without a terminal.
    pub(crate) fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tearmesh"));
        command
            .args(words(line))
            .current_dir(self.folder.path())
            .stdin(Stdio::null())
            .env_remove("NO_COLOR");
        command
    }

    /// Runs such a process to its end.
    pub(crate) fn process(&self, line: &str) -> Answer {
        let output = self.command(line).output();
        output.expect("the command runs").into()
    }

    /// Runs a line such as `tearmesh cut in.obj … > out.obj`, with or without its first word.
    pub(crate) fn run(&self, line: &str) -> Answer {
        let (mut typed, mut input, mut file) = (vec!["tearmesh".to_owned()], Vec::new(), None);
        let mut words = words(line).into_iter();
        while let Some(word) = words.next() {
            let mut name = || words.next().expect("the name of a file");
            match &*word {
                "<" => input = self.bytes(&name()),
                ">" => file = Some(name()),
                _ => typed.push(word),
            }
        }
        if typed.iter().any(|word| word == "-h" || word == "--help") {
            return self.process(line); // It is as wide as the terminal of the process.
        }
        let typed = typed.iter().map(String::as_str);
        let mut ran = self.within(|| in_memory(typed, &input, false));
        if let Some(file) = file {
            self.write(&file, std::mem::take(&mut ran.output));
        }
        Answer {
            exit: ran.exit as i32,
            output: ran.output,
            error: ran.error,
        }
    }

    /// Does something with this folder as the working folder.
    pub(crate) fn within<T>(&self, act: impl FnOnce() -> T) -> T {
        static TURN: Mutex<()> = Mutex::new(());
        let turn = || TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let _turn = (!has_own_folder()).then(turn);
        std::env::set_current_dir(self.folder.path()).expect("the folder is there");
        act()
    }

    /// Runs a line that ends with this exit status, and gives what is seen.
    pub(crate) fn ends(&self, line: &str, exit: i32) -> String {
        let answer = self.run(line);
        assert_eq!(answer.exit, exit, "{line}\n{}", answer.seen());
        answer.seen()
    }

    /// Runs a line that succeeds, and gives what is seen.
    pub(crate) fn done(&self, line: &str) -> String {
        self.ends(line, 0)
    }

    /// Runs a line that succeeds, and gives its report.
    pub(crate) fn report(&self, line: &str) -> Value {
        let answer = self.run(&format!("{line} --format json"));
        assert_eq!(answer.exit, 0, "{line}\n{}", answer.seen());
        answer.json()
    }
}

/// All files in a folder and in those in it, sorted.
pub(crate) fn files_in(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let all = walkdir::WalkDir::new(folder).sort_by_file_name();
    let paths = all.into_iter().map(|one| one.expect("one").into_path());
    paths.filter(|path| path.is_file())
}

/// A mesh as a file.
pub(crate) fn file_of((mesh, positions): &(Mesh, Positions)) -> String {
    let places = positions.as_slice().iter();
    let vertices = places.map(|p| format!("v {} {} {}\n", p.x, p.y, p.z));
    let face = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| v.index() + 1);
        format!("f {a} {b} {c}\n")
    };
    vertices.chain(mesh.faces().map(face)).collect()
}

/// The words of a line, but for the name of the command.
fn words(line: &str) -> Vec<String> {
    let line = line.replace("cargo run --release --", "tearmesh");
    let mut words = shlex::split(&line).expect("words that a shell understands");
    if words.first().is_some_and(|word| word == "tearmesh") {
        words.remove(0);
    }
    words
}

/// Whether this thread has a working folder that it shares with no other, from now on.
fn has_own_folder() -> bool {
    #[cfg(target_os = "linux")]
    return nix::sched::unshare(nix::sched::CloneFlags::CLONE_FS).is_ok();
    #[cfg(not(target_os = "linux"))]
    false
}

/// Sends a signal to a process.
#[cfg(unix)]
pub(crate) fn signal(name: &str, id: u32) {
    let killed = Command::new("kill").args([name, &id.to_string()]).status();
    killed.expect("kill runs"); // The process may have ended already.
}

/// What a command leaves that is interrupted, as by Ctrl-C, as soon as there is this file.
#[cfg(unix)]
pub(crate) fn interrupted_at(mut command: Command, file: &Path) -> Answer {
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let child = piped.spawn().expect("a run");
    while !file.exists() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    signal("-INT", child.id());
    child.wait_with_output().expect("an end").into()
}
