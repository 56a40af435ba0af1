//! Standard output that is full, or closed: the one is an error with its code, the other is no
//! failure.

use std::ffi::OsString;
use std::fs;
use std::io::{self, BufWriter, ErrorKind, Write};

use tearmesh_cli::{Exit, Streams, run};

use crate::harness::{Folder, seen};

const RAYS: &str = "--rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1";

/// What every verb prints on a full device, and the file that is there all the same.
#[test]
fn regression_a_full_standard_output_is_said() {
    if fs::metadata("/dev/full").is_err() {
        return; // No such device on this system.
    }
    let folder = Folder::new();
    let torn = format!("tearmesh cut flag.obj {RAYS} -o torn.obj");
    assert_eq!(folder.run(&torn).status.code(), Some(0));
    let full = fs::canonicalize("/dev/full").expect("the device");
    let tear = "tear flag.obj --scene hang --seconds 0.05";
    for (line, file) in [
        (format!("cut flag.obj {RAYS} -o x.obj"), Some("x.obj")),
        (format!("cut flag.obj {RAYS} -o -"), None),
        (format!("cut flag.obj {RAYS} -q"), None),
        (format!("cut flag.obj {RAYS} --format json"), None),
        (
            format!("cut flag.obj {RAYS} --format json -o y.obj"),
            Some("y.obj"),
        ),
        (format!("{tear} -o z.obj"), Some("z.obj")),
        (format!("{tear} -o - -q"), None),
        (format!("{tear} --format json -o u.obj"), Some("u.obj")),
        ("mend torn.obj -o v.obj".to_owned(), Some("v.obj")),
        ("mend torn.obj -o -".to_owned(), None),
        (
            "mend torn.obj --format json -o w.obj".to_owned(),
            Some("w.obj"),
        ),
        ("check flag.obj torn.obj".to_owned(), None),
        ("check flag.obj no.obj --format json".to_owned(), None),
        ("check -v flag.obj".to_owned(), None),
        ("cut --help".to_owned(), None),
        ("--version".to_owned(), None),
    ] {
        let output = folder.run(&format!("tearmesh {line} > {}", full.display()));
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(7), "{line}\n{said}");
        let errors = said.matches("error[E-IO-WRITE]: cannot write standard output");
        assert_eq!(errors.count(), 1, "{line}\n{said}");
        if let Some(file) = file {
            assert!(
                said.contains(&format!("`{file}` was written")),
                "{line}\n{said}"
            );
            assert!(folder.path(file).exists(), "{line}");
        }
    }
    // The report tells what the exit status does.
    let line = format!("tearmesh cut flag.obj {RAYS} -o x.obj --report r.json");
    folder.run(&format!("{line} > {}", full.display()));
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    assert_eq!((&report["exit"], &report["ok"]), (&7.into(), &false.into()));
    assert_eq!(report["diagnostics"][0]["code"], "E-IO-WRITE");
}

/// What is printed as JSON and what the process ends with are the same story.
#[test]
fn regression_a_report_that_cannot_be_written_is_in_the_json() {
    let folder = Folder::new();
    let line = format!("tearmesh cut flag.obj {RAYS} --format json --report no/r.json");
    let output = folder.run(&line);
    assert_eq!(output.status.code(), Some(7));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&report["exit"], &report["ok"]), (&7.into(), &false.into()));
    assert_eq!(report["diagnostics"][0]["code"], "E-IO-WRITE");
}

/// Takes a number of bytes, and then fails.
struct Narrow {
    room: usize,
    kind: ErrorKind,
}

impl Write for Narrow {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let taken = bytes.len().min(self.room);
        self.room -= taken;
        if taken == 0 && !bytes.is_empty() {
            return Err(self.kind.into());
        }
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn ran(args: &[&str], mesh: &[u8], output: &mut dyn Write) -> (Exit, String) {
    let mut error = Vec::new();
    let streams = Streams {
        input: &mut &mesh[..],
        output,
        error: &mut error,
        output_is_terminal: false,
        error_is_terminal: false,
    };
    let typed = ["tearmesh"].iter().chain(args).map(OsString::from);
    let exit = run(typed, streams);
    (exit, String::from_utf8(error).expect("words are text"))
}

/// Wherever standard output ends, the run says so once and exits with 7; where it was closed it ends
/// as if all had been read.
#[test]
fn standard_output_may_end_at_any_byte() {
    let squares = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n".as_slice();
    let rays = "--rays=0.4,2,5:0,0,-1;0.6,-1,5:0,0,-1";
    let miss = "--rays=9,2,5:0,0,-1;9,-1,5:0,0,-1";
    let mut torn = Vec::new();
    assert_eq!(ran(&["cut", "-", rays], squares, &mut torn).0, Exit::Done);
    let mut cases = 0;
    for (mesh, args) in [
        (squares, vec!["cut", "-", rays]),
        (squares, vec!["cut", "-", rays, "-q"]),
        (squares, vec!["cut", "-", rays, "--dry-run"]),
        (squares, vec!["cut", "-", rays, "-o", "/dev/null"]),
        (
            squares,
            vec!["cut", "-", rays, "--format", "json", "--no-timing"],
        ),
        (
            squares,
            vec!["cut", "-", miss, "--format", "json", "--no-timing"],
        ),
        (&torn, vec!["mend", "-"]),
        (&torn, vec!["mend", "-", "--format", "json", "--no-timing"]),
        (&torn, vec!["check", "-"]),
        (&torn, vec!["check", "-", "-v"]),
        (&torn, vec!["check", "no.obj", "-", "--format", "json"]),
        (&torn, vec!["mend", "--help"]),
    ] {
        let mut all = Vec::new();
        let (exit, _) = ran(&args, mesh, &mut all);
        for room in (0..all.len()).step_by(5).chain([all.len() - 1, all.len()]) {
            for kind in [ErrorKind::StorageFull, ErrorKind::BrokenPipe] {
                for buffer in [1, 64, 1 << 13] {
                    cases += 1;
                    let mut output = BufWriter::with_capacity(buffer, Narrow { room, kind });
                    let (ended, said) = ran(&args, mesh, &mut output);
                    let is_full = kind == ErrorKind::StorageFull && room < all.len();
                    let how = format!("{cases}: {args:?}, {room} bytes, {kind}\n{said}");
                    assert_eq!(ended, if is_full { Exit::Output } else { exit }, "{how}");
                    let errors = said.matches("error[E-IO-WRITE]").count();
                    assert_eq!(errors, usize::from(is_full), "{how}");
                }
            }
        }
    }
    println!("{cases} ends of standard output");
}
