//! The rules of the house, so that they stay true: imports run downward, the floors below know
//! no float, the library reads no file, and one file alone tears a link.

mod crates;

use std::fs;
use std::path::Path;

use crates::Files;

/// Every crate of the project, by the file that it begins with, and how many files it has at least.
const CRATES: [(&str, &str, usize); 6] = [
    ("tools/cloth/src", "lib.rs", 50),
    ("tools/lab/src", "lib.rs", 4),
    ("tests", "main.rs", 30),
    ("tests/cloth", "main.rs", 30),
    ("tests/obj", "main.rs", 12),
    ("tests/cli", "main.rs", 8),
];

/// The files of a crate, read from its folder.
fn files_of(folder: &str, root: &str) -> Files {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    Files::of(root, &|name| fs::read_to_string(folder.join(name)).ok())
}

#[test]
fn no_files_use_each_other_in_a_circle() {
    let mut told = Vec::new();
    for (folder, root, least) in CRATES {
        let files = files_of(folder, root);
        println!(
            "{folder}: {} files, {} edges",
            files.names.len(),
            files.edges.len()
        );
        assert!(files.names.len() >= least, "{folder}: {:?}", files.names);
        for circle in files.circles() {
            told.push(format!("in {folder}:\n    {circle}"));
        }
    }
    assert!(
        told.is_empty(),
        "{} circles\n{}",
        told.len(),
        told.join("\n")
    );
}

/// The floor of each module of the library; a module may import its own floor and those below.
/// `script` drives everything, and nothing imports it.
const FLOORS: [(&str, u32); 17] = [
    ("id", 0),
    ("geometry", 0),
    ("exact", 0),
    ("mesh", 1),
    ("edit", 1),
    ("split", 2),
    ("mend", 2),
    ("subdivide", 2),
    ("slide", 2),
    ("classify", 2),
    ("place", 2),
    ("attribute", 2),
    ("mass", 2),
    ("shapes", 2),
    ("scissor", 3),
    ("tear", 3),
    ("script", 4),
];

fn floor(module: &str) -> u32 {
    let known = FLOORS.iter().find(|(name, _)| *name == module);
    known
        .unwrap_or_else(|| panic!("`{module}` has no floor: give it one in this test"))
        .1
}

/// A file of the library: its module, its path, and its code without comments and tests.
struct Source {
    module: String,
    path: String,
    code: String,
}

fn sources() -> Vec<Source> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut sources = Vec::new();
    let mut folders = vec![src.clone()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder of the library") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            let name = path
                .strip_prefix(&src)
                .expect("it lies in src")
                .with_extension("");
            let module = name
                .iter()
                .next()
                .expect("a module")
                .to_string_lossy()
                .into_owned();
            let text = fs::read_to_string(&path).expect("a source file");
            let code = text
                .split("\n#[cfg(test)]\nmod tests")
                .next()
                .expect("some code");
            let code = code
                .lines()
                .map(|line| line.split("//").next().unwrap_or_default());
            let code = code.collect::<Vec<_>>().join("\n");
            sources.push(Source {
                module,
                path: name.display().to_string(),
                code,
            });
        }
    }
    sources.retain(|source| source.module != "lib");
    assert!(
        sources.len() >= 20,
        "the library has more files than {}",
        sources.len()
    );
    sources
}

/// The words of a text: names and numbers.
fn words(code: &str) -> impl Iterator<Item = &str> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| !word.is_empty())
}

#[test]
fn imports_run_downward() {
    let mut imports = 0;
    for Source { module, path, code } in sources() {
        for import in code.split("crate::").skip(1) {
            // `use crate::{a::b, c}` names several modules, at the depth of one brace.
            let mut names = Vec::new();
            if let Some(list) = import.strip_prefix('{') {
                let mut depth = 0;
                let mut start = true;
                for (i, c) in list.char_indices() {
                    match c {
                        '}' if depth == 0 => break,
                        '{' => depth += 1,
                        '}' => depth -= 1,
                        ',' if depth == 0 => start = true,
                        c if c.is_alphabetic() && start => {
                            names.extend(words(&list[i..]).next());
                            start = false;
                        }
                        _ => {}
                    }
                }
            } else {
                names.extend(words(import).next());
            }
            for name in names
                .into_iter()
                .filter(|name| name.starts_with(char::is_lowercase))
            {
                imports += 1;
                assert!(
                    floor(name) <= floor(&module),
                    "src/{path}.rs imports `{name}` from above"
                );
            }
        }
    }
    assert!(imports >= 40, "only {imports} imports were understood");
}

#[test]
fn topology_knows_no_float() {
    for Source { module, path, code } in sources() {
        // The log has the weights of insertions and merges, and no more.
        let foreign: &[&str] = match &*module {
            "id" | "mesh" | "split" => &["f32", "f64", "Point", "Vector"],
            "edit" | "subdivide" => &["f32", "Vector", "geometry"],
            _ => &[],
        };
        let float = words(&code).find(|word| foreign.contains(word));
        assert_eq!(float, None, "src/{path}.rs");
    }
}

#[test]
fn one_file_tears_links_and_one_sews_them() {
    let writers: [(&str, &[&str]); 10] = [
        (".tear(", &["split"]),
        (".sew(", &["mend"]),
        (".pop_vertex(", &["mend"]),
        (".isolate(", &["mend"]),
        (".link(", &["subdivide"]),
        (".unlink(", &["subdivide"]),
        (".push_face(", &["subdivide"]),
        (".push_vertex(", &["split", "subdivide"]),
        (".set_origin(", &["split", "mend", "subdivide"]),
        (".set_half_edge_of(", &["split", "mend", "subdivide"]),
    ];
    for Source { path, code, .. } in sources() {
        for (writer, files) in writers {
            assert!(
                !code.contains(writer) || files.contains(&&*path),
                "src/{path}.rs calls {writer}…)"
            );
        }
        assert!(
            !code.contains("Link::TORN") || ["mesh", "mesh/torn"].contains(&&*path),
            "src/{path}.rs writes torn marks"
        );
    }
}

#[test]
fn the_library_reads_no_file_prints_nothing_and_knows_no_clock() {
    let foreign = [
        "fs",
        "io",
        "net",
        "env",
        "time",
        "thread",
        "process",
        "println",
        "eprintln",
        "print",
        "dbg",
        "Instant",
        "SystemTime",
        "HashMap",
        "HashSet",
        "unwrap",
        "unsafe",
    ];
    for Source { path, code, .. } in sources() {
        let found = words(&code).find(|word| foreign.contains(word));
        assert_eq!(found, None, "src/{path}.rs");
    }
}

#[test]
fn one_file_names_nalgebra() {
    for Source { path, code, .. } in sources() {
        assert!(
            path == "geometry" || !code.contains("nalgebra"),
            "src/{path}.rs"
        );
    }
}
