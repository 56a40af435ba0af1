//! Odd arguments, files and places.

use std::fs;

use crate::harness::{Folder, seen};

const CUT: &str = "tearmesh cut flag.obj --rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1";

/// A file that cannot be opened is exit 3 for every verb, whatever else is asked for.
#[test]
fn a_file_that_cannot_be_opened_is_exit_3_for_every_verb() {
    let folder = Folder::new();
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 1 0,5 0\nf 1 2 3\n");
    let rays = "--rays 0,1,5:0,0,-1 0,-1,5:0,0,-1";
    for file in ["no.obj", "tests", "flag.obj/x.obj", "no/x.obj"] {
        for line in [
            format!("cut {file} {rays} -o x.obj"),
            format!("cut {file} {rays} --dry-run --format json"),
            format!("cut flag.obj --rays-file {file} -o x.obj"),
            format!("tear {file} --scene hang -o x.obj"),
            format!("tear flag.obj --scene ./{file} -o x.obj"),
            format!("mend {file} -o x.obj"),
            format!("check {file}"),
            format!("check -q {file}"),
            format!("check {file} --format json"),
            format!("check bad.obj {file} flag.obj"),
            format!("check {file} bad.obj"),
        ] {
            let said = seen(&folder.run(&format!("tearmesh {line}")));
            assert!(said.contains("E-IO-"), "{line}\n{said}");
            assert!(said.ends_with("(exit 3)\n"), "{line}\n{said}");
        }
    }
    let said = seen(&folder.run("tearmesh check bad.obj flag.obj"));
    assert!(said.ends_with("(exit 1)\n"), "{said}");
}

/// A byte order mark, line ends of two characters, blank lines and comments: the same rays, and the same
/// scene.
#[test]
fn regression_texts_may_begin_with_a_byte_order_mark() {
    let folder = Folder::new();
    for (name, option, lines) in [
        (
            "r.txt",
            "cut flag.obj --rays-file",
            "0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1\n",
        ),
        (
            "s.toml",
            "tear flag.obj --scene",
            "base = \"hang\"\nseconds = 0.1\n",
        ),
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
                folder.write(name, format!("{begin}{}", lines.replace('\n', end)));
                let output = folder.run(&format!("tearmesh {option} {name} -q -o x.obj"));
                let said = seen(&output);
                assert_eq!(output.status.code(), Some(0), "{begin:?} {end:?}\n{said}");
                let made = folder.read("x.obj");
                assert!(
                    *plain.get_or_insert(made.clone()) == made,
                    "{begin:?} {end:?}"
                );
            }
        }
    }
}

#[test]
fn regression_words_about_rays_are_about_what_is_wrong() {
    let folder = Folder::new();
    for (rays, words) in [
        ("nan,0,5:0,0,-1 1,0,5:0,0,-1", "expected a finite number"),
        ("1,0,5:0,0,-1 inf,0,5:0,0,-1", "expected a finite number"),
        ("x,0,5@0,0,-1 1,0,5:0,0,-1", "expected a finite number"),
        (
            "1e99,0,5:0,0,-1 1,0,5:0,0,-1",
            "expected an origin that is less far away",
        ),
        ("0,0,5:0,0,0 1,0,5:0,0,-1", "expected a direction"),
    ] {
        let said = seen(&folder.run(&format!("tearmesh cut flag.obj --rays {rays} -o x.obj")));
        assert!(said.contains(words), "{rays}\n{said}");
    }
}

#[test]
fn regression_standard_input_is_checked_once() {
    let folder = Folder::new();
    let said = seen(&folder.run("tearmesh check - flag.obj - < flag.obj"));
    assert!(
        said.contains("error[E-USAGE]") && said.ends_with("(exit 2)\n"),
        "{said}"
    );
}

#[test]
fn regression_a_chart_and_its_figures_are_files_of_their_own() {
    let folder = Folder::new();
    fs::create_dir(folder.path("d")).expect("a folder");
    for line in [
        "-o x.svg --csv ./x.svg",
        "-o x.svg --csv d/y --json d/../d/y",
    ] {
        let said = seen(&folder.run(&format!("tearmesh chart tear {line}")));
        assert!(said.contains("error[E-USAGE]"), "{line}\n{said}");
        assert!(said.ends_with("(exit 2)\n"), "{line}\n{said}");
    }
}

#[cfg(target_os = "linux")]
mod linux {
    use super::*;

    /// The message is the same for each run, and names the file that was given and no other.
    #[test]
    fn regression_a_place_that_cannot_be_written_is_told_by_its_own_name() {
        let folder = Folder::new();
        let line = format!("{CUT} -o /proc/torn.obj --report /proc/torn.json");
        let said = seen(&folder.run(&line));
        assert!(
            said.contains("cannot write `/proc/torn.obj`: No such file"),
            "{said}"
        );
        assert!(!said.contains(".tmp"), "{said}");
        assert_eq!(seen(&folder.run(&line)), said);
    }

    /// Names of open pipes look like links that lead nowhere.
    #[test]
    fn regression_the_names_of_standard_streams_can_be_written() {
        let folder = Folder::new();
        let mesh = folder.run(&format!("{CUT} -q -o -")).stdout;
        for name in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
            let output = folder.run(&format!("{CUT} -q -o {name}"));
            assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
            assert!(output.stdout == mesh, "{name}");
        }
        let output = folder.run(&format!("{CUT} -q -o x.obj --report /dev/stderr"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        assert!(serde_json::from_slice::<serde_json::Value>(&output.stderr).is_ok());
    }
}
