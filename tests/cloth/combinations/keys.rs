//! The completeness of the factors: every key of scene files and every verb of simulations is a level of some factor,
//! or stands in a list of exceptions with the reason.

use std::collections::BTreeSet;

use tearmesh_cloth::Method;

use super::factors::{Case, FACTORS, OTHER_KEYS, OTHER_VERBS};
use super::script;
use super::shapes::Shape;
use super::text::Text;

const GUIDE: &str = include_str!("../../../tools/cli/src/guide/scenes.md");
const PUBLIC: &str = include_str!("../../public/tearmesh_cloth.txt");

/// Every level of every factor, with what it needs to be allowed.
fn levels() -> Vec<Case> {
    let mut all = Vec::new();
    for (factor, levels) in FACTORS {
        for level in *levels {
            for base in [
                "",
                "mesh=panels seams=sewn",
                "cut=default threshold=stretch collider=ball",
            ] {
                for method in Method::NAMES {
                    let case = Case::of(base).with("method", method).with(factor, level);
                    all.extend(Some(case).filter(Case::is_allowed));
                }
            }
        }
    }
    all
}

/// The keys of the guide, as `table.key`.
fn keys_of_guide() -> BTreeSet<String> {
    let (mut table, mut keys) = ("", BTreeSet::new());
    for line in GUIDE.lines() {
        if let Some(title) = line.strip_prefix("# ") {
            table = title.trim_matches(['`', '[', ']']);
        }
        let key = line
            .strip_prefix("| `")
            .and_then(|rest| rest.split('`').next());
        keys.extend(key.map(|key| match table {
            "At the top" => key.to_owned(),
            table => format!("{table}.{key}"),
        }));
    }
    keys
}

/// Compares names with those that factors have and those that are excepted; says what is in neither, and what is
/// excepted for nothing.
fn compare(all: &BTreeSet<String>, used: &BTreeSet<String>, excepted: &[(&str, &str)]) {
    let others: BTreeSet<String> = excepted
        .iter()
        .map(|(name, _)| (*name).to_owned())
        .collect();
    let missing: Vec<_> = all
        .iter()
        .filter(|name| !used.contains(*name) && !others.contains(*name))
        .collect();
    assert!(
        missing.is_empty(),
        "no factor has {missing:?}, and no exception"
    );
    let needless: Vec<_> = others
        .iter()
        .filter(|name| used.contains(*name) || !all.contains(*name))
        .collect();
    assert!(needless.is_empty(), "{needless:?} need no exception");
    let unknown: Vec<_> = used.difference(all).collect();
    assert!(unknown.is_empty(), "{unknown:?} are not documented");
}

#[test]
fn every_key_of_scene_files_is_a_level_of_a_factor() {
    let mut used = BTreeSet::new();
    for case in levels() {
        used.extend(Text::of(&case, &Shape::of(case.get("mesh"))).keys());
    }
    let all = keys_of_guide();
    assert!(all.len() > 80, "{} keys", all.len());
    compare(&all, &used, OTHER_KEYS);
}

#[test]
fn every_verb_of_simulations_is_in_some_script() {
    let mut used: BTreeSet<String> = BTreeSet::new();
    for words in [
        "hold=released cut=default heal=ended hand=led wind=later",
        "mesh=panels seams=sewn unpick=late",
    ] {
        let case = Case::of(words);
        let shape = Shape::of(case.get("mesh"));
        let (scene, frame) = super::scenes::read(&case, &shape).expect("a scene");
        let script = script::recorded(&case, &shape, &scene, &frame).expect("a script");
        used.extend(script.verbs.iter().map(|verb| (*verb).to_owned()));
    }
    let items = PUBLIC
        .lines()
        .filter_map(|line| line.strip_prefix("tearmesh_cloth::Simulation::"));
    let all: BTreeSet<String> = items.map(ToOwned::to_owned).collect();
    compare(&all, &used, OTHER_VERBS);
}
