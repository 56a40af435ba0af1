//! The bound on memory: the larger of 64 MiB and twelve times the file, for whatever is in it.
//!
//! Each file is read, and its mesh built, by a process of its own, whose peak of resident
//! memory the system knows. Linux only: elsewhere the test says that it was skipped.

#![expect(
    clippy::print_stdout,
    reason = "the child tells its peak, and the parent a table of them"
)]

use std::fs::File;
use std::io::{BufReader, Write as _, stderr};
use std::process::Command;

use super::support::cases::stride;
use super::tables::with_record;

use tearmesh_obj::{Document, Repair};

const CHILD: &str = "TEARMESH_MEMORY_OF";

/// Not a test of its own: what [`reading_takes_no_more_memory_than_promised`] runs.
#[test]
fn child() {
    let Some(path) = std::env::var_os(CHILD) else {
        return;
    };
    let file = BufReader::new(File::open(path).expect("the parent wrote it"));
    let document = Document::read(file);
    if let Ok(document) = document
        && let Err(error) = document.mesh()
    {
        let mut defects = error.error().defects().iter();
        assert!(defects.all(|defect| !defect.to_string().is_empty()));
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
    let peak = said.split("VmHWM:").nth(1);
    let peak = peak.and_then(|rest| rest.split_whitespace().next()?.parse().ok());
    peak.expect("the child tells a number of KiB")
}

/// Lines over and over up to a size, in turn those between `|`. In a line `{2i+3}` is a number that
/// grows by 2 with each.
fn filled(start: &str, mib: usize, lines: &str) -> Vec<u8> {
    let lines: Vec<&str> = lines.split('|').collect();
    let mut file = start.to_owned();
    for i in 0.. {
        if file.len() >= mib << 20 {
            break;
        }
        for (at, part) in lines[i % lines.len()].split(['{', '}']).enumerate() {
            match part.split_once("i+") {
                Some((factor, first)) if at % 2 == 1 => {
                    let [factor, first] = [factor, first].map(|n| n.parse().unwrap_or(1));
                    file += &(factor * i + first).to_string();
                }
                _ => file += part,
            }
        }
    }
    file.into_bytes()
}

/// The size of most files. Twelve times it is just more than 64 MiB, so that what is taken besides counts
/// most.
const MIB: usize = 6;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

const NINE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nv 2 0 1\nv 0 2 1\nv 2 2 0\nv 3 1 0\n\
    v 1 3 0\nvt 0\nvn 0 0 1\n";

/// What the table calls by a name: the last two are the first lines of a record, and of one of version 2,
/// which has more kinds of lines.
const NAMES: [(&str, &str); 4] = [
    ("{TRIANGLE}", TRIANGLE),
    ("{NINE}", NINE),
    (
        "{RECORD}",
        "#tearmesh record 1 v 2000000000 f 2000000000 vt 0 0 vn 0 0 faces 0123456789abcdef\n",
    ),
    (
        "{LATER}",
        "#tearmesh record 2 v 2000000000 f 2000000000 vt 9 2000000000 vn 0 0 faces 0123456789abcdef\n",
    ),
];

/// The files of the table: what each is called, its size, what it begins with, and the lines that fill it.
fn table() -> impl Iterator<Item = (&'static str, Vec<u8>)> {
    include_str!("memory.txt").lines().map(|row| {
        let [name, size, rest] = row.splitn(3, ": ").collect::<Vec<_>>()[..] else {
            panic!("{row} has three parts");
        };
        let (start, lines) = rest.split_once(" ... ").expect("a start and lines");
        let all = |text: &str| {
            text.replace("\\n", "\n")
                .replace("\\0", "\0")
                .replace("\\s", " ")
                .replace("\\\\", "\\")
        };
        let start = NAMES
            .iter()
            .fold(all(start), |start, (name, text)| start.replace(name, text));
        let mib = size.strip_suffix(" MiB").and_then(|mib| mib.parse().ok());
        (name, filled(&start, mib.expect("a size"), &all(lines)))
    })
}

/// Triangles that have only one vertex in common, which a record that fits says of its copies.
fn fans_joined(count: usize) -> Vec<u8> {
    let (mut faces, mut items) = (String::new(), String::new());
    let first = 2 * count + 2;
    for i in 0..count {
        let apex = if i == 0 { 1 } else { first + i - 1 };
        let [a, b] = [2 * i + 2, 2 * i + 3];
        faces += &format!("f {apex} {a} {b}\n");
        if i > 0 {
            items += &format!("#~ fan {apex} 1\n");
        }
    }
    let rims = "v 1 0 0\nv 0 1 0\n".repeat(count);
    let body = format!("v 0 0 0\n{rims}{}{faces}", "v 0 0 0\n".repeat(count - 1));
    with_record(&body, "1", "vt 0 0 vn 0 0", &items).into_bytes()
}

#[test]
fn reading_takes_no_more_memory_than_promised() {
    if !cfg!(target_os = "linux") {
        let said = writeln!(stderr(), "skipped: peaks of memory, which only Linux tells");
        said.expect("standard error is open");
        return;
    }
    let few = |i: usize| {
        let digits = |at: usize| 100 + (i * at + i / 900) % 300;
        format!("f {} {} {}\n", digits(1), digits(7) + 300, digits(77) + 600)
    };
    let few: String = (0..MIB << 16).map(few).collect();
    let last = "f 1 2 3\n".repeat(450_000);
    let mut files = vec![
        ("nothing", TRIANGLE.into()),
        ("fans joined", fans_joined(150_000)),
        (
            "triangles of a few vertices",
            ("v 0 0 0\n".repeat(999) + &few).into_bytes(),
        ),
        (
            "last corners in full",
            filled(
                &(NINE.to_owned() + &last + "f 1/1/1 2/1/1 3/1/1\n"),
                MIB,
                "f 1 2 3\n",
            ),
        ),
    ];
    files.extend(table());
    let mut over = Vec::new();
    for (name, file) in files.into_iter().step_by(stride()) {
        let allowed = (64 << 10).max(12 * file.len() / 1024);
        let peak = peak(&file);
        if peak > allowed {
            over.push(name);
        }
    }
    assert!(over.is_empty(), "over the bound: {over:?}");
}
