//! Pages: by `view`, and those that other verbs leave beside a mesh.

use std::fs;
use std::io::Read as _;

use base64::Engine as _;
use serde_json::Value;

#[cfg(unix)]
use crate::harness::interrupted_at;
use crate::harness::{Folder, seen};

const CUT: &str = "tearmesh cut sheet.obj --rays 0.3,0.2,5:0,0,-1 0.7,0.8,5:0,0,-1";

/// The text of a page.
fn text(html: &str) -> Value {
    let (_, data) = html.split_once("type=\"text/plain\">").expect("data");
    let (data, _) = data.split_once('<').expect("an end");
    let packed = base64::engine::general_purpose::STANDARD
        .decode(data)
        .expect("base64");
    let mut bytes = Vec::new();
    flate2::read::ZlibDecoder::new(&packed[..])
        .read_to_end(&mut bytes)
        .expect("zlib");
    let length = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) as usize;
    serde_json::from_slice(&bytes[4..4 + length]).expect("JSON")
}

/// Runs a command that has to be done.
fn done(folder: &Folder, line: &str) -> String {
    let output = folder.run(line);
    assert_eq!(output.status.code(), Some(0), "{line}\n{}", seen(&output));
    seen(&output)
}

#[test]
fn every_verb_shows_its_mesh_and_how_to_cut_it() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    fs::create_dir(folder.path("my meshes")).expect("a folder");
    fs::copy(folder.path("sheet.obj"), folder.path("my meshes/it's.obj")).expect("a copy");
    fs::copy(folder.path("sheet.obj"), folder.path("my meshes/-.obj")).expect("a copy");
    for (line, page, cut) in [
        (
            format!("{CUT} -o torn.obj --view cut.html"),
            "cut.html",
            ["torn.obj", "", "torn-cut.obj"],
        ),
        (
            "tearmesh mend torn.obj -o m.obj --view m.html".to_owned(),
            "m.html",
            ["m.obj", "", "m-cut.obj"],
        ),
        (
            "tearmesh tear flag.obj --scene s.toml -o t.obj --view t.html".to_owned(),
            "t.html",
            ["t.obj", "", "t-cut.obj"],
        ),
        (
            "tearmesh view torn.obj --repair -o v.html".to_owned(),
            "v.html",
            ["torn.obj", " --repair", "torn-cut.obj"],
        ),
        (
            "tearmesh view \"my meshes/it's.obj\"".to_owned(),
            "it's.html",
            ["\"my meshes/it's.obj\"", "", "\"my meshes/it's-cut.obj\""],
        ),
        (
            "tearmesh view torn.obj --up 0,0,1 --separate-fans".to_owned(),
            "torn.html",
            ["torn.obj", " --separate-fans", "torn-cut.obj"],
        ),
    ] {
        done(&folder, &line);
        let html = folder.read(page);
        let text = text(&html);
        let moments = text["moments"].as_array().expect("moments");
        let last = moments.last().expect("a moment");
        assert_eq!(last["cut"], serde_json::json!(cut), "{line}");
        done(&folder, &line);
        assert!(folder.read(page) == html, "{line}: other bytes");
    }
    // A page of standard output, and one of a mesh that was written there.
    let output = folder.run("tearmesh view torn.obj -o -");
    let html = String::from_utf8(output.stdout).expect("text");
    assert!(html.ends_with("</html>\n") && output.stderr.is_empty());
    done(&folder, "tearmesh view - -o in.html < sheet.obj");
    assert_eq!(
        text(&folder.read("in.html"))["moments"][0]["cut"][0],
        "mesh.obj"
    );
    let output = folder.run(&format!("{CUT} --view p.html"));
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(
        text(&folder.read("p.html"))["moments"][0]["cut"][0],
        "mesh.obj"
    );
    // What was not written cannot be cut.
    done(&folder, &format!("{CUT} --format json --view j.html"));
    assert_eq!(
        text(&folder.read("j.html"))["moments"][0]["cut"],
        Value::Null
    );
}

#[test]
fn frames_in_a_folder_are_played_in_their_order() {
    let folder = Folder::new();
    done(
        &folder,
        "tearmesh tear sheet.obj --scene rip --seconds 1 --frames f -o t.obj --view t.html",
    );
    let said = done(&folder, "tearmesh view f");
    assert!(said.starts_with("view: 31 meshes, 600 to "), "{said}");
    let [frames, whole] = ["f.html", "t.html"].map(|name| text(&folder.read(name)));
    let labels = frames["moments"].as_array().expect("moments").iter();
    let labels: Vec<&str> = labels
        .map(|one| one["label"].as_str().expect("a name"))
        .collect();
    assert_eq!(labels[0], "frame_00000.obj");
    assert!(labels.is_sorted());
    // The simulation has as many moments, and says when each was, and what was pulled.
    let moments = whole["moments"].as_array().expect("moments");
    assert_eq!(moments.len(), labels.len());
    let times: Vec<f64> = moments
        .iter()
        .map(|one| one["time"].as_f64().expect("seconds"))
        .collect();
    assert!(times.is_sorted() && times[0] == 0.0 && (times[30] - 1.0).abs() < 1e-3);
    assert!(moments[..30].iter().all(|one| one["cut"].is_null()));
    let torn = |one: &Value| one["torn"].as_f64().expect("a length");
    assert!(torn(&moments[0]) == 0.0 && torn(&moments[30]) > 1.0);
    let names = whole["plots"].as_array().expect("plots").iter();
    let names: Vec<&str> = names
        .map(|plot| plot["name"].as_str().expect("a name"))
        .collect();
    assert_eq!(names, ["largest stretch", "force at holds"]);
    let stretch = whole["plots"][0]["lines"][0]["points"]
        .as_array()
        .expect("points");
    assert_eq!(stretch.len(), moments.len());
    assert!((stretch[0][1].as_f64().expect("a ratio") - 1.0).abs() < 1e-9);
}

#[cfg(unix)]
#[test]
fn an_interrupted_simulation_is_shown_as_far_as_it_came() {
    let folder = Folder::new();
    let mut command = folder.command();
    command.args([
        "tear",
        "sheet.obj",
        "--scene",
        "hang",
        "--seconds",
        "100000",
        "--view",
        "t.html",
    ]);
    command.args(["--frames", "f", "-o", "t.obj", "--report", "r.json"]);
    let output = interrupted_at(&mut command, &folder.path("f/frame_00002.obj"));
    assert_eq!(output.status.code(), Some(130), "{}", seen(&output));
    let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let text = text(&folder.read("t.html"));
    let last = text["moments"]
        .as_array()
        .and_then(|all| all.last())
        .expect("moments");
    assert_eq!(last["time"], report["time_simulated_s"]);
    assert_eq!(last["cut"][0], "t.obj");
}

/// What fails in the middle is shown up to there.
#[test]
fn a_simulation_that_fails_is_shown_as_far_as_it_came() {
    let folder = Folder::new();
    let strict = "base = \"rip\"\ngravity_m_per_s2 = 0\n[fabric]\nstretch_n_per_m = 1e8\n[solver]\nmethod = \"implicit\"\ndt_s = 0.05\n";
    folder.write("s.toml", strict);
    let output = folder.run("tearmesh tear flag.obj --scene s.toml -o t.obj --view t.html");
    assert_eq!(output.status.code(), Some(5), "{}", seen(&output));
    let text = text(&folder.read("t.html"));
    let last = text["moments"]
        .as_array()
        .and_then(|all| all.last())
        .expect("moments");
    assert!(last["time"].as_f64() < Some(3.0), "{last}");
    assert_eq!(last["cut"][0], "t.obj");
}

/// Four seconds of a flag with 1,089 vertices and more.
#[test]
fn a_page_of_120_moments_of_1000_vertices_is_small() {
    let folder = Folder::new();
    done(
        &folder,
        "tearmesh tear flag.obj --scene flag --solver xpbd --seconds 3.97 -o t.obj --view t.html -q",
    );
    let html = folder.read("t.html");
    let text = text(&html);
    let moments = text["moments"].as_array().expect("moments");
    let vertices = moments
        .iter()
        .map(|one| one["vertices"].as_u64().expect("a count"))
        .sum::<u64>();
    let page = html.len() as f64 * 120_000.0 / vertices as f64;
    println!(
        "{} moments, {vertices} vertices in all, {} bytes",
        moments.len(),
        html.len()
    );
    assert!(moments.len() >= 120 && vertices >= 120_000);
    assert!(page <= 600_000.0, "{page} bytes for each 120 · 1,000");
}

#[test]
fn a_page_replaces_nothing_else_and_is_not_begun_where_it_cannot_be_written() {
    let folder = Folder::new();
    folder.write("sheet.html", "<!doctype html><title>mine</title>");
    folder.write("empty.obj", "v 0 0 0\n");
    folder.write("bad.obj", "v 0 0 x\n");
    for (line, exit) in [
        (format!("{CUT} -o x.obj --view sheet.obj"), 2),
        (format!("{CUT} -o x.obj --view ./x.obj"), 2),
        (format!("{CUT} -o x.obj --view x.png --picture x.png"), 2),
        (format!("{CUT} -o x.obj --view -"), 2),
        (format!("{CUT} -o x.html"), 2),
        (format!("{CUT} -o x.obj --view no/x.html"), 7),
        (
            "tearmesh tear sheet.obj --scene hang --forces f.csv --view f.csv -o x.obj".to_owned(),
            2,
        ),
        (
            "tearmesh tear sheet.obj --scene hang --frames . --view frame_00001.obj -o x.obj"
                .to_owned(),
            2,
        ),
        ("tearmesh view sheet.obj".to_owned(), 2),
        ("tearmesh view sheet.obj -o x.obj".to_owned(), 2),
        (
            "tearmesh view sheet.obj sheet.html -o sheet.html".to_owned(),
            2,
        ),
        ("tearmesh view - < sheet.obj".to_owned(), 2),
        ("tearmesh view - - -o x.html".to_owned(), 2),
        ("tearmesh view sheet.obj --up 0,0,0 -o x.html".to_owned(), 2),
        ("tearmesh view empty.obj -o x.html".to_owned(), 3),
        ("tearmesh view bad.obj -o x.html".to_owned(), 3),
        (
            "tearmesh view sheet.obj missing.obj -o x.html".to_owned(),
            3,
        ),
        ("tearmesh view tests/data/none -o x.html".to_owned(), 3),
        ("tearmesh view sheet.obj -o no/x.html".to_owned(), 7),
    ] {
        let before = folder.names();
        let output = folder.run(&line);
        assert_eq!(
            output.status.code(),
            Some(exit),
            "{line}\n{}",
            seen(&output)
        );
        assert!(seen(&output).contains("error"), "{line}");
        assert_eq!(folder.names(), before, "{line}");
    }
    assert!(folder.read("sheet.html").contains("mine"));
    done(&folder, &format!("{CUT} --dry-run --view x.html"));
    done(
        &folder,
        "tearmesh tear sheet.obj --scene hang --seconds 0.1 --dry-run --view x.html",
    );
    assert!(!folder.path("x.html").exists());
    // A page of ours is replaced, and another one if that is asked for.
    done(&folder, "tearmesh view sheet.obj -o sheet.html");
    done(&folder, "tearmesh view sheet.obj");
}

/// The page of a simulation and its summary speak of one length: that at rest.
#[test]
fn a_tear_has_one_length() {
    let folder = Folder::new();
    let scene = "tearmesh tear sheet.obj --scene rip --seconds 0.8 --report r.json";
    let words = done(&folder, &format!("{scene} -o x.obj --view x.html"));
    let report: Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    let rest_m = report["tear_length_m"].as_f64().expect("a length");
    assert!(rest_m > 0.1, "{rest_m}");
    assert!(words.contains(" m torn (at rest), "), "{words}");
    let page = text(&folder.read("x.html"));
    let last = page["moments"].as_array().and_then(|all| all.last());
    let last = last.expect("a moment");
    let shown = last["torn"].as_f64().expect("a length");
    assert!((shown - rest_m).abs() < 1e-9 * rest_m, "{shown} {rest_m}");
    assert_eq!(last["torn_at_rest"], true);
}
