//! The rules of the house, so that they stay true: no files use each other in a circle, the imports of the
//! kernel and of the cloth run downward, those of the cloth from the file that defines a thing, the kernel's
//! floors below know no float, the kernel reads no file and knows no cloth, and one file alone tears a link.

mod crates;

use std::fs;
use std::path::Path;

use crates::Files;

/// Every crate of the project, by the file that it begins with, and how many files it has at least.
const CRATES: &[(&str, &str, usize)] = &[
    ("src", "lib.rs", 40),
    ("tools/cloth/src", "lib.rs", 50),
    ("tools/obj/src", "lib.rs", 30),
    ("tools/lab/src", "lib.rs", 4),
    ("tools/view/src", "lib.rs", 8),
    ("tools/view/play/src", "lib.rs", 4),
    ("tools/python/src", "lib.rs", 4),
    ("tools/cli/src", "lib.rs", 25),
    ("tools/bench/src", "main.rs", 20),
    ("tools/engine/src", "main.rs", 2),
    ("tests", "main.rs", 30),
    ("tests/cloth", "main.rs", 30),
    ("tests/obj", "main.rs", 12),
    ("tests/view", "main.rs", 3),
    ("tests/cli", "main.rs", 8),
    ("tests/browser", "main.rs", 5),
    ("tests/combinations", "main.rs", 3),
];

/// The files of a crate, read from its folder, and what is planted at the end of one of them.
fn files_of(folder: &str, root: &str, planted: Option<(&str, &str)>) -> Files {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut names = vec![root.to_owned()];
    let mut folders = vec![folder.clone()];
    while let Some(inside) = folders.pop() {
        for entry in fs::read_dir(inside).expect("a folder of sources") {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(&folder).expect("it lies there");
            let name = name.to_string_lossy().into_owned();
            if path.is_dir() {
                folders.push(path);
            } else if name.ends_with(".rs") && name != root {
                names.push(name);
            }
        }
    }
    names[1..].sort();
    let read = |name: String| {
        let mut text = fs::read_to_string(folder.join(&name)).expect("a source file");
        if let Some((_, code)) = planted.filter(|(file, _)| *file == name) {
            text.push_str(code);
        }
        (name, text)
    };
    Files::of(names.into_iter().map(read).collect())
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let mut told = Vec::new();
    for &(folder, root, least) in CRATES {
        let files = files_of(folder, root, None);
        assert!(files.names.len() >= least, "{folder}: {:?}", files.names);
        let circles = files.circles().into_iter();
        told.extend(circles.map(|circle| format!("in {folder}:\n    {circle}")));
    }
    assert!(
        told.is_empty(),
        "{} circles\n{}",
        told.len(),
        told.join("\n")
    );
}

/// Files that are planted, and how many circles they make, by the table beside this file.
#[test]
fn planted_circles_are_seen_and_no_others() {
    let rows = include_str!("house/circles.txt").lines();
    for row in rows.filter(|row| row.starts_with(['0', '1'])) {
        let (count, files) = row.split_once(' ').expect("files");
        let file = |file: &str| {
            file.split_once(": ")
                .map(|(name, code)| (name.into(), code.into()))
        };
        let files = files.split(" | ").map(|text| file(text).expect("a name"));
        let circles = Files::of(files.collect()).circles();
        assert_eq!(circles.len().to_string(), count, "{row}: {circles:?}");
    }
}

/// The floors of the kernel's modules, from below; a module may import its own floor and those below.
/// `script` drives everything, and nothing imports it.
const FLOORS: [&str; 5] = [
    "id geometry exact sets",
    "mesh edit",
    "split mend insert slide classify place attribute undo unsewn unshare engine gap mass shapes",
    "scissor tear",
    "sheet script",
];

/// The floors of the rooms of `tools/cloth`, from below, and of the files that stand beside them.
const CLOTH_FLOORS: [&str; 6] = [
    "system text digest",
    "method",
    "cloth",
    "simulation",
    "scene",
    "guide",
];

fn floor(floors: &[&str], module: &str) -> usize {
    let known = floors.iter().position(|floor| has(floor, module));
    known.unwrap_or_else(|| panic!("`{module}` has no floor here"))
}

/// Whether a list has a word.
fn has(list: &str, word: &str) -> bool {
    list.split(' ').any(|listed| listed == word)
}

/// The imports of a crate with such floors that go up, each told.
fn upward_imports(files: &Files, floors: &[&str]) -> Vec<String> {
    let name = |file: usize| files.names[file].trim_end_matches(".rs");
    let module = |file: usize| name(file).split('/').next().expect("a module");
    let goes_up = |&(&(from, to), _): &(&(usize, usize), &String)| {
        module(from) != "lib" && floor(floors, module(to)) > floor(floors, module(from))
    };
    let told = |(&(from, to), path)| format!("{} uses {path} of {}", name(from), name(to));
    files.edges.iter().filter(goes_up).map(told).collect()
}

#[test]
fn imports_of_the_kernel_run_downward() {
    let none: [String; 0] = [];
    let files = files_of("src", "lib.rs", None);
    assert_eq!(upward_imports(&files, &FLOORS), none);
    let planted = "\nfn planted() { use crate::scissor; scissor::Scissor::SNAP; }";
    let files = files_of("src", "lib.rs", Some(("mesh/walk.rs", planted)));
    let up = upward_imports(&files, &FLOORS);
    assert_eq!(up, ["mesh/walk uses crate::scissor of scissor"]);
}

/// The imports of the command that go from verb to verb, or to a verb from what verbs share, each told.
fn imports_of_verbs(files: &Files) -> Vec<String> {
    let name = |file: usize| files.names[file].trim_end_matches(".rs");
    let verb = |file: usize| name(file).strip_prefix("verbs/")?.split('/').next();
    let is_wrong = |&(&(from, to), _): &(&(usize, usize), &String)| {
        let begins = ["lib", "verbs"].contains(&name(from));
        verb(to).is_some() && verb(from) != verb(to) && !begins
    };
    let told = |(&(from, to), path)| format!("{} uses {path} of {}", name(from), name(to));
    files.edges.iter().filter(is_wrong).map(told).collect()
}

#[test]
fn no_verb_uses_a_file_of_another() {
    let of = |planted| files_of("tools/cli/src", "lib.rs", planted);
    assert_eq!(imports_of_verbs(&of(None)), [""; 0]);
    for file in ["verbs/play.rs", "say.rs"] {
        let planted = "\nfn planted() { crate::verbs::cut::run(); }";
        let wrong = imports_of_verbs(&of(Some((file, planted))));
        assert_eq!(wrong.len(), 1, "{wrong:?}");
    }
}

#[test]
fn imports_of_the_cloth_run_downward_from_where_things_are_defined() {
    let (none, cloth): ([String; 0], _) = ([], "tools/cloth/src");
    let files = files_of(cloth, "lib.rs", None);
    assert_eq!(upward_imports(&files, &CLOTH_FLOORS), none);
    assert_eq!(files.detours, none);
    let planted = "\nuse crate::method::solver::Failure; use crate::{Tear, scene::Frame}; type T = crate::System;";
    let files = files_of(cloth, "lib.rs", Some(("system/pair.rs", planted)));
    let up = upward_imports(&files, &CLOTH_FLOORS);
    let arrows = [
        "crate::Tear of cloth/tearing/apply",
        "crate::method::solver::Failure of method/solver",
        "crate::scene::Frame of scene",
    ];
    assert_eq!(up, arrows.map(|arrow| format!("system/pair uses {arrow}")));
    let detours = ["crate::Tear", "crate::scene::Frame", "crate::System"];
    let told = detours.map(|path| format!("system/pair.rs uses {path}"));
    assert_eq!(files.detours, told);
}

/// Shows the files of the kernel, by their paths without `.rs`, but for the first, and their words.
fn for_kernel(check: impl Fn(&str, &[String])) {
    let files = files_of("src", "lib.rs", None);
    for (name, words) in files.names.iter().zip(&files.words).skip(1) {
        check(name.trim_end_matches(".rs"), words);
    }
}

/// The words that no file of some modules has, or no file at all: topology knows no float, and the log has
/// the weights of insertions and merges and no more; the library reads no file, prints nothing and knows
/// no clock; and one file names nalgebra.
const FOREIGN: [[&str; 2]; 4] = [
    ["id mesh split", "f32 f64 Point Vector"],
    ["edit insert", "f32 Vector geometry"],
    [
        "",
        "fs io net env time thread process println eprintln print dbg Instant SystemTime HashMap HashSet \
         unwrap unsafe",
    ],
    ["", "nalgebra"],
];

#[test]
fn files_of_the_kernel_have_no_foreign_words() {
    for_kernel(|name, words| {
        let module = name.split('/').next().expect("a module");
        for [modules, foreign] in FOREIGN {
            let is_meant = modules.is_empty() || has(modules, module);
            let is_home = name == "geometry" && foreign == "nalgebra";
            let found = words.iter().find(|word| has(foreign, word));
            assert!(found.is_none() || !is_meant || is_home, "{name}: {found:?}");
        }
        for cloth in ["cloth", "solver", "spring", "particle"] {
            let found = words
                .iter()
                .find(|word| word.to_lowercase().contains(cloth));
            assert_eq!(found, None, "src/{name}.rs");
        }
    });
}

#[test]
fn one_file_tears_links_and_one_sews_them() {
    let writers = [
        ("tear", "split"),
        ("sew swap_remove_vertex", "mend"),
        ("link unlink", "insert mesh/torn"),
        ("close_seams open_seams", "unsewn unsewn/closed"),
        ("push_face", "insert"),
        ("push_vertex", "split insert"),
        ("set_origin set_half_edge_of", "split mend insert"),
    ];
    for_kernel(|name, words| {
        let stands = |sequence: [&str; 3]| words.windows(3).any(|three| three == sequence);
        for (writers, files) in writers {
            for writer in writers.split(' ').filter(|_| !has(files, name)) {
                assert!(!stands([".", writer, "("]), "{name} calls {writer}");
            }
        }
        let marks = stands(["Link", "::", "TORN"]);
        assert!(!marks || ["mesh", "mesh/torn"].contains(&name), "{name}");
    });
}

/// The functions of `f64` whose last bits differ from machine to machine, or may.
const PLATFORM: &str = "sin cos sin_cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp exp2 \
    exp_m1 ln ln_1p log log2 log10 powf powi hypot cbrt gamma ln_gamma erf erfc mul_add";

/// The functions of the platform that some code names, as methods or by their path.
fn platform_calls(words: &[String]) -> Vec<&str> {
    let named = words
        .windows(2)
        .filter(|two| [".", "::"].contains(&&*two[0]));
    let named = named.map(|two| &*two[1]);
    named.filter(|name| has(PLATFORM, name)).collect()
}

#[test]
fn the_kernel_calls_no_function_of_the_platform() {
    let none: [&str; 0] = [];
    for_kernel(|name, words| assert_eq!(platform_calls(words), none, "src/{name}.rs"));
    let planted = "fn f() { a.sin_cos(); f64::atan2(y, x) + x\n .exp() + sin(x).map(f64::tan) }";
    let files = Files::of(vec![("lib.rs".to_owned(), planted.to_owned())]);
    let calls = platform_calls(&files.words[0]);
    assert_eq!(calls, ["sin_cos", "atan2", "exp", "tan"]);
}
