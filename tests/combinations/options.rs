//! Every option of the verbs that cut, and every setting of the library's scissor and sheet, is a factor of the
//! table or stands here with a reason.

use std::collections::BTreeSet;

use crate::in_process::in_memory;
use crate::table::FACTORS;

/// Options of `cut` and `mend`, and the factor, or why there is none.
const OPTIONS: &[(&str, &str)] = &[
    ("--rays", "factor rays"),
    ("--plane", "factor aim"),
    ("--layers", "factor layers"),
    ("--gap", "factor gap"),
    ("--method", "factor method"),
    ("--snap", "factor snap"),
    ("--snap-move", "factor snap-move"),
    ("--through", "factor through"),
    ("--tips", "factor tips"),
    ("--mass", "factor mass"),
    ("--weld", "factor history"),
    ("--last", "factor history"),
    ("--near", "factor history"),
    ("--radius", "factor history"),
    ("--simplify", "factor history"),
    (
        "--allow-miss",
        "every cut has it: a draw that misses is drawn again",
    ),
    ("--rays-file", "another place of --rays"),
    (
        "--camera",
        "another way to write --rays; the report has them, and tests/cli compares",
    ),
    ("--up", "of --camera"),
    ("--fov", "of --camera"),
    ("--viewport", "of --camera"),
    ("--points", "of --camera"),
    (
        "--repair",
        "changes the input before the cut, and tests/obj/repair.rs compares that",
    ),
    (
        "--separate-fans",
        "changes the input before the cut, as --repair",
    ),
    ("--seam", "a file beside the mesh, which it does not change"),
    ("--map", "a file beside the mesh"),
    ("--pieces", "files beside the mesh"),
    (
        "--coincident",
        "for files without a record, and the sequences keep theirs",
    ),
    ("--max-distance", "refuses, and changes nothing else"),
    ("--output", "where to, and how the command tells of it"),
    ("--in-place", "where to"),
    ("--dry-run", "where to"),
    ("--format", "how the command tells of it"),
    ("--report", "how the command tells of it"),
    ("--picture", "a file beside the mesh"),
    ("--view", "a file beside the mesh"),
    ("--no-timing", "how the command tells of it"),
    ("--color", "how the command tells of it"),
    ("--quiet", "how the command tells of it"),
    ("--verbose", "how the command tells of it"),
    ("--help", "prints the options"),
];

/// What `Sheet` and `Scissor` can do, and the factor, or why there is none.
const ITEMS: &[(&str, &str)] = &[
    ("Scissor::new", "factor rays"),
    ("Scissor::by_plane", "factor aim"),
    ("Scissor::continued", "factor aim"),
    ("Scissor::closed", "factor aim"),
    ("Scissor::with_snap", "factor snap"),
    ("Scissor::with_snap_move", "factor snap-move"),
    ("Scissor::with_layers", "factor layers"),
    ("Scissor::with_through", "factor through"),
    ("Scissor::with_tips", "factor tips"),
    ("Scissor::cut", "cut_measured without the report"),
    ("Scissor::cut_measured", "factor method"),
    ("Scissor::SNAP", "a level of the factor snap"),
    ("Scissor::aimed_at", "what every cut does first"),
    (
        "Scissor::from_words",
        "reads what to_words wrote; tests/scissor.rs compares",
    ),
    ("Scissor::to_words", "writes a scissor"),
    ("Scissor::plane", "reads a scissor"),
    ("Scissor::sides", "reads a scissor"),
    ("Scissor::skew", "reads a scissor"),
    ("Sheet::new", "holds what the library path holds by itself"),
    ("Sheet::with", "factor attributes"),
    ("Sheet::with_masses", "factor mass"),
    ("Sheet::cut", "factor method"),
    ("Sheet::cut_measured", "factor method"),
    ("Sheet::mend", "factor history"),
    ("Sheet::tear", "factor history"),
    ("Sheet::split", "what tears and cuts are made of"),
    ("Sheet::check", "reads a sheet"),
    ("Sheet::edits", "reads a sheet"),
    ("Sheet::masses", "reads a sheet"),
    ("Sheet::mesh", "reads a sheet"),
    ("Sheet::positions", "reads a sheet"),
    ("Sheet::values", "reads a sheet"),
    ("Sheet::values_mut", "reads a sheet"),
];

/// The options that the help of a verb lists, which clap writes from its definition.
fn options(verb: &str) -> BTreeSet<String> {
    let ran = in_memory(["tearmesh", verb, "--help"], &[], false);
    let help = String::from_utf8(ran.output).expect("text") + &ran.error;
    // What is said of an option is indented further.
    let is_option =
        |line: &&str| line.trim_start().starts_with('-') && !line.starts_with("        ");
    let words = help.lines().filter(is_option);
    let long = words.filter_map(|line| {
        let first = line.trim_start().split("  ").next()?;
        let mut words = first.split([' ', ',', '[', '=']);
        words.find(|word| word.starts_with("--")).map(str::to_owned)
    });
    long.collect()
}

/// The public items of the library of these types, but for their traits.
fn items() -> BTreeSet<String> {
    let list = include_str!("../public/tearmesh.txt").lines();
    let names = list.filter_map(|line| line.strip_prefix("tearmesh::"));
    let of_types = names.filter(|name| {
        ["Scissor::", "Sheet::"]
            .iter()
            .any(|of| name.starts_with(of))
    });
    of_types.map(str::to_owned).collect()
}

/// What is there and not in a list, and what is in the list and not there.
fn differences(there: &BTreeSet<String>, list: &[(&str, &str)]) -> Vec<String> {
    let listed: BTreeSet<String> = list.iter().map(|(name, _)| (*name).to_owned()).collect();
    there.symmetric_difference(&listed).cloned().collect()
}

#[test]
fn every_option_is_a_factor_or_says_why_not() {
    let options: BTreeSet<String> = ["cut", "mend"].into_iter().flat_map(options).collect();
    assert!(options.len() > 30, "{options:?}");
    for (there, list) in [(options, OPTIONS), (items(), ITEMS)] {
        let none: [String; 0] = [];
        assert_eq!(
            differences(&there, list),
            none,
            "neither in the table nor excepted"
        );
        let mut more = there.clone();
        more.insert("--wedge".to_owned());
        assert_eq!(differences(&more, list), ["--wedge"]);
        for (name, why) in list {
            let factor = why.strip_prefix("factor ");
            let is_there = |factor: &str| FACTORS.iter().any(|(name, _)| *name == factor);
            assert!(factor.is_none_or(is_there), "{name} is no {why}");
            assert!(!why.is_empty(), "{name} needs a reason");
        }
    }
}
