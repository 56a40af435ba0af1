//! Real files, where there are some: set `TEARMESH_CORPUS` to their folder.

#![expect(
    clippy::print_stdout,
    reason = "the table of outcomes is what a person runs this for"
)]

use std::collections::HashMap;
use std::io::{Write as _, stderr};
use std::path::Path;

use tearmesh_obj::{Document, ReadError};

use super::{positions, read, write_as};

/// V and F of each file, by the table that comes with the files.
fn manifest(folder: &Path) -> HashMap<String, (usize, usize)> {
    let table = std::fs::read_to_string(folder.join("MANIFEST.tsv")).unwrap_or_default();
    let mut rows = table
        .lines()
        .map(|line| line.split('\t').collect::<Vec<_>>());
    let heads = rows.next().unwrap_or_default();
    let column = |name: &str| heads.iter().position(|&head| head == name);
    let (Some(name), Some(v), Some(f)) = (column("name"), column("V"), column("F")) else {
        return HashMap::new();
    };
    rows.filter_map(|row| {
        Some((
            row[name].to_owned(),
            (row[v].parse().ok()?, row[f].parse().ok()?),
        ))
    })
    .collect()
}

/// Reads a file, and if it is a mesh, writes it twice; what happened, in a few words.
fn outcome(bytes: &[u8], expected: Option<&(usize, usize)>) -> String {
    let document = match Document::read(bytes) {
        Ok(document) => document,
        Err(ReadError::Refused(refusal)) => return format!("{} {refusal}", refusal.code),
        Err(error @ ReadError::Input(_)) => panic!("{error}"),
    };
    let counts = (document.positions().len(), document.polygon_count());
    assert_eq!(Some(&counts), expected, "V and F as in the table");
    let mesh = match document.mesh() {
        Ok(mesh) => mesh,
        Err(error) => return format!("{} {}", error.shown()[0].code, error.shown()[0]),
    };
    let written = write_as(&document, &mesh, &positions(&document));
    let again = read(&written);
    let twice = write_as(&again, &again.mesh().expect("the same"), &positions(&again));
    assert!(twice == written, "writing again gives the same bytes");
    let obj_rs = std::panic::catch_unwind(|| obj::raw::parse_obj(bytes).is_ok()).unwrap_or(false);
    if obj_rs {
        assert!(
            obj::raw::parse_obj(&written[..]).is_ok(),
            "obj-rs reads the input, so the output too"
        );
    }
    format!("ok, {} triangles", mesh.face_count())
}

#[test]
fn every_real_file_is_read_or_refused_for_a_reason() {
    let Some(folder) = std::env::var_os("TEARMESH_CORPUS") else {
        // Past the test runner, which would keep it to itself.
        let said = writeln!(
            stderr(),
            "skipped: real files, since TEARMESH_CORPUS is not set"
        );
        said.expect("standard error is open");
        return;
    };
    let folder = Path::new(&folder);
    let expected = manifest(folder);
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("the folder can be read")
        .map(|entry| entry.expect("an entry can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "obj"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "no OBJ file in {}", folder.display());
    for path in files {
        let name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let bytes = std::fs::read(&path).expect("the file can be read");
        println!("{name:40} {}", outcome(&bytes, expected.get(&name)));
    }
}
