//! Places: what is never written over, and what is found out before the work.

use std::fs;

use crate::harness::{Folder, seen};

#[test]
fn no_output_replaces_an_input_of_any_kind() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    folder.write("w.txt", "33 0.5\n");
    folder.write("r.txt", "0.31,2,5:0,0,-1 0.31,-2,5:0,0,-1\n");
    fs::create_dir(folder.path("f")).expect("a folder");
    folder.write("f/frame_00009.obj", "base = \"hang\"\nseconds = 0.1\n");
    folder.write("f/frame_00008.obj", "33 0.5\n");
    let kept = [
        "s.toml",
        "w.txt",
        "r.txt",
        "f/frame_00009.obj",
        "f/frame_00008.obj",
    ];
    let before = kept.map(|name| folder.read(name));
    let tear = "tearmesh tear flag.obj --seconds 0.1 --scene";
    for line in [
        format!("{tear} s.toml -o s.toml"),
        format!("{tear} s.toml -o ./s.toml --in-place"),
        format!("{tear} s.toml -q -o x.obj --report s.toml"),
        format!("{tear} hang --strength w.txt -o w.txt"),
        format!("{tear} hang --strength w.txt --report w.txt -o x.obj"),
        format!("{tear} f/frame_00009.obj --frames f -o x.obj"),
        format!("{tear} hang --strength f/frame_00008.obj --frames f -o x.obj"),
        format!("{tear} hang --frames f --report f/frame_00000.obj -o x.obj"),
        format!("{tear} hang -o new.obj --report ./new.obj"),
        "tearmesh cut flag.obj --rays-file r.txt -o r.txt".to_owned(),
        "tearmesh cut flag.obj --rays-file r.txt --report r.txt -o x.obj".to_owned(),
    ] {
        let said = seen(&folder.run(&line));
        assert!(
            said.contains("error[E-USAGE]") && said.ends_with("(exit 2)\n"),
            "{line}\n{said}"
        );
        assert_eq!(kept.map(|name| folder.read(name)), before, "{line}");
        assert!(!folder.path("x.obj").exists(), "{line}");
    }
    // A name of a scene is no file.
    let output = folder.run(&format!("{tear} hang -o hang"));
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
}
