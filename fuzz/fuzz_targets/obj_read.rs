//! Any bytes may be an OBJ file: what can be read and is a mesh can be written, and what was
//! written reads as the same triangles and writes as the same bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tearmesh::Positions;
use tearmesh_obj::Document;

fuzz_target!(|data: &[u8]| {
    let Ok(document) = Document::read(data) else {
        return;
    };
    let Some(written) = written(&document) else {
        return;
    };
    let again = Document::read(&written[..]).expect("what was written can be read");
    assert_eq!(again.triangles(), document.triangles());
    assert!(
        bits(&again) == bits(&document),
        "numbers come back bit for bit"
    );
    let twice = self::written(&again).expect("the same triangles are a mesh");
    assert!(twice == written, "writing again gives the same bytes");
});

/// The positions, texture coordinates and normals.
fn bits(document: &Document) -> Vec<u64> {
    let points = document.positions().iter().flat_map(|p| [p.x, p.y, p.z]);
    let texture = (0..document.texture_count()).flat_map(|i| document.texture(i).to_vec());
    let normals = document.normals().iter().flatten().copied();
    points
        .chain(texture)
        .chain(normals)
        .map(f64::to_bits)
        .collect()
}

/// The file as it is written with nothing torn; nothing if it is no mesh.
fn written(document: &Document) -> Option<Vec<u8>> {
    let mesh = document.mesh().ok()?;
    assert_eq!(mesh.check(), []);
    let points = document.positions().iter().copied();
    let positions = Positions::new(points).expect("the reader refuses other coordinates");
    let mut out = Vec::new();
    document
        .write(&mesh, &positions, &mut out)
        .expect("a vector takes everything");
    Some(out)
}
