//! Runs that are killed, as by `kill -9`: they can tidy nothing up.

use std::fs::{self, File};
use std::process::Child;
use std::time::{Duration, Instant};

use crate::harness::{Folder, seen};

/// A flat sheet that takes a while to read and to write.
fn large_sheet(cells: usize) -> String {
    let mut obj = String::new();
    for j in 0..=cells {
        for i in 0..=cells {
            obj.push_str(&format!("v {} {} 0\n", i as f64 / 7.0, j as f64 / 7.0));
        }
    }
    for j in 0..cells {
        for i in 0..cells {
            let a = j * (cells + 1) + i + 1;
            let (b, c, d) = (a + 1, a + cells + 2, a + cells + 1);
            obj.push_str(&format!("f {a} {b} {c}\nf {a} {c} {d}\n"));
        }
    }
    obj
}

/// A folder with a large sheet.
struct Sheet {
    folder: Folder,
    input: String,
}

impl Sheet {
    fn new() -> Sheet {
        let (folder, input) = (Folder::new(), large_sheet(100));
        folder.write("large.obj", &input);
        Sheet { folder, input }
    }

    fn cut(&self, output: &str) -> Child {
        let rays = ["--rays", "9.3,-1,5:0,0,-1", "9.1,99,5:0,0,-1"];
        let mut command = self.folder.command();
        command.args(["cut", "large.obj"]).args(rays);
        command.args(["-q", "-o", output]);
        command.spawn().expect("a run")
    }

    /// How long a run takes that makes this file.
    fn whole(&self, output: &str) -> Duration {
        let begun = Instant::now();
        assert!(self.cut(output).wait().expect("an end").success());
        begun.elapsed()
    }

    fn killed_after(&self, output: &str, time: Duration) {
        let mut child = self.cut(output);
        std::thread::sleep(time);
        let _ = child.kill(); // It may have ended already.
        child.wait().expect("an end");
    }

    /// The files in the folder whose names are not as they were given.
    fn left(&self) -> Vec<String> {
        let names = self.folder.names().into_iter();
        names.filter(|name| name.contains(".tmp")).collect()
    }
}

#[test]
fn a_run_killed_at_any_moment_leaves_the_old_file_or_the_new_one() {
    let sheet = Sheet::new();
    let old = "something old\n";
    let whole = sheet.whole("new.obj");
    let new = sheet.folder.read("new.obj");
    for i in 0..=24 {
        sheet.folder.write("out.obj", old);
        match i {
            24 => sheet.whole("out.obj"),
            _ => {
                sheet.killed_after("out.obj", whole * i / 20);
                whole
            }
        };
        let now = sheet.folder.read("out.obj");
        assert!(now == old || now == new, "run {i} left {} bytes", now.len());
        assert!(i > 0 || now == old, "a run killed at once has written");
        assert!(i < 24 || now == new, "a run left alone has not written");
        let input = sheet.folder.read("large.obj");
        assert!(input == sheet.input, "the input was touched");
    }
    // One that was killed between giving a file its name and putting it in the place of the old one
    // leaves that, but the next does not.
    assert_eq!(sheet.left(), [""; 0]);
}

/// As many runs as `TEARMESH_KILLS` says, or 40. A new file has no name until it is whole, so that
/// there is no moment at which anything could be left.
#[test]
fn regression_a_killed_run_leaves_no_temporary_file() {
    let sheet = Sheet::new();
    if !has_files_without_names(&sheet.folder) {
        return;
    }
    let runs = std::env::var("TEARMESH_KILLS").map_or(40, |n| n.parse().expect("a number"));
    let whole = sheet.whole("new.obj");
    let new = sheet.folder.read("new.obj");
    let (mut random, mut written) = (1_u64, 0);
    for run in 1..=runs {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        let part = (random >> 33) as f64 / f64::from(1_u32 << 31);
        sheet.killed_after("out.obj", whole.mul_f64(1.2 * part));
        assert_eq!(sheet.left(), [""; 0], "after {run} runs");
        if sheet.folder.path("out.obj").exists() {
            assert!(sheet.folder.read("out.obj") == new, "run {run} left a part");
            fs::remove_file(sheet.folder.path("out.obj")).expect("a file");
            written += 1;
        }
    }
    println!("{runs} runs, {written} of them not killed in time");
}

/// Linux has files without names, but not every file system of it.
fn has_files_without_names(folder: &Folder) -> bool {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{Mode, OFlags, open};
        let flags = OFlags::TMPFILE | OFlags::WRONLY;
        open(folder.path(""), flags, Mode::empty()).is_ok()
    }
    #[cfg(not(target_os = "linux"))]
    false
}

/// What a killed run left is removed by the next one that writes the same file, and what belongs to
/// a run that is still there, or to another file, is not.
#[test]
fn regression_what_a_killed_run_left_is_removed_by_the_next() {
    let folder = Folder::new();
    let cut = "tearmesh cut flag.obj --rays 0.31,2,5:0,0,-1 0.25,-2,5:0,0,-1 -o out.obj";
    let (gone, other) = (
        ".out.obj.tearmesh-AbC123.tmp",
        ".in.obj.tearmesh-AbC123.tmp",
    );
    let busy = ".out.obj.tearmesh-dEf456.tmp";
    let strangers = [".out.obj.tearmesh-notes.tmp", "out.obj.tearmesh-AbC123.tmp"];
    folder.write("out.obj", "something old\n");
    for name in [gone, other, busy].iter().chain(&strangers) {
        folder.write(name, "half a mesh\n");
    }
    let owner = File::open(folder.path(busy)).expect("a file");
    owner.lock().expect("a lock");
    let output = folder.run(cut);
    assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    let is_there = |name: &str| folder.path(name).exists();
    assert!(!is_there(gone), "{:?}", folder.names());
    assert!(is_there(other) && is_there(busy), "{:?}", folder.names());
    assert!(
        strangers.iter().all(|name| is_there(name)),
        "{:?}",
        folder.names()
    );
    drop(owner);
    folder.run(cut);
    assert!(!is_there(busy), "{:?}", folder.names());
}

/// Many runs at once on one file: each ends well, and one of them has written the file.
#[test]
fn runs_at_once_on_one_file_do_not_disturb_each_other() {
    let sheet = Sheet::new();
    sheet.whole("new.obj");
    for _ in 0..4 {
        let runs: Vec<Child> = (0..6).map(|_| sheet.cut("out.obj")).collect();
        for mut run in runs {
            assert!(run.wait().expect("an end").success());
        }
        assert!(sheet.folder.read("out.obj") == sheet.folder.read("new.obj"));
        assert_eq!(sheet.left(), [""; 0]);
    }
}
