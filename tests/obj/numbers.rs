//! Under which numbers vertices are written, and how they are found again.

use super::bodies::Sheets;
use super::random::Random;
use super::tables::with_record;
use super::work::Work;
use super::{read, rewritten, text};

/// Two objects, six faces round a vertex and a triangle.
const WHEEL: &str = "o wheel\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0 0\nv -1 -1 0\nv 0 -1 0\nv 0 0 0\n\
    f 7 1 2\nf 7 2 3\nf 7 3 4\nf 7 4 5\nf 7 5 6\nf 7 6 1\n\
    o tile\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 8 9 10\n";

/// What is written once two opposite faces of the wheel have a hub of their own: four fans, and so two copies. And
/// whether vertices are written in their order.
fn with_bow_ties(file: &str) -> (String, bool) {
    let document = read(file.as_bytes());
    let mut work = Work::on(&document);
    work.deeds("split 6 0 3");
    (text(&work.written()), work.in_order().is_sorted())
}

#[test]
fn copies_for_fans_are_counted_behind_their_object() {
    let (written, _) = with_bow_ties(WHEEL);
    let tile = written.find("o tile").expect("the second object");
    let of_wheel = written[..tile].matches("\nv ").count();
    assert_eq!(of_wheel, 14, "a new hub, and copies of both and of the rim");
    let again = read(written.as_bytes());
    let counts = [again.vertex_statement_count(), again.positions().len()];
    assert_eq!(counts, [17, 11], "copies are one with their vertices");
    let numbers: Vec<usize> = (0..11).map(|v| again.number_of_vertex(v)).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 5, 6, 7, 8, 15, 16, 17]);
    for (vertex, &number) in numbers.iter().enumerate() {
        assert_eq!(again.vertex_of_number(number), Some(vertex));
        let line = written.lines().nth(again.line_of_vertex(vertex) - 1);
        let [x, y, z] = <[f64; 3]>::from(again.positions()[vertex]);
        assert_eq!(line, Some(&*format!("v {x} {y} {z}")));
    }
    for item in written
        .lines()
        .filter_map(|line| line.strip_prefix("#~ fan "))
    {
        let (copy, of) = item.split_once(' ').expect("two numbers");
        let [copy, of] = [copy, of].map(|number| number.parse().expect("a number"));
        assert_eq!(again.vertex_of_number(copy), again.vertex_of_number(of));
    }
    let none = [0, 18].map(|number| again.vertex_of_number(number));
    assert_eq!(none, [None; 2]);
    assert_eq!(text(&rewritten(written.as_bytes())), written);
}

/// A line or an edge of another program names vertices by numbers that we do not change, so these
/// stay, and the vertices of the second object are moved up before the torn faces.
#[test]
fn vertices_that_statements_may_name_keep_numbers() {
    for statement in ["l 8 9", "p 8", "surf 0 1 0 1 8 9 10", "e 8 9"] {
        let file = format!("{WHEEL}{statement}\n");
        let (written, is_sorted) = with_bow_ties(&file);
        let vertices = |file: &str| {
            let lines = file.lines().filter(|line| line.starts_with("v "));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let (is, was) = (vertices(&written), vertices(&file));
        assert!(is.starts_with(&was), "{statement}");
        assert!(written.contains(&format!("f 8 9 10\n{statement}\n#tearmesh record 1 ")));
        assert_eq!(text(&rewritten(written.as_bytes())), written, "{statement}");
        assert!(is_sorted, "{statement}");
    }
    for statement in ["nl 2", "nv 8 9 10", "g 8 9", "# l 8 9", "vp 8 9"] {
        let (written, _) = with_bow_ties(&format!("{WHEEL}{statement}\n"));
        let is_renumbered = written.contains("f 15 16 17\n");
        assert!(is_renumbered, "{statement} names no vertex");
    }
}

/// Another program adds a line to a file whose second object counts on from the new vertices of the
/// first: these numbers have to stay, so nothing is mended, and that is said.
#[test]
fn a_line_added_to_a_torn_file_keeps_what_it_names() {
    let (written, _) = with_bow_ties(WHEEL);
    let file = written.replace("f 15 16 17\n", "f 15 16 17\nl 15 16\n");
    let again = read(file.as_bytes());
    let why = "this record is not used, since another program changed the file: `l` may";
    let mut said = again.diagnostics().iter();
    assert!(said.any(|one| one.message.starts_with(why)));
    let plain = text(&rewritten(file.as_bytes()));
    assert_eq!(file.split("#tearmesh").next(), Some(&*plain));
    // Where the new vertices are the last ones anyway, the record stays.
    let alone = WHEEL.split("o tile").next().expect("the first object");
    let (written, _) = with_bow_ties(alone);
    let file = written.replace("#tearmesh record", "l 1 2\n#tearmesh record");
    assert_eq!(text(&rewritten(file.as_bytes())), file);
}

/// What version 1 wrote: the second object's vertices before the torn face, new ones behind all.
#[test]
fn a_file_of_version_1_is_read_and_mended() {
    let body = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nv 5 0 0\nv 6 0 0\nv 5 1 0\n\
        v 1 0 0\nv 0 1 0\nf 9 8 4\no b\nf 5 6 7\n";
    let items = "#~ split 8 2 1\n#~ split 9 3 1\n";
    let file = with_record(body, "1", "vt 0 0 vn 0 0", items);
    let document = read(file.as_bytes());
    assert_eq!(document.diagnostics(), []);
    assert_eq!(text(&rewritten(file.as_bytes())), file);
    let mut work = Work::on(&document);
    work.sew(&work.torn.stitches_of_last(1));
    assert_eq!(
        text(&work.written()),
        "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nv 5 0 0\nv 6 0 0\nv 5 1 0\n\
         f 3 2 4\no b\nf 5 6 7\n"
    );
}

/// Whether all lines of a file are in another, in order, and between them new `v` and `vt` alone. Neighbouring
/// faces count as one, and the record does not.
fn has_all_lines(is: &str, was: &str) -> bool {
    let lines = |file: &str| {
        let body = file.split("#tearmesh").next().expect("a body");
        let lines = body
            .lines()
            .map(|l| if l.starts_with("f ") { "f" } else { l });
        let mut lines: Vec<String> = lines.map(str::to_owned).collect();
        lines.dedup_by(|one, other| one == "f" && other == "f");
        lines
    };
    let (is, was) = (lines(is), lines(was));
    let mut left = was.iter().peekable();
    let is_new = |line: &String| line.starts_with("v ") || line.starts_with("vt ");
    let mut is = is.iter();
    is.all(|line| left.next_if_eq(&line).is_some() || is_new(line)) && left.next().is_none()
}

/// A part of a cut is undone in another session, and all lines of the file that was never cut are still in
/// their places.
#[test]
fn mending_a_part_moves_no_line() {
    let mut parts = 0;
    for seed in 0..400 {
        let mut random = Random(77_000 + seed);
        let file = text(&rewritten(Sheets::random(&mut random).file.as_bytes()));
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        work.tear(&mut random, 3, false);
        work.torn.next_cut();
        for _ in 0..4 {
            work.split(&mut random);
        }
        let torn = text(&work.written());
        let again = read(torn.as_bytes());
        let mut later = Work::on(&again);
        let stitches = later.torn.stitches_of_last(1);
        let some: Vec<_> = stitches.iter().step_by(2).copied().collect();
        later.sew(&some);
        let mended = text(&later.written());
        let moves_none = has_all_lines(&mended, &file);
        assert!(moves_none, "seed {seed}:\n{torn}\n->\n{mended}");
        parts += usize::from(mended.len() < torn.len());
    }
    assert!(parts > 200, "{parts}");
}
