//! Records that another program, or an accident, has changed: said by line, and never more.

use tearmesh::{FaceId, VertexId, mend, split};
use tearmesh_obj::Document;

use super::digest;
use super::random::Random;
use super::tables::{TORN, whole, with_record};
use super::work::{Work, files};
use super::{read, rewritten, text};

/// What a record says of faces is not believed before the file is known to have them.
#[test]
fn regression_faces_that_a_file_has_not_take_no_memory() {
    let items = "#~ parent 1 4000000000 1 2 3\n#~ again 0 1 2 3 3999999999\n";
    let file = with_record(TORN, "4", "vt 0 0 vn 0 0", items).replace("f 3 ", "f 4000000000 ");
    let document = read(file.as_bytes());
    let [warning] = document.diagnostics() else {
        panic!("one warning, not {:?}", document.diagnostics());
    };
    assert!(
        warning
            .message
            .ends_with("it had 4000000000 `f`, and has 3")
    );
}

#[test]
fn a_part_that_is_the_whole_of_its_parent_is_taken_out_with_it() {
    let file = whole(TORN).replace("record 1", "record 4");
    let items = file.lines().filter(|line| line.starts_with("#~"));
    let items: String = items.map(|line| format!("{line}\n")).collect();
    let items = items + "#~ again 0 3 2 4 2 3\n";
    let document = read(with_record(TORN, "4", "vt 0 0 vn 0 0", &items).as_bytes());
    let mut work = Work::on(&document);
    work.sew_all();
    let simplified = work.torn.simplified(&work.mesh, &work.positions);
    let simple = simplified.expect("what we wrote").document;
    let simple = simple.expect("all goes");
    assert_eq!(simple.triangles(), [[0, 1, 2], [2, 1, 3]]);
}

#[test]
fn positions_may_change_and_copies_that_part_are_vertices() {
    // Vertex 1 with two fans, as a finite cut leaves it.
    let file = "v 0 0 0 0.5\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 1 0\nv -1 -1 0\n\
                f 1 2 6\nf 1 6 3\nf 1 3 4\nf 1 4 7\nf 1 7 5\nf 1 5 2\n";
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    let faces = [0, 3].map(|f| FaceId::new(f).expect("small"));
    let v = VertexId::new(0).expect("small");
    work.edit(|mesh, _, edits| {
        split::vertex(mesh, v, &faces, edits).expect("a split");
    });
    let written = text(&work.written());
    assert_eq!(read(written.as_bytes()).mesh().as_ref(), Ok(&work.mesh));

    let moved = written.replace("v 0 0 0 0.5\n", "v 0 0 7 0.5\n");
    let again = read(moved.as_bytes());
    assert!(again.diagnostics().is_empty());
    assert_eq!(again.mesh().as_ref(), Ok(&work.mesh));
    assert_eq!(again.positions()[7], [0.0, 0.0, 7.0].into());

    let at = written.rfind("v 0 0 0 0.5\n").expect("a copy");
    let moved = format!("{}v 0 0 9 0.5\n{}", &written[..at], &written[at + 12..]);
    let copy = written[..at].matches("v ").count() + 1;
    let of = written.split(&format!("#~ fan {copy} ")).nth(1);
    let of = of.expect("the copy is on record").lines().next();
    let again = read(moved.as_bytes());
    let said = again.diagnostics().iter().map(|one| &one.message[..]);
    let of = of.expect("a vertex");
    let message = format!(
        "`v` {copy} was a copy of {of} and has moved away from it: it is now a separate vertex"
    );
    assert_eq!(said.collect::<Vec<_>>(), [&message[..]]);
    let mut work = Work::on(&again);
    let count = work.mesh.vertex_count();
    assert_eq!(count, read(written.as_bytes()).positions().len() + 1);
    assert_eq!(again.extra_numbers(count - 1), [0.5]);
    assert!(exercise(moved.as_bytes()));
    assert_eq!(work.torn.cuts(), [1]);
    work.sew_apart(&mend::stitches(&work.mesh, |_| true), 99.0);
    assert_eq!(Ok(&work.mesh), document.mesh().as_ref());
}

fn is_of_record(line: &str) -> bool {
    ["#tearmesh record", "#~ ", "#tearmesh end"]
        .iter()
        .any(|start| line.starts_with(start))
}

/// Everything that can be done with a file, whatever its record says.
pub(crate) fn exercise(bytes: &[u8]) -> bool {
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
    if !document.has_record() && lines(bytes) > 0 && lines(&written) == 0 {
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
    work.sew_apart(&work.torn.stitches_of_last(1), f64::INFINITY);
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
    work.slide(1, 3, 0.5);
    let written = text(&work.written());
    assert_eq!(
        written.split("#tearmesh").next(),
        Some(
            "v 0 0 0\nv 1 0.5 0 0.75\nv 0 1 0\nv 1 1 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 9\nvt 1 0.5\n\
             f 1/1 2/6 3/3\nf 3/3 2/6 4/4\n"
        )
    );
}
