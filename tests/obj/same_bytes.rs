//! What holds of any bytes that are an OBJ file and a mesh, whatever is split in it.
//!
//! The fuzz targets `obj_read` and `obj_roundtrip` and the replay of their seeds use this.

use tearmesh::insert::Plan;
use tearmesh::{Cursor, Edits, FaceId, Follower as _, Mesh, Positions, mend, slide, split};
use tearmesh_obj::{Document, TornDocument};

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
    let mut positions = positions(&document);
    let mut edits = Edits::new();
    for chunk in splits.chunks_exact(3).take(64) {
        let number = usize::from(chunk[0]) % mesh.vertex_count();
        let v = mesh.vertex(number);
        let mask = u16::from_le_bytes([chunk[1], chunk[2]]);
        let mut faces: Vec<FaceId> = mesh.faces_of(v).collect();
        faces.sort();
        let mut bit = 0..;
        faces.retain(|_| bit.next().is_some_and(|i: u32| mask >> (i % 16) & 1 == 1));
        // The empty and the full set are refused, and nothing has happened then.
        let _ = split::vertex(&mut mesh, v, &faces, &mut edits);
    }
    let mut torn = TornDocument::new(&document);
    edits.replay(&mut (&mut positions, &mut torn));
    assert_eq!(mesh.check(), []);

    let written = write_torn(&torn, &mesh, &positions);
    divide_and_mend(&document, mesh.clone(), positions.clone(), torn, splits);
    let again = Document::read(&written[..]).expect("what was written can be read");
    corners_are_the_same(&document, &mesh, &positions, &again);
    attributes_are_the_same(&document, &again);
    if edits.cursor() == Cursor::START {
        assert_eq!(again.triangles(), document.triangles());
        let vertices = |document: &Document| {
            let points = document.positions().iter().flat_map(|p| [p.x, p.y, p.z]);
            points.map(f64::to_bits).collect::<Vec<_>>()
        };
        assert!(vertices(&again) == vertices(&document), "positions");
    }
    let same = again.mesh().expect("what was written is a mesh");
    assert_eq!(same.check(), []);
    assert_same(&write(&again, &same, &self::positions(&again)), &written);
    true
}

fn positions(document: &Document) -> Positions {
    let points = document.positions().iter().copied();
    Positions::new(points).expect("the reader refuses other coordinates")
}

fn assert_same(one: &[u8], other: &[u8]) {
    assert_eq!(String::from_utf8_lossy(one), String::from_utf8_lossy(other));
    assert!(one == other, "the same bytes");
}

fn write(document: &Document, mesh: &Mesh, positions: &Positions) -> Vec<u8> {
    write_torn(&TornDocument::new(document), mesh, positions)
}

fn write_torn(torn: &TornDocument<'_>, mesh: &Mesh, positions: &Positions) -> Vec<u8> {
    let mut out = Vec::new();
    let done = torn.write(mesh, positions, &mut out);
    done.expect("a vector takes everything");
    out
}

/// Slides and inserts where the bytes say; what is written is read and written again. Then all
/// is sewn and simplified, in a second session too.
fn divide_and_mend(
    document: &Document,
    mut mesh: Mesh,
    mut positions: Positions,
    mut torn: TornDocument<'_>,
    places: &[u8],
) {
    torn.next_cut();
    let mut edits = Edits::new();
    slide_some(&mut mesh, places, &mut edits);
    let mut plan = Plan::new();
    for chunk in places.chunks_exact(3).take(16) {
        let place = usize::from(u16::from_le_bytes([chunk[1], chunk[2]]));
        if chunk[0] % 3 == 0 {
            let f = mesh.face(place % mesh.face_count());
            plan.in_face(f, [1.0, 1.0 + f64::from(chunk[0]), 2.0]);
        } else {
            let h = mesh.half_edge(place % mesh.half_edge_count());
            plan.on_edge(h, (1.0 + f64::from(chunk[0])) / 257.0);
        }
    }
    // Points at one place are refused, and nothing has happened then.
    let _ = plan.apply(&mut mesh, &mut edits);
    let mut torn = torn.starting_at(Cursor::START);
    let mut moving = positions.clone().starting_at(Cursor::START);
    edits.replay(&mut (&mut moving, &mut torn));
    positions = moving;
    let written = write_torn(&torn, &mesh, &positions);
    let again = Document::read(&written[..]).expect("what was written can be read");
    let same = again.mesh().expect("what was written is a mesh");
    let points = self::positions(&again);
    let twice = write_torn(&TornDocument::new(&again), &same, &points);
    assert_same(&twice, &written);
    let later = mended(TornDocument::new(&again), same, points);
    let mended = mended(
        torn.starting_at(Cursor::START),
        mesh,
        positions.starting_at(Cursor::START),
    );
    if !document.has_record() {
        let uncut = document.mesh().expect("it was one before");
        let uncut = write(document, &uncut, &self::positions(document));
        assert_same(&mended, &uncut);
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
fn slide_some(mesh: &mut Mesh, places: &[u8], edits: &mut Edits) {
    let mut copies = vec![0; mesh.vertex_count()];
    let roots = mesh.roots();
    for &root in &roots {
        copies[root as usize] += 1;
    }
    for chunk in places
        .chunks_exact(3)
        .take(16)
        .filter(|chunk| chunk[0] & 4 != 0)
    {
        let place = usize::from(u16::from_be_bytes([chunk[1], chunk[2]]));
        let h = mesh.half_edge(place % mesh.half_edge_count());
        let [vertex, toward] = [mesh.origin(h), mesh.target(h)];
        if copies[roots[vertex.index()] as usize] == 1 {
            let t = (1.0 + f64::from(chunk[0])) / 257.0;
            slide::toward(mesh, vertex, toward, t, edits).expect("an edge");
        }
    }
}

/// What is written once all is sewn and simplified.
fn mended(mut torn: TornDocument<'_>, mut mesh: Mesh, mut positions: Positions) -> Vec<u8> {
    let mut edits = Edits::new();
    let stitches = mend::stitches(&mesh, |_| true);
    mend::sew(
        &mut mesh,
        &positions,
        &stitches,
        |_| 1.0,
        f64::INFINITY,
        &mut edits,
    )
    .expect("all are of one root");
    edits.replay(&mut (&mut positions, &mut torn));
    assert_eq!(torn.cuts(), []);
    let simplified = torn.simplified(&mesh, &positions);
    match simplified.expect("it can be read").document {
        None => write_torn(&torn, &mesh, &positions),
        Some(simple) => {
            let mesh = simple.mesh().expect("a simplified mesh is one");
            write(&simple, &mesh, &self::positions(&simple))
        }
    }
}

/// Each corner of each triangle is where it was, bit for bit, and has its vt and vn.
fn corners_are_the_same(before: &Document, mesh: &Mesh, positions: &Positions, after: &Document) {
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
