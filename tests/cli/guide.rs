//! The guide is held against the command: its tables of codes, of keys of the report and of keys of
//! scene files, its scene, and its batches. (Its commands are held by `transcripts.rs`.)

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::harness::{Answer, Folder, files_in, root};

/// A page of the guide.
fn page(name: &str) -> String {
    let path = root().join("tools/cli/src/guide").join(name);
    fs::read_to_string(path).expect("a page of the guide")
}

/// The rows of all tables with this header, each as the texts of its cells.
fn rows(page: &str, header: &str) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    let mut is_within = false;
    for line in page.lines() {
        if !line.starts_with('|') {
            is_within = false;
        } else if line == header {
            is_within = true;
        } else if is_within && !line.starts_with("|---") {
            let cells = line.trim_matches('|').split(" | ");
            rows.push(cells.map(|cell| cell.trim().to_owned()).collect());
        }
    }
    rows
}

/// What stands between back quotes in a text.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

/// The text of the blocks of a page that are fenced as `language`.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let opening = format!("```{language}\n");
    let behind = page.split(&opening).skip(1);
    let text = |rest: &str| rest.split("```").next().expect("an end").to_owned();
    behind.map(text).collect()
}

/// The codes of the guide, each with the exit statuses that go with it.
fn codes_of_the_guide() -> BTreeMap<String, BTreeSet<i32>> {
    let rows = rows(&page("codes.md"), "| code | exit | meaning |");
    let count = rows.len();
    let code = |row: Vec<String>| {
        let exits = row[1]
            .split(", ")
            .map(|exit| exit.parse().expect("a status"));
        (row[0].trim_matches('`').to_owned(), exits.collect())
    };
    let codes: BTreeMap<_, _> = rows.into_iter().map(code).collect();
    assert_eq!(codes.len(), count, "a code stands twice");
    codes
}

/// Whether a word has the form of a code.
fn is_code(word: &str) -> bool {
    let is_part = |part: &str| {
        let is_sign = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit();
        !part.is_empty() && part.chars().all(is_sign)
    };
    let mut parts = word.split('-');
    matches!(parts.next(), Some("E" | "W")) && word.len() > 3 && parts.all(is_part)
}

/// The codes that stand as literals in the sources of a folder, tests left out.
fn codes_in(folder: &Path, codes: &mut BTreeSet<String>) {
    let is_source = |path: &PathBuf| path.extension().is_some_and(|end| end == "rs");
    for path in files_in(folder).filter(is_source) {
        let text = fs::read_to_string(&path).expect("a source");
        let code = text.split("#[cfg(test)]").next().expect("some code");
        let literals = code.split('"').filter(|word| is_code(word));
        codes.extend(literals.map(str::to_owned));
    }
}

#[test]
fn the_guide_has_the_codes_of_the_command_and_no_others() {
    let mut codes = BTreeSet::new();
    for folder in [
        "tools/obj/src",
        "tools/cloth/src",
        "tools/view/src",
        "tools/cli/src",
    ] {
        codes_in(&root().join(folder), &mut codes);
    }
    assert!(codes.len() > 90, "{codes:?}");
    let told: BTreeSet<_> = codes_of_the_guide().into_keys().collect();
    assert_eq!(told, codes);
}

#[test]
fn the_guide_has_the_exit_statuses_of_the_command() {
    let told = rows(&page("codes.md"), "| exit | meaning |");
    let told: Vec<i32> = told
        .iter()
        .map(|row| row[0].parse().expect("a status"))
        .collect();
    let exits = fs::read_to_string(root().join("tools/cli/src/exit.rs")).expect("a source");
    let numbers = exits
        .lines()
        .filter_map(|line| line.trim().strip_suffix(','));
    let numbers = numbers.filter_map(|line| line.split_once(" = "));
    let numbers: Vec<i32> = numbers
        .map(|(_, number)| number.parse().expect("one"))
        .collect();
    assert_eq!(told, numbers);
}

fn codes_of_words(text: &str) -> impl Iterator<Item = &str> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-');
    words.filter(|word| is_code(word))
}

/// Fails if an answer has a code that does not come with this exit status. Returns its codes.
fn codes_of<'a>(
    answer: &'a str,
    exit: i32,
    told: &BTreeMap<String, BTreeSet<i32>>,
) -> BTreeSet<&'a str> {
    let codes: BTreeSet<_> = codes_of_words(answer).collect();
    let fits = |code: &str| told[code].contains(&exit);
    let mut errors = codes.iter().filter(|code| code.starts_with('E'));
    assert!(errors.all(|code| fits(code)), "{answer}");
    if codes.is_empty() {
        // Arguments that cannot be parsed have no code.
        assert!(exit == 0 || exit == 2, "{answer}");
    } else if exit != 0 {
        assert!(codes.iter().any(|code| fits(code)), "{answer}");
    }
    codes
}

#[test]
fn codes_come_with_the_exit_statuses_of_the_guide() {
    let told = codes_of_the_guide();
    let mut seen = BTreeSet::new();
    let mut answers = 0;
    for path in files_in(&root().join("tests/cli/transcripts")) {
        let text = fs::read_to_string(path).expect("a transcript");
        for answer in text.split("$ tearmesh ").skip(1) {
            // An empty line ends an answer.
            let answer = answer.split("\n\n").next().expect("an answer");
            let exit = answer
                .rsplit_once("(exit ")
                .map(|(_, end)| end.split(')').next());
            let exit = exit
                .flatten()
                .map_or(0, |exit| exit.parse().expect("a status"));
            let codes = codes_of(answer, exit, &told);
            seen.extend(codes.into_iter().map(str::to_owned));
            answers += 1;
        }
    }
    assert!(answers > 200);

    // What is refused in rows: the exit status and, below, parts of what is said.
    for path in files_in(&root().join("tests/cli/answers")) {
        let rows = fs::read_to_string(path).expect("rows");
        let mut exit = 0;
        for line in rows.lines().filter(|line| !line.starts_with("  ! ")) {
            if let Some(Ok(status)) = line.split(' ').next().map(str::parse) {
                exit = status;
            }
            for code in codes_of_words(line) {
                let fits = told[code].contains(&exit) || code.starts_with('W');
                assert!(fits, "{exit}: {line}");
                seen.insert(code.to_owned());
            }
        }
    }
    assert!(seen.len() > 60);
}

/// Adds the keys of a value, as paths such as `cuts[].plane.point`.
fn keys_of(value: &Value, path: &str, keys: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (name, field) in fields {
                let dot = if path.is_empty() { "" } else { "." };
                let path = format!("{path}{dot}{name}");
                keys.insert(path.clone());
                keys_of(field, &path, keys);
            }
        }
        Value::Array(items) => {
            let items = items.iter().filter(|item| item.is_object());
            items.for_each(|item| keys_of(item, &format!("{path}[]"), keys));
        }
        _ => {}
    }
}

/// Commands that between them print every key there is.
const REPORTS: &[&str] = &[
    "cut flag.obj --rays 0,0,9@-0.5,0.2,0 0,0,9@0.5,0.1,0 --layers first --gap 5% --pieces p -o a.obj",
    "cut flag.obj --camera 0,0,5@0,0,0 --fov 40 --viewport 800x600 --points 200,300 600,250 -o b.obj",
    "cut three.obj --plane 0.5,0,0:1,0,0 -o c.obj",
    "cut notch.obj --plane 0,0,0:0,1,0 -o c.obj",
    "mend b.obj --simplify -o d.obj",
    "tear sheet.obj --scene rip --seconds 0.8 --frames f --frames-topology final --cache c.pc2 -o e.obj",
    "tear sheet.obj --scene hang --seconds 0.02 --solver xpbd -o e.obj",
    "tear sheet.obj --scene hang --seconds 0.02 --solver pbd -o e.obj",
    "tear sheet.obj --scene hang --seconds 0.02 --solver implicit -o e.obj",
    "tear sheet.obj --scene hang --seconds 0.02 --solver provot -o e.obj",
    "tear sheet.obj --scene springs.toml -o e.obj",
    "tear sheet.obj --scene flag --seconds 1.6 --solver provot -o e.obj",
    "tear sheet.obj --scene pin.toml -o e.obj",
    "tear sheet.obj --scene body.toml --seconds 0.01 -o e.obj",
    "tear panels.obj --scene seam.toml --seconds 0.01 -o e.obj",
];

#[test]
fn the_guide_has_the_keys_of_the_report_and_no_others() {
    let folder = Folder::new();
    folder.add_files("tests/cli/inputs.txt");
    folder.write("pin.toml", "seconds = 0.01\n[[hold]]\nnear = [0, 1]\n");
    let dummy = root().join("tests/data/dummy.obj");
    let [one, other] = [
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
        "v 1.1 0 0\nv 1 1.1 0\nv 0.1 1 0\n",
    ];
    folder.write("panels.obj", format!("{one}{other}f 1 2 3\nf 4 5 6\n"));
    folder.write(
        "seam.toml",
        "[[seam]]\nname = \"side\"\none = [2, 3]\nother = [4, 6]\n",
    );
    folder.write("body.toml", format!("[[collider]]\nbody = {dummy:?}\n"));

    let mut printed = BTreeSet::new();
    for typed in REPORTS {
        folder.run(&format!("{typed} --report r.json"));
        keys_of(&folder.json("r.json"), "", &mut printed);
        fs::remove_file(folder.path("r.json")).expect("a file");
    }
    let checked = folder.run("check flag.obj quilt.obj three.obj --format json");
    for line in checked.text().lines() {
        let mut keys = BTreeSet::new();
        keys_of(&serde_json::from_str(line).expect("JSON"), "", &mut keys);
        let name = |key: String| match key.starts_with("diagnostics[]") {
            true => key,
            false => format!("check: {key}"),
        };
        printed.extend(keys.into_iter().map(name));
    }

    let mut told = BTreeSet::new();
    for row in rows(&page("report.md"), "| key | meaning |") {
        for key in quoted(&row[0]) {
            assert!(told.insert(key.to_owned()), "{key} stands twice");
        }
    }
    let differences: Vec<_> = printed.symmetric_difference(&told).collect();
    assert!(differences.is_empty(), "{differences:?}");
}

#[test]
fn the_scenes_of_the_guide_can_be_played() {
    let folder = Folder::new();
    let scenes = blocks(&page("scenes.md"), "toml");
    assert_eq!(scenes.len(), 3);
    for scene in scenes {
        folder.write("guide.toml", scene);
        folder.done("tear sheet.obj --scene guide.toml --seconds 0.05 -o played.obj");
        assert!(folder.read("played.obj").contains("\nf "));
    }
}

/// The command in a folder of its own, which a shell finds.
fn shell(folder: &Folder, typed: &str) -> Answer {
    let own = Path::new(env!("CARGO_BIN_EXE_tearmesh")).parent();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut folders = vec![own.expect("a folder").to_owned()];
    folders.extend(std::env::split_paths(&path));
    Command::new("sh")
        .args(["-c", typed])
        .env("PATH", std::env::join_paths(folders).expect("a path"))
        .env("HOME", folder.path("."))
        .current_dir(folder.path("."))
        .output()
        .expect("a shell")
        .into()
}

/// Runs the batches of the guide, and each of their cuts alone.
#[test]
#[ignore = "needs GNU parallel, as .ci/run installs it"]
fn batches_by_gnu_parallel() {
    let skipped = std::env::var("TEARMESH_SKIP").unwrap_or_default();
    let is_there = Command::new("parallel").arg("--version").output().is_ok();
    if !is_there && skipped.split(' ').any(|tool| tool == "parallel") {
        println!("skipped: there is no parallel, and TEARMESH_SKIP names it");
        return;
    }
    assert!(
        is_there,
        "there is no parallel; install it, or let TEARMESH_SKIP name it"
    );

    let folder = Folder::new();
    fs::create_dir(folder.path("meshes")).expect("a folder");
    let names = ["flag", "sheet", "sleeve"];
    for name in names {
        let copy = folder.path(&format!("meshes/{name}.obj"));
        fs::copy(folder.path(&format!("{name}.obj")), copy).expect("a copy");
    }
    let page = page("batches.md");
    let [all, reported, places, resumed, charts] = &blocks(&page, "sh")[..] else {
        panic!("five batches");
    };
    let play = |batch: &str, expected: i32| {
        let answer = shell(&folder, batch);
        assert_eq!(answer.exit, expected, "{batch}: {answer:?}");
    };
    let alone = |typed: &str| {
        folder.done(&format!("cut {typed} -q -o alone.obj"));
        folder.read("alone.obj")
    };
    let plane = "--plane 0.21,0.05,0:1,0,0";
    let check = || {
        for name in names {
            let cut = folder.read(&format!("cut/{name}.obj"));
            assert_eq!(cut, alone(&format!("{name}.obj {plane}")), "{name}");
        }
    };

    play(charts, 0);
    let whole =
        "tearmesh chart pareto --scene swing,hang --mesh grid,delaunay --size 4 -q --csv whole.csv";
    folder.done(whole);
    // The header comes first, and the rows of the parts in the order of their files.
    let [parts, whole] = ["pareto", "whole"].map(|name| folder.read(&format!("{name}.csv")));
    assert_eq!(parts.lines().next(), whole.lines().next());
    let sorted = |table: &str| {
        let mut rows: Vec<_> = table.lines().map(str::to_owned).collect();
        rows.sort();
        rows
    };
    assert!(
        sorted(&parts) == sorted(&whole),
        "the parts are not the whole"
    );
    assert!(folder.read("pareto.svg").starts_with("<svg "));

    play(all, 0);
    check();
    play(places, 0);
    for x in ["-0.25", "0.1", "0.4"] {
        let cut = folder.read(&format!("cut/at{x}.obj"));
        assert_eq!(
            cut,
            alone(&format!("flag.obj --plane {x},0,0:1,0,0")),
            "{x}"
        );
    }
    fs::remove_dir_all(folder.path("cut")).expect("a folder");

    // One run fails; all others are done, and it leaves a report and no mesh.
    folder.write("meshes/bad.obj", "v 0 0 0\nv 1 0 0\nv 1 0,5 0\nf 1 2 3\n");
    play(reported, 1);
    check();
    assert!(!folder.path("cut/bad.obj").exists());
    for name in ["bad", "flag", "sheet", "sleeve"] {
        let report = folder.json(&format!("cut/{name}.json"));
        assert_eq!(report["ok"], Value::Bool(name != "bad"), "{name}");
    }

    // What is done is not done again.
    fs::remove_file(folder.path("cut/flag.obj")).expect("a file");
    play(resumed, 0);
    assert!(!folder.path("cut/flag.obj").exists());
}

#[test]
fn the_readme_links_to_every_page_of_the_guides() {
    let readme = fs::read_to_string(root().join("README.md")).expect("the README");
    for folder in ["tools/cli/src/guide", "tools/cloth/src/guide", "src/guide"] {
        for page in files_in(&root().join(folder)) {
            let name = page.file_name().expect("a file").to_string_lossy();
            let link = format!("]({folder}/{name})");
            assert!(readme.contains(&link), "the README has no {link}");
        }
    }
}
