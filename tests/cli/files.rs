//! Streams and files: pipes, links, modes, interruptions, and the report.

use std::fs;
use std::io::{Read as _, Write as _};
use std::process::Stdio;

use crate::harness::{Answer, Folder, signal};

const CUT: &str = "cut flag.obj --rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1";

#[test]
fn no_escape_bytes_reach_a_pipe_unless_asked_for() {
    let folder = Folder::new();
    let bad = "cut falg.obj --plane 0,0,0:1,0,0";
    for line in [bad, "cut --help", "tear --help", "cut", "--version"] {
        assert!(!folder.process(line).seen().contains('\x1b'), "{line}");
    }
    let asked = folder.process(&format!("{bad} --color always"));
    assert!(asked.seen().contains('\x1b'));
}

#[test]
fn help_fits_a_screen_and_has_two_examples() {
    let folder = Folder::new();
    for (verb, other) in [("cut", "tear"), ("tear", "cut")] {
        let short = folder.done(&format!("{verb} -h"));
        assert!(short.lines().count() <= 40, "{short}");
        let long = folder.done(&format!("{verb} --help"));
        let examples = |verb| long.matches(&format!("  tearmesh {verb} ")).count();
        assert_eq!((examples(verb), examples(other)), (2, 0));
    }
    let words = ["no", "one", "two", "three", "four", "five", "six", "seven"];
    let meshes = words[tearmesh_lab::tear::CELLS.len()];
    let long = folder.done("chart tear --help");
    assert!(
        long.contains(&format!("strips of {meshes} meshes")),
        "{long}"
    );
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let folder = Folder::new();
    let mut command = folder.command(&format!("{CUT} -q -o -"));
    let piped = command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = piped.spawn().expect("a run");
    drop(child.stdout.take());
    let mut words = String::new();
    let mut said = child.stderr.take().expect("words");
    said.read_to_string(&mut words).expect("text");
    let exit = child.wait().expect("an end").code();
    assert_eq!((exit, words.as_str()), (Some(0), ""));
}

/// A byte order mark, line ends of two characters, blank lines and comments: the same rays, and the same
/// scene.
#[test]
fn regression_texts_may_begin_with_a_byte_order_mark() {
    let folder = Folder::new();
    let rays = "0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1\n";
    let scene = "base = \"hang\"\nseconds = 0.1\n";
    for (command, lines) in [
        ("cut flag.obj --rays-file", rays),
        ("tear flag.obj --scene", scene),
    ] {
        let mut plain = None;
        for begin in [
            "",
            "\u{feff}",
            "\u{feff}\n",
            "# a comment\n",
            "\u{feff}# a comment\r\n",
        ] {
            for end in ["\n", "\r\n", " \r\n"] {
                folder.write("x.toml", format!("{begin}{}", lines.replace('\n', end)));
                folder.done(&format!("{command} x.toml -q -o x.obj"));
                let made = folder.read("x.obj");
                assert!(
                    *plain.get_or_insert(made.clone()) == made,
                    "{begin:?} {end:?}"
                );
            }
        }
    }
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    use super::*;

    #[test]
    fn links_are_followed_and_stay_links() {
        let folder = Folder::new();
        fs::create_dir(folder.path("real")).expect("a folder");
        for (to, link) in [
            ("real/torn.obj", "link.obj"),
            ("flag.obj", "input.obj"),
            ("round.obj", "round.obj"),
        ] {
            symlink(to, folder.path(link)).expect("a link");
        }
        for _ in 0..2 {
            folder.done(&format!("{CUT} -o link.obj"));
            assert!(folder.path("link.obj").is_symlink());
            assert!(folder.read("real/torn.obj").starts_with("# a waving flag"));
        }
        folder.ends(&format!("{CUT} -o input.obj"), 2);
        folder.ends(&format!("{CUT} -o round.obj"), 7);
    }

    #[test]
    fn a_file_keeps_its_mode_and_a_new_one_gets_the_usual_one() {
        let folder = Folder::new();
        let mode = |name: &str| {
            let file = fs::metadata(folder.path(name)).expect("a file");
            file.permissions().mode() & 0o777
        };
        folder.write("usual.obj", "");
        folder.write("private.obj", "");
        let private = fs::Permissions::from_mode(0o600);
        fs::set_permissions(folder.path("private.obj"), private).expect("a mode");
        for name in ["private.obj", "new.obj"] {
            folder.done(&format!("{CUT} -o {name}"));
        }
        assert_eq!(mode("private.obj"), 0o600);
        assert_eq!(mode("new.obj"), mode("usual.obj"));
    }

    #[test]
    fn devices_are_written_and_not_replaced() {
        let folder = Folder::new();
        folder.done(&format!("{CUT} -o /dev/null"));
        assert!(
            !fs::metadata("/dev/null")
                .expect("it is still there")
                .is_file()
        );
        if fs::metadata("/dev/full").is_ok() {
            folder.ends(&format!("{CUT} -o /dev/full"), 7);
        }
    }

    #[test]
    fn an_interrupted_run_ends_with_130() {
        let folder = Folder::new();
        let mut command = folder.command(&(CUT.replace("flag.obj", "-") + " -o torn.obj"));
        let mut child = command.stdin(Stdio::piped()).spawn().expect("a run");
        let mut input = child.stdin.take().expect("an input");
        // The program is reading, and so has installed its handler, once a pipe's worth of
        // bytes is gone.
        input.write_all(&[b'\n'; 1 << 20]).expect("a reader");
        signal("-INT", child.id());
        assert_eq!(child.wait().expect("an end").code(), Some(130));
        assert!(!folder.path("torn.obj").exists());
    }

    /// The message is the same for each run, and names the file that was given and no other.
    #[cfg(target_os = "linux")]
    #[test]
    fn regression_an_unwritable_place_is_told_by_its_name() {
        let folder = Folder::new();
        let line = format!("{CUT} -o /proc/torn.obj --report /proc/torn.json");
        let said = folder.ends(&line, 7);
        assert!(
            said.contains("cannot write `/proc/torn.obj`: No such file"),
            "{said}"
        );
        assert!(!said.contains(".tmp"), "{said}");
        assert_eq!(folder.ends(&line, 7), said);
    }

    /// Names of open pipes look like links that lead nowhere.
    #[cfg(target_os = "linux")]
    #[test]
    fn regression_the_names_of_standard_streams_can_be_written() {
        let folder = Folder::new();
        let process = |options: &str| -> Answer {
            let answer = folder.process(&format!("{CUT} -q {options}"));
            assert_eq!(answer.exit, 0, "{}", answer.seen());
            answer
        };
        let mesh = process("-o -").output;
        for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
            assert!(process(&format!("-o {name}")).output == mesh, "{name}");
        }
        let report = process("-o x.obj --report /dev/stderr").error;
        assert!(serde_json::from_str::<serde_json::Value>(&report).is_ok());
    }
}
