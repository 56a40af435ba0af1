//! The page that is played: a real mouse rips, cuts, mends and saves; fingers do so too; and what a person did
//! is repeated to the bit, natively and in the browser.

use std::fs;
use std::time::{Duration, Instant};

use serde_json::json;
use tearmesh_play::{Plan, Player};

use crate::chrome::Chrome;
use crate::harness::{Folder, root};
use crate::random::Random;
use crate::read_back::content;
use crate::screen::{is_grey, is_seam};

/// A page that is open, and the folder that it saves into.
struct Played {
    chrome: Chrome,
    folder: Folder,
}

/// The middle of the stage, and its lower end.
const MIDDLE: [f64; 2] = [340.0, 320.0];
const BELOW: [f64; 2] = [340.0, 610.0];

impl Played {
    /// Opens a page that a command wrote; none without a browser.
    fn open(options: &str) -> Option<Played> {
        Played::within(Folder::new(), options)
    }

    fn within(folder: Folder, options: &str) -> Option<Played> {
        let mut chrome = Chrome::start()?;
        folder.done(&format!("play -o play.html {options}"));
        chrome.downloads_to(&folder.path(""));
        chrome.open(&folder.path("play.html"));
        Some(Played { chrome, folder })
    }

    fn choose(&mut self, id: &str, value: &str) {
        let event = "dispatchEvent(new Event('change'))";
        self.chrome
            .value(&format!("{id}.value = '{value}', {id}.{event}, 0"));
        self.chrome.drawn();
    }

    /// Waits until something is so: for five minutes at most, since pictures are drawn by the processor.
    fn wait(&mut self, what: &str, mut is_so: impl FnMut(&mut Played) -> bool) {
        let begun = Instant::now();
        while !is_so(self) {
            let said = self.chrome.hidden_text("say");
            assert!(begun.elapsed() < Duration::from_secs(300), "{what}: {said}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// A number among the facts beside the cloth.
    fn fact(&mut self, name: &str) -> f64 {
        let text = format!(
            "[...facts.children].find(e => e.textContent === '{name}')?.nextSibling.textContent"
        );
        let text = self.chrome.value(&text);
        let text = text.as_str().unwrap_or_default();
        let number = text.split_whitespace().next().unwrap_or_default();
        number.parse().expect("a number among the facts")
    }

    /// Waits until a fact is what it is to be.
    fn until(&mut self, name: &str, is_it: impl Fn(f64) -> bool) {
        self.wait(name, |played| is_it(played.fact(name)));
    }

    /// Lets simulated time pass.
    fn pass(&mut self, seconds: f64) {
        let until = self.fact("time") + seconds;
        self.until("time", |time| time >= until);
    }

    /// Grabs the cloth with the mouse, drags it somewhere, and lets simulated time pass on the way.
    fn pull(&mut self, from: [f64; 2], to: [f64; 2], seconds: f64) {
        self.chrome.mouse("mouseMoved", from);
        self.chrome.mouse("mousePressed", from);
        // The page tells its time five times a second.
        for part in 1..=4 {
            let part = f64::from(part) / 4.0;
            let at = [0, 1].map(|i| from[i] + (to[i] - from[i]) * part);
            self.chrome.mouse("mouseDragged", at);
            self.pass(seconds / 4.0);
        }
    }

    /// Presses a button that saves a file; its content.
    fn saved(&mut self, button: &str, name: &str) -> Vec<u8> {
        let path = self.folder.path(name);
        drop(fs::remove_file(&path));
        self.chrome.value(&format!("{button}.click()"));
        self.wait(name, |_| path.exists());
        self.folder.bytes(name)
    }

    /// The digest of which the page speaks.
    fn digest(&mut self) -> String {
        let said = self.chrome.text("say");
        let (_, digest) = said
            .split_once("digest ")
            .unwrap_or_else(|| panic!("{said}"));
        digest.trim_end_matches('.').to_owned()
    }

    /// Has the page repeat a log, or take another file.
    fn take(&mut self, name: &str) {
        let root = self.chrome.call("DOM.getDocument", &json!({}));
        let query = json!({"nodeId": root["root"]["nodeId"], "selector": "#drop"});
        let input = self.chrome.call("DOM.querySelector", &query);
        let files = json!({"nodeId": input["nodeId"], "files": [self.folder.path(name)]});
        self.chrome.call("DOM.setFileInputFiles", &files);
        self.chrome.drawn();
    }

    /// Saves the log, and compares three times: as it was lived, repeated natively, repeated in the browser.
    fn repeats(&mut self) {
        self.repeats_as("sheet-32");
    }

    /// Does so with files that have a name.
    fn repeats_as(&mut self, stem: &str) {
        let [log_name, obj_name] = [".log", "-torn.obj"].map(|end| format!("{stem}{end}"));
        self.chrome
            .value("pause.textContent === 'Pause' && pause.click()");
        self.chrome.drawn();
        let log = self.saved("record", &log_name);
        let digest = self.digest();
        let obj = self.saved("save", &obj_name);
        let log = String::from_utf8(log).expect("a log is text");
        let mut settings = Player::settings_of(&log).expect("settings");
        let (page, file) = content(&self.folder.read("play.html"));
        let plan = page["plan"].as_str();
        settings.plan = plan.map(|plan| Plan::read(plan.as_bytes()).expect("a scene"));
        let document = settings.document(&file).expect("a cloth");
        let native = Player::replayed(&document, settings, &log).expect("a replay");
        assert_eq!(format!("{:016x}", native.digest()), digest, "native");
        assert!(native.obj().expect("a file") == obj, "the same file");
        self.take(&log_name);
        self.wait("it is repeated", |played| {
            played.chrome.text("say").starts_with("Repeated")
        });
        assert_eq!(self.digest(), digest, "in the browser");
        let again = self.saved("save", &obj_name);
        assert!(again == obj, "the same file, repeated");
    }
}

#[test]
#[ignore = "needs chromium"]
fn a_mouse_rips_and_mends_and_saves_what_checks() {
    let Some(mut played) = Played::open("") else {
        return;
    };
    let holds = played.chrome.text("holds");
    assert!(holds.contains("highest 3 % along y: 33"), "{holds}");
    let size = [680.0, 640.0];
    played.pass(0.1);
    assert!(played.chrome.screen(size).places(is_seam).is_empty());
    played.pull(MIDDLE, BELOW, 2.0);
    let (tears, vertices) = (played.fact("tears"), played.fact("vertices"));
    assert!(tears > 40.0 && vertices > 1120.0, "{tears} tears");
    assert!(played.chrome.screen(size).places(is_seam).len() > 300);
    played.chrome.mouse("mouseReleased", BELOW);
    played.saved("save", "sheet-32-torn.obj");
    let said = played.folder.done("check sheet-32-torn.obj");
    assert!(said.contains(" ok "), "{said}");
    // The record has the tears: mended as a whole, it is the sheet again.
    let said = played.folder.done("mend sheet-32-torn.obj -o whole.obj");
    assert!(said.contains("1089"), "{said}");

    played.chrome.press("mend");
    played.until("pieces", |pieces| pieces == 1.0);
    played.until("vertices", |vertices| vertices < 1100.0);
    played.repeats();
    played.chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn a_moving_flag_is_cut_as_the_line_says_and_then_ripped() {
    let Some(mut played) = Played::open("--scene flag") else {
        return;
    };
    played.pass(0.4);
    played.chrome.press("cut");
    // It is shown while it is drawn, and made when the button goes up, through the cloth as it is then.
    played.chrome.drag([330.0, 60.0], [350.0, 620.0]);
    assert!(played.chrome.text("say").starts_with("Cut: "));
    played.until("pieces", |pieces| pieces >= 2.0);
    // Two clicks do the same.
    for at in [[180.0, 250.0], [260.0, 280.0]] {
        played.chrome.click(at);
    }
    assert!(played.chrome.text("say").starts_with("Cut: "));
    played.chrome.press("pause");
    // The line, for the file before the cut, makes the file that the page has: of cuts while it is paused.
    for at in [[200.0, 300.0], [280.0, 340.0]] {
        played.chrome.click(at);
    }
    let line = played.chrome.text("line");
    played.saved("before", "sheet-32-before.obj");
    let obj = played.saved("save", "sheet-32-torn.obj");
    let said = played.folder.done(&line);
    let cut = played.folder.bytes("sheet-32-cut.obj");
    assert!(cut == obj, "{line}\n{said}");
    played.folder.done("check sheet-32-torn.obj");

    played.chrome.press("pause");
    played.chrome.press("hand");
    let before = played.fact("tears");
    played.pull([240.0, 300.0], [640.0, 600.0], 1.5);
    played.chrome.mouse("mouseReleased", [640.0, 600.0]);
    assert!(played.fact("tears") > before, "the pull rips it");
    played.repeats();
    played.chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn fingers_pull_pin_and_turn() {
    let Some(mut played) = Played::open("") else {
        return;
    };
    // Ten fingers pull the cloth apart, and let it go while it is mended.
    let at = |apart: f64| {
        let finger = |i| {
            let (across, down) = (f64::from(i % 5 - 2), f64::from(i / 5) - 0.5);
            [340.0 + 60.0 * apart * across, 330.0 + 140.0 * apart * down]
        };
        (0..10).map(finger).collect::<Vec<_>>()
    };
    played.chrome.touch("touchStart", &at(1.0));
    for step in 0..10 {
        played
            .chrome
            .touch("touchMove", &at(1.0 + 0.16 * f64::from(step)));
        played.pass(0.1);
    }
    assert!(played.fact("tears") > 40.0, "they rip it");
    played.chrome.key("m");
    played.chrome.touch("touchEnd", &[]);
    played.pass(0.3);
    played.repeats();
    let log = played.folder.read("sheet-32.log");
    assert_eq!(log.matches(" grab ").count(), 10, "{log}");
    // Drawn finer, what is crumpled is round.
    let coarse = played.chrome.screen([680.0, 560.0]);
    played.chrome.key("n");
    played.chrome.drawn();
    let fine = played.chrome.screen([680.0, 560.0]);
    assert!(coarse.apart_from(&fine) > 300, "it is finer");
    played.chrome.key("n");
    // One pins.
    played.chrome.value("reset.click()");
    played.chrome.press("pin");
    played.chrome.touch("touchStart", &[MIDDLE]);
    played.chrome.touch("touchEnd", &[]);
    played.until("pins", |now| now == 34.0);
    // Keys work after a click on a box or on the list of keys; that of the pointer's place unpins.
    played.chrome.press("front");
    played
        .chrome
        .value("document.querySelector('summary').focus()");
    played.chrome.mouse("mouseMoved", MIDDLE);
    let key = json!({"type": "keyDown", "key": "p", "text": "p"});
    played.chrome.call("Input.dispatchKeyEvent", &key);
    played.until("pins", |now| now == 33.0);
    // Beside the cloth, one turns the view.
    played.chrome.press("hand");
    let before = played.chrome.screen([680.0, 560.0]);
    played.chrome.drag([30.0, 400.0], [130.0, 440.0]);
    let after = played.chrome.screen([680.0, 560.0]);
    assert!(before.apart_from(&after) > 1000, "it turned");
    // On a telephone all buttons are on the screen.
    played.chrome.size(390, 844);
    played.chrome.drawn();
    assert!(!played.chrome.sticks_out());
    played.chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn a_shirt_is_sewn_round_a_body_cut_and_ripped() {
    let folder = Folder::new();
    for name in ["dress.obj", "dress.toml", "dummy.obj"] {
        let from = root().join("tests/data").join(name);
        folder.write(name, fs::read(from).expect(name));
    }
    let moves = "[[collider]]\nmoves = [[0.5, 0, 0, 0], [1, 0, 0.02, 0]]\n";
    let scene = folder.read("dress.toml").replace("[[collider]]\n", moves);
    folder.write("dress.toml", scene);
    let Some(mut played) = Played::within(folder, "dress.obj --scene dress.toml") else {
        return;
    };
    // The body is drawn where the cloth leaves it bare: its neck is grey. It moves up.
    let size = [680.0, 640.0];
    let bare = |played: &mut Played| played.chrome.screen(size).places(is_grey);
    let before = bare(&mut played);
    assert!(before.len() > 500, "{} grey pixels", before.len());
    played.until("time", |time| time > 1.0);
    let after = bare(&mut played);
    assert!(
        after[0][1] < before[0][1] - 3.0,
        "{:?} {:?}",
        before[0],
        after[0]
    );
    played.until("pieces", |pieces| pieces == 1.0);
    played.until("vertices", |vertices| vertices == 794.0);
    played.chrome.press("front");
    played.chrome.press("cut");
    played.chrome.drag([330.0, 330.0], [345.0, 450.0]);
    assert!(played.chrome.text("say").starts_with("Cut: "));
    played.chrome.press("hand");
    played.pull([325.0, 470.0], [105.0, 550.0], 1.2);
    played.chrome.mouse("mouseReleased", [105.0, 550.0]);
    assert!(played.fact("tears") > 10.0, "the pull rips it");
    played.repeats_as("dress");
    played.folder.done("check dress-torn.obj");
    // Another mesh is played in a scene that stands ready, and without the body.
    played
        .folder
        .write("other.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    played.take("other.obj");
    played.until("faces", |faces| faces == 1.0);
    let ready = played.chrome.value("held.value");
    assert_eq!(ready.as_str(), Some("rip"));
    assert!(bare(&mut played).len() < before.len() / 4);
    played.chrome.was_quiet();
}

const SCENES: [&str; 5] = ["rip", "hang", "flag", "trouser", "fall"];

#[test]
#[ignore = "needs chromium"]
fn every_scene_survives_whoever_plays_with_it() {
    let Some(mut played) = Played::open("") else {
        return;
    };
    played.choose("source", "16");
    for scene in SCENES {
        for seed in 1..=3 {
            let mut random = Random(2014 + seed);
            let mut place = || [60.0 + 560.0 * random.next(), 60.0 + 560.0 * random.next()];
            played.choose("held", scene);
            played.pass(0.1);
            for _ in 0..3 {
                let (from, to) = (place(), place());
                played.pull(from, to, 0.3);
                played.chrome.mouse("mouseReleased", to);
            }
            played.chrome.press("cut");
            played.chrome.drag(place(), place());
            played.chrome.press("hand");
            played.chrome.press("mend");
            played.pass(0.3);
            let said = played.chrome.hidden_text("say");
            let words = ["The simulation", "error"];
            let is_over = words.iter().any(|word| said.contains(word));
            assert!(!is_over, "{scene}: {said}");
            let obj = played.saved("save", "sheet-16-torn.obj");
            assert!(!String::from_utf8_lossy(&obj).contains("NaN"), "{scene}");
            played.folder.done("check sheet-16-torn.obj");
        }
    }
    played.chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn a_file_is_played_and_a_bad_one_changes_nothing() {
    let folder = Folder::new();
    folder.write("it's a flag.obj", folder.read("flag.obj"));
    let Some(mut played) = Played::within(folder, "\"it's a flag.obj\" --scene hang") else {
        return;
    };
    assert_eq!(played.chrome.text("title"), "it's a flag.obj");
    played.pass(0.2);
    played.folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    played.take("bad.obj");
    played.chrome.drawn();
    let said = played.chrome.text("say");
    assert!(said.starts_with("bad.obj: line 2"), "{said}");
    assert_eq!(played.chrome.text("title"), "it's a flag.obj");
    played.pass(0.1);
    played.chrome.press("cut");
    played.chrome.drag([100.0, 300.0], [600.0, 340.0]);
    let line = played.chrome.text("line");
    assert!(line.contains("'it'\\''s a flag-before.obj'"), "{line}");
    played.saved("save", "it's a flag-torn.obj");
    played.folder.done("check \"it's a flag-torn.obj\"");
    // What was torn is played on, and keeps its record, so it is mended.
    played.take("it's a flag-torn.obj");
    played.until("pieces", |pieces| pieces >= 2.0);
    played.saved("save", "it's a flag-torn-torn.obj");
    let mend = "mend \"it's a flag-torn-torn.obj\" -o whole.obj";
    let said = played.folder.done(mend);
    assert!(said.contains("-> 1 piece"), "{said}");
    // One vertex more than there may be.
    let mut many = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_owned();
    many.push_str(&"v 0 0 1\n".repeat(19_998));
    played.folder.write("many.obj", many);
    played.take("many.obj");
    let said = played.chrome.text("say");
    assert!(said.contains("20001 vertices"), "{said}");
    played.chrome.was_quiet();
}
