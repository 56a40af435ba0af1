//! Records that another program, or an accident, has changed: said by line, and never more.

use tearmesh::mend;

use super::digest;
use super::random::Random;
use super::support::cases::stride;
use super::tables::{TORN, with_record};
use super::work::{Work, exercise, files};
use super::{read, text};

/// What a record says of faces is not believed before the file is known to have them.
#[test]
fn regression_faces_that_a_file_has_not_take_no_memory() {
    let items = "#~ parent 1 4000000000 1 2 3\n#~ again 0 1 2 3 3999999999\n";
    let file = with_record(TORN, "4", "vt 0 0 vn 0 0", items).replace("f 3 ", "f 4000000000 ");
    let document = read(file.as_bytes());
    let message = &document.diagnostics()[0].message;
    assert!(message.ends_with("it had 4000000000 `f`, and has 3"));
}

#[test]
fn a_part_that_is_its_whole_parent_is_taken_out() {
    let items = "#~ split 5 2 1\n#~ split 6 3 1\n#~ edge 7 1 3 4 0.5\n#~ parent 2 3 3 2 4\n\
                 #~ again 0 3 2 4 2 3\n";
    let document = read(with_record(TORN, "4", "vt 0 0 vn 0 0", items).as_bytes());
    let undone = read(Work::on(&document).undone().as_bytes());
    assert_eq!(undone.triangles(), [[0, 1, 2], [2, 1, 3]]);
}

#[test]
fn positions_may_change_and_copies_that_part_are_vertices() {
    // Vertex 1 with two fans, as a finite cut leaves it.
    let file = "v 0 0 0 0.5\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nv 1 1 0\nv -1 -1 0\n\
                f 1 2 6\nf 1 6 3\nf 1 3 4\nf 1 4 7\nf 1 7 5\nf 1 5 2\n";
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("split 0 0 3");
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

#[test]
fn damaged_records_do_no_harm() {
    let (mut plain, mut forged) = (0, 0);
    let of_name = |name: &str| files().into_iter().find(|(other, _)| other == name);
    let seeds = (0..12 / stride() as u64)
        .map(|seed| ("late", seed))
        .chain([("quilt", 0), ("quilt", 1)]);
    for (name, seed) in seeds {
        let (_, bytes) = of_name(name).expect("a fixture");
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
            let mut points = work.positions.as_slice().to_vec();
            points
                .iter_mut()
                .step_by(5)
                .for_each(|point| point.z += 1.0);
            work.torn.set_apart(points);
        }
        let written = text(&work.written());
        let Some((body, record)) = written.split_once("#tearmesh record") else {
            continue;
        };
        let record = format!("#tearmesh record{record}");
        let lines: Vec<&str> = record.lines().collect();
        let file = |lines: &[&str]| format!("{body}{}\n", lines.join("\n"));
        let warned = |lines: &[&str]| {
            let file = file(lines);
            exercise(file.as_bytes());
            let document = read(file.as_bytes());
            let mut said = document.diagnostics().iter();
            said.any(|one| one.code == "W-OBJ-RECORD")
        };
        for (i, line) in lines.iter().enumerate() {
            let mut fewer = lines.clone();
            fewer.remove(i);
            assert!(warned(&fewer), "{name}: without {line}");
            if i > 0 {
                let mut swapped = lines.clone();
                swapped.swap(i - 1, i);
                assert!(warned(&swapped), "{name}: {line} too early");
            }
            plain += 2;
            for (at, digit) in line.bytes().enumerate().filter(|(_, b)| b.is_ascii_digit()) {
                let digit = (digit - b'0' + 1 + random.below(8) as u8) % 10;
                let line = format!("{}{digit}{}", &line[..at], &line[at + 1..]);
                let mut changed = lines.clone();
                changed[i] = &line;
                // In the first line the counts of texture coordinates and normals may be others.
                assert!(i == 0 || warned(&changed), "{name}: {line}");
                // The same by someone who knows the checksum.
                let items = &changed[1..lines.len() - 1];
                let hash = items.iter().flat_map(|item| item.bytes().chain([b'\n']));
                let hash = digest::after(digest::EMPTY, hash);
                let end = format!("#tearmesh end {} {hash:016x}", items.len());
                changed[lines.len() - 1] = &end;
                forged += usize::from(exercise(file(&changed).as_bytes()));
            }
        }
    }
    assert!(plain > 200 && forged > 200);
}
