//! Pages that are played, turned, and looked at by day and by night.

use serde_json::json;

use crate::chrome::Chrome;
use crate::harness::Folder;
use crate::screen::{is_grey, is_seam};

/// The size of the stage of an open page.
fn size(chrome: &mut Chrome) -> [f64; 2] {
    let stage = chrome.value("[stage.clientWidth, stage.clientHeight]");
    [0, 1].map(|i| stage[i].as_f64().expect("a number"))
}

#[test]
#[ignore = "needs chromium"]
fn a_simulation_is_played_and_can_be_turned() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    folder.done("tear sheet.obj --scene rip --seconds 1.2 -o torn.obj --view rip.html");
    chrome.open(&folder.path("rip.html"));
    let size = size(&mut chrome);
    // It opens at the first tear, which is marked on the slider, and nothing is torn before.
    let red = chrome.screen(size).places(is_seam).len();
    assert!(red > 40, "{red} red pixels at the first tear");
    let off = "parseFloat(tears.firstChild.style.left) - 100 * time.value / time.max";
    let off = chrome.value(off).as_f64().expect("per cent");
    assert!(off.abs() < 0.01, "the mark is {off} % off");
    let marks = chrome.value("tears.childElementCount");
    assert!(marks.as_u64() > Some(1), "{marks} marks");
    chrome.set("time", "time.value - 1");
    let before = chrome.screen(size);
    assert!(before.places(is_seam).is_empty(), "it is whole");
    // A shadow is on the ground below, which is the background but darker.
    let is_shadow = |[r, g, b]: [u8; 3]| r == g && r.abs_diff(b) < 4 && (120..240).contains(&r);
    let dark = before.places(is_shadow).len();
    assert!(dark > 5000, "{dark} pixels of shadow");
    chrome.set("time", "0");
    assert_eq!(chrome.text("clock"), "0.00 s");
    assert!(chrome.text("plots").contains("largest stretch"));

    chrome.press("play");
    // Pressed by the page itself: on a busy machine a press from outside may come after the end.
    let pause = "new Promise(r => { const watch = setInterval(() => {
        if (Number(time.value) > 3) { clearInterval(watch); play.click(); r(); }
    }, 10); })";
    chrome.value(pause);
    let reached = chrome.value("time.value");
    // A space plays on, also after a click on another button.
    chrome.press("edges");
    chrome.key(" ");
    assert_eq!(chrome.text("play"), "Pause");
    chrome.key(" ");
    chrome.key("ArrowLeft");
    assert_eq!(chrome.text("play"), "Play");
    chrome.set("time", &reached.to_string());
    assert_eq!(chrome.text("play"), "Play");
    chrome.value("new Promise(r => setTimeout(r, 100))");
    assert_eq!(chrome.value("time.value"), reached, "it is paused");
    assert_ne!(reached, "36", "it was paused before the end");

    // Of what is torn nothing can be cut before the end, since no file has it.
    for point in [[200.0, 150.0], [500.0, 200.0]] {
        chrome.click(point);
    }
    assert!(chrome.text("hint").contains("go to torn.obj"));
    chrome.set("time", "time.max");
    assert_eq!(chrome.text("clock"), "1.20 s");
    assert!(chrome.text("line").starts_with("tearmesh cut "));
    chrome.press("clear");
    assert_eq!(chrome.text("line"), "");
    let red = chrome.screen(size).places(is_seam).len();
    assert!(red > 400, "{red} red pixels");

    let before = chrome.hidden_text("render");
    chrome.drag([300.0, 300.0], [420.0, 340.0]);
    assert_ne!(chrome.hidden_text("render"), before, "it was turned");
    let before = chrome.hidden_text("render");
    chrome.mouse("mouseWheel", [300.0, 300.0]);
    chrome.drawn();
    assert_ne!(chrome.hidden_text("render"), before, "it came nearer");
    let colors = chrome.screen(size).colors();
    assert!(colors > 200, "{colors} colours");
    chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn a_seam_is_red_by_day_and_by_night_and_names_do_not_break_out() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    let name = "</script><script>alert(1)</script>\"'&.obj".replace('/', "\u{2215}");
    let quoted = shlex::try_quote(&name).expect("no zero");
    folder.done(&format!(
        "cut flag.obj --rays 0,2,5:0,0,-1 0,-0.4,5:0,0,-1 -o {quoted} --view flag.html"
    ));
    for theme in ["light", "dark"] {
        let features = json!([{"name": "prefers-color-scheme", "value": theme}]);
        chrome.call("Emulation.setEmulatedMedia", &json!({"features": features}));
        chrome.open(&folder.path("flag.html"));
        assert_eq!(chrome.text("title"), name);
        assert_eq!(chrome.value("document.title"), json!(name));
        assert_eq!(chrome.value("document.scripts.length"), json!(2));
        // 1.4 of the flag's height of 2, which takes some 500 pixels; the line is 2.4 wide.
        let red = chrome.screen([680.0, 640.0]).places(is_seam).len();
        assert!((500..1400).contains(&red), "{theme}: {red} red pixels");
    }
    chrome.press("draw");
    chrome.drag([200.0, 300.0], [400.0, 350.0]);
    assert!(chrome.text("line").contains(" --rays "));
    chrome.set("gap", "5");
    let line = chrome.text("line");
    assert!(line.contains(" --gap 5% "), "{line}");
    chrome.press("front");
    let line = chrome.text("line");
    assert!(line.contains(" --layers first "), "{line}");
    // Keys work after a click on a button or a box, but for a number that is typed.
    for id in ["front", "edges", "gap"] {
        if id != "front" {
            chrome.press(id);
        }
        chrome.key("e");
        let is_pressed = chrome.value("document.getElementById('edges').ariaPressed");
        assert_eq!(is_pressed, "true", "after {id}");
    }
    chrome.press("theme");
    // As on a phone: two fingers spread, and two taps plan a cut.
    chrome.size(390, 844);
    chrome.drawn();
    let before = chrome.hidden_text("render");
    for (kind, apart) in [
        ("touchStart", 40.0),
        ("touchMove", 70.0),
        ("touchMove", 100.0),
    ] {
        chrome.touch(kind, &[[195.0 - apart, 250.0], [195.0 + apart, 260.0]]);
    }
    chrome.touch("touchEnd", &[]);
    chrome.drawn();
    assert_ne!(chrome.hidden_text("render"), before, "it came nearer");
    chrome.press("clear");
    for point in [[150.0, 200.0], [230.0, 300.0]] {
        chrome.touch("touchStart", &[point]);
        chrome.touch("touchEnd", &[]);
    }
    assert!(chrome.text("line").contains(" --rays "));
    assert!(!chrome.sticks_out());
    chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn every_moment_is_in_the_frame() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    folder.done("tear sheet.obj --scene fall --seconds 1 -o end.obj --view fall.html");
    chrome.open(&folder.path("fall.html"));
    let size = size(&mut chrome);
    let is_cloth = |[r, _, b]: [u8; 3]| b > r.saturating_add(40);
    let counts = [0, 10, 20, 30].map(|moment| {
        chrome.set("time", &moment.to_string());
        chrome.screen(size).places(is_cloth).len()
    });
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    assert!(counts[3] * 2 > counts[0], "all of it is seen: {counts:?}");
    chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn bodies_are_seen_where_they_are_and_are_not_picked() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    let moves = "[[collider]]\nmoves = [[0, 0, 0, 0], [0.2, 0, 0.1, 0]]\n";
    let scene = folder.read("dress.toml").replace("[[collider]]\n", moves);
    folder.write("s.toml", scene);
    folder.done("tear dress.obj --scene s.toml --seconds 0.2 -o t.obj --view dress.html");
    chrome.open(&folder.path("dress.html"));
    let size = size(&mut chrome);
    let [before, after] = ["0", "time.max"].map(|moment| {
        chrome.set("time", moment);
        chrome.screen(size).places(is_grey)
    });
    assert!(before.len() > 500, "{} grey pixels", before.len());
    assert!(
        after[0][1] < before[0][1] - 20.0,
        "{:?} {:?}",
        before[0],
        after[0]
    );
    // Two clicks at the neck, above the cloth.
    for point in [after[0], [after[0][0] + 5.0, after[0][1] + 5.0]] {
        chrome.click(point);
    }
    let hint = chrome.text("hint");
    assert_eq!(hint, "The line misses the mesh: click two other points.");
    chrome.was_quiet();
}
