//! The bound on memory: the larger of 64 MiB and twelve times the file, for whatever is in it.
//!
//! Each file is read, and its mesh built, by a process of its own, whose peak of resident
//! memory the system knows. Linux only: elsewhere the test says that it was skipped.

#![expect(
    clippy::print_stdout,
    reason = "the child tells its peak, and the parent a table of them"
)]

use std::fs::File;
use std::io::{Write as _, stderr};
use std::process::Command;

use super::digest;

use tearmesh_obj::{Document, Repair};

const CHILD: &str = "TEARMESH_MEMORY_OF";

/// Not a test of its own: what [`reading_takes_no_more_memory_than_promised`] runs.
#[test]
fn child() {
    let Some(path) = std::env::var_os(CHILD) else {
        return;
    };
    let file = File::open(path).expect("the parent wrote it");
    let document = Document::read(file);
    if let Ok(document) = document
        && let Err(error) = document.mesh()
    {
        let listed: usize = error
            .error()
            .defects()
            .iter()
            .map(|defect| defect.to_string().len())
            .sum();
        assert!(listed > 0, "a defect has words");
        drop(error);
        let repaired = document.repaired(Repair::All);
        let _refused = repaired.mesh().is_ok();
    }
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let peak = status.lines().find(|line| line.starts_with("VmHWM:"));
    println!("{}", peak.expect("Linux knows the peak"));
}

/// The peak of resident memory while a file is read, in KiB.
fn peak(file: &[u8]) -> usize {
    let path = std::env::temp_dir().join(format!("tearmesh-memory-{}.obj", std::process::id()));
    std::fs::write(&path, file).expect("a temporary file");
    let output = Command::new(std::env::current_exe().expect("this test"))
        .args(["memory::child", "--exact", "--nocapture"])
        .env(CHILD, &path)
        .output();
    std::fs::remove_file(&path).expect("it was written");
    let output = output.expect("this test can be run");
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{said}");
    let digits = said.split("VmHWM:").nth(1).expect("the child says so");
    let digits: String = digits
        .trim_start()
        .chars()
        .take_while(char::is_ascii_digit)
        .collect();
    digits.parse().expect("a number of KiB")
}

/// Statements over and over up to a size.
fn filled(start: &str, mib: usize, mut line: impl FnMut(usize) -> String) -> Vec<u8> {
    let mut file = start.as_bytes().to_vec();
    for i in 0.. {
        if file.len() >= mib << 20 {
            break;
        }
        file.extend_from_slice(line(i).as_bytes());
    }
    file
}

/// The size of most files. Twelve times it is just more than 64 MiB, so that what is taken besides counts
/// most.
const MIB: usize = 6;

/// A triangle, and the first line of a record.
const RECORD: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\
    #tearmesh record 1 v 2000000000 f 2000000000 vt 0 0 vn 0 0 faces 0123456789abcdef\n";

/// A triangle, and the first line of a record of version 2, which has more kinds of lines.
const LATER: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\
    #tearmesh record 2 v 2000000000 f 2000000000 vt 9 2000000000 vn 0 0 faces 0123456789abcdef\n";

/// Triangles that have only one vertex in common, which a record that fits says of its copies.
fn fans_joined(count: usize) -> Vec<u8> {
    let (mut file, mut faces, mut items) =
        (String::from("v 0 0 0\n"), String::new(), String::new());
    let first = 2 * count + 2;
    let mut corners = vec![(3 * count) as u64];
    file += &"v 1 0 0\nv 0 1 0\n".repeat(count);
    for i in 0..count {
        let apex = if i == 0 { 1 } else { first + i - 1 };
        let [a, b] = [2 * i + 2, 2 * i + 3];
        faces += &format!("f {apex} {a} {b}\n");
        corners.extend([apex, a, b].map(|v| v as u64 - 1));
        if i > 0 {
            file += "v 0 0 0\n";
            items += &format!("#~ fan {apex} 1\n");
        }
    }
    let hash = super::torn_damage::hash_of_faces(&corners);
    let items_hash = digest::after(digest::EMPTY, items.bytes());
    let (vertices, copies) = (3 * count, count - 1);
    file += &format!(
        "{faces}#tearmesh record 1 v {vertices} f {count} vt 0 0 vn 0 0 faces {hash:016x}\n\
         {items}#tearmesh end {copies} {items_hash:016x}\n"
    );
    file.into_bytes()
}

#[test]
fn reading_takes_no_more_memory_than_promised() {
    if !cfg!(target_os = "linux") {
        let said = writeln!(stderr(), "skipped: peaks of memory, which only Linux tells");
        said.expect("standard error is open");
        return;
    }
    let mut over = Vec::new();
    let nine = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nv 2 0 1\nv 0 2 1\nv 2 2 0\nv 3 1 0\nv 1 3 0\nvt 0\nvn 0 0 1\n";
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let digit = |i: usize| i % 9 + 1;
    for (name, file) in [
        ("nothing", triangle.into()),
        ("vertices", filled(triangle, MIB, |_| "v 0 0 0\n".into())),
        (
            "vertices and colours",
            filled(triangle, MIB, |_| "v 0 0 0 1\n".into()),
        ),
        ("texture", filled(triangle, MIB, |_| "vt 0\n".into())),
        ("normals", filled(triangle, MIB, |_| "vn 0 0 1\n".into())),
        (
            "kinds in turn",
            filled(triangle, MIB, |i| {
                ["vt 0\n", "v 0 0 0\n", "x\n"][i % 3].into()
            }),
        ),
        (
            "empty lines in turn",
            filled(triangle, MIB, |i| ["\n", "vt 0\n"][i % 2].into()),
        ),
        ("the same face", filled(nine, MIB, |_| "f 1 2 3\n".into())),
        (
            "faces",
            filled(nine, MIB, |i| {
                format!("f {} {} {}\n", digit(i), digit(i + 1), digit(i + 3))
            }),
        ),
        (
            "corners in full",
            filled(nine, MIB, |_| "f 1/1/1 2/1/1 3/1/1\n".into()),
        ),
        (
            "last corners in full",
            filled(nine, MIB, |i| {
                if i == 450_000 {
                    "f 1/1/1 2/1/1 3/1/1\n"
                } else {
                    "f 1 2 3\n"
                }
                .into()
            }),
        ),
        ("quads", filled(nine, MIB, |_| "f 1 2 3 4\n".into())),
        ("hexagons", filled(nine, MIB, |_| "f 1 2 3 4 5 6\n".into())),
        (
            "nonagons",
            filled(nine, MIB, |_| "f 1 2 3 4 5 6 7 8 9\n".into()),
        ),
        (
            "faces ahead",
            filled(triangle, MIB, |i| format!("f 1 2 {}\n", i + 4)),
        ),
        (
            "one line",
            filled(&format!("{triangle}# "), 20, |_| "x".into()),
        ),
        (
            "one face",
            filled(&format!("{triangle}f"), 20, |_| " 1".into()),
        ),
        (
            "one face of blanks",
            filled(&format!("{triangle}f 1"), 20, |_| " ".into()),
        ),
        (
            "one vertex",
            filled(&format!("{triangle}v"), 20, |_| " 0".into()),
        ),
        (
            "foreign keywords",
            filled(triangle, MIB, |i| format!("x{i}\n")),
        ),
        (
            "relative lines",
            filled(triangle, MIB, |_| "l -1 -2\n".into()),
        ),
        ("continuations", filled(triangle, MIB, |_| "\\\n".into())),
        ("zeros", filled("", MIB, |_| "\0".into())),
        (
            "triangles apart",
            filled("", MIB, |i| {
                format!(
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nf {} {} {}\n",
                    3 * i + 1,
                    3 * i + 2,
                    3 * i + 3
                )
            }),
        ),
        (
            "splits on record",
            filled(RECORD, MIB, |i| format!("#~ split {} 1 1\n", i + 2)),
        ),
        (
            "fans on record",
            filled(RECORD, MIB, |i| format!("#~ fan {} 1\n", i + 2)),
        ),
        (
            "edges on record",
            filled(RECORD, MIB, |i| format!("#~ edge {} 1 1 2 .5\n", i + 3)),
        ),
        (
            "parents on record",
            filled(RECORD, MIB, |i| format!("#~ parent {0} {0} 1 2 3\n", i + 1)),
        ),
        (
            "slides on record",
            filled(LATER, MIB, |i| {
                format!("#~ slide {} 1 0 0 0 1 1 1\n", i % 9 + 1)
            }),
        ),
        (
            "corners of slides on record",
            filled(&format!("{LATER}#~ slide 1 1 0 0 0 1 1 1\n"), MIB, |_| {
                "#~ slide-vt 2 1 0\n".into()
            }),
        ),
        (
            "inserted indices on record",
            filled(LATER, MIB, |i| format!("#~ vt {0} {0}\n", 2 * i + 1)),
        ),
        ("fans joined", fans_joined(150_000)),
        (
            "bow-ties",
            filled("v 0 0 0\n", MIB, |i| {
                format!("v 1 0 0\nv 0 1 0\nf 1 {} {}\n", 2 * i + 2, 2 * i + 3)
            }),
        ),
        (
            "a bow-tie in copies",
            filled(nine, MIB, |i| {
                ["f 1 2 3\n", "f 1 4 5\n", "f 1 6 7\n"][i % 3].into()
            }),
        ),
        (
            "a bow-tie of pentagons",
            filled(nine, MIB, |i| {
                ["f 1 2 3 4 5\n", "f 1 6 7 8 9\n"][i % 2].into()
            }),
        ),
        (
            "a bow-tie a face",
            filled("v 0 0 0\nv 0 0 1\nv 0 1 0\n", MIB, |i| {
                let i = 2 * i;
                format!("v 1 0 0\nv 0 1 0\nf {} {} {}\n", i + 1, i + 4, i + 5)
            }),
        ),
        (
            "faces on one edge",
            filled(triangle, MIB, |i| format!("v 0 0 1\nf 1 2 {}\n", i + 4)),
        ),
        (
            "flipped faces",
            filled(triangle, MIB, |i| {
                format!("v 0 0 1\nf {} {} {}\n", i + 2, i + 3, i + 4)
            }),
        ),
        (
            "pillows",
            filled("v 0 0 0\nv 0 1 0\n", MIB, |i| {
                let [a, b, c] = [i + 1, i + 2, i + 3];
                format!("v 0 0 1\nf {a} {b} {c}\nf {a} {c} {b}\n")
            }),
        ),
        (
            "triangles of a few vertices",
            filled(&"v 0 0 0\n".repeat(999), MIB, |i| {
                let digits = |at: usize| 100 + (i * at + i / 900) % 300;
                format!("f {} {} {}\n", digits(1), digits(7) + 300, digits(77) + 600)
            }),
        ),
    ] {
        let allowed = (64 << 10).max(12 * file.len() / 1024);
        let peak = peak(&file);
        println!(
            "{name:24} {:6} KiB, peak {peak:7} KiB of {allowed:7}",
            file.len() / 1024
        );
        if peak > allowed {
            over.push(name);
        }
    }
    assert!(over.is_empty(), "over the bound: {over:?}");
}
