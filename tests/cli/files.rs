//! Streams and files: pipes, links, modes, interruptions, and the report.

use std::fs;
use std::io::{Read as _, Write as _};
use std::process::Stdio;

use crate::harness::{Folder, seen};

const CUT: &str = "tearmesh cut flag.obj --rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1";
const RAYS: [&str; 3] = ["--rays", "0.31,2,5:0,0,-1", "0.25,-2,5:0,0,-1"];

#[test]
fn the_same_input_gives_the_same_bytes() {
    let folder = Folder::new();
    for name in ["a", "b"] {
        let output = folder.run(&format!(
            "{CUT} -o {name}.obj --report {name}.json --no-timing"
        ));
        assert_eq!(output.status.code(), Some(0));
    }
    assert_eq!(folder.read("a.obj"), folder.read("b.obj"));
    assert_eq!(
        folder.read("a.json").replace("a.obj", "b.obj"),
        folder.read("b.json")
    );
    let streamed = folder.run(&format!("{CUT} -o -"));
    assert_eq!(
        String::from_utf8_lossy(&streamed.stdout),
        folder.read("a.obj")
    );
    let piped = folder.run("tearmesh cut - --rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1 < flag.obj");
    assert_eq!(piped.stdout, streamed.stdout);
}

#[test]
fn the_report_has_the_fields_that_others_rely_on() {
    let folder = Folder::new();
    let output = folder.run(&format!("{CUT} --format json -o cut.obj"));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    for pointer in [
        "/schema",
        "/version",
        "/command",
        "/ok",
        "/exit",
        "/input/path",
        "/input/vertices",
        "/input/faces",
        "/input/components",
        "/input/boundary_loops",
        "/output/path",
        "/output/vertices",
        "/output/faces",
        "/output/components",
        "/output/boundary_loops",
        "/cuts/0/rays/0/origin",
        "/cuts/0/rays/1/direction",
        "/cuts/0/method",
        "/cuts/0/plane/point",
        "/cuts/0/plane/normal",
        "/cuts/0/faces_crossed",
        "/cuts/0/splits",
        "/cuts/0/refused",
        "/cuts/0/ghost_pairs",
        "/cuts/0/separated",
        "/cuts/0/pieces",
        "/cuts/0/pieces_expected",
        "/cuts/0/crumbs",
        "/cuts/0/lost",
        "/cuts/0/seam_length",
        "/cuts/0/seam_length_ratio",
        "/cuts/0/seam_deviation_max",
        "/cuts/0/seam_deviation_max_edges",
        "/cuts/0/vertices_inserted",
        "/cuts/0/angle_min_deg",
        "/cuts/0/altitude_min",
        "/mass/before",
        "/mass/after",
        "/invariants/checked",
        "/invariants/violations",
        "/timing_ms/read",
        "/timing_ms/build",
        "/timing_ms/cut",
        "/timing_ms/check",
        "/timing_ms/write",
        "/diagnostics",
    ] {
        assert!(
            report
                .pointer(pointer)
                .is_some_and(|value| !value.is_null()),
            "{pointer}"
        );
    }
    assert!(output.stderr.is_empty());
}

#[test]
fn json_alone_reports_failures_too() {
    let folder = Folder::new();
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 1 0,5 0\nf 1 2 3\n");
    let line = "tearmesh cut bad.obj --rays 0,1,5:0,0,-1 0,-1,5:0,0,-1 --format json";
    let output = folder.run(line);
    assert_eq!(output.status.code(), Some(3));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((&report["ok"], &report["exit"]), (&false.into(), &3.into()));
    let found = &report["diagnostics"][0];
    assert_eq!(
        (&found["code"], &found["line"], &found["column"]),
        (&"E-OBJ-FLOAT".into(), &3.into(), &5.into())
    );
}

#[test]
fn no_escape_bytes_reach_a_pipe_unless_asked_for() {
    let folder = Folder::new();
    let bad = "tearmesh cut falg.obj --rays 0,1,5:0,0,-1 0,-1,5:0,0,-1";
    for line in [
        bad,
        "tearmesh cut --help",
        "tearmesh cut",
        "tearmesh --version",
    ] {
        assert!(!seen(&folder.run(line)).contains('\x1b'), "{line}");
    }
    assert!(seen(&folder.run(&format!("{bad} --color always"))).contains('\x1b'));
}

#[test]
fn help_fits_a_screen_and_has_two_examples() {
    let folder = Folder::new();
    let short = folder.run("tearmesh cut -h");
    assert!(String::from_utf8_lossy(&short.stdout).lines().count() <= 40);
    let long = folder.run("tearmesh cut --help");
    assert_eq!(
        String::from_utf8_lossy(&long.stdout)
            .matches("  tearmesh cut ")
            .count(),
        2
    );
    assert!(!String::from_utf8_lossy(&long.stdout).contains("tearmesh tear"));
}

#[test]
fn the_help_of_a_chart_counts_its_meshes() {
    let folder = Folder::new();
    let help = folder.run("tearmesh chart tear --help");
    let words = ["no", "one", "two", "three", "four", "five", "six", "seven"];
    let meshes = format!(
        "strips of {} meshes",
        words[tearmesh_lab::tear::CELLS.len()]
    );
    let said = seen(&help);
    assert!(said.contains(&meshes), "{said}");
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let folder = Folder::new();
    let mut command = folder.command();
    command
        .args(["cut", "flag.obj"])
        .args(RAYS)
        .args(["-q", "-o", "-"]);
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a run");
    drop(child.stdout.take());
    let mut words = String::new();
    child
        .stderr
        .take()
        .expect("words")
        .read_to_string(&mut words)
        .expect("text");
    assert_eq!(
        (child.wait().expect("an end").code(), words.as_str()),
        (Some(0), "")
    );
}

#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let folder = Folder::new();
    folder.write("old.obj", "something old\n");
    folder.write("bad.obj", "v 0 0 0\n");
    let before = folder.names();
    folder.run("tearmesh cut bad.obj --rays 0,1,5:0,0,-1 0,-1,5:0,0,-1 -o old.obj");
    assert_eq!(folder.read("old.obj"), "something old\n");
    assert_eq!(folder.names(), before);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    use super::*;

    #[test]
    fn links_are_followed_and_stay_links() {
        let folder = Folder::new();
        fs::create_dir(folder.path("real")).expect("a folder");
        symlink("real/torn.obj", folder.path("link.obj")).expect("a link");
        for _ in 0..2 {
            assert_eq!(
                folder.run(&format!("{CUT} -o link.obj")).status.code(),
                Some(0)
            );
            assert!(folder.path("link.obj").is_symlink());
            assert!(folder.read("real/torn.obj").starts_with("# a waving flag"));
        }
        symlink("flag.obj", folder.path("input.obj")).expect("a link");
        assert_eq!(
            folder.run(&format!("{CUT} -o input.obj")).status.code(),
            Some(2)
        );
        symlink("round.obj", folder.path("round.obj")).expect("a link");
        assert_eq!(
            folder.run(&format!("{CUT} -o round.obj")).status.code(),
            Some(7)
        );
    }

    #[test]
    fn a_file_keeps_its_mode_and_a_new_one_gets_the_usual_one() {
        let folder = Folder::new();
        let mode = |name: &str| {
            fs::metadata(folder.path(name))
                .expect("a file")
                .permissions()
                .mode()
                & 0o777
        };
        folder.write("usual.obj", "");
        folder.write("private.obj", "");
        let private = fs::Permissions::from_mode(0o600);
        fs::set_permissions(folder.path("private.obj"), private).expect("a mode");
        for name in ["private.obj", "new.obj"] {
            assert_eq!(
                folder.run(&format!("{CUT} -o {name}")).status.code(),
                Some(0)
            );
        }
        assert_eq!(mode("private.obj"), 0o600);
        assert_eq!(mode("new.obj"), mode("usual.obj"));
    }

    #[test]
    fn devices_are_written_and_not_replaced() {
        let folder = Folder::new();
        assert_eq!(
            folder.run(&format!("{CUT} -o /dev/null")).status.code(),
            Some(0)
        );
        assert!(
            !fs::metadata("/dev/null")
                .expect("it is still there")
                .is_file()
        );
        if fs::metadata("/dev/full").is_ok() {
            let output = folder.run(&format!("{CUT} -o /dev/full"));
            assert_eq!(output.status.code(), Some(7), "{}", seen(&output));
        }
    }

    #[test]
    fn an_interrupted_run_ends_with_130() {
        let folder = Folder::new();
        let mut command = folder.command();
        command
            .args(["cut", "-"])
            .args(RAYS)
            .args(["-o", "torn.obj"]);
        let mut child = command.stdin(Stdio::piped()).spawn().expect("a run");
        let mut input = child.stdin.take().expect("an input");
        // The program is reading, and so has installed its handler, once a pipe's worth of
        // bytes is gone.
        input.write_all(&[b'\n'; 1 << 20]).expect("a reader");
        let id = child.id().to_string();
        let killed = std::process::Command::new("kill")
            .args(["-INT", &id])
            .status();
        assert!(killed.expect("kill runs").success());
        assert_eq!(child.wait().expect("an end").code(), Some(130));
        assert!(!folder.names().contains(&"torn.obj".to_owned()));
    }
}
