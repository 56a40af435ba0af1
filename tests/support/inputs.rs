//! The seeds of fuzz targets, and their finds.

use std::fs;
use std::path::{Path, PathBuf};

/// The seeds of a target in `fuzz/corpus`, or its inputs in `fuzz/regressions`, in the order of their names; each
/// is printed.
pub(crate) fn inputs(kind: &str, target: &str) -> Vec<Vec<u8>> {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fuzz = ["fuzz", "../../fuzz"].map(|fuzz| package.join(fuzz));
    let fuzz = fuzz.into_iter().find(|fuzz| fuzz.is_dir());
    let Ok(folder) = fuzz.expect("the folder").join(kind).join(target).read_dir() else {
        assert_eq!(kind, "regressions", "{target} has seeds");
        return Vec::new();
    };
    let paths = folder.map(|entry| entry.expect("a readable folder").path());
    let mut paths: Vec<_> = paths
        .filter(|path| kind != "corpus" || !is_new(path))
        .collect();
    paths.sort();
    let read = |path: &PathBuf| {
        println!("{}", path.display());
        fs::read(path).expect("a readable file")
    };
    paths.iter().map(read).collect()
}

/// Whether libFuzzer has just added this input to the seeds, by its name: 40 hexadecimal digits.
fn is_new(path: &Path) -> bool {
    let name = path.file_name().expect("a name").to_string_lossy();
    name.len() == 40 && name.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// What the seeds and the finds of a target are.
pub(crate) fn seeds_and_finds(target: &str) -> impl Iterator<Item = Vec<u8>> {
    let both = ["corpus", "regressions"].map(|kind| inputs(kind, target));
    both.into_iter().flatten()
}
