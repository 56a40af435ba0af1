//! Standard output that is full, or closed: the one is an error with its code, the other is no
//! failure.

use std::io::{self, BufWriter, ErrorKind, Write};

use tearmesh_cli::Exit;

use crate::harness::Folder;
use crate::in_process::ran;
use crate::support::cases::stride;

const RAYS: &str = "--rays=0.31,2,5:0,0,-1;0.25,-2,5:0,0,-1";

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

/// What every verb says where nothing can be printed, and the file that is there all the same.
#[test]
fn regression_a_full_standard_output_is_said() {
    let folder = Folder::new();
    folder.done(&format!("cut flag.obj {RAYS} -o torn.obj"));
    let check = |line: &str, file: Option<&str>| {
        let line = format!("tearmesh {line}");
        let (room, kind) = (0, ErrorKind::StorageFull);
        let full = &mut Narrow { room, kind };
        let (exit, said) = folder.within(|| ran(line.split(' '), b"", full, false));
        assert_eq!(exit, Exit::Output, "{line}\n{said}");
        let errors = said.matches("error[E-IO-WRITE]: cannot write standard output");
        assert_eq!(errors.count(), 1, "{line}\n{said}");
        if let Some(file) = file {
            assert!(
                said.contains(&format!("`{file}` was written")),
                "{line}\n{said}"
            );
            assert!(folder.path(file).exists(), "{line}");
        }
    };
    for verb in [
        format!("cut flag.obj {RAYS}"),
        "tear flag.obj --scene hang --seconds 0.05".to_owned(),
        "mend torn.obj".to_owned(),
    ] {
        check(&format!("{verb} -q -o -"), None);
        check(&format!("{verb} --format json"), None);
        check(&format!("{verb} -o x.obj"), Some("x.obj"));
        check(&format!("{verb} --format json -o y.obj"), Some("y.obj"));
    }
    for line in [
        "check flag.obj torn.obj",
        "check flag.obj no.obj --format json",
        "--version",
    ] {
        check(line, None);
    }
    // The report tells what the exit status does.
    check(
        &format!("cut flag.obj {RAYS} -o x.obj --report r.json"),
        Some("x.obj"),
    );
    let report = folder.json("r.json");
    assert_eq!((&report["exit"], &report["ok"]), (&7.into(), &false.into()));
    assert_eq!(report["diagnostics"][0]["code"], "E-IO-WRITE");
    // Nothing of it waits in the buffer of the process.
    if let Ok(full) = std::fs::File::options().write(true).open("/dev/full") {
        let mut command = folder.command(&format!("cut flag.obj {RAYS} -o x.obj"));
        let status = command.stdout(full).status();
        assert_eq!(status.expect("a run").code(), Some(7));
    }
}

/// A stream that is closed as the program begins is not written, whatever the runtime puts in its place; to throw
/// away what is printed is no failure.
#[cfg(target_os = "linux")]
#[test]
fn regression_a_closed_standard_output_is_said() {
    let folder = Folder::new();
    for (line, says) in [
        (format!("cut flag.obj {RAYS} -o -"), ""),
        (format!("cut flag.obj {RAYS}"), ""),
        (format!("cut flag.obj {RAYS} --format json"), ""),
        (
            format!("cut flag.obj {RAYS} -o x.obj"),
            "`x.obj` was written",
        ),
        ("render flag.obj -o -".to_owned(), ""),
        ("check flag.obj".to_owned(), ""),
        ("completions bash".to_owned(), ""),
    ] {
        let ended = |to: &str| {
            let command = folder.command(&line);
            let mut shell = std::process::Command::new("sh");
            shell.args(["-c", &format!("exec \"$0\" \"$@\" {to}")]);
            shell.arg(command.get_program()).args(command.get_args());
            let output = shell.current_dir(folder.path("")).output();
            let output = output.expect("a shell");
            (
                output.status.code(),
                String::from_utf8(output.stderr).expect("words"),
            )
        };
        let (exit, said) = ended(">&-");
        assert_eq!(exit, Some(7), "{line}\n{said}");
        let error = "error[E-IO-WRITE]: cannot write standard output: it is closed";
        assert_eq!(said.matches(error).count(), 1, "{line}\n{said}");
        assert!(said.contains(says), "{line}\n{said}");
        for to in ["> /dev/null", "1<> /dev/null", "<&- > /dev/null"] {
            let (exit, said) = ended(to);
            assert_eq!(exit, Some(0), "{line} {to}\n{said}");
        }
    }
}

/// Wherever standard output ends, the run says so once and exits with 7; where it was closed it ends
/// as if all had been read. In CI it ends at every fifth byte, and else at every twentieth.
#[test]
fn standard_output_may_end_at_any_byte() {
    let squares = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n".as_slice();
    let cut = "cut - --rays=0.4,2,5:0,0,-1;0.6,-1,5:0,0,-1";
    let miss = "cut - --rays=9,2,5:0,0,-1;9,-1,5:0,0,-1";
    let run = |line: &str, mesh: &[u8], output: &mut dyn Write| {
        ran(format!("tearmesh {line}").split(' '), mesh, output, false)
    };
    let mut torn = Vec::new();
    assert_eq!(run(cut, squares, &mut torn).0, Exit::Done);
    let mut cases = 0;
    for (mesh, line) in [
        (squares, cut),
        (squares, &format!("{cut} -q")),
        (squares, &format!("{cut} --dry-run")),
        (squares, &format!("{cut} -o /dev/null")),
        (squares, &format!("{cut} --format json --no-timing")),
        (squares, &format!("{miss} --format json --no-timing")),
        (&torn, "mend -"),
        (&torn, "mend - --format json --no-timing"),
        (&torn, "check -"),
        (&torn, "check - -v"),
        (&torn, "check no.obj - --format json"),
        (&torn, "mend --help"),
    ] {
        let mut all = Vec::new();
        let (exit, _) = run(line, mesh, &mut all);
        let rooms = (0..all.len()).step_by(5 * stride());
        for room in rooms.chain([all.len() - 1, all.len()]) {
            for kind in [ErrorKind::StorageFull, ErrorKind::BrokenPipe] {
                for buffer in [1, 64, 1 << 13] {
                    cases += 1;
                    let mut output = BufWriter::with_capacity(buffer, Narrow { room, kind });
                    let (ended, said) = run(line, mesh, &mut output);
                    let is_full = kind == ErrorKind::StorageFull && room < all.len();
                    let how = format!("{cases}: {line}, {room} bytes, {kind}\n{said}");
                    assert_eq!(ended, if is_full { Exit::Output } else { exit }, "{how}");
                    let errors = said.matches("error[E-IO-WRITE]").count();
                    assert_eq!(errors, usize::from(is_full), "{how}");
                }
            }
        }
    }
}
