//! What holds of the command whatever is typed and whatever is on standard input.
//!
//! The fuzz target `cut_cli` and the replay of its seeds use this. The command runs in the
//! process of the caller, on streams in memory, and a case is never given a path.

use std::ffi::OsString;
use std::fmt;
use std::io::Write;

use serde_json::Value;
use tearmesh_cli::{Exit, Streams, run};
use tearmesh_obj::Document;

/// Runs the command in this process. Gives its exit status, and what it says on standard error.
pub(crate) fn ran<'w>(
    typed: impl IntoIterator<Item = &'w str>,
    mut input: &[u8],
    output: &mut dyn Write,
    terminal: bool,
) -> (Exit, String) {
    let mut error = Vec::new();
    let streams = Streams {
        input: &mut input,
        output,
        error: &mut error,
        output_is_terminal: terminal,
        error_is_terminal: terminal,
    };
    let exit = run(typed.into_iter().map(OsString::from), streams);
    (exit, String::from_utf8(error).expect("words are text"))
}

/// What a run left.
#[derive(Debug, PartialEq)]
pub(crate) struct Ran {
    pub(crate) exit: Exit,
    pub(crate) output: Vec<u8>,
    pub(crate) error: String,
}

/// Runs it on a mesh in memory.
pub(crate) fn in_memory<'w>(
    typed: impl IntoIterator<Item = &'w str>,
    mesh: &[u8],
    terminal: bool,
) -> Ran {
    let mut output = Vec::new();
    let (exit, error) = ran(typed, mesh, &mut output, terminal);
    Ran {
        exit,
        output,
        error,
    }
}

/// Options that take the name of a file. Here each means the standard stream.
pub(crate) const PATHS: [&str; 9] = [
    "--output",
    "--report",
    "--rays-file",
    "--seam",
    "--map",
    "--pieces",
    "--picture",
    "--view",
    "-o",
];

/// What is typed behind `tearmesh cut -`, and standard input.
#[derive(Clone)]
pub(crate) struct Case {
    args: Vec<String>,
    input: Vec<u8>,
    /// Whether output and error are terminals.
    terminal: bool,
}

impl Case {
    /// Any bytes are a case: arguments up to the first line end, with `|` between them, and
    /// the rest is standard input. The argument `TERMINAL` stands for a terminal.
    pub(crate) fn from_bytes(bytes: &[u8]) -> Case {
        let mut lines = bytes.splitn(2, |&byte| byte == b'\n');
        let line = String::from_utf8_lossy(lines.next().unwrap_or_default());
        let mut terminal = false;
        let mut args = Vec::new();
        for word in line.split('|').filter(|word| !word.is_empty()).take(24) {
            match word {
                "TERMINAL" => terminal = true,
                // Options that take a path have it already.
                "-" => {}
                word => args.push(without_path(word)),
            }
        }
        Case {
            args,
            input: lines.next().unwrap_or_default().to_vec(),
            terminal,
        }
    }

    /// Checks everything, and gives the exit status.
    pub(crate) fn check(&self) -> Exit {
        let ran = self.run();
        assert_ne!(ran.exit, Exit::Bug, "{self:?}\n{}", ran.error);
        assert_ne!(ran.exit, Exit::Output, "memory takes everything");
        let report = serde_json::from_slice(&ran.output).ok();
        if let Some(report) = &report {
            assert_eq!(ran.error, "", "all is in the report");
            the_report_agrees(report, ran.exit);
        } else if !self.asks_for("help") && !self.asks_for("version") {
            self.the_words_agree(&ran);
        }
        if ran.error.contains("wrote standard output") {
            self.the_mesh_is_whole(&ran.output);
        }
        self.the_advice_works(&ran);
        let again = self.run();
        assert_eq!(again.exit, ran.exit, "the same again");
        match report {
            Some(report) => {
                let again: Value = serde_json::from_slice(&again.output).expect("JSON again");
                assert_eq!(without_times(again), without_times(report));
            }
            None => assert_eq!(again, ran),
        }
        ran.exit
    }

    fn run(&self) -> Ran {
        let typed = ["tearmesh", "cut", "-"].into_iter();
        let typed = typed.chain(self.args.iter().map(String::as_str));
        in_memory(typed, &self.input, self.terminal)
    }

    fn asks_for(&self, what: &str) -> bool {
        let letter = what.chars().next().into_iter();
        let letters = letter.flat_map(|c| [c, c.to_ascii_uppercase()]);
        let letters: Vec<char> = letters.collect();
        self.args.iter().any(|arg| {
            arg == &format!("--{what}")
                || arg.starts_with('-') && !arg.starts_with("--") && arg.contains(&letters[..])
        })
    }

    fn the_words_agree(&self, ran: &Ran) {
        let colored = ran.error.contains('\x1b');
        let says = |what: &str| {
            let mut lines = ran.error.lines();
            lines.any(|line| line.starts_with(what) || colored && line.contains(what))
        };
        match ran.exit {
            Exit::Done => assert!(colored || !says("error"), "{}", ran.error),
            Exit::NothingCut => {
                assert!(says("warning"), "{}", ran.error);
                assert!(colored || !says("error"), "{}", ran.error);
                assert_eq!(ran.output, b"", "nothing was cut, and nothing written");
            }
            _ => {
                assert!(says("error"), "{:?}: {}", ran.exit, ran.error);
                assert_eq!(ran.output, b"", "refused, and nothing written");
            }
        }
    }

    /// What is on the cut is not said to be away from it, and what is said to make a cut does.
    fn the_advice_works(&self, ran: &Ran) {
        let said = format!("{}{}", ran.error, String::from_utf8_lossy(&ran.output));
        assert!(!said.contains(" is 0 away"), "{self:?}\n{said}");
        if said.contains("--snap 0 makes it") {
            let mut advised = self.clone();
            let snap = advised.args.iter().position(|arg| arg == "--snap");
            if let Some(at) = snap.filter(|at| at + 1 < advised.args.len()) {
                advised.args.drain(at..=at + 1);
            }
            advised.args.retain(|arg| !arg.starts_with("--snap="));
            advised.works("--snap=0", &said);
        }
        if said.contains("--through cuts there") {
            self.clone().works("--through", &said);
        }
    }

    /// With this option too, the command cuts something.
    fn works(mut self, advised: &str, said: &str) {
        self.args.insert(0, advised.to_owned());
        let then = self.run();
        assert_eq!(then.exit, Exit::Done, "{self:?}\n{said}{}", then.error);
    }

    fn the_mesh_is_whole(&self, written: &[u8]) {
        let before = Document::read(&self.input[..]).expect("it was read");
        let after = Document::read(written).expect("what was written can be read");
        let [before, after_faces] = [&before, &after].map(|document| document.triangles().len());
        assert!(after_faces >= before, "{after_faces} faces of {before}");
        let mesh = after.mesh().expect("what was written is a mesh");
        assert_eq!(mesh.check(), []);
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let input = String::from_utf8_lossy(&self.input);
        let terminal = if self.terminal { " on a terminal" } else { "" };
        write!(f, "tearmesh cut - {:?}{terminal}\n{input}", self.args)
    }
}

/// The word, or the standard stream where it would name a file. With IN given before, no other
/// word can be a path.
fn without_path(word: &str) -> String {
    let name = word.split('=').next().unwrap_or_default();
    if name.starts_with("--") && PATHS.contains(&name) {
        format!("{name}=-")
    } else if word.starts_with('-') && !word.starts_with("--") && word.contains('o') {
        "-o-".to_owned()
    } else {
        word.replace('\0', " ")
    }
}

/// The exit status, `ok` and the diagnostics tell the same story.
fn the_report_agrees(report: &Value, exit: Exit) {
    assert_eq!(report["schema"], "tearmesh.report/1");
    assert_eq!(report["exit"], exit as u8);
    assert_eq!(report["ok"], exit == Exit::Done);
    let diagnostics = report["diagnostics"].as_array().expect("a list");
    let says = |level: &str| diagnostics.iter().any(|one| one["level"] == level);
    match exit {
        Exit::Done => assert!(!says("error"), "{report:#}"),
        Exit::NothingCut => assert!(says("warning") && !says("error"), "{report:#}"),
        _ => assert!(says("error"), "{report:#}"),
    }
    for one in diagnostics {
        let code = one["code"].as_str().expect("a code");
        let is_error = one["level"] == "error";
        assert_eq!(is_error, code.starts_with("E-"), "{report:#}");
        assert_ne!(one["message"], "");
    }
    if exit == Exit::Done {
        assert_eq!(report["invariants"]["checked"], true);
        assert_eq!(report["mass"]["before"], report["mass"]["after"]);
        let cuts = report["cuts"].as_array().expect("a list");
        let count = |name: &str| -> u64 { cuts.iter().filter_map(|cut| cut[name].as_u64()).sum() };
        let new = count("splits") + count("vertices_inserted");
        let [before, after] = ["input", "output"].map(|file| report[file]["vertices"].as_u64());
        assert_eq!(before.map(|count| count + new), after);
        let numbers = cuts.iter().flat_map(|cut| cut.as_object().expect("a cut"));
        for (name, number) in numbers {
            assert!(!number.is_null(), "{name} is no number");
        }
    }
}

fn without_times(mut report: Value) -> Value {
    let fields = report.as_object_mut().expect("a report");
    fields.remove("timing_ms");
    report
}
