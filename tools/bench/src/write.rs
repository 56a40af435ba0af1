//! `write`: a document in memory to OBJ bytes in memory.

use std::io::Write as _;

use tearmesh::{Mesh, Positions};
use tearmesh_obj::{Document, TornDocument};

use crate::measure::{Contestant, contest, timed_on_cpu};
use crate::options::Options;
use crate::sheet::{Dialect, Sheet};

/// Every writer on plain triangles with short and with full numbers, as tables.
pub(crate) fn run(options: &Options) -> String {
    let tables = [Dialect::Plain, Dialect::FullDigits].map(|dialect| {
        let model = Model::new(&Sheet::new(dialect, options.faces));
        let bytes = model.written().len();
        format!(
            "{}: {} vertices, {} faces, {:.1} MB\n{}",
            dialect.name(),
            model.positions.len(),
            model.mesh.face_count(),
            bytes as f64 / 1e6,
            contest(&model, bytes, &WRITERS, &["{}"], options)
        )
    });
    tables.join("\n")
}

/// What is written.
struct Model {
    document: Document,
    mesh: Mesh,
    positions: Positions,
}

impl Model {
    fn new(sheet: &Sheet) -> Model {
        let document = Document::read(sheet.text.as_bytes()).expect("a sheet is readable");
        let mesh = document.mesh().expect("a sheet is a mesh");
        let positions = Positions::new(document.positions().iter().copied()).expect("finite");
        Model {
            document,
            mesh,
            positions,
        }
    }

    fn written(&self) -> Vec<u8> {
        let mut out = Vec::new();
        TornDocument::new(&self.document)
            .write(&self.mesh, &self.positions, &mut out)
            .expect("memory takes all");
        out
    }

    /// Writes vertices and triangles alone, numbers by `write_number`.
    fn written_plainly(&self, write_number: impl Fn(&mut Vec<u8>, f64)) -> Vec<u8> {
        let mut out = Vec::new();
        for at in self.positions.as_slice() {
            out.push(b'v');
            for number in [at.x, at.y, at.z] {
                out.push(b' ');
                write_number(&mut out, number);
            }
            out.push(b'\n');
        }
        for [a, b, c] in self.document.triangles() {
            writeln!(out, "f {} {} {}", a + 1, b + 1, c + 1).expect("memory takes all");
        }
        out
    }
}

const WRITERS: [Contestant<'_, Model>; 3] = [
    Contestant {
        name: "tearmesh-obj",
        note: "every statement in order; vertices with several fans are looked for",
        run: &|model| Some(timed_on_cpu(|| model.written()).1),
    },
    Contestant {
        name: "{}",
        note: "v and f alone",
        run: &|model| {
            let number = |out: &mut Vec<u8>, x: f64| write!(out, "{x}").expect("memory takes all");
            Some(timed_on_cpu(|| model.written_plainly(number)).1)
        },
    },
    Contestant {
        name: "ryu",
        note: "v and f alone; exponents as ryu has them",
        run: &|model| {
            let number = |out: &mut Vec<u8>, x: f64| {
                out.extend_from_slice(ryu::Buffer::new().format_finite(x).as_bytes());
            };
            Some(timed_on_cpu(|| model.written_plainly(number)).1)
        },
    },
];
