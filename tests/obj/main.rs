//! Tests of `tearmesh-obj` through its public interface.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod accept;
mod apart;
mod bodies;
#[path = "../support/cases.rs"]
mod cases;
mod coincident;
mod collinear;
mod corpus;
mod differential;
#[path = "../support/digest.rs"]
mod digest;
mod digits;
mod edited;
mod fuzz;
#[path = "../support/inputs.rs"]
mod inputs;
mod memory;
mod mesh;
mod normals;
mod numbers;
#[path = "../support/random.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod random;
mod raw;
mod refuse;
mod repair;
mod round_trip;
mod same_bytes;
mod slides;
mod spelling;
#[path = "../support/stride.rs"]
mod stride;
mod tables;
mod torn;
mod torn_damage;
mod torn_record;
mod triangulate;
mod undone;
#[path = "../support/vectors.rs"]
mod vectors;
mod work;

use proptest::test_runner::Config;
use tearmesh::{Mesh, Positions};
use tearmesh_obj::{Document, TornDocument};

/// The settings of every property: no files are written for cases that fail (a find becomes a test of its own).
fn properties() -> Config {
    Config {
        cases: cases::cases().try_into().expect("below 2^32"),
        failure_persistence: None,
        ..Config::default()
    }
}

/// Reads a file that must be accepted.
fn read(bytes: &[u8]) -> Document {
    match Document::read(bytes) {
        Ok(document) => document,
        Err(error) => panic!("{error}\n{}", String::from_utf8_lossy(bytes)),
    }
}

/// The positions of a document, for writing it with its own mesh.
fn positions(document: &Document) -> Positions {
    Positions::new(document.positions().iter().copied()).expect("the reader checks coordinates")
}

/// Writes a document as a mesh.
fn write_as(document: &Document, mesh: &Mesh, positions: &Positions) -> Vec<u8> {
    let mut out = Vec::new();
    TornDocument::new(document)
        .write(mesh, positions, &mut out)
        .expect("memory can be written");
    out
}

/// Reads, builds and writes.
fn rewritten(bytes: &[u8]) -> Vec<u8> {
    let document = read(bytes);
    let mesh = document.mesh().unwrap_or_else(|error| panic!("{error}"));
    write_as(&document, &mesh, &positions(&document))
}

/// Bytes as text, for comparisons that a person can read.
fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
