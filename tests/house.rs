//! The rules of the house, so that they stay true: no files use each other in a circle, the kernel's
//! imports run downward, the floors below know no float, the kernel reads no file and knows no cloth,
//! and one file alone tears a link.

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
    ("tools/cli/src", "lib.rs", 25),
    ("tools/bench/src", "main.rs", 20),
    ("tests", "main.rs", 30),
    ("tests/cloth", "main.rs", 30),
    ("tests/obj", "main.rs", 12),
    ("tests/view", "main.rs", 3),
    ("tests/cli", "main.rs", 8),
    ("tests/browser", "main.rs", 5),
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
        let (count, edges) = (files.names.len(), files.edges.len());
        println!("{folder}: {count} files, {edges} edges");
        assert!(count >= least, "{folder}: {:?}", files.names);
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

/// The circles among a few files, planted.
fn circles_of(planted: &[(&str, &str)]) -> Vec<String> {
    let planted = planted.iter();
    let planted = planted.map(|&(name, text)| (name.to_owned(), text.to_owned()));
    Files::of(planted.collect()).circles()
}

#[test]
fn planted_circles_are_seen() {
    let by_use = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "use crate::a::A; pub struct B(Vec<A>);"),
    ];
    let by_inline_path = [
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "pub fn run() { println!(\"{}\", super::b::run()); }",
        ),
        ("b.rs", "use crate::a; pub fn run() { a::run() }"),
    ];
    let parent_and_child = [
        ("lib.rs", "mod a;"),
        ("a.rs", "mod b; pub use b::B; pub struct A; fn of(b: &B) {}"),
        ("a/b.rs", "use super::A; pub struct B(A);"),
    ];
    let through_what_is_exported = [
        ("lib.rs", "mod a; mod b; pub use a::A; pub use b::B;"),
        (
            "a.rs",
            "pub struct A; impl A { fn b(&self) -> crate::B { todo!() } }",
        ),
        (
            "b.rs",
            "pub struct B; impl B { fn a(&self) -> crate::A { todo!() } }",
        ),
    ];
    for planted in [
        by_use,
        by_inline_path,
        parent_and_child,
        through_what_is_exported,
    ] {
        let circles = circles_of(&planted);
        assert_eq!(circles.len(), 1, "{planted:?}: {circles:?}");
        println!("{}", circles[0]);
    }
}

#[test]
fn what_is_no_circle_is_not_called_one() {
    let child_uses_parent = [
        ("lib.rs", "mod a; pub use a::{A, b::B};"),
        ("a.rs", "pub mod b; pub use b::B; pub struct A;"),
        ("a/b.rs", "use super::A; pub struct B(A);"),
    ];
    let for_tests_alone = [
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "pub struct A; #[cfg(test)] mod tests { use crate::b::B; }",
        ),
        ("b.rs", "use crate::a::A; pub struct B(A);"),
    ];
    let module_and_function_of_one_name = [
        (
            "lib.rs",
            "mod a; mod b; use b::b; fn main() { b(); a::a(); }",
        ),
        ("a.rs", "use crate::b::b; pub fn a() { b() }"),
        ("b.rs", "pub fn b() {}"),
    ];
    let in_words_alone = [
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "/// See [`B`](crate::b::B). // crate::b::B\npub struct A; const B: &str = \"crate::b::B\";",
        ),
        ("b.rs", "use crate::a::A; pub struct B(A);"),
    ];
    for planted in [
        child_uses_parent,
        for_tests_alone,
        module_and_function_of_one_name,
        in_words_alone,
    ] {
        let none: [String; 0] = [];
        assert_eq!(circles_of(&planted), none, "{planted:?}");
    }
}

/// The floor of each module of the kernel; a module may import its own floor and those below.
/// `script` drives everything, and nothing imports it.
const FLOORS: [(&str, u32); 23] = [
    ("id", 0),
    ("geometry", 0),
    ("exact", 0),
    ("sets", 0),
    ("mesh", 1),
    ("edit", 1),
    ("split", 2),
    ("mend", 2),
    ("insert", 2),
    ("slide", 2),
    ("classify", 2),
    ("pick", 2),
    ("place", 2),
    ("attribute", 2),
    ("undo", 2),
    ("weld", 2),
    ("draw", 2),
    ("mass", 2),
    ("shapes", 2),
    ("scissor", 3),
    ("tear", 3),
    ("sheet", 4),
    ("script", 4),
];

fn floor(module: &str) -> u32 {
    let known = FLOORS.iter().find(|(name, _)| *name == module);
    known
        .unwrap_or_else(|| panic!("`{module}` has no floor: give it one in this test"))
        .1
}

/// The imports of the kernel that go up, each told.
fn upward_imports(files: &Files) -> Vec<String> {
    let module = |file: usize| {
        let name = files.names[file].split(['/', '.']).next();
        name.expect("a module")
    };
    let goes_up = |&(&(from, to), _): &(&(usize, usize), &String)| {
        module(from) != "lib" && floor(module(to)) > floor(module(from))
    };
    let up = files.edges.iter().filter(goes_up);
    up.map(|(&(from, to), path)| {
        format!(
            "src/{} uses {path} of src/{}",
            files.names[from], files.names[to]
        )
    })
    .collect()
}

#[test]
fn imports_of_the_kernel_run_downward() {
    let none: [String; 0] = [];
    assert_eq!(upward_imports(&files_of("src", "lib.rs", None)), none);
}

#[test]
fn a_planted_upward_import_is_seen() {
    let planted = "\nfn planted() { use crate::scissor; scissor::Scissor::SNAP; }";
    let files = files_of("src", "lib.rs", Some(("mesh/walk.rs", planted)));
    let up = upward_imports(&files);
    assert_eq!(
        up,
        ["src/mesh/walk.rs uses crate::scissor of src/scissor.rs"]
    );
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
fn topology_knows_no_float() {
    for Source { module, path, code } in sources() {
        // The log has the weights of insertions and merges, and no more.
        let foreign: &[&str] = match &*module {
            "id" | "mesh" | "split" => &["f32", "f64", "Point", "Vector"],
            "edit" | "insert" => &["f32", "Vector", "geometry"],
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
        (".link(", &["insert"]),
        (".unlink(", &["insert"]),
        (".push_face(", &["insert"]),
        (".push_vertex(", &["split", "insert"]),
        (".set_origin(", &["split", "mend", "insert"]),
        (".set_half_edge_of(", &["split", "mend", "insert"]),
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

/// The functions of `f64` whose last bits differ from machine to machine, or may.
const PLATFORM: &[&str] = &[
    "sin", "cos", "sin_cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh",
    "asinh", "acosh", "atanh", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10",
    "powf", "powi", "hypot", "cbrt", "gamma", "ln_gamma", "erf", "erfc", "mul_add",
];

/// The functions of the platform that some code names, as methods or by their path.
fn platform_calls(code: &str) -> Vec<&str> {
    let named = code.split(['.', ':']).skip(1);
    let named = named.filter_map(|rest| words(rest).next().filter(|name| rest.starts_with(name)));
    named.filter(|name| PLATFORM.contains(name)).collect()
}

#[test]
fn the_kernel_calls_no_transcendental_function_of_the_platform() {
    for Source { path, code, .. } in sources() {
        let none: [&str; 0] = [];
        assert_eq!(platform_calls(&code), none, "src/{path}.rs");
    }
    let planted =
        "let (y, x) = a.sin_cos(); f64::atan2(y, x) + x\n    .exp() + sin(x).map(f64::tan)";
    assert_eq!(platform_calls(planted), ["sin_cos", "atan2", "exp", "tan"]);
}

#[test]
fn the_kernel_knows_no_cloth() {
    for Source { path, code, .. } in sources() {
        let foreign = ["cloth", "solver", "spring", "particle"];
        let code = code.to_lowercase();
        let found = foreign.iter().find(|&&word| code.contains(word));
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
