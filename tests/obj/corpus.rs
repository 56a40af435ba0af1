//! Real files and hazardous ones: what becomes of each is pinned in `outcomes.txt`.
//!
//! Set `TEARMESH_CORPUS` to the folder of the real files; the hazardous ones lie in `obj_hazards`
//! beside it. `TEARMESH_BLESS=1` writes the table anew; read the difference before you keep it.

use std::collections::BTreeMap;
use std::io::{Write as _, stderr};
use std::path::{Path, PathBuf};

use tearmesh::Mesh;
use tearmesh_obj::{Document, ReadError, Repair};

use super::{positions, read, write_as};

/// What the table that comes with the real files says of each, by column.
type Manifest = BTreeMap<String, BTreeMap<String, String>>;

fn manifest(folder: &Path) -> Manifest {
    let table = std::fs::read_to_string(folder.join("MANIFEST.tsv")).expect("a manifest");
    let mut rows = table
        .lines()
        .map(|line| line.split('\t').map(str::to_owned));
    let heads: Vec<String> = rows.next().expect("a line of heads").collect();
    let row = |cells| heads.iter().cloned().zip(cells).collect::<BTreeMap<_, _>>();
    rows.map(|cells| {
        let row = row(cells);
        (row["name"].clone(), row)
    })
    .collect()
}

pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder can be read");
    let mut files: Vec<_> = entries
        .map(|entry| entry.expect("an entry can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "obj"))
        .collect();
    files.sort();
    files
}

/// Reads a file, and if it is a mesh, writes it twice; what happened, in a few words. `known` is
/// its row of the manifest.
fn outcome(bytes: &[u8], known: Option<&BTreeMap<String, String>>) -> String {
    let document = match Document::read(bytes) {
        Ok(document) => document,
        Err(ReadError::Refused(refusal)) => {
            let place = refusal.location.expect("every refusal has a place");
            return format!("{} {}:{}", refusal.code, place.line, place.column);
        }
        Err(error) => panic!("{error}"),
    };
    let count = |column: &str| -> Option<usize> { known?[column].parse().ok() };
    let counts = (document.positions().len(), document.polygon_count());
    assert_eq!((Some(counts.0), Some(counts.1)), (count("V"), count("F")));
    let sound = ["nmE", "nmV", "inconsistent"].map(|defects| count(defects) == Some(0));
    let loaded = format!("{} v, {} f", counts.0, counts.1);
    let mesh = match document.mesh() {
        Ok(mesh) => mesh,
        Err(error) => {
            assert_ne!(sound, [true; 3], "the manifest knows of no defect: {error}");
            let first = &error.shown()[0];
            let line = first.location.expect("a defect has a place").line;
            let repaired = document.repaired(Repair::All);
            let then = match repaired.mesh() {
                Ok(mesh) => {
                    survives(bytes, &repaired, &mesh);
                    let (v, f) = (mesh.vertex_count(), mesh.face_count());
                    format!("repaired: {v} v, {f} triangles")
                }
                Err(error) => format!("beyond repair: {}", error.shown()[0].code),
            };
            return format!("{loaded}, {} {line}, {then}", first.code);
        }
    };
    assert_eq!(sound, [true; 3], "the manifest knows of a defect");
    assert_eq!(Some(mesh.components().count()), count("comps"));
    assert_eq!(Some(mesh.boundary_loops().len()), count("loops"));
    survives(bytes, &document, &mesh);
    format!("{loaded}, {} triangles", mesh.face_count())
}

/// What is written is read again, by us and by obj-rs, and written again byte for byte.
fn survives(bytes: &[u8], document: &Document, mesh: &Mesh) {
    let written = write_as(document, mesh, &positions(document));
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
}

#[test]
fn real_and_hazardous_files_become_what_is_pinned() {
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
    let known = manifest(folder);
    let stem = |path: &Path| path.file_stem().expect("a name").display().to_string();
    let mut table = String::new();
    let mut names = Vec::new();
    for path in files(folder) {
        let name = stem(&path);
        let bytes = std::fs::read(&path).expect("the file can be read");
        table += &format!("{name:36} {}\n", outcome(&bytes, known.get(&name)));
        names.push(name);
    }
    names.sort();
    assert!(names.iter().eq(known.keys()), "the files of the manifest");
    table += "\nHazards\n";
    for path in files(&folder.with_file_name("obj_hazards")) {
        let bytes = std::fs::read(&path).expect("the file can be read");
        table += &format!("{:36} {}\n", stem(&path), outcome(&bytes, None));
    }
    let pinned = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/obj/outcomes.txt");
    if std::env::var_os("TEARMESH_BLESS").is_some() {
        std::fs::write(&pinned, &table).expect("a blessed table");
    }
    let pinned = std::fs::read_to_string(pinned).expect("a table");
    assert!(pinned == table, "the outcomes are now:\n{table}");
}
