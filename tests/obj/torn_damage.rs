//! Records that another program, or an accident, has changed: said by line, and never more.

use tearmesh::{Edits, FaceId, Mesh, VertexId, mend, slide};
use tearmesh_obj::{Diagnostic, Document, Level};

use super::digest;
use super::random::Random;
use super::torn_record::{Work, files};
use super::{positions, read, rewritten, text};

/// The hash of faces: the number of vertices, then the corners.
pub(crate) fn hash_of_faces(numbers: &[u64]) -> u64 {
    let mut bytes = numbers[0].to_le_bytes().to_vec();
    bytes.extend(numbers[1..].iter().flat_map(|&v| (v as u32).to_le_bytes()));
    digest::after(digest::EMPTY, bytes)
}

/// Two triangles torn apart at vertices 2 and 3, with a vertex on the edge 3-4 of the second.
const TORN: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0.5 1 0\n\
    f 1 2 3\nf 7 6 5\nf 7 5 4\n";

const HEADER: &str = "#tearmesh record 1 v 7 f 3 vt 0 0 vn 0 0 faces ";

fn record(items: &str) -> String {
    let corners = [7, 0, 1, 2, 6, 5, 4, 6, 4, 3];
    let faces = hash_of_faces(&corners);
    let (count, items_hash) = (
        items.lines().count(),
        digest::after(digest::EMPTY, items.bytes()),
    );
    format!("{HEADER}{faces:016x}\n{items}#tearmesh end {count} {items_hash:016x}\n")
}

const ITEMS: &str = "#~ split 5 2 1\n#~ split 6 3 1\n#~ edge 7 1 3 4 0.5\n#~ parent 2 3 3 2 4\n";

#[track_caller]
fn warns(file: &str, code: &str, place: (usize, usize), message: &str) -> Document {
    let document = read(file.as_bytes());
    let [warning]: &[Diagnostic; 1] = document.diagnostics().try_into().unwrap_or_else(|_| {
        panic!("one warning, not {:?}\n{file}", document.diagnostics());
    });
    let at = warning.location.map(|at| (at.line, at.column));
    assert_eq!((warning.level, warning.code), (Level::Warning, code));
    assert_eq!(
        (warning.message.as_str(), at),
        (message, Some(place)),
        "{file}"
    );
    document
}

fn is_plain(document: &Document) {
    let triangles = document.triangles();
    assert_eq!(document.mesh(), {
        let plain = Mesh::build(document.positions().len(), triangles);
        Ok(plain.expect("each fan has its own vertex"))
    });
}

#[test]
fn a_record_that_fits_is_taken_in() {
    let file = format!("{TORN}{}", record(ITEMS));
    let document = read(file.as_bytes());
    assert!(
        document.diagnostics().is_empty(),
        "{:?}",
        document.diagnostics()
    );
    let mesh = document.mesh().expect("two triangles");
    assert_eq!(mesh.roots(), [0, 1, 2, 3, 1, 2, 6]);
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

#[test]
fn what_is_wrong_with_a_record_is_said_by_line_and_column() {
    let bad_line = |items: &str, place, message| {
        is_plain(&warns(
            &format!("{TORN}{}", record(items)),
            "W-OBJ-RECORD",
            place,
            message,
        ));
    };
    let range = "a number of this record is out of its range";
    bad_line("#~ split 5 6 1\n", (12, 12), range);
    bad_line("#~ split 8 2 1\n", (12, 10), range);
    bad_line("#~ split 5 2 0\n", (12, 14), range);
    bad_line("#~ split 5 2\n", (12, 13), range);
    bad_line(
        "#~ split 5 2 1 1\n",
        (12, 16),
        "this line of a record has extra words",
    );
    bad_line(
        "#~ splat 5 2 1\n",
        (12, 4),
        "this record has no line `splat` here",
    );
    bad_line("#~\n", (12, 3), "this record has no line `` here");
    bad_line(
        "#~ parent 2 3 3 2 4\n#~ split 5 2 1\n",
        (13, 4),
        "this record has no line `split` here",
    );
    bad_line(
        "#~ split 5 2 1\n#~ edge 5 1 3 4 0.5\n",
        (13, 9),
        "vertex 5 was split from 2",
    );
    bad_line("#~ edge 7 1 3 4 1\n", (12, 17), range);
    bad_line("#~ edge 7 1 3 4 x\n", (12, 17), "cannot read number `x`");
    bad_line("#~ face 7 1 3 4 1 0 0.5 0.5\n", (12, 19), range);
    bad_line(
        "#~ edge 7 1 3 4 .5\n#~ edge 7 1 3 4 .5\n",
        (13, 9),
        "vertices of this record are not in order",
    );
    bad_line(
        "#~ parent 2 3 3 3 4\n",
        (12, 15),
        "a face of this record has a vertex twice",
    );
    bad_line("#~ parent 2 4 3 2 4\n", (12, 13), range);
    bad_line(
        "#~ fan 5 2\n",
        (13, 1),
        "the copies of this record are not the last vertices",
    );
    bad_line("#~ fan 7 2\n#~ fan 8 2\n", (13, 8), range);
    bad_line(
        "#~ fan 7 6\n",
        (11, 1),
        "this record is not used: it joins corners of a face",
    );

    let file = format!("{TORN}{}", record(ITEMS));
    let bad = |from: &str, to: &str, place, message: &str| {
        let changed = file.replacen(from, to, 1);
        assert_ne!(changed, file);
        let document = warns(&changed, "W-OBJ-RECORD", place, message);
        is_plain(&document);
        // What is left out is not written, and so not warned of again.
        let again = rewritten(changed.as_bytes());
        assert_eq!(rewritten(&again), again);
        assert!(read(&again).diagnostics().is_empty());
    };
    let others = "this record is not used, since another program changed the file: ";
    bad(
        "record 1",
        "record 5",
        (11, 18),
        "this record is of a later version, and not used",
    );
    bad(
        "record 1",
        "record",
        (11, 18),
        "this record has `v` where `1` should be",
    );
    bad(
        "f 7 5 4",
        "f 5 4 7",
        (11, 1),
        &format!("{others}its faces are others"),
    );
    bad(
        "f 7 5 4\n",
        "",
        (10, 1),
        &format!("{others}it had 3 `f`, and has 2"),
    );
    bad(
        "f 1",
        "v 0 0 9\nf 1",
        (12, 1),
        &format!("{others}it had 7 `v`, and has 8"),
    );
    bad(
        " vn",
        " xn",
        (11, 35),
        "this record has `xn` where `vn` should be",
    );
    let sum = file.split("faces ").nth(1).expect("a sum")[..16].to_owned();
    bad(
        "faces ",
        "faces g",
        (11, 48),
        &format!("`g{sum}` is no checksum"),
    );
    bad(
        "#tearmesh end",
        "# the end",
        (11, 1),
        "this record has no end, and is not used",
    );
    bad(
        "0.5\n",
        "0.25\n",
        (16, 17),
        "a line of this record was changed",
    );
    bad(
        "end 4",
        "end 5",
        (16, 15),
        "lines of this record are missing or were added",
    );
    let joined = format!("{file}{}", record(ITEMS));
    warns(
        &joined,
        "W-OBJ-RECORD",
        (17, 1),
        "this file has two records, and neither is used",
    );
    let orphan = format!("{TORN}#tearmesh end 0 0123456789abcdef\n");
    warns(
        &orphan,
        "W-OBJ-RECORD",
        (11, 1),
        "a record ends here that has not begun",
    );
    let comment = "v 0 0 0 #tearmesh end\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    warns(
        comment,
        "W-OBJ-RECORD",
        (1, 9),
        "a record ends here that has not begun",
    );
    let lonely = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\n";
    let faces = hash_of_faces(&[4, 0, 1, 2]);
    let items = "#~ split 4 1 1\n";
    let lonely = format!(
        "{lonely}#tearmesh record 1 v 4 f 1 vt 0 0 vn 0 0 faces {faces:016x}\n{items}\
         #tearmesh end 1 {:016x}\n",
        digest::after(digest::EMPTY, items.bytes())
    );
    let message = "this record is not used: it splits vertices without faces";
    warns(&lonely, "W-OBJ-RECORD", (6, 1), message);
}

/// What a record says of faces is not believed before the file is known to have them.
#[test]
fn regression_faces_that_a_file_has_not_take_no_memory() {
    let items = "#~ parent 1 4000000000 1 2 3\n#~ again 0 1 2 3 3999999999\n";
    let hash = digest::after(digest::EMPTY, items.bytes());
    let file = format!(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\
         #tearmesh record 4 v 3 f 4000000000 vt 0 0 vn 0 0 faces {hash:016x}\n{items}\
         #tearmesh end 2 {hash:016x}\n",
    );
    let message = "this record is not used, since another program changed the file: \
                   it had 4000000000 `f`, and has 1";
    is_plain(&warns(&file, "W-OBJ-RECORD", (5, 1), message));
}

/// Copies anywhere, and lists of what was inserted.
#[test]
fn what_version_2_adds_is_checked_as_well() {
    let second = |items: &str, counts: &str| {
        let record = record(items).replace("record 1", "record 2");
        format!("{TORN}{}", record.replace("vt 0 0", counts))
    };
    let range = "a number of this record is out of its range";
    for (items, place, message) in [
        (
            "#~ split 5 2 1\n#~ fan 5 2\n",
            (13, 8),
            "a copy of this record was split off",
        ),
        (
            "#~ fan 5 2\n#~ fan 6 5\n",
            (13, 10),
            "this record has a copy of a copy",
        ),
        ("#~ fan 6 3\n#~ fan 5 2\n", (13, 8), range),
        ("#~ fan 5 6\n", (12, 10), range),
        (
            "#~ fan 5 2\n#~ edge 5 1 3 4 0.5\n",
            (13, 9),
            "vertex 5 is a copy",
        ),
        (
            "#~ split 6 5 1\n#~ fan 5 2\n",
            (11, 1),
            "this record is not used: it splits a copy",
        ),
        ("#~ vt 1 1\n", (12, 7), range),
        ("#~ vn 1 1\n", (12, 7), range),
    ] {
        let file = second(items, "vt 0 0");
        is_plain(&warns(&file, "W-OBJ-RECORD", place, message));
    }
    let uneven = "this record has a slide with different counts of numbers before and after";
    let large = "this record has a coordinate that is too large";
    let nothing = "this record has corners here without a vertex that slid";
    let more = "this line of a record has extra words";
    for (items, place, message) in [
        ("#~ vt 2 1\n", (12, 9), range),
        ("#~ vt 1 1\n#~ vt 2 2\n", (13, 7), range),
        ("#~ vt 3 3\n#~ vt 1 1\n", (13, 7), range),
        (
            "#~ vt 1 2\n",
            (13, 1),
            "the counts of this record do not match its lines",
        ),
        ("#~ vn 1 1\n#~ vt 1 1\n", (12, 7), range),
        ("#~ slide 8 1 0 0 0 1 0 0\n", (12, 10), range),
        ("#~ slide 7 0 0 0 0 1 0 0\n", (12, 12), range),
        (
            "#~ slide 7 2 0 0 0 1 0 0\n#~ slide 7 1 1 0 0 2 0 0\n",
            (13, 12),
            range,
        ),
        ("#~ slide 7 1 0 0 0 1 0\n", (12, 13), uneven),
        ("#~ slide 7 1 0 0 1 0\n", (12, 13), uneven),
        ("#~ slide 7 1 0 0 0 1 0 1e80\n", (12, 13), large),
        (
            "#~ slide 7 1 0 0 x 1 0 0\n",
            (12, 18),
            "cannot read number `x`",
        ),
        (
            "#~ fan 5 2\n#~ slide 5 1 0 0 0 1 0 0\n",
            (13, 10),
            "vertex 5 is a copy",
        ),
        ("#~ slide-vt 3 1 0.5\n", (12, 12), nothing),
        (
            "#~ slide 7 1 0 0 0 1 0 0\n#~ slide-vt 3 3 0\n",
            (13, 12),
            nothing,
        ),
        (
            "#~ slide 7 1 0 0 0 1 0 0\n#~ slide-vt 4 1 0\n",
            (13, 13),
            range,
        ),
        (
            "#~ slide 7 1 0 0 0 1 0 0\n#~ slide-vn 1 1 0\n",
            (13, 13),
            range,
        ),
        (
            "#~ slide 7 1 0 0 0 1 0 0\n#~ slide-vt 3 1 0 0 0 0\n",
            (13, 23),
            more,
        ),
    ] {
        let file = second(items, "vt 2 3");
        is_plain(&warns(&file, "W-OBJ-RECORD", place, message));
    }
    let first = format!("{TORN}{}", record("#~ vt 1 1\n"));
    let message = "this record has no line `vt` here";
    is_plain(&warns(&first, "W-OBJ-RECORD", (12, 4), message));
    // In this version copies stand anywhere behind their vertex.
    let file = second("#~ fan 5 2\n#~ fan 6 3\n", "vt 0 0");
    let document = read(file.as_bytes());
    assert!(
        document.diagnostics().is_empty(),
        "{:?}",
        document.diagnostics()
    );
    assert_eq!(document.triangles(), [[0, 1, 2], [4, 2, 1], [4, 1, 3]]);
}

#[test]
fn positions_may_change_and_copies_that_part_are_vertices() {
    // Vertex 1 with two fans, as a finite cut leaves it.
    let file = "v 0 0 0 0.5\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 1 0\nv -1 -1 0\n";
    let document =
        read(format!("{file}f 1 2 6\nf 1 6 3\nf 1 3 4\nf 1 4 7\nf 1 7 5\nf 1 5 2\n").as_bytes());
    let mut work = Work::on(&document);
    let faces = [0, 3].map(|f| FaceId::new(f).expect("small"));
    let v = VertexId::new(0).expect("small");
    let mut edits = Edits::new();
    tearmesh::split::vertex(&mut work.mesh, v, &faces, &mut edits).expect("a split");
    edits.replay(&mut (&mut work.positions, &mut work.torn));
    let written = text(&work.written());
    let again = read(written.as_bytes());
    assert_eq!(again.mesh().as_ref(), Ok(&work.mesh));

    let moved = written.replace("v 0 0 0 0.5\n", "v 0 0 7 0.5\n");
    let again = read(moved.as_bytes());
    assert!(again.diagnostics().is_empty());
    assert_eq!(again.mesh().as_ref(), Ok(&work.mesh));
    assert_eq!(again.positions()[7], [0.0, 0.0, 7.0].into());

    let at = written.rfind("v 0 0 0 0.5\n").expect("a copy");
    let line = written[..at].lines().count() + 1;
    let moved = format!("{}v 0 0 9 0.5\n{}", &written[..at], &written[at + 12..]);
    let copy = written[..at]
        .lines()
        .filter(|line| line.starts_with("v "))
        .count()
        + 1;
    let [of] = written
        .lines()
        .filter_map(|line| line.strip_prefix(&format!("#~ fan {copy} ")))
        .collect::<Vec<_>>()[..]
    else {
        panic!("the copy is on record");
    };
    let message = format!(
        "`v` {copy} was a copy of {of} and has moved away from it: it is now a separate vertex"
    );
    let again = warns(&moved, "W-OBJ-RECORD-MOVED", (line, 1), &message);
    let mesh = again.mesh().expect("a torn mesh");
    assert_eq!(mesh.vertex_count(), work.mesh.vertex_count() + 1);
    assert_eq!(again.extra_numbers(mesh.vertex_count() - 1), [0.5]);
    assert!(mesh.check().is_empty());
    let bytes = rewritten(moved.as_bytes());
    assert_eq!(rewritten(&bytes), bytes);
    let mut work = Work::on(&again);
    assert_eq!(work.torn.cuts(), [1]);
    let all = mend::stitches(&work.mesh, |_| true);
    let mut edits = Edits::new();
    mend::sew(
        &mut work.mesh,
        &work.positions,
        &all,
        |_| 1.0,
        99.0,
        &mut edits,
    )
    .expect("one root");
    assert_eq!(Ok(&work.mesh), document.mesh().as_ref());
}

fn is_of_record(line: &str) -> bool {
    ["#tearmesh record", "#~ ", "#tearmesh end"]
        .iter()
        .any(|start| line.starts_with(start))
}

#[test]
fn regression_the_lines_of_a_damaged_record_are_said_to_be_left_out() {
    let whole = record(ITEMS);
    for (damaged, lines) in [
        (whole.replace("#~ split 5 2 1", "#~ split 5 6 1"), 6),
        (whole.replace("record 1", "record 5"), 6),
        (whole.replace("#~ edge 7 1 3 4 0.5", "#~ edge 7 1 3 4 x"), 6),
        (whole.replace("v 7 f 3", "v 8 f 3"), 6),
        (
            whole
                .lines()
                .take(3)
                .map(|line| format!("{line}\n"))
                .collect(),
            3,
        ),
        (format!("{whole}{whole}"), 12),
    ] {
        let file = format!("{TORN}{damaged}");
        assert_eq!(
            file.lines().filter(|line| is_of_record(line)).count(),
            lines
        );
        assert!(exercise(file.as_bytes()));
    }
}

/// Everything that can be done with a file, whatever its record says.
fn exercise(bytes: &[u8]) -> bool {
    let Ok(document) = Document::read(bytes) else {
        return false;
    };
    let Ok(mesh) = document.mesh() else {
        return false;
    };
    assert!(mesh.check().is_empty());
    let written = rewritten(bytes);
    // What is left out is said to be.
    let lines = |bytes: &[u8]| {
        text(bytes)
            .lines()
            .filter(|line| is_of_record(line))
            .count()
    };
    if lines(&written) == 0 && lines(bytes) > 0 {
        let helps = document
            .diagnostics()
            .iter()
            .filter_map(|one| one.help.as_ref());
        let said = helps
            .filter(|help| help.contains("will not be written again"))
            .count();
        assert_eq!(said, 1, "{:?}\n{}", document.diagnostics(), text(bytes));
    }
    assert_eq!(text(&rewritten(&written)), text(&written));
    let mut work = Work::on(&document);
    let stitches = work.torn.stitches_of_last(1);
    let positions = positions(&document);
    let mut edits = Edits::new();
    mend::sew(
        &mut work.mesh,
        &positions,
        &stitches,
        |_| 1.0,
        f64::INFINITY,
        &mut edits,
    )
    .expect("the stitches are of one root");
    edits.replay(&mut (&mut work.positions, &mut work.torn));
    let simplified = work.torn.simplified(&work.mesh, &work.positions);
    if let Some(simple) = simplified.ok().and_then(|one| one.document) {
        let _refused = simple.mesh().is_ok();
    }
    true
}

#[test]
fn damaged_records_do_no_harm() {
    let (mut used, mut plain, mut forged) = (0, 0, 0);
    for (name, bytes) in files()
        .into_iter()
        .filter(|(name, _)| name == "late" || name == "quilt")
    {
        for seed in 0..if name == "late" { 12 } else { 2 } {
            let mut random = Random(seed);
            let document = read(&bytes);
            let mut work = Work::on(&document);
            for _ in 0..2 {
                if seed % 2 == 1 {
                    work.cut_sliding(&mut random);
                }
                work.tear(&mut random, 8, true);
                work.torn.next_cut();
            }
            if seed % 3 == 0 {
                let points = work.positions.as_slice().iter().enumerate();
                let lifted = points.map(|(i, p)| [p.x, p.y, p.z + f64::from(u8::from(i % 5 == 0))]);
                work.torn.set_apart(lifted.map(Into::into).collect());
            }
            let written = text(&work.written());
            let Some(start) = written.find("#tearmesh record") else {
                continue;
            };
            let (body, record) = written.split_at(start);
            let lines: Vec<&str> = record.lines().collect();
            let warned = |lines: &[&str]| {
                let file = format!("{body}{}\n", lines.join("\n"));
                let document = read(file.as_bytes());
                exercise(file.as_bytes());
                document
                    .diagnostics()
                    .iter()
                    .any(|one| one.code == "W-OBJ-RECORD")
            };
            for i in 0..lines.len() {
                let mut fewer = lines.clone();
                fewer.remove(i);
                assert!(warned(&fewer), "{name}: without {}", lines[i]);
                let mut swapped = lines.clone();
                if i > 0 {
                    swapped.swap(i - 1, i);
                    assert!(warned(&swapped), "{name}: {} too late", lines[i - 1]);
                }
                plain += 2;
                for (at, digit) in lines[i]
                    .bytes()
                    .enumerate()
                    .filter(|(_, b)| b.is_ascii_digit())
                {
                    let mut line = lines[i].to_owned().into_bytes();
                    line[at] = b'0' + (digit - b'0' + 1 + random.below(8) as u8) % 10;
                    let line = String::from_utf8(line).expect("ASCII");
                    let mut changed = lines.clone();
                    changed[i] = &line;
                    let counts_of_texture = i == 0 && !warned(&changed);
                    assert!(counts_of_texture || warned(&changed), "{name}: {line}");
                    used += usize::from(counts_of_texture);
                    // The same by someone who knows the checksum.
                    let items: String = changed[1..lines.len() - 1]
                        .iter()
                        .map(|line| format!("{line}\n"))
                        .collect();
                    let end = format!(
                        "#tearmesh end {} {:016x}",
                        lines.len() - 2,
                        digest::after(digest::EMPTY, items.bytes())
                    );
                    *changed.last_mut().expect("an end") = &end;
                    let file = format!("{body}{}\n", changed.join("\n"));
                    forged += usize::from(exercise(file.as_bytes()));
                }
            }
        }
    }
    println!("{plain} damaged, {used} with other counts of vt or vn, {forged} forged");
    assert!(plain > 200 && forged > 200);
}

#[test]
fn a_vertex_that_slides_takes_its_corners_with_it() {
    let file = b"v 0 0 0\nv 1 0 0 0.5\nv 0 1 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 9\n\
f 1/1 2/2 3/3\nf 3/3 2/2 4/4\n";
    let document = read(file);
    let mut work = Work::on(&document);
    let [one, other] = [1, 3].map(|v| VertexId::new(v).expect("small"));
    let mut edits = Edits::new();
    slide::toward(&work.mesh, one, other, 0.5, &mut edits).expect("an edge");
    edits.replay(&mut (&mut work.positions, &mut work.torn));
    let written = text(&work.written());
    assert_eq!(
        written.split("#tearmesh").next(),
        Some(
            "v 0 0 0\nv 1 0.5 0 0.75\nv 0 1 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 9\nvt 1 0.5\n\
             f 1/1 2/6 3/3\nf 3/3 2/6 4/4\n"
        )
    );
}

#[test]
fn what_version_4_adds_is_checked_as_well() {
    let range = "a number of this record is out of its range";
    let file = |version: &str, items: &str| {
        let record = record(&format!("{ITEMS}{items}"));
        format!("{TORN}{}", record.replace("record 1", version))
    };
    for (items, message) in [
        ("#~ again 1 3 2 4 2\n", range),
        ("#~ again 0 3 2 4 3 2\n", range),
        ("#~ again 0 3 2 4 4\n", range),
        ("#~ again 0 5 2 4 2\n", "vertex 5 was split from 2"),
        (
            "#~ again 0 3 2 3 2\n",
            "a face of this record has a vertex twice",
        ),
        (
            "#~ again 0 3 2 4 2\n#~ again 1 3 2 4 2\n",
            "this record has a face in two that were divided again",
        ),
        (
            "#~ again 0 3 2 4 1 2\n",
            "this record is not used: it divides a face of two parents",
        ),
        ("#~ again 0 3 2 4 x\n", range),
    ] {
        let document = read(file("record 4", items).as_bytes());
        let messages = document.diagnostics().iter().map(|one| &one.message[..]);
        assert_eq!(messages.collect::<Vec<_>>(), [message], "{items}");
        is_plain(&document);
    }
    let item = "#~ again 0 3 2 4 2 3\n";
    let document = read(file("record 3", item).as_bytes());
    let message = "this record has no line `again` here";
    assert_eq!(document.diagnostics()[0].message, message);
    // One that is the whole of its parent is odd, and does no harm.
    let document = read(file("record 4", item).as_bytes());
    assert_eq!(document.diagnostics(), []);
    let mut work = Work::on(&document);
    assert_eq!(text(&work.written()), text(&rewritten(&work.written())));
    work.sew_all();
    let simplified = work.torn.simplified(&work.mesh, &work.positions);
    let simple = simplified.expect("what we wrote").document;
    assert_eq!(
        simple.expect("all goes").triangles(),
        [[0, 1, 2], [2, 1, 3]]
    );
}
