//! Rivals that are processes of their own: asked a line, they answer a line.

use std::cell::RefCell;
use std::fs;
use std::io::{self, BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Output, Stdio};

/// A folder of this process for files, which is removed in the end.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new() -> io::Result<Folder> {
        let folder = std::env::temp_dir().join(format!("tearmesh-bench-{}", std::process::id()));
        fs::create_dir_all(&folder)?;
        Ok(Folder(folder))
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // What cannot be removed is the system's to clear away.
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A program of `rivals/`, compiled into a folder of its own.
pub(crate) struct Program {
    folder: Folder,
    name: &'static str,
}

impl Program {
    /// Compiles it; or why that cannot be.
    pub(crate) fn compile(name: &'static str, flags: &[&str]) -> Result<Program, String> {
        let folder = Folder::new().map_err(|error| error.to_string())?;
        let source = format!("{}/rivals/{name}.cpp", env!("CARGO_MANIFEST_DIR"));
        let program = Program { folder, name };
        let mut compiler = Command::new("c++");
        compiler.args(["-std=c++17", "-O3", &source]).args(flags);
        match said(compiler.arg("-o").arg(program.path())) {
            Some(output) if output.status.success() => Ok(program),
            Some(output) => {
                eprint!("{}", String::from_utf8_lossy(&output.stderr));
                Err("does not compile (see above)".to_owned())
            }
            None => Err("not compiled: there is no c++".to_owned()),
        }
    }

    pub(crate) fn path(&self) -> PathBuf {
        self.folder.path(self.name)
    }
}

/// What a program says that is asked nothing; `None` if it cannot be run.
pub(crate) fn said(command: &mut Command) -> Option<Output> {
    command.stdin(Stdio::null()).output().ok()
}

/// A rival that is ready.
pub(crate) struct Process {
    pub(crate) version: String,
    pipes: RefCell<Pipes>,
}

struct Pipes {
    child: Child,
    asked: ChildStdin,
    said: BufReader<ChildStdout>,
}

impl Process {
    /// Starts a rival, tells it something, and waits until it says `ready` and its version; `None`
    /// if it cannot be run, or says anything else.
    pub(crate) fn start(command: &mut Command, told: &str) -> Option<Process> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().ok()?;
        let asked = child.stdin.take().expect("it is piped");
        let said = BufReader::new(child.stdout.take().expect("it is piped"));
        let mut pipes = Pipes { child, asked, said };
        pipes.asked.write_all(told.as_bytes()).ok()?;
        pipes.asked.flush().ok()?;
        let version = pipes.line()?.strip_prefix("ready ")?.to_owned();
        Some(Process {
            version,
            pipes: RefCell::new(pipes),
        })
    }

    /// The answer to a line.
    pub(crate) fn ask(&self, what: &str) -> String {
        let mut pipes = self.pipes.borrow_mut();
        writeln!(pipes.asked, "{what}").expect("a rival that is ready listens");
        pipes.line().expect("a rival answers every line")
    }
}

impl Pipes {
    /// The next line of the answer; `None` if the process has ended.
    fn line(&mut self) -> Option<String> {
        let mut line = String::new();
        match self.said.read_line(&mut line) {
            Ok(0) | Err(_) => None,
            Ok(_) => Some(line.trim_end().to_owned()),
        }
    }
}

impl Drop for Pipes {
    fn drop(&mut self) {
        // It would end by itself with its input; a mesh of its memory need not wait for that.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
