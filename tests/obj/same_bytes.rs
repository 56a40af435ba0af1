//! What holds of any bytes that are an OBJ file and a mesh, whatever is split in it.
//!
//! The fuzz targets `obj_read` and `obj_roundtrip` and the replay of their seeds use this.

use tearmesh::insert::Plan;
use tearmesh::{Cursor, FaceId, slide, split};
use tearmesh_obj::Document;

use super::work::{Work, read, rewritten};

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
    if document.mesh().is_err() {
        return false;
    }
    let mut work = Work::on(&document);
    for chunk in splits.chunks_exact(3).take(64) {
        let number = usize::from(chunk[0]) % work.mesh.vertex_count();
        let v = work.mesh.vertex(number);
        let mask = u16::from_le_bytes([chunk[1], chunk[2]]);
        let mut faces: Vec<FaceId> = work.mesh.faces_of(v).collect();
        faces.sort();
        let mut bit = 0..;
        faces.retain(|_| bit.next().is_some_and(|i: u32| mask >> (i % 16) & 1 == 1));
        // The empty and the full set are refused, and nothing has happened then.
        let _ = split::vertex(&mut work.mesh, v, &faces, &mut work.edits);
    }
    work.follow();
    assert_eq!(work.mesh.check(), []);

    let written = work.written();
    let again = read(&written);
    corners_are_the_same(&document, &work, &again);
    attributes_are_the_same(&document, &again);
    if work.edits.cursor() == Cursor::START {
        assert_eq!(again.triangles(), document.triangles());
        let vertices = |document: &Document| {
            let points = document.positions().iter().flat_map(|p| [p.x, p.y, p.z]);
            points.map(f64::to_bits).collect::<Vec<_>>()
        };
        assert!(vertices(&again) == vertices(&document), "positions");
    }
    assert_eq!(Work::on(&again).mesh.check(), []);
    assert_same(&rewritten(&written), &written);
    divide_and_mend(&document, work, splits);
    true
}

fn assert_same(one: &[u8], other: &[u8]) {
    assert_eq!(String::from_utf8_lossy(one), String::from_utf8_lossy(other));
    assert!(one == other, "the same bytes");
}

/// Slides and inserts where the bytes say; what is written is read and written again. Then all
/// is sewn and simplified, in a second session too.
fn divide_and_mend(document: &Document, mut work: Work<'_>, places: &[u8]) {
    work.torn.next_cut();
    slide_some(&mut work, places);
    let mut plan = Plan::new();
    for chunk in places.chunks_exact(3).take(16) {
        let place = usize::from(u16::from_le_bytes([chunk[1], chunk[2]]));
        if chunk[0] % 3 == 0 {
            let f = work.mesh.face(place % work.mesh.face_count());
            plan.in_face(f, [1.0, 1.0 + f64::from(chunk[0]), 2.0]);
        } else {
            let h = work.mesh.half_edge(place % work.mesh.half_edge_count());
            plan.on_edge(h, (1.0 + f64::from(chunk[0])) / 257.0);
        }
    }
    // Points at one place are refused, and nothing has happened then.
    let _ = plan.apply(&mut work.mesh, &mut work.edits);
    work.follow();
    let written = work.written();
    assert_same(&rewritten(&written), &written);
    let again = read(&written);
    let later = mended(Work::on(&again));
    let mended = mended(work);
    if !document.has_record() {
        assert_same(&mended, &Work::on(document).written());
    }
    if keeps_what_may_name_numbers(&mended) {
        let lines = |bytes: &[u8]| {
            let mut lines: Vec<Vec<u8>> =
                bytes.split(|&b| b == b'\n').map(<[u8]>::to_vec).collect();
            lines.sort();
            lines
        };
        assert!(
            lines(&later) == lines(&mended),
            "the same but for moved `v`"
        );
        return;
    }
    assert_same(&later, &mended);
}

/// Whether a file has a line that is kept as text and may name a vertex by its number. Numbers stay
/// as they are then, new vertices follow the last one, and a face that has one has all `v` before
/// it: another session does not know where these stood.
fn keeps_what_may_name_numbers(file: &[u8]) -> bool {
    let is_plain = |line: &[u8]| {
        let word = line
            .split(|b| b.is_ascii_whitespace())
            .find(|word| !word.is_empty());
        let word = word.unwrap_or_default();
        let words: [&[u8]; 14] = [
            b"v", b"vt", b"vn", b"f", b"o", b"g", b"s", b"usemtl", b"mtllib", b"mg", b"nl", b"ny",
            b"nv", b"vv",
        ];
        word.is_empty() || word.starts_with(b"#") || words.contains(&word)
    };
    !file.split(|&b| b == b'\n').all(is_plain)
}

/// Slides vertices, of which there are no copies, along edges.
fn slide_some(work: &mut Work<'_>, places: &[u8]) {
    let roots = work.mesh.roots();
    for chunk in places
        .chunks_exact(3)
        .take(16)
        .filter(|chunk| chunk[0] & 4 != 0)
    {
        let place = usize::from(u16::from_be_bytes([chunk[1], chunk[2]]));
        let h = work.mesh.half_edge(place % work.mesh.half_edge_count());
        let [vertex, toward] = [work.mesh.origin(h), work.mesh.target(h)];
        let root = roots[vertex.index()];
        if roots.iter().filter(|&&other| other == root).count() == 1 {
            let t = (1.0 + f64::from(chunk[0])) / 257.0;
            let (mesh, edits) = (&mut work.mesh, &mut work.edits);
            slide::toward(mesh, vertex, toward, t, edits).expect("an edge");
        }
    }
}

/// What is written once all is sewn and simplified.
fn mended(mut work: Work<'_>) -> Vec<u8> {
    work.sew_apart(&work.all_stitches(), f64::INFINITY);
    assert_eq!(work.torn.cuts(), []);
    work.simplest().0
}

/// Each corner of each triangle is where it was, bit for bit, and has its vt and vn.
fn corners_are_the_same(before: &Document, work: &Work<'_>, after: &Document) {
    let (mesh, positions) = (&work.mesh, &work.positions);
    assert_eq!(after.triangles().len(), before.triangles().len());
    assert_eq!(after.triangles().len(), mesh.face_count());
    for (f, triangle) in mesh.faces().zip(after.triangles()) {
        for (i, v) in mesh.face_vertices(f).into_iter().enumerate() {
            let (was, is) = (positions.at(v), after.positions()[triangle[i] as usize]);
            for axis in 0..3 {
                assert_eq!(is[axis].to_bits(), was[axis].to_bits(), "{v} of {f}");
            }
            // Not those of the root: in the file a copy may have numbers of its own.
            let was_at = before.triangles()[f.index()][i];
            let bits = |document: &Document, vertex: u32| {
                let numbers = document.extra_numbers(vertex as usize).iter();
                numbers.map(|x| x.to_bits()).collect::<Vec<_>>()
            };
            assert_eq!(bits(after, triangle[i]), bits(before, was_at), "{v} of {f}");
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
