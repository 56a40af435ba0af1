//! Pages: by `view`, and those that other verbs leave beside a mesh.

use std::fs;

use serde_json::Value;

use crate::harness::Folder;
#[cfg(unix)]
use crate::harness::interrupted_at;
use crate::read_back::content;

const CUT: &str = "cut sheet.obj --rays 0.3,0.2,5:0,0,-1 0.7,0.8,5:0,0,-1";

/// The moments of a page in a file.
fn moments(folder: &Folder, page: &str) -> Vec<Value> {
    let (text, _) = content(&folder.read(page));
    text["moments"].as_array().expect("moments").clone()
}

#[test]
fn every_verb_shows_its_mesh_and_how_to_cut_it() {
    let folder = Folder::new();
    folder.write("s.toml", "base = \"hang\"\nseconds = 0.1\n");
    fs::create_dir(folder.path("my meshes")).expect("a folder");
    fs::copy(folder.path("sheet.obj"), folder.path("my meshes/it's.obj")).expect("a copy");
    // What is typed, the page, and what it has of a cut: the file, options, and the output.
    for row in [
        "$CUT -o torn.obj --view cut.html | cut.html | torn.obj |  | torn-cut.obj",
        "mend torn.obj -o m.obj --view m.html | m.html | m.obj |  | m-cut.obj",
        "tear flag.obj --scene s.toml -o t.obj --view t.html | t.html | t.obj |  | t-cut.obj",
        "view torn.obj --repair -o v.html | v.html | torn.obj | --repair | torn-cut.obj",
        "view \"my meshes/it's.obj\" | it's.html | \"my meshes/it's.obj\" |  | \"my meshes/it's-cut.obj\"",
        "view torn.obj --up 0,0,1 --separate-fans | torn.html | torn.obj | --separate-fans | torn-cut.obj",
        // Of a mesh that was read from a stream, or written to one.
        "view - -o in.html < sheet.obj | in.html | mesh.obj |  | mesh-cut.obj",
        "$CUT --view p.html | p.html | mesh.obj |  | mesh-cut.obj",
    ] {
        let row = row.replace("$CUT", CUT);
        let [line, page, file, options, output] = row.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{row}")
        };
        let options = if options.is_empty() {
            String::new()
        } else {
            format!(" {options}")
        };
        let cut = [file, &options, output];
        folder.done(line);
        let html = folder.read(page);
        let moments = moments(&folder, page);
        let last = moments.last().expect("a moment");
        assert_eq!(last["cut"], serde_json::json!(cut), "{line}");
        folder.done(line);
        assert!(folder.read(page) == html, "{line}: other bytes");
    }
    let streamed = folder.run("view torn.obj -o -");
    assert!(streamed.text().ends_with("</html>\n") && streamed.error.is_empty());
    // What was not written cannot be cut.
    folder.done(&format!("{CUT} --format json --view j.html"));
    assert!(moments(&folder, "j.html")[0]["cut"].is_null());
}

#[test]
fn a_page_has_the_bodies_of_its_scene_where_they_are() {
    let folder = Folder::new();
    let moves = "[[collider]]\nmoves = [[0, 0, 0, 0], [1, 0, 0.1, 0]]\n";
    let scene = folder.read("dress.toml").replace("[[collider]]\n", moves);
    folder.write("s.toml", scene);
    folder.done("tear dress.obj --scene s.toml --seconds 0.1 -o t.obj --view t.html");
    let (text, _) = content(&folder.read("t.html"));
    let solid = &text["solids"][0];
    assert_eq!(solid["vertices"], 434);
    let side = text["side"].as_f64().expect("a length");
    let placings = solid["placings"].as_array().expect("placings");
    for (placing, moment) in placings.iter().zip(moments(&folder, "t.html")) {
        let up = placing[10].as_f64().expect("a number") * side;
        let time = moment["time"].as_f64().expect("a time");
        assert!((up - 0.1 * time).abs() < 1e-9, "{time}: {up}");
    }
    // A floor is not drawn.
    folder.done("tear sheet.obj --scene fall --seconds 0.1 -o t.obj --view t.html");
    assert!(content(&folder.read("t.html")).0["solids"].is_null());
}

/// The page of a simulation has as many moments as there are frames, says when each was, and what was pulled; it and
/// the summary speak of one length, that at rest.
#[test]
fn frames_in_a_folder_are_played_in_their_order() {
    let folder = Folder::new();
    let line =
        "tear sheet.obj --scene rip --seconds 1 --frames f -o t.obj --view t.html --report r.json";
    let words = folder.done(line);
    let said = folder.done("view f");
    assert!(said.starts_with("view: 31 meshes, 600 to "), "{said}");
    let labels = moments(&folder, "f.html").into_iter();
    let labels: Vec<String> = labels.map(|one| one["label"].to_string()).collect();
    assert_eq!(labels[0], "\"frame_00000.obj\"");
    assert!(labels.is_sorted());
    let moments = moments(&folder, "t.html");
    assert_eq!(moments.len(), labels.len());
    let numbers = |key: &str| -> Vec<f64> {
        let numbers = moments.iter().map(|one| one[key].as_f64());
        numbers.map(|number| number.expect("a number")).collect()
    };
    let times = numbers("time");
    assert!(times.is_sorted() && times[0] == 0.0 && (times[30] - 1.0).abs() < 1e-3);
    assert!(moments[..30].iter().all(|one| one["cut"].is_null()));
    let rest_m = folder.json("r.json")["tear_length_m"]
        .as_f64()
        .expect("a length");
    let torn = numbers("torn");
    assert!(torn[0] == 0.0 && torn[30] > 1.0 && (torn[30] - rest_m).abs() < 1e-9 * rest_m);
    assert_eq!(moments[30]["torn_at_rest"], true);
    assert!(words.contains(" m torn (at rest), "), "{words}");
    let (text, _) = content(&folder.read("t.html"));
    let plots = &text["plots"];
    let names = [0, 1].map(|i| plots[i]["name"].as_str().unwrap_or_default());
    assert_eq!(names, ["largest stretch", "force at holds"]);
    let stretch = plots[0]["lines"][0]["points"].as_array().expect("points");
    assert_eq!(stretch.len(), moments.len());
    assert!((stretch[0][1].as_f64().expect("a ratio") - 1.0).abs() < 1e-9);
}

#[cfg(unix)]
#[test]
fn an_interrupted_simulation_is_saved_and_shown() {
    let folder = Folder::new();
    let line = "tear sheet.obj --scene hang --seconds 100000 --view t.html --frames f -o t.obj \
                --report r.json";
    let answer = interrupted_at(folder.command(line), &folder.path("f/frame_00002.obj"));
    let said = answer.seen();
    assert_eq!(answer.exit, 130, "{said}");
    assert!(
        said.contains("interrupted") && said.contains("wrote t.obj"),
        "{said}"
    );
    let report = folder.json("r.json");
    assert_eq!(report["status"], "interrupted");
    assert!(report["steps"].as_u64() > Some(20));
    folder.done("check t.obj");
    let moments = moments(&folder, "t.html");
    let last = moments.last().expect("a moment");
    assert_eq!(last["time"], report["time_simulated_s"]);
    assert_eq!(last["cut"][0], "t.obj");
}

/// What fails in the middle is shown up to there.
#[test]
fn a_simulation_that_fails_is_shown_as_far_as_it_came() {
    let folder = Folder::new();
    folder.add_files("tests/cli/inputs.txt");
    folder.ends(
        "tear flag.obj --scene strict.toml -o t.obj --view t.html",
        5,
    );
    let moments = moments(&folder, "t.html");
    let last = moments.last().expect("a moment");
    assert!(last["time"].as_f64() < Some(3.0), "{last}");
    assert_eq!(last["cut"][0], "t.obj");
}

/// Four seconds of a flag with 1,089 vertices and more.
#[test]
fn a_page_of_120_moments_of_1000_vertices_is_small() {
    let folder = Folder::new();
    folder
        .done("tear flag.obj --scene flag --solver xpbd --seconds 3.97 -o t.obj --view t.html -q");
    let moments = moments(&folder, "t.html");
    let vertices = moments
        .iter()
        .map(|one| one["vertices"].as_u64().expect("a count"));
    let (vertices, bytes) = (vertices.sum::<u64>(), folder.read("t.html").len());
    assert!(moments.len() >= 120 && vertices >= 120_000);
    let page = bytes as f64 * 120_000.0 / vertices as f64;
    assert!(page <= 600_000.0, "{page} bytes for each 120 · 1,000");
}
