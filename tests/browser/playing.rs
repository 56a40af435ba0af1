//! Pages that are played, turned, and looked at by day and by night.

use serde_json::json;

use crate::chrome::Chrome;
use crate::folder::{Folder, done};
use crate::screen::is_seam;

#[test]
#[ignore = "needs chromium"]
fn a_simulation_is_played_and_can_be_turned() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    folder.write("sheet.obj", "sheet.obj", |p| p);
    let [mesh, torn, page] = ["sheet.obj", "torn.obj", "rip.html"].map(|name| folder.name(name));
    done(&[
        "tearmesh",
        "tear",
        &mesh,
        "--scene",
        "rip",
        "--seconds",
        "1.2",
        "-o",
        &torn,
        "--view",
        &page,
    ]);
    chrome.open(&folder.path("rip.html"));
    let stage = chrome.value("[stage.clientWidth, stage.clientHeight]");
    let size = [0, 1].map(|i| stage[i].as_f64().expect("a number"));
    // It opens at the first tear, which is marked on the slider, and nothing is torn before.
    let red = chrome.screen(size).places(is_seam).len();
    assert!(red > 40, "{red} red pixels at the first tear");
    let off = "parseFloat(tears.firstChild.style.left) - 100 * time.value / time.max";
    let off = chrome.value(off).as_f64().expect("per cent");
    assert!(off.abs() < 0.01, "the mark is {off} % off");
    let marks = chrome.value("tears.childElementCount");
    assert!(marks.as_u64() > Some(1), "{marks} marks");
    chrome.value("time.value -= 1; time.dispatchEvent(new Event('input'))");
    let before = chrome.screen(size);
    assert!(before.places(is_seam).is_empty(), "it is whole");
    // A shadow is on the ground below, which is the background but darker.
    let is_shadow = |[r, g, b]: [u8; 3]| r == g && r.abs_diff(b) < 4 && (120..240).contains(&r);
    let dark = before.places(is_shadow).len();
    println!("{dark} pixels of shadow");
    assert!(dark > 5000, "{dark} pixels of shadow");
    chrome.value("time.value = 0; time.dispatchEvent(new Event('input'))");
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
    chrome.value(&format!(
        "time.value = {reached}; time.dispatchEvent(new Event('input'))"
    ));
    assert_eq!(chrome.text("play"), "Play");
    chrome.value("new Promise(r => setTimeout(r, 100))");
    assert_eq!(chrome.value("time.value"), reached, "it is paused");
    assert_ne!(reached, "36", "it was paused before the end");

    // Of what is torn nothing can be cut before the end, since no file has it.
    for point in [[200.0, 150.0], [500.0, 200.0]] {
        chrome.click(point);
    }
    assert!(chrome.text("hint").contains("go to torn.obj"));
    let end = "time.value = time.max; time.dispatchEvent(new Event('input'))";
    chrome.value(end);
    assert_eq!(chrome.text("clock"), "1.20 s");
    assert!(chrome.text("line").starts_with("tearmesh cut "));
    chrome.press("clear");
    assert_eq!(chrome.text("line"), "");
    let red = chrome.screen(size).places(is_seam).len();
    println!("{red} red pixels at the end");
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
    folder.write("flag.obj", "flag.obj", |p| p);
    let [mesh, torn, page] = ["flag.obj", &name, "flag.html"].map(|name| folder.name(name));
    done(&[
        "tearmesh",
        "cut",
        &mesh,
        "--rays",
        "0,2,5:0,0,-1",
        "0,-0.4,5:0,0,-1",
        "-o",
        &torn,
        "--view",
        &page,
    ]);
    for theme in ["light", "dark"] {
        let features = json!([{"name": "prefers-color-scheme", "value": theme}]);
        chrome.call("Emulation.setEmulatedMedia", &json!({"features": features}));
        chrome.open(&folder.path("flag.html"));
        assert_eq!(chrome.text("title"), name);
        assert_eq!(chrome.value("document.title"), json!(name));
        assert_eq!(chrome.value("document.scripts.length"), json!(2));
        // 1.4 of the flag's height of 2, which takes some 500 pixels; the line is 2.4 wide.
        let red = chrome.screen([680.0, 640.0]).places(is_seam).len();
        println!("{theme}: {red} red pixels");
        assert!((500..1400).contains(&red), "{theme}: {red} red pixels");
    }
    chrome.press("draw");
    chrome.drag([200.0, 300.0], [400.0, 350.0]);
    assert!(chrome.text("line").contains(" --rays "));
    chrome.value("gap.value = 5; gap.dispatchEvent(new Event('input'))");
    let line = chrome.text("line");
    assert!(line.contains(" --gap 5% "), "{line}");
    chrome.press("front");
    let line = chrome.text("line");
    assert!(line.contains(" --layers first "), "{line}");
    // Keys work after a click on a button or a box, but for a number that is typed.
    let is_pressed = |id| format!("document.getElementById('{id}').ariaPressed");
    chrome.key("e");
    assert_eq!(chrome.value(&is_pressed("edges")), "true");
    chrome.press("edges");
    chrome.key("e");
    assert_eq!(chrome.value(&is_pressed("edges")), "true");
    chrome.press("gap");
    chrome.key("e");
    assert_eq!(chrome.value(&is_pressed("edges")), "true");
    chrome.press("theme");
    // As on a phone: two fingers spread, and two taps plan a cut.
    chrome.size(390, 844);
    chrome.drawn();
    let before = chrome.hidden_text("render");
    for (kind, apart) in [("touchStart", 40), ("touchMove", 70), ("touchMove", 100)] {
        let points =
            json!([{"x": 195 - apart, "y": 250, "id": 1}, {"x": 195 + apart, "y": 260, "id": 2}]);
        chrome.call(
            "Input.dispatchTouchEvent",
            &json!({"type": kind, "touchPoints": points}),
        );
    }
    chrome.call(
        "Input.dispatchTouchEvent",
        &json!({"type": "touchEnd", "touchPoints": []}),
    );
    chrome.drawn();
    assert_ne!(chrome.hidden_text("render"), before, "it came nearer");
    chrome.press("clear");
    for [x, y] in [[150, 200], [230, 300]] {
        let points = json!([{"x": x, "y": y}]);
        chrome.call(
            "Input.dispatchTouchEvent",
            &json!({"type": "touchStart", "touchPoints": points}),
        );
        chrome.call(
            "Input.dispatchTouchEvent",
            &json!({"type": "touchEnd", "touchPoints": []}),
        );
    }
    assert!(chrome.text("line").contains(" --rays "));
    let sticks_out = "document.documentElement.scrollWidth > innerWidth";
    assert_eq!(chrome.value(sticks_out), json!(false));
    chrome.was_quiet();
}

#[test]
#[ignore = "needs chromium"]
fn every_moment_is_in_the_frame() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    folder.write("sheet.obj", "sheet.obj", |p| p);
    let [mesh, end, page] = ["sheet.obj", "end.obj", "fall.html"].map(|name| folder.name(name));
    let fall = ["tearmesh", "tear", &mesh, "--scene", "fall"];
    let files = ["--seconds", "1", "-o", &end, "--view", &page];
    done(&[&fall[..], &files].concat());
    chrome.open(&folder.path("fall.html"));
    let stage = chrome.value("[stage.clientWidth, stage.clientHeight]");
    let size = [0, 1].map(|i| stage[i].as_f64().expect("a number"));
    let is_cloth = |[r, _, b]: [u8; 3]| b > r.saturating_add(40);
    let mut counts = Vec::new();
    for moment in [0, 10, 20, 30] {
        chrome.value(&format!(
            "time.value = {moment}; time.dispatchEvent(new Event('input'))"
        ));
        counts.push(chrome.screen(size).places(is_cloth).len());
    }
    println!("{counts:?} pixels of cloth");
    assert!(counts.iter().all(|&count| count > 1000), "{counts:?}");
    assert!(counts[3] * 2 > counts[0], "all of it is seen: {counts:?}");
    chrome.was_quiet();
}
