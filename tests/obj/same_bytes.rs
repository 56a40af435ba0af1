//! What holds of any bytes that are an OBJ file and a mesh, whatever is split in it.
//!
//! The fuzz targets `obj_read` and `obj_roundtrip` and the replay of their seeds use this.

use tearmesh::{Edits, FaceId, Mesh, Positions, VertexId, split};
use tearmesh_obj::Document;

/// A file, and behind a zero byte (which no OBJ file has) what is split. Whether it is a mesh.
pub(crate) fn check(bytes: &[u8]) -> bool {
    let end = bytes.iter().position(|&byte| byte == 0);
    let (file, splits) = bytes.split_at(end.unwrap_or(bytes.len()));
    check_file(file, splits.get(1..).unwrap_or_default())
}

/// Reads, splits, writes, reads and writes: the same bytes, and the same numbers. Each three
/// bytes of `splits` are a vertex, and a set of its faces; what is no split is refused.
pub(crate) fn check_file(file: &[u8], splits: &[u8]) -> bool {
    let Ok(document) = Document::read(file) else {
        return false;
    };
    let Ok(mut mesh) = document.mesh() else {
        return false;
    };
    let points = document.positions().iter().copied();
    let mut positions = Positions::new(points).expect("the reader refuses other coordinates");
    let mut edits = Edits::new();
    for chunk in splits.chunks_exact(3).take(64) {
        let number = usize::from(chunk[0]) % mesh.vertex_count();
        let v = VertexId::new(number).expect("a vertex of the mesh");
        let mask = u16::from_le_bytes([chunk[1], chunk[2]]);
        let mut faces: Vec<FaceId> = mesh.faces_of(v).collect();
        faces.sort();
        let mut bit = 0..;
        faces.retain(|_| bit.next().is_some_and(|i: u32| mask >> (i % 16) & 1 == 1));
        // The empty and the full set are refused, and nothing has happened then.
        let _ = split::faces(&mut mesh, v, &faces, &mut edits);
    }
    edits.replay(&mut positions);
    assert_eq!(mesh.check(), []);

    let written = write(&document, &mesh, &positions);
    let again = Document::read(&written[..]).expect("what was written can be read");
    corners_are_the_same(&document, &mesh, &positions, &again);
    attributes_are_the_same(&document, &again);
    if edits.next_number() == 0 {
        assert_eq!(again.triangles(), document.triangles());
        let vertices = |document: &Document| {
            let points = document.positions().iter().flat_map(|p| [p.x, p.y, p.z]);
            points.map(f64::to_bits).collect::<Vec<_>>()
        };
        assert!(vertices(&again) == vertices(&document), "positions");
    }
    let same = again.mesh().expect("what was written is a mesh");
    assert_eq!(same.check(), []);
    let points = again.positions().iter().copied();
    let positions = Positions::new(points).expect("the reader refuses other coordinates");
    let twice = write(&again, &same, &positions);
    assert_eq!(
        String::from_utf8_lossy(&twice),
        String::from_utf8_lossy(&written),
        "writing again gives the same text"
    );
    assert!(twice == written, "writing again gives the same bytes");
    true
}

fn write(document: &Document, mesh: &Mesh, positions: &Positions) -> Vec<u8> {
    let mut out = Vec::new();
    let done = document.write(mesh, positions, &mut out);
    done.expect("a vector takes everything");
    out
}

/// Each corner of each triangle is where it was, bit for bit, and has its vt and vn.
fn corners_are_the_same(before: &Document, mesh: &Mesh, positions: &Positions, after: &Document) {
    assert_eq!(after.triangles().len(), before.triangles().len());
    assert_eq!(after.triangles().len(), mesh.face_count());
    for (f, triangle) in mesh.faces().zip(after.triangles()) {
        for (i, v) in mesh.corners(f).into_iter().enumerate() {
            let (was, is) = (positions.at(v), after.positions()[triangle[i] as usize]);
            for axis in 0..3 {
                assert_eq!(is[axis].to_bits(), was[axis].to_bits(), "{v} of {f}");
            }
            let root = mesh.root(v).index();
            assert_eq!(
                after.extra_numbers(triangle[i] as usize),
                before.extra_numbers(root)
            );
            let [was, is] = [before, after].map(|document| document.corner(f.index(), i));
            assert_eq!((is.texture, is.normal), (was.texture, was.normal));
        }
    }
}

fn attributes_are_the_same(before: &Document, after: &Document) {
    let bits = |document: &Document| {
        let texture = (0..document.texture_count()).map(|i| document.texture(i).to_vec());
        let normals = document.normals().iter().map(|normal| normal.to_vec());
        let numbers = texture.chain(normals);
        let bits = numbers.map(|one| one.iter().map(|x| x.to_bits()).collect());
        bits.collect::<Vec<Vec<u64>>>()
    };
    assert_eq!(after.texture_count(), before.texture_count());
    assert!(bits(after) == bits(before), "vt and vn bit for bit");
}
