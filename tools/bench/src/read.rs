//! `read`: OBJ bytes in memory to a document in memory.

pub(crate) mod fast_obj;

use tearmesh_obj::Document;

use crate::measure::{Contestant, contest, timed_on_cpu};
use crate::options::Options;
use crate::rivals::{self, Plain};
use crate::sheet::{Dialect, Sheet};

/// Every reader on a file of every dialect, as tables.
pub(crate) fn run(options: &Options) -> String {
    let names = Dialect::ALL.map(Dialect::name);
    let dialects = Dialect::ALL
        .into_iter()
        .filter(|dialect| options.picks(dialect.name(), &names));
    let tables = dialects.map(|dialect| {
        let sheet = Sheet::new(dialect, options.faces);
        let bytes = sheet.text.len();
        format!(
            "{}: {} vertices, {} faces, {:.1} MB\n{}",
            dialect.name(),
            sheet.vertices,
            sheet.faces,
            bytes as f64 / 1e6,
            contest(&sheet, bytes, &READERS, &["obj-rs", "plain"], options)
        )
    });
    let tables: Vec<String> = tables.chain([fast_obj::tables(options)]).collect();
    tables.join("\n")
}

const READERS: [Contestant<'_, Sheet>; 7] = [
    Contestant {
        name: "tearmesh-obj",
        note: "f64, every statement in order, line numbers; quads as triangles too",
        run: &|sheet| {
            read(
                sheet,
                |bytes| Document::read(bytes).expect("readable"),
                |document| (document.positions().len(), document.polygon_count()),
            )
        },
    },
    Contestant {
        name: "plain",
        note: "f64, v and triangles alone; nothing checked",
        run: &|sheet| {
            if matches!(sheet.dialect, Dialect::Plain | Dialect::FullDigits) {
                read(
                    sheet,
                    |bytes| Plain::read(bytes).expect("readable"),
                    |plain| (plain.positions.len(), plain.triangles.len()),
                )
            } else {
                None
            }
        },
    },
    Contestant {
        name: "obj-rs",
        note: "f32, a list for each face",
        run: &|sheet| {
            read(sheet, rivals::obj_rs, |raw| {
                (raw.positions.len(), raw.polygons.len())
            })
        },
    },
    Contestant {
        name: "tobj",
        note: "f32, polygons as they are",
        run: &|sheet| {
            read(sheet, rivals::tobj, |models| {
                let mesh = &models[0].mesh;
                let faces = match mesh.face_arities.len() {
                    0 => mesh.indices.len() / 3,
                    count => count,
                };
                (mesh.positions.len() / 3, faces)
            })
        },
    },
    Contestant {
        name: "wavefront_obj",
        note: "f64, polygons as triangles",
        run: &|sheet| {
            read(sheet, rivals::wavefront_obj, |set| {
                let object = &set.objects[0];
                let triangles: usize = object.geometry.iter().map(|g| g.shapes.len()).sum();
                let per_face = if sheet.dialect == Dialect::Quads {
                    2
                } else {
                    1
                };
                (object.vertices.len(), triangles / per_face)
            })
        },
    },
    Contestant {
        name: "obj",
        note: "f32, a list for each face",
        run: &|sheet| {
            read(sheet, rivals::obj, |data| {
                let groups = data.objects.iter().flat_map(|object| &object.groups);
                (
                    data.position.len(),
                    groups.map(|group| group.polys.len()).sum(),
                )
            })
        },
    },
    Contestant {
        name: "wobj",
        note: "f32, a list for each face",
        run: &|sheet| {
            read(sheet, rivals::wobj, |obj| {
                (
                    obj.vertices().len(),
                    obj.meshes().iter().map(|mesh| mesh.faces().len()).sum(),
                )
            })
        },
    },
];

/// How many seconds it takes to read a sheet, whole.
fn read<T>(
    sheet: &Sheet,
    reader: impl FnOnce(&[u8]) -> T,
    counts: impl FnOnce(&T) -> (usize, usize),
) -> Option<f64> {
    let (result, time) = timed_on_cpu(|| reader(sheet.text.as_bytes()));
    assert_eq!(
        counts(&result),
        (sheet.vertices, sheet.faces),
        "all of it is read"
    );
    Some(time)
}
