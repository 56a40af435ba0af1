//! Runs that end in the middle: of a signal, after which nothing is left of them, or killed, as by
//! `kill -9`, when they can tidy nothing up.

use std::process::Child;
use std::time::{Duration, Instant};

use tearmesh::shapes;

use crate::harness::{Folder, file_of, signal};
use crate::support::cases::stride;

/// A folder with a sheet that takes a while to read and to write.
struct Sheet {
    folder: Folder,
    input: String,
}

impl Sheet {
    fn new() -> Sheet {
        let (folder, input) = (Folder::new(), file_of(&shapes::grid(100, 100)));
        folder.write("large.obj", &input);
        Sheet { folder, input }
    }

    fn cut(&self, output: &str) -> Child {
        let line = "cut large.obj --rays 0.653,-1,5:0,0,-1 0.637,9,5:0,0,-1 -q -o";
        let mut command = self.folder.command(&format!("{line} {output}"));
        command.spawn().expect("a run")
    }

    /// How long a run takes that makes this file.
    fn whole(&self, output: &str) -> Duration {
        let begun = Instant::now();
        assert!(self.cut(output).wait().expect("an end").success());
        begun.elapsed()
    }

    /// The files in the folder whose names are not as they were given.
    fn left(&self) -> Vec<String> {
        let names = self.folder.list(".").into_iter();
        names.filter(|name| name.contains(".tmp")).collect()
    }
}

#[test]
fn a_killed_run_leaves_the_old_file_or_the_new_one() {
    let sheet = Sheet::new();
    let old = "something old\n";
    let whole = sheet.whole("new.obj");
    let new = sheet.folder.read("new.obj");
    for i in 0..=24 {
        sheet.folder.write("out.obj", old);
        let mut child = sheet.cut("out.obj");
        if i < 24 {
            std::thread::sleep(whole * i / 20);
            let _ = child.kill(); // It may have ended already.
        }
        child.wait().expect("an end");
        let now = sheet.folder.read("out.obj");
        assert!(now == old || now == new, "run {i} left {} bytes", now.len());
        assert!(i > 0 || now == old, "a run killed at once has written");
        assert!(i < 24 || now == new, "a run left alone has not written");
        let input = sheet.folder.read("large.obj");
        assert!(input == sheet.input, "the input was touched");
    }
}

#[test]
fn a_run_ended_by_a_signal_leaves_no_draft() {
    let sheet = Sheet::new();
    let whole = sheet.whole("new.obj");
    let new = sheet.folder.read("new.obj");
    let mut in_writing = 0;
    let runs = 60 / stride() as u32;
    for i in 0..runs {
        let old = "something old\n";
        sheet.folder.write("out.obj", old);
        let mut child = sheet.cut("out.obj");
        // Half of them as soon as there is a draft.
        if i % 2 == 0 {
            std::thread::sleep(whole * i / runs);
        } else {
            while child.try_wait().expect("a state").is_none() && sheet.left().is_empty() {}
        }
        in_writing += usize::from(!sheet.left().is_empty());
        signal(["-INT", "-TERM"][i as usize / 2 % 2], child.id());
        child.wait().expect("an end");
        assert_eq!(sheet.left(), [""; 0], "after {i} runs");
        let now = sheet.folder.read("out.obj");
        assert!(now == old || now == new, "run {i} left {} bytes", now.len());
    }
    assert!(in_writing > 0, "no run was ended while it wrote");
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
