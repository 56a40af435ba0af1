//! Simulations: frames against each other by a reader that shares no code with the writer, the
//! report, interruptions, and the same bytes on every run.

use std::fs;

#[cfg(unix)]
use crate::harness::interrupted_at;
use crate::harness::{Folder, seen};

/// A file's vertices, and its faces by vertices, read in the simplest way.
fn read(text: &str) -> (Vec<[u64; 3]>, Vec<[usize; 3]>) {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.first() {
            Some(&"v") => vertices.push([1, 2, 3].map(|i| {
                let x: f64 = words[i].parse().expect("a number");
                x.to_bits()
            })),
            Some(&"f") => faces.push([1, 2, 3].map(|i| {
                let index = words[i].split('/').next().expect("an index");
                index.parse::<usize>().expect("a vertex") - 1
            })),
            _ => {}
        }
    }
    (vertices, faces)
}

fn frames(folder: &Folder, name: &str) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder.path(name))
        .expect("a folder of frames")
        .map(|entry| {
            entry
                .expect("a frame")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

#[test]
fn frames_with_one_topology_are_the_frames_corner_by_corner() {
    let folder = Folder::new();
    let rip = "tearmesh tear sheet.obj --scene rip --seconds 1.5";
    for (name, line) in [
        ("own", format!("{rip} --frames own -o own.obj")),
        (
            "final",
            format!("{rip} --frames final --frames-topology final -o final.obj --report r.json"),
        ),
    ] {
        let output = folder.run(&line);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", seen(&output));
    }
    assert_eq!(folder.read("own.obj"), folder.read("final.obj"));
    let names = frames(&folder, "own");
    assert_eq!(names, frames(&folder, "final"));
    assert_eq!(names.len(), 46);
    assert_eq!(names[45], "frame_00045.obj");
    let last = read(&folder.read("final.obj"));
    let mut grown = 0;
    for name in &names {
        let own = read(&folder.read(&format!("own/{name}")));
        let one = read(&folder.read(&format!("final/{name}")));
        assert_eq!(one.1, last.1, "{name}: one index buffer");
        assert_eq!(one.0.len(), last.0.len());
        assert_eq!(own.1.len(), one.1.len());
        for (f, (face, other)) in own.1.iter().zip(&one.1).enumerate() {
            for (v, w) in face.iter().zip(other) {
                assert_eq!(own.0[*v], one.0[*w], "{name}, face {f}");
            }
        }
        // Vertices keep their order, and new ones are appended.
        assert_eq!(own.0[..], one.0[..own.0.len()]);
        grown = own.0.len().max(grown);
    }
    assert!(grown > 600, "something tore");
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert_eq!(report["frames"]["count"], 46);
    assert_eq!(report["frames"]["corners_checked"], 46 * 3 * last.1.len());
    // The last frame is the output, which has more copies behind those: of vertices whose faces
    // share no edge.
    assert_eq!(
        grown,
        600 + report["splits"].as_u64().expect("a count") as usize
    );
    assert!(grown < last.0.len());
}

#[test]
fn the_report_says_what_the_method_says_of_its_steps() {
    let folder = Folder::new();
    for (solver, quality) in [
        ("provot", &["limiter", "steps_infeasible"][..]),
        ("pbd", &["strain_rms"]),
        ("xpbd", &["residual_n"]),
        ("implicit", &["implicit", "indefinite"]),
        ("verlet", &["guarded", "carried"]),
    ] {
        let line = "tearmesh tear sheet.obj --scene rip --seconds 0.8 --dry-run --report r.json";
        let output = folder.run(&format!("{line} --solver {solver}"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
        let report: serde_json::Value =
            serde_json::from_str(&folder.read("r.json")).expect("a report");
        let said = quality.iter().fold(&report["quality"], |at, key| &at[*key]);
        assert!(said.is_number(), "{solver}: {said}");
        // The hand is faster than any cloth is long, which the limiter cannot mend.
        let warned = seen(&output).contains("W-SIM-LIMIT");
        assert_eq!(warned, solver == "provot", "{}", seen(&output));
    }
}

#[test]
fn the_report_lists_the_features_in_use_and_their_shares() {
    let folder = Folder::new();
    for (scene, features) in [
        ("hang", &["springs", "tearing"][..]),
        ("flag", &["springs", "wind"]),
        (
            "tests/data/woven.toml",
            &["springs", "triangles", "tearing"],
        ),
        ("tests/data/folds.toml", &["springs", "bending"]),
    ] {
        let line = format!("tearmesh tear sheet.obj --scene {scene} --seconds 0.1 --dry-run -v");
        let said = seen(&folder.run(&format!("{line} --report r.json")));
        let report: serde_json::Value =
            serde_json::from_str(&folder.read("r.json")).expect("a report");
        let told = report["counters"]["features"].as_array().expect("a list");
        let names: Vec<_> = told.iter().map(|one| one["name"].as_str()).collect();
        let expected: Vec<_> = features.iter().map(|&name| Some(name)).collect();
        assert_eq!(names, expected, "{scene}");
        let visits: u64 = told
            .iter()
            .map(|one| one["visits"].as_u64().expect("a count"))
            .sum();
        let mut words = Vec::new();
        for one in told {
            let share = one["visits"].as_f64().expect("a count") / visits as f64;
            assert!((one["share"].as_f64().expect("a part") - share).abs() < 1e-12);
            let name = one["name"].as_str().expect("a name");
            words.push(format!("{name} {:.0} %", 100.0 * share));
        }
        assert!(
            said.contains(&format!("element visits: {}", words.join(", "))),
            "{said}"
        );
    }
}

#[test]
fn seconds_that_steps_do_not_make_up_are_warned_of() {
    let folder = Folder::new();
    let line = "tearmesh tear flag.obj --scene hang --solver implicit -o x.obj";
    for (options, made) in [
        (
            "--seconds 0.001 --dt 0.01",
            Some("0 s are simulated, in 0 steps"),
        ),
        (
            "--seconds 0.02 --dt 0.016",
            Some("0.016 s are simulated, in 1 step"),
        ),
        ("--seconds 0 --dt 0.01", None),
        ("--seconds 0.02 --dt 0.01", None),
        ("--seconds 0.02 --dt 0.003999", None),
        ("--seconds 0.1", None),
    ] {
        let said = seen(&folder.run(&format!("{line} {options}")));
        let warned = said.contains("W-SIM-SECONDS");
        assert_eq!(warned, made.is_some(), "{options}\n{said}");
        assert!(made.is_none_or(|made| said.contains(made)), "{said}");
    }
    // What it advises works.
    let said = seen(&folder.run(&format!("{line} --seconds 0.02 --dt 0.016")));
    assert!(said.contains("help: --dt 0.01\n"), "{said}");
}

/// The faces of a frame before the cut are divided already, but on the same surface.
#[test]
fn frames_before_a_cut_have_its_vertices_on_their_edges() {
    let folder = Folder::new();
    let line = "tearmesh tear sheet.obj --scene tests/data/scarf.toml";
    for options in ["--frames own", "--frames final --frames-topology final"] {
        let output = folder.run(&format!("{line} {options} -o out.obj"));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    }
    let area = |(vertices, faces): &(Vec<[u64; 3]>, Vec<[usize; 3]>)| -> f64 {
        let sum = faces.iter().map(|face| {
            let [a, b, c] = face.map(|v| vertices[v].map(f64::from_bits));
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let n = [1, 2, 0].map(|i| u[i] * v[(i + 1) % 3] - u[(i + 1) % 3] * v[i]);
            n.iter().map(|x| x * x).sum::<f64>().sqrt() / 2.0
        });
        sum.sum()
    };
    for name in frames(&folder, "own") {
        let own = read(&folder.read(&format!("own/{name}")));
        let one = read(&folder.read(&format!("final/{name}")));
        assert_eq!(own.0[..], one.0[..own.0.len()], "{name}");
        let [before, after] = [area(&own), area(&one)];
        assert!(
            (before - after).abs() < 1e-9 * before,
            "{name}: {before} {after}"
        );
    }
}

#[test]
fn the_report_has_what_others_rely_on_and_two_runs_are_equal() {
    let folder = Folder::new();
    for name in ["a", "b"] {
        let output = folder.run(&format!(
            "tearmesh tear flag.obj --scene rip --seconds 1.5 --no-timing -o {name}.obj \
             --report {name}.json --frames {name}"
        ));
        assert_eq!(output.status.code(), Some(0), "{}", seen(&output));
    }
    assert_eq!(folder.read("a.obj"), folder.read("b.obj"));
    for frame in frames(&folder, "a") {
        let [one, other] = ["a", "b"].map(|name| folder.read(&format!("{name}/{frame}")));
        assert_eq!(one, other, "{frame}");
    }
    let report = folder.read("a.json");
    let other = folder.read("b.json").replace("b.obj", "a.obj");
    assert_eq!(
        report,
        other.replace("\"folder\": \"b\"", "\"folder\": \"a\"")
    );
    let report: serde_json::Value = serde_json::from_str(&report).expect("a report");
    for pointer in [
        "/steps",
        "/splits",
        "/status",
        "/time_simulated_s",
        "/time_planned_s",
        "/dt_s",
        "/max_stretch",
        "/momentum_drift",
        "/solver",
        "/scene",
        "/counters/visits/project",
        "/counters/visits/force",
        "/counters/visits/detect",
        "/counters/force_evaluations",
        "/energy_j/torn_edges",
        "/energy_j/began",
        "/energy_j/kinetic",
        "/energy_j/elastic",
        "/energy_j/gravity",
        "/energy_j/held",
        "/energy_j/wind",
        "/energy_j/drag",
        "/energy_j/colliders",
        "/energy_j/edits",
        "/energy_j/numerical_dissipation",
        "/pieces_before",
        "/pieces",
        "/tear_length_m",
        "/cap_hit",
        "/mass/before",
        "/frames/count",
    ] {
        assert!(
            report.pointer(pointer).is_some_and(|x| !x.is_null()),
            "{pointer}"
        );
    }
    assert!(report["energy_j"]["gain"].is_null());
    assert_eq!(report["status"], "done");
    assert_eq!(report["mass"]["before"], report["mass"]["after"]);
    assert!(report["splits"].as_u64() > Some(10));
    let grown = report["output"]["vertices"]
        .as_u64()
        .zip(report["input"]["vertices"].as_u64());
    assert_eq!(
        grown.map(|(after, before)| after - before),
        report["splits"].as_u64()
    );
}

#[test]
fn a_simulation_that_fails_keeps_its_state_and_says_so() {
    let folder = Folder::new();
    folder.write(
        "fast.toml",
        "[[hold]]\nnear = [0, 1]\nradius = 0.1\n\
         moves = [[0, 0, 0, 0], [0.1, 0, 0, 0], [0.102, 0, 500, 0]]\n",
    );
    let line = "tearmesh tear flag.obj --scene fast.toml --format json -o kept.obj";
    let output = folder.run(line);
    assert_eq!(output.status.code(), Some(5));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["status"], "blown up");
    assert_eq!(report["diagnostics"][0]["code"], "E-SIM-BLOWUP");
    let time = report["time_simulated_s"].as_f64().expect("a time");
    assert!((0.09..0.12).contains(&time), "{time}");
    assert_eq!(report["output"]["vertices"], 1089);
    assert_eq!(read(&folder.read("kept.obj")).0.len(), 1089);
}

/// The slivers of the cut are what the step fails of, so exactly this cut must be reported.
#[test]
fn a_cut_whose_step_fails_is_told_of() {
    let folder = Folder::new();
    let output = folder.run(
        "tearmesh tear flag.obj --scene hang --solver provot --dt 0.0002 --seconds 0.1 \
         --rays 0.51,2,5:0,0,-1 0.513,-2,5:0,0,-1 --cut-at 0.05 -o kept.obj --report r.json",
    );
    let said = seen(&output);
    assert_eq!(output.status.code(), Some(5), "{said}");
    assert!(said.contains("E-SIM-UNSTABLE"), "{said}");
    assert!(said.contains("1 piece -> 2 pieces · at 0.05 s"), "{said}");
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("a report");
    assert_eq!(report["pieces"], 2);
    let cuts = report["cuts"].as_array().expect("a list");
    assert_eq!(cuts.len(), 1);
}

/// What is to happen when the scene is over never happens, and that is said.
#[test]
fn what_never_happens_is_warned_of() {
    let folder = Folder::new();
    folder.write(
        "late.toml",
        "base = \"hang\"\n[[hold]]\nalong = [0.97, 1]\n[[hold]]\nalong = [0, 0.1]\nfrom_s = 1\n",
    );
    let rays = "--rays 0,2,5:0,0,-1 0,-2,5:0,0,-1";
    let cut = format!("hang {rays} --cut-at");
    for (line, words) in [
        (
            format!("{cut} 1 --seconds 0.1"),
            "the cut at 1 s is never made",
        ),
        (
            format!("{cut} 0.1 --seconds 0.1"),
            "the cut at 0.1 s is never made",
        ),
        (
            format!("{cut} 0 --seconds 0"),
            "the cut at 0 s is never made",
        ),
        (format!("{cut} 0.09 --seconds 0.1"), ""),
        (
            "late.toml --seconds 0.1".to_owned(),
            "hold 2 is never taken",
        ),
        ("hang --seconds 0".to_owned(), ""),
    ] {
        let output = folder.run(&format!("tearmesh tear flag.obj --dry-run --scene {line}"));
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(0), "{line}: {said}");
        assert_eq!(
            said.contains("W-SCENE-LATE"),
            !words.is_empty(),
            "{line}: {said}"
        );
        assert!(said.contains(words), "{line}: {said}");
    }
}

/// What a mesh or a step is too coarse for is said: with a number, and not where it is fine.
#[test]
fn what_gets_past_colliders_and_what_cannot_tear_is_said() {
    let folder = Folder::new();
    let ball =
        |radius: f64| format!("[[collider]]\ncentre = [0.5, 0.5, -0.4]\nradius_m = {radius}\n");
    let strong = |radius: f64| {
        format!("base = \"hang\"\n[[strength]]\nnear = [0.5, 0.5]\nradius = {radius}\nfactor = 8\n")
    };
    folder.write("ball.toml", ball(0.3));
    folder.write("pea.toml", ball(0.01));
    folder.write(
        "thrown.toml",
        format!("gravity_m_per_s2 = [0, 0, -2000]\n{}", ball(0.3)),
    );
    folder.write("some.toml", strong(0.2));
    folder.write("all.toml", strong(2.0));
    for (line, words) in [
        ("ball.toml", None),
        (
            "pea.toml",
            Some("W-SIM-COLLIDER]: collider 1 is a ball 0.02 m across, and edges are up to 0."),
        ),
        (
            "thrown.toml --dt 0.02 --solver xpbd",
            Some("W-SIM-COLLIDER]: a vertex moved "),
        ),
        ("some.toml", None),
        (
            "all.toml",
            Some("are stronger than the cloth: nothing tears below 8 times the threshold"),
        ),
    ] {
        let command = "tearmesh tear sheet.obj --dry-run --seconds 0.1 --scene";
        let output = folder.run(&format!("{command} {line}"));
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(0), "{line}: {said}");
        let is_said = ["W-SIM-COLLIDER", "W-SIM-STRONG"]
            .iter()
            .any(|code| said.contains(code));
        assert_eq!(is_said, words.is_some(), "{line}: {said}");
        assert!(
            words.is_none_or(|words| said.contains(words)),
            "{line}: {said}"
        );
    }
}

/// Each with what is typed, and what it says; the numbers of lines are those of the file.
#[test]
fn what_would_be_ignored_is_refused() {
    let folder = Folder::new();
    let woven = "warp_n_per_m = 300\nweft_n_per_m = 300\n";
    let woven = format!("[solver]\nmethod = \"implicit\"\n[fabric]\n{woven}");
    for (scene, options, words) in [
        (
            "base = \"flag\"\n[[strength]]\nnear = [0, 1]\nfactor = 2\n",
            "",
            "error[E-SCENE-CLASH]: nothing tears in this scene at:2:1",
        ),
        (
            "[[strength]]\nfactor = 2\nvertices = [999999]\n",
            "",
            "error[E-SCENE-RANGE]: strength 1 names the vertex 999999 at:3:12",
        ),
        (
            "\n[[strength]]\nfactor = 2\nfrom = [8, 8, 8]\nto = [9, 9, 9]\n",
            "",
            "error[E-SCENE-EMPTY]: strength 1 contains no vertex at:2:1",
        ),
        (
            "[[hold]]\nvertices = [1]\n[[hold]]\nvertices = [1, 999999]\n",
            "",
            "error[E-SCENE-RANGE]: hold 2 names the vertex 999999 at:4:12",
        ),
        (
            "[solver]\nmethod = \"verlet\"\nsweeps = 3\n",
            "",
            "error[E-SCENE-CLASH]: `sweeps` goes with xpbd or pbd, and the method is verlet at:3:10",
        ),
        (
            "[solver]\nmethod = \"verlet\"\nlimit_ratio = 1.2\n",
            "",
            "error[E-SCENE-CLASH]: `limit_ratio` at:3:15",
        ),
        (
            "[solver]\norder = \"2\"\n",
            "",
            "error[E-SCENE-CLASH]: `order` goes with implicit, and the method is verlet at:2:9",
        ),
        ("[solver]\norder = \"2\"\n", "--solver implicit", ""),
        (
            "[fabric]\nflexural_n_m2 = 1e-6\n",
            "",
            "error[E-SCENE-KEY]: `flexural_n_m2` of [fabric] was removed at:2:1",
        ),
        (
            "[solver]\nnewton_iterations = 2\n",
            "",
            "error[E-SCENE-KEY]: `newton_iterations` of [solver] was removed at:2:1",
        ),
        (
            "[tear]\ndelay_s = 0.1\n",
            "",
            "error[E-SCENE-KEY]: `delay_s` of [tear] was removed at:2:1",
        ),
        (
            "[tear]\ntears_held = true\n",
            "",
            "error[E-SCENE-KEY]: `tears_held` of [tear] was removed at:2:1",
        ),
        (
            "[solver]\nmethod = \"xpbd\"\nsweeps = 2\n",
            "--solver implicit",
            "",
        ),
        (
            "[tear]\nnever = true\nthreshold = 1.2\n",
            "",
            "error[E-SCENE-CLASH]: `never` and `threshold` cannot go together at:3:13",
        ),
        ("[tear]\nnever = false\nthreshold = 1.2\n", "", ""),
        (
            &format!("{woven}[tear]\nthreshold_n = 4\n"),
            "",
            "error[E-SCENE-CLASH]: `threshold_n` at:7:15",
        ),
        (
            &woven,
            "--threshold-newton 4",
            "error[E-USAGE]: `--threshold-newton`",
        ),
        (
            &format!("{woven}stretch_n_per_m = 100\n[tear]\nthreshold_n = 4\n"),
            "",
            "",
        ),
    ] {
        folder.write("s.toml", scene);
        let line = "tearmesh tear flag.obj --scene s.toml --seconds 0.01 --dry-run";
        let output = folder.run(&format!("{line} {options}"));
        let said = seen(&output);
        let wanted = if words.is_empty() { 0 } else { 2 };
        assert_eq!(
            output.status.code(),
            Some(wanted),
            "{scene} {options}: {said}"
        );
        let (words, at) = words.split_once(" at:").unwrap_or((words, ""));
        assert!(said.contains(words), "{words}: {said}");
        assert!(
            at.is_empty() || said.contains(&format!("s.toml:{at}\n")),
            "{at}: {said}"
        );
    }
}

/// Whoever wrote the file is told where to look.
#[test]
fn faults_of_a_scene_file_have_its_lines() {
    let folder = Folder::new();
    let woven = "[solver]\nmethod = \"implicit\"\n[fabric]\nwarp_n_per_m = 9\nweft_n_per_m = 9\n";
    for (scene, words, shown) in [
        (
            "[[cut]]\nrays = [\"0,1,5:0,0,-1\", \"0,1,5:0,0,-1\"]\n",
            "error[E-SCENE-RANGE]: the two rays are the same line, so they span no cutting plane at:2:8",
            "2 | rays = [\"0,1,5:0,0,-1\", \"0,1,5:0,0,-1\"]",
        ),
        (
            "[[hold]]\nnear = [0, 1]\n\n[[hold]]\nfrom = [8, 8, 8]\nto = [9, 9, 9]\n",
            "error[E-SCENE-EMPTY]: hold 2 holds no vertex at:4:1",
            "4 | [[hold]]",
        ),
        (
            "[tear]\nthreshold_warp = 1.2\nthreshold_weft = 1.2\nwarp = [0, 0, 0]\n",
            "error[E-SCENE-RANGE]: the axis (0, 0, 0) of the warp has no direction at:4:8",
            "4 | warp = [0, 0, 0]",
        ),
        (
            &format!("{woven}warp = [0, 0, 0]\n"),
            "error[E-SCENE-RANGE]: the warp (0, 0, 0) has no direction in the face at:6:8",
            "6 | warp = [0, 0, 0]",
        ),
        (
            // The mesh lies in the plane of x and y.
            &format!("{woven}warp = [0, 0, 1]\n"),
            "error[E-SCENE-RANGE]: the warp (0, 0, 1) has no direction in the face at:6:8",
            "6 | warp = [0, 0, 1]",
        ),
        (
            "\n[[cut]]\nrays = [\n  \"0,1,5:0,0,-1\",\n  \"0,1,x:0,0,-1\",\n]\n",
            "error[E-RAY-SYNTAX]: cannot read the ray `0,1,x:0,0,-1` at:5:8",
            "5 |   \"0,1,x:0,0,-1\",",
        ),
        (
            "\u{feff}seconds = -1\n",
            "error[E-SCENE-RANGE] at:1:11",
            "1 | seconds = -1",
        ),
        (
            "[wind]\nvelocity_m_per_s = [1, 0, 0]\nsway_m_per_s = [1, 0, 0]\nperiod_s = 1e-320\n",
            "error[E-SCENE-RANGE]: `period_s` at:4:12",
            "4 | period_s = 1e-320",
        ),
    ] {
        folder.write("s.toml", scene);
        let line = "tearmesh tear sheet.obj --scene s.toml --seconds 0.01 --dry-run";
        let output = folder.run(line);
        let said = seen(&output);
        assert_eq!(output.status.code(), Some(2), "{scene}: {said}");
        let (words, at) = words.split_once(" at:").expect("a place");
        assert!(said.contains(words), "{words}: {said}");
        assert!(said.contains(&format!("s.toml:{at}\n")), "{at}: {said}");
        assert!(said.contains(shown), "{shown}: {said}");
    }
}

#[test]
fn help_fits_a_screen_and_has_two_examples_and_every_key() {
    let folder = Folder::new();
    let short = folder.run("tearmesh tear -h");
    assert!(String::from_utf8_lossy(&short.stdout).lines().count() <= 40);
    let long = folder.run("tearmesh tear --help");
    let long = String::from_utf8_lossy(&long.stdout);
    assert_eq!(long.matches("  tearmesh tear ").count(), 2);
    for key in [
        "stretch_n_per_m",
        "splits_per_step",
        "[[hold]]",
        "sway_m_per_s",
    ] {
        assert!(long.contains(key), "{key}");
    }
    assert!(!long.contains('\x1b'));
    let words = long.split_whitespace().collect::<Vec<_>>().join(" ");
    for said in [
        "replaces all entries of its kind in the base",
        "A [tear] section enables tearing",
        "without duplicates (named in comments `#~ fan` of a torn file)",
    ] {
        assert!(words.contains(said), "{said}");
    }
}

#[test]
fn frames_of_an_earlier_run_are_warned_of() {
    let folder = Folder::new();
    let line = "tearmesh tear sheet.obj --scene hang --frames f -q -o x.obj --seconds";
    folder.run(&format!("{line} 0.2"));
    let said = seen(&folder.run(&format!("{line} 0.1")));
    assert!(
        said.contains("W-FRAMES-OLD") && said.contains("frame_00004.obj"),
        "{said}"
    );
}

#[cfg(unix)]
#[test]
fn an_interrupted_simulation_is_saved() {
    let folder = Folder::new();
    let mut command = folder.command();
    command.args(["tear", "flag.obj", "--scene", "hang", "--seconds", "100000"]);
    command.args(["--frames", "f", "-o", "saved.obj", "--report", "r.json"]);
    let output = interrupted_at(&mut command, &folder.path("f/frame_00002.obj"));
    assert_eq!(output.status.code(), Some(130));
    let said = seen(&output);
    assert!(
        said.contains("interrupted") && said.contains("wrote saved.obj"),
        "{said}"
    );
    let report: serde_json::Value = serde_json::from_str(&folder.read("r.json")).expect("JSON");
    assert_eq!(report["status"], "interrupted");
    assert!(report["steps"].as_u64() > Some(20));
    assert_eq!(read(&folder.read("saved.obj")).0.len(), 1089);
}

/// Only a simulation knows a density.
#[test]
fn what_cut_and_mend_weigh_vertices_by_is_said_to_be_an_area() {
    let folder = Folder::new();
    for line in [
        "tearmesh cut sheet.obj --rays 0.3,2,5:0,0,-1 0.3,0.5,5:0,0,-1 -o cut.obj",
        "tearmesh mend cut.obj --last 1 -o mended.obj",
    ] {
        let words = seen(&folder.run(line));
        assert!(
            words.contains("\narea ") && !words.contains("mass"),
            "{words}"
        );
        let output = folder.run(&format!("{line} --in-place --format json"));
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(report["mass"]["unit"], "area");
    }
}
