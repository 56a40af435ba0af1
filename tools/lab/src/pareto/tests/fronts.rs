//! The fronts by visits of edges, which are the same on every machine: a change of a method that moves one has
//! to say so.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use super::*;
use crate::pareto::observable::TOLD;

/// What is on the front, by each observable that charts have.
fn fronts(study: &Study) -> String {
    let mut text = String::new();
    for case in &study.cases {
        let is_known = |o: &Observable| {
            let mut floors = case.floors.iter();
            floors.any(|known| known.observable == *o && known.floor.is_some())
        };
        for observable in TOLD.into_iter().filter(is_known) {
            let on = case
                .rows
                .iter()
                .filter(|row| row.error(observable).is_some_and(|error| error.is_on_front));
            let names: Vec<&str> = on.filter_map(|row| row.run.rsplit('/').next()).collect();
            let names = names.join(" ");
            writeln!(text, "{} {}: {names}", case.name, observable.name()).expect("a string grows");
        }
    }
    text
}

/// With `TEARMESH_BLESS` set, the record is written anew.
#[test]
fn fronts_are_those_of_the_record() {
    let wanted = ["hang", "swing", "sliver", "taut", "strip"];
    let options = Options {
        scenes: SCENES
            .into_iter()
            .filter(|scene| wanted.contains(&scene.name))
            .collect(),
        meshes: MeshKind::ALL.to_vec(),
        cells: vec![5],
        threads: crate::pool::workers(),
        visits_max: 3_000_000,
        repeats: 0,
    };
    let study = study(&options, Provenance::default(), None, &|| false, |_, _| {});
    let found = fronts(&study);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/pareto/tests/fronts.txt");
    if std::env::var_os("TEARMESH_BLESS").is_some() {
        fs::write(&path, &found).expect("a record that can be written");
    }
    let record = fs::read_to_string(&path).expect("a record");
    for (found, record) in found.lines().zip(record.lines()) {
        assert_eq!(
            found, record,
            "a front has moved; set TEARMESH_BLESS if it is meant to"
        );
    }
    assert_eq!(found.lines().count(), record.lines().count());
}
