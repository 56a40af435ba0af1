//! Two points that are clicked, and the cut that the page's line makes.

use crate::chrome::Chrome;
use crate::eye::Eye;
use crate::harness::Folder;
use crate::random::Random;
use crate::screen::{apart, distance, is_trace};

/// How far the trace may be from the cut, in pixels, and half of the width of its line.
const OFF: f64 = 2.0;
const HALF: f64 = 1.2;
/// How far the mark of a point reaches.
const MARK: f64 = 6.0;
/// Each pair that misses is followed by another one.
const PAIRS: usize = 10;

#[test]
#[ignore = "needs chromium"]
fn the_line_cuts_where_the_page_shows_it() {
    let Some(mut chrome) = Chrome::start() else {
        return;
    };
    let folder = Folder::new();
    let moved = |to: &str, mesh: &str, by: &dyn Fn([f64; 3]) -> [f64; 3]| {
        let line = |line: &str| match line.strip_prefix("v ") {
            Some(numbers) => {
                let [x, y, z] = by(three(numbers));
                format!("v {x} {y} {z}\n")
            }
            None => format!("{line}\n"),
        };
        let text = folder.read(mesh);
        folder.write(to, text.lines().map(line).collect::<String>());
    };
    moved("flag in the wind.obj", "flag.obj", &|p| p.map(|x| x * 1e-3));
    moved("far.obj", "sheet.obj", &|[x, y, z]| {
        [1e6 + x, y - 2e6, 5e5 + z]
    });
    moved("sleeve.obj", "sleeve.obj", &|p| p.map(|x| x * 1e3));
    moved("quilt.obj", "quilt.obj", &|[x, y, z]| {
        [7.0 - x, 1e3 + y, z * 3.0]
    });
    // A sheet folded again and again, tiny and not at the origin.
    moved("folded's.obj", "sheet.obj", &|[x, y, z]| {
        let fold = ((x * 3.0) % 2.0 - 1.0).abs();
        [2.0 + (1.0 - fold) * 5e-6, y * 2e-5, 1.0 + 1e-5 * (x + z)]
    });
    let mut random = Random(2014);
    for mesh in [
        "'flag in the wind.obj'",
        "far.obj",
        "sleeve.obj",
        "quilt.obj",
        "\"folded's.obj\"",
    ] {
        folder.done(&format!("view {mesh} -o page.html"));
        chrome.open(&folder.path("page.html"));
        cut_at_random(&mut chrome, &folder, mesh, &mut random, PAIRS);
    }
    // The end of a simulation, which the page knows by what has changed from moment to moment.
    let slit = "--rays 0.3,0.4,5:0,0,-1 0.8,0.7,5:0,0,-1 --cut-at 0.3";
    let tear = "tear sheet.obj --scene hang --seconds 0.8";
    folder.done(&format!("{tear} {slit} -o torn.obj --view torn.html"));
    chrome.open(&folder.path("torn.html"));
    chrome.set("time", "time.max");
    cut_at_random(&mut chrome, &folder, "torn.obj", &mut random, PAIRS / 2);
    chrome.was_quiet();
}

/// The first three numbers of a line.
fn three(line: &str) -> [f64; 3] {
    let mut numbers = line.split_whitespace();
    [(); 3].map(|()| {
        let number = numbers.next().and_then(|x| x.parse().ok());
        number.expect("three numbers")
    })
}

/// Cuts a mesh on an open page so often, each time from elsewhere.
fn cut_at_random(
    chrome: &mut Chrome,
    folder: &Folder,
    mesh: &str,
    random: &mut Random,
    pairs: usize,
) {
    chrome.press("box");
    // Letters have edges in all colours.
    chrome.value("tools.style.visibility = say.style.visibility = 'hidden'");
    let (mut hit, mut missed) = (0, 0);
    while hit < pairs {
        assert!(missed < 60, "{mesh}: nothing is hit");
        let turned = [0; 2].map(|_| 200.0 + 300.0 * random.next());
        chrome.drag([150.0, 320.0], turned);
        let points = [0; 2].map(|_| [30.0 + 620.0 * random.next(), 60.0 + 500.0 * random.next()]);
        chrome.value(&format!("front.checked = {}", hit % 2 == 1));
        match planned(chrome, folder, mesh, points) {
            true => hit += 1,
            false => missed += 1,
        }
    }
}

/// Clicks two points, and checks what the page shows. False if they miss the mesh, which is checked too.
fn planned(chrome: &mut Chrome, folder: &Folder, mesh: &str, points: [[f64; 2]; 2]) -> bool {
    for point in points {
        chrome.click(point);
    }
    let line = chrome.text("line");
    let eye = Eye::of(&chrome.hidden_text("render"));
    if line.is_empty() {
        let hint = chrome.text("hint");
        assert_eq!(hint, "The line misses the mesh: click two other points.");
        assert!(traced(chrome, &eye, points).is_empty(), "no trace is left");
        misses(folder, &eye, mesh, points);
        return false;
    }
    let is_first = line.contains(" --layers first");
    assert_eq!(chrome.value("front.checked"), is_first, "{line}");
    let said = folder.done(&format!("{line} --seam seam.obj"));

    let segments = seam_pixels(&folder.read("seam.obj"), &eye);
    assert!(!segments.is_empty(), "{line}\n{said}");
    for &end in segments.as_flattened() {
        let off = distance(end, points);
        assert!(
            off <= OFF,
            "{points:?}: the cut goes {off} beside them\n{line}"
        );
    }
    let drawn = traced(chrome, &eye, points);
    for &at in &drawn {
        let near = segments.iter().map(|&one| distance(at, one));
        let near = near.fold(f64::INFINITY, f64::min);
        assert!(
            near <= OFF + HALF,
            "{points:?}: the trace at {at:?} is {near} from the cut\n{line}"
        );
    }
    // And all of the cut is shown, but for what is under the marks of the points.
    for [a, b] in segments {
        let steps = apart(a, b).ceil().max(1.0);
        for step in 0..=steps as u32 {
            let at = [0, 1].map(|i| a[i] + (b[i] - a[i]) * f64::from(step) / steps);
            if points.iter().any(|&point| apart(point, at) < MARK + OFF) {
                continue;
            }
            let near = drawn.iter().map(|&drawn| apart(drawn, at));
            let near = near.fold(f64::INFINITY, f64::min);
            let is_inside = (0..2).all(|i| at[i] > 4.0 && at[i] < eye.size[i] - 4.0);
            assert!(
                near <= OFF || !is_inside,
                "{points:?}: the cut at {at:?} is {near} from the trace\n{line}"
            );
        }
    }
    true
}

/// The pixels of the trace beside the marks of the points.
fn traced(chrome: &mut Chrome, eye: &Eye, marks: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let mut drawn = chrome.screen(eye.size).places(is_trace);
    drawn.retain(|&at| marks.iter().all(|&mark| apart(mark, at) > MARK));
    if drawn.is_empty() || chrome.value("facts.textContent.includes('nothing')") == true {
        return drawn;
    }
    // The edge of a red line may have its colour: what is there without a trace is none.
    chrome.value("document.getElementById('clear').click()");
    let other = chrome.screen(eye.size).places(is_trace);
    drawn.retain(|at| !other.contains(at));
    drawn
}

/// What the page says of a miss is what `cut --camera` says of it.
fn misses(folder: &Folder, eye: &Eye, mesh: &str, points: [[f64; 2]; 2]) {
    let [[ax, ay], [bx, by]] = points;
    let ([width, height], options) = (eye.size, eye.options.join(" "));
    let line = format!("cut {mesh} --dry-run --viewport {width}x{height} {options}");
    folder.ends(&format!("{line} --points {ax},{ay} {bx},{by}"), 1);
}

/// The segments of a seam in a file, as they are seen.
fn seam_pixels(text: &str, eye: &Eye) -> Vec<[[f64; 2]; 2]> {
    let of = |begin| {
        text.lines()
            .filter_map(move |line| line.strip_prefix(begin))
    };
    let points: Vec<[f64; 2]> = of("v ").map(|line| eye.pixel(three(line))).collect();
    let mut segments = Vec::new();
    for line in of("l ") {
        let numbers = line
            .split(' ')
            .map(|n| n.parse::<usize>().expect("a number"));
        let along: Vec<[f64; 2]> = numbers.map(|n| points[n - 1]).collect();
        segments.extend(along.windows(2).map(|pair| [pair[0], pair[1]]));
    }
    segments
}
