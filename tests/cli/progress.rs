//! Progress bars, on a terminal.

use std::fs::File;
use std::io::Read as _;
use std::process::Stdio;

use nix::pty::{Winsize, openpty};

use crate::harness::Folder;

/// What a command shows on a terminal of its own.
fn shown(folder: &Folder, line: &str) -> String {
    let size = Winsize {
        ws_row: 24,
        ws_col: 80,
        ws_xpixel: 0,
        ws_ypixel: 0,
    };
    let terminal = openpty(&size, None).expect("a terminal");
    let mut master = File::from(terminal.master);
    let mut command = folder.command(line);
    command.stdout(Stdio::null()).stderr(terminal.slave);
    let mut child = command.spawn().expect("it runs");
    drop(command); // It would keep the terminal open.
    let mut bytes = Vec::new();
    // Once the other end is closed, a terminal cannot be read.
    let _ = master.read_to_end(&mut bytes);
    assert!(child.wait().expect("an end").success(), "{line}");
    String::from_utf8_lossy(&bytes).into_owned()
}

#[test]
fn what_takes_long_shows_how_far_it_is() {
    let folder = Folder::new();
    for line in [
        "tear sheet.obj --scene hang --seconds 0.05 --dry-run",
        "render sheet.obj --scene hang --seconds 0.05 --strip 2 --size 64x48 -o strip.png",
    ] {
        let seen = shown(&folder, line);
        assert!(seen.contains(" left"), "{line}: {seen}");
        let seen = shown(&folder, &format!("{line} -q"));
        assert_eq!(seen, "", "{line}");
    }
}
