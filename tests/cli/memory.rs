//! The bound on memory holds for the command, too: the larger of 64 MiB and twelve times the file.
//!
//! tests/obj/memory.rs has all kinds of files for the library. Here are those that took most
//! there, since the command adds excerpts, hints that are tried, and its own code.

use std::process::Command;

use crate::in_process::ran;
use crate::support::cases::stride;

const CHILD: &str = "TEARMESH_MEMORY_OF_COMMAND";

/// Not a test of its own: what the others run.
#[test]
fn child() {
    let Some(line) = std::env::var_os(CHILD) else {
        return;
    };
    let line = line.into_string().expect("the parent wrote it");
    let (exit, _) = ran(line.split('|'), b"", &mut Vec::new(), false);
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let peak = status.lines().find(|line| line.starts_with("VmHWM:"));
    println!("{exit:?} {}", peak.expect("Linux knows the peak"));
}

/// How the command ended, and its peak of resident memory in KiB.
fn exit_and_peak(args: &[&str]) -> (String, usize) {
    let output = Command::new(std::env::current_exe().expect("this test"))
        .args(["memory::child", "--exact", "--nocapture"])
        .env(CHILD, args.join("|"))
        .output()
        .expect("this test can be run");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    let words: Vec<&str> = said.split_whitespace().collect();
    let at = words.iter().position(|&word| word == "VmHWM:");
    let at = at.expect("the child says so");
    let peak = words[at + 1].parse().expect("a number of KiB");
    (words[at - 1].to_owned(), peak)
}

/// The size of such a file. Twelve times it is a little more than 64 MiB, so that what is taken besides
/// counts. (At six, the code of these tests, which is counted too, is a tenth.)
const MIB: usize = 7;

/// Files that have the same faces again and again: the first of them by the first verb, and in CI both by both.
#[test]
fn refused_files_take_no_more_memory_than_promised() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("refused.obj");
    let path = path.to_str().expect("a plain name");
    let nine = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nv 2 0 1\nv 0 2 1\nv 2 2 0\nv 3 1 0\nv 1 3 0\n";
    let files = [
        ("nonagons", "f 1 2 3 4 5 6 7 8 9\n"),
        ("a bow-tie of pentagons", "f 1 2 3 4 5\nf 1 6 7 8 9\n"),
    ];
    let cases = files.map(|file| ["check", "cut"].map(|verb| (file, verb)));
    for &((name, faces), verb) in cases.as_flattened().iter().step_by(stride()) {
        let file = nine.to_owned() + &faces.repeat((MIB << 20) / faces.len());
        std::fs::write(path, &file).expect("a temporary file");
        let allowed = 12 * file.len() / 1024;
        let rays = ["--rays", "0.1,0,5:0,0,-1", "0.2,1,5:0,0,-1", "--dry-run"];
        let rays = if verb == "cut" { &rays[..] } else { &[] };
        let (exit, peak) = exit_and_peak(&[&["tearmesh", verb, path], rays].concat());
        assert_eq!(exit, if verb == "cut" { "Input" } else { "NothingCut" });
        assert!(peak <= allowed, "{verb} {name}: {peak} KiB of {allowed}");
    }
}

#[test]
fn regression_repairing_many_fans_keeps_to_the_memory() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let [path, out] = ["fans.obj", "out.obj"].map(|name| folder.path().join(name));
    let [path, out] = [&path, &out].map(|path| path.to_str().expect("a plain name"));
    let fan = |i: usize| format!("v 1 0 0\nv 0 1 0\nf 1 {} {}\n", 2 * i + 2, 2 * i + 3);
    let file = "v 0 0 0\n".to_owned() + &(0..400_000).map(fan).collect::<String>();
    std::fs::write(path, &file).expect("a temporary file");
    let rays = ["--rays", "9,9,1:0,0,-1", "9,8,1:0,0,-1", "--allow-miss"];
    let args = ["tearmesh", "cut", path, "--repair", "-q", "-o", out];
    let (exit, peak) = exit_and_peak(&[&args[..], &rays].concat());
    let allowed = 12 * file.len() / 1024;
    assert_eq!(exit, "Done");
    assert!(peak <= allowed, "{peak} KiB of {allowed}");
}
