//! Replays what the fuzz targets of the library start from, and what they found.

use std::panic::catch_unwind;
use std::path::Path;

use tearmesh::script::Script;

use crate::cases::cases;
use crate::cut_mend;
use crate::inputs::{inputs, seeds_and_finds};
use crate::lockstep;
use crate::random::Random;
use crate::rays::{Case, Outcome};

/// Where the seeds of the target `script` are, in bytes.
const SEEDS: &str = "fuzz/corpus/script";

/// Where scripts are written that differ from their bytes: as seeds, after a change of `fuzz.txt` or of how
/// scripts are coded. (`TEARMESH_WRITE_SEEDS=1 cargo test --test main -- seeds_of_the_target`)
const WRITE: &str = "TEARMESH_WRITE_SEEDS";

/// And what is found in bytes is found in the text again.
#[test]
fn seeds_of_the_target_are_these_scripts() {
    let sections = include_str!("fuzz.txt").split("\n[").skip(1);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(SEEDS);
    let mut names = Vec::new();
    for section in sections {
        let (name, text) = section.split_once("]\n").expect("a name");
        let script: Script = text.parse().expect(name);
        lockstep::check(&script);
        let (path, bytes) = (folder.join(name), script.to_bytes());
        assert_eq!(Script::from_bytes(&bytes), script, "{name}");
        if std::env::var_os(WRITE).is_some() {
            std::fs::write(&path, &bytes).expect("a folder");
        }
        let is = std::fs::read(path).expect("a seed");
        assert_eq!(is, bytes, "{name}: {WRITE} is not set");
        names.push(name);
    }
    let seeds = inputs("corpus", "script").len();
    assert_eq!(seeds, names.len(), "a seed for each section");
}

#[test]
fn scripts_that_fuzzing_found_agree_with_the_oracle() {
    for bytes in inputs("regressions", "script") {
        let script = Script::from_bytes(&bytes);
        println!("{script}");
        lockstep::check(&script);
    }
}

/// And cuts of random bytes.
#[test]
fn cuts_of_seeds_finds_and_random_bytes_are_mended() {
    let mut random = Random(59);
    let random_bytes = (0..4_000).map(|_| random.bytes(120));
    let mut done = cut_mend::Done::default();
    for bytes in seeds_and_finds("cut_mend").chain(random_bytes) {
        let case = cut_mend::Case::from_bytes(&bytes);
        let checked = catch_unwind(|| case.check());
        let one = checked.unwrap_or_else(|_| panic!("{bytes:?}: {case:?}"));
        done.by_planes += one.by_planes;
        done.of_first += one.of_first;
    }
    assert!(done.by_planes >= 500 && done.of_first >= 500, "{done:?}");
}

/// And rays of random bytes.
#[test]
fn rays_of_seeds_finds_and_random_bytes_cut_as_they_should() {
    let mut random = Random(113);
    let random_bytes = (0..cases()).map(|_| random.bytes(120));
    let mut counts = [0; 5];
    for bytes in seeds_and_finds("scissor_rays").chain(random_bytes) {
        println!("{bytes:?}");
        counts[match Case::from_bytes(&bytes).check() {
            Outcome::NoRay => 0,
            Outcome::NoPlane => 1,
            Outcome::RaysCross => 2,
            Outcome::Cut(0) => 3,
            Outcome::Cut(_) => 4,
        }] += 1;
    }
    let [no_ray, no_plane, _, missed, cut] = counts;
    let some = no_ray >= 1 && no_plane >= 1 && missed >= 1 && cut >= 5;
    assert!(some, "{counts:?}");
}
