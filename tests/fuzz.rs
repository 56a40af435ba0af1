//! Replays what the fuzz targets of the library start from, and what they found.

use std::path::{Path, PathBuf};

use arbitrary::{Arbitrary as _, Unstructured};
use tearmesh::script::Script;

use crate::lockstep;
use crate::rays::{Case, Outcome};

/// The seeds of the target, as text: one for each shape and each kind of operation.
const SEEDS: [(&str, &str); 15] = [
    (
        "grid",
        "grid 3 3 0b101\nsplit 5 0b11\nplane 6 1 0 0\nsplit 5 0b1 foreign 3\nclear\nsplit 16 1",
    ),
    (
        "fan",
        "fan 6\nplane 0 0 1 0\nplane 1 0 1 0\nsplit 0 0b101\nclear\nsplit 7 0b10",
    ),
    (
        "open_fan",
        "open-fan 3\nsplit 0 0b10\nsplit 2 0b1\nsplit 0 0b1 repeated 0\nsplit 0 0b11",
    ),
    ("saddle", "saddle\nplane 0 0 0 1\nplane 9 1 1 0"),
    (
        "tube",
        "tube 5 2\ncut through 0 -64 32 0 0 -1 0 64 32 0 0 -1\nclear\nplane 6 1 -1 0",
    ),
    (
        "torus",
        "torus 4 4\nsplit 3 0b111\ncut -10 -64 32 0 0 -1 -10 64 32 0 0 -1\ntear",
    ),
    (
        "sphere",
        "octahedron 1\ncut midpoint 3 -64 32 0 0 -1 3 2 32 0 0 -1\nsplit 8 0b101",
    ),
    (
        "grown",
        "grown 0 1 5 2 6 3 9 13 1 4 7 11\nplane 2 1 2 -1\nplane 4 -1 0 3\nsplit 1 0b110\ntear",
    ),
    (
        "glued",
        "glued 6 0 3 1 6 4 9 10 12 7 15\nsplit 2 0b1\nplane 3 1 0 0\nclear\ntear",
    ),
    (
        "insert",
        "fan 6\ninsert 0 edge 1 16 edge 0 48 edge 1 40 chord 3 5\ninsert 4 face 0 1 2 3 face 0 3 3 3\n\
         insert 7 edge 0 64\ninsert 7 face 2 0 1 1\ninsert 0 edge 1 20 edge 1 20\nclear\n\
         insert 0 face 0 1 1 1 chord 0 3\ninsert 2",
    ),
    (
        "insert_on_a_tear",
        "open-fan 4\nsplit 0 0b110\ninsert 3 edge 0 16 edge 0 24 edge 8 32\nsplit 6 0b1\n\
         insert 2 edge 0 8 edge 3 60\nmerge 0 1 1 3\ninsert 9 edge 2 32 face 2 1 1 1",
    ),
    (
        "merge",
        "fan 6\nsplit 0 0b101\nsplit 0 0b10\nsplit 7 0b1\nmerge 0 1 0 0\nmerge 1 2 -1 3\n\
         merge any 1 2 1 1\nmerge 0 0 1 1\nmerge 2 0 5 1\nclear\nmerge 0 1 2 2",
    ),
    (
        "merge_renumbers",
        "grid 2 2 0b0110\nsplit 4 0b11\ninsert 0 edge 2 32\nmerge 0 1 1 1\nsplit 9 0b1\ntear\n\
         merge 3 1 1 1\nmerge 8 2 1 0\nsew 0x5555",
    ),
    (
        "sew",
        "tube 4 2\nplane 5 1 0 0\nplane 5 0 0 1\ninsert 12 edge 3 32\nsew 0xffff\ntear\nsew 0xff0f\n\
         insert 4 face 0 1 1 1\nsew 0xffff",
    ),
    (
        "slide",
        "grid 2 2 0b0110\nslide 4 1 16\nslide 0 0 0\nslide any 0 8 32\nsplit 4 0b11\nslide 4 2 48\n\
         slide 9 0 1\ninsert 0 edge 1 32\nclear\nslide 10 3 63\nmerge 0 1 1 3\nslide 4 1 64\nslide 4 1 8",
    ),
];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fuzz")
        .join(name)
}

#[test]
fn the_seeds_are_these_scripts() {
    for (name, text) in SEEDS {
        let script: Script = text.parse().expect(name);
        lockstep::check(&script);
        let path = folder("seeds/script").join(name);
        let bytes = std::fs::read(&path).expect("a seed");
        assert_eq!(Script::from_bytes(&bytes), script, "{}", path.display());
        let arbitrary = Script::arbitrary_take_rest(Unstructured::new(&bytes));
        assert_eq!(arbitrary, Ok(script), "a fuzzer's bytes are the script's");
    }
}

/// The inputs in a folder, which need not be there.
fn inputs(name: &str) -> Vec<Vec<u8>> {
    let Ok(folder) = folder(name).read_dir() else {
        return Vec::new();
    };
    let mut paths: Vec<PathBuf> = folder
        .map(|entry| entry.expect("a readable folder").path())
        .collect();
    paths.sort();
    let read = |path: &PathBuf| {
        println!("{}", path.display());
        std::fs::read(path).expect("a readable file")
    };
    paths.iter().map(read).collect()
}

#[test]
fn what_fuzzing_found_stays_found() {
    for bytes in inputs("regressions/script") {
        let script = Script::from_bytes(&bytes);
        println!("{script}");
        lockstep::check(&script);
    }
}

#[test]
fn cuts_of_the_seeds_and_of_what_fuzzing_found_can_be_mended() {
    let mut cuts = 0;
    for folder in ["seeds/cut_mend", "regressions/cut_mend"] {
        for bytes in inputs(folder) {
            cuts += crate::cut_mend::Case::from_bytes(&bytes).check().cuts;
        }
    }
    assert!(cuts >= 20, "only {cuts} cuts");
}

#[test]
fn rays_of_the_seeds_and_of_what_fuzzing_found_cut_as_they_should() {
    let mut ends = [0; 4];
    for folder in ["seeds/scissor_rays", "regressions/scissor_rays"] {
        for bytes in inputs(folder) {
            let case = Case::from_bytes(&bytes);
            let end = case.check();
            println!("{end:?}");
            ends[match end {
                Outcome::NoRay => 0,
                Outcome::NoPlane => 1,
                Outcome::Cut(0) => 2,
                Outcome::Cut(_) => 3,
            }] += 1;
        }
    }
    let [no_ray, no_plane, missed, cut] = ends;
    assert!(
        no_ray >= 1 && no_plane >= 1 && missed >= 1 && cut >= 5,
        "{ends:?}"
    );
}
