//! Files of several objects, torn and divided, line by line: no line moves.
//!
//! A new vertex stands behind those of the object whose vertex it was, so the numbers of the
//! objects behind it change, and nothing else of them does.

use super::random::Random;
use super::torn_record::Work;
use super::{read, rewritten, text};

/// How a file of several objects is made.
#[derive(Clone, Copy)]
pub(crate) struct Style {
    pub(crate) objects: usize,
    /// The vertices of all objects first, each under its `o`; or those of each before its faces.
    pub(crate) heads_first: bool,
    /// Texture coordinates and normals, of each object its own.
    pub(crate) texture: bool,
    /// Comments between vertices and behind them.
    pub(crate) comments: bool,
    /// Faces that hang each object to the one before.
    pub(crate) joined: bool,
}

impl Style {
    pub(crate) fn of_seed(seed: usize) -> Style {
        Style {
            objects: 1 + seed % 4,
            heads_first: (seed / 4).is_multiple_of(3),
            texture: (seed / 12).is_multiple_of(2),
            comments: (seed / 24).is_multiple_of(2),
            joined: (seed / 48).is_multiple_of(2),
        }
    }

    /// Strips of triangles, an object each.
    pub(crate) fn file(self) -> String {
        let (mut heads, mut file) = (String::new(), String::from("# a scene\n"));
        for object in 0..self.objects {
            let mut head = format!("o object{object}\n");
            let mut textures = String::new();
            for i in 0..8 {
                if self.comments && i % 3 == 1 {
                    head += &format!("# vertex {i} of {object}\n");
                }
                head += &format!("v {} {} {object}", i / 2, i % 2);
                head += if self.comments && i % 4 == 2 {
                    " # said of it\n"
                } else {
                    "\n"
                };
                if self.texture {
                    textures += &format!("vt {} {}\n", i / 2, i % 2);
                }
            }
            head += &textures;
            if self.texture {
                head += &format!("vn 0 0 1\nvn 0 {object} 1\n");
            }
            let mut faces = format!("# faces of {object}\ng part{object}\nusemtl m{object}\n");
            for i in 0..6 {
                if i == 3 {
                    faces += "s off\n# the second half\n";
                }
                let [a, b, c] = if i % 2 == 0 {
                    [i, i + 2, i + 1]
                } else {
                    [i, i + 1, i + 2]
                };
                let corner = |v: usize| {
                    let number = 8 * object + v + 1;
                    match self.texture {
                        true => format!("{number}/{number}/{}", 2 * object + 1 + v % 2),
                        false => number.to_string(),
                    }
                };
                faces += &format!("f {} {} {}\n", corner(a), corner(b), corner(c));
            }
            if self.joined && object > 0 {
                // Two triangles between the end of one object and the start of the other.
                let [a, b, c, d] = [8 * object, 8 * object - 1, 8 * object + 1, 8 * object + 2];
                faces += &format!("f {a} {b} {c}\nf {a} {c} {d}\n");
            }
            if self.heads_first {
                heads += &head;
                file += &faces;
            } else {
                file += &(head + &faces);
            }
        }
        heads + &file
    }
}

/// The lines of a file without its record, all neighbouring faces as one.
pub(crate) fn skeleton(file: &str) -> Vec<&str> {
    let body = file.split("#tearmesh").next().expect("a body");
    let mut lines: Vec<&str> = Vec::new();
    for line in body.lines() {
        let line = if line.starts_with("f ") { "f" } else { line };
        if line != "f" || lines.last() != Some(&"f") {
            lines.push(line);
        }
    }
    lines
}

/// The lines that were added to those of a file, all of which stay in their order.
pub(crate) fn added<'l>(was: &[&str], is: &[&'l str]) -> Option<Vec<&'l str>> {
    let mut was = was.iter().peekable();
    let added = is.iter().filter(|line| was.next_if_eq(line).is_none());
    let added = added.copied().collect();
    was.next().is_none().then_some(added)
}

/// No face comes before the vertices, texture coordinates and normals that it names.
fn assert_in_order(file: &str) {
    let mut counts = [0, 0, 0];
    for line in file.lines() {
        let mut words = line.split(' ');
        match words.next() {
            Some("v") => counts[0] += 1,
            Some("vt") => counts[1] += 1,
            Some("vn") => counts[2] += 1,
            Some("f") => {
                for (which, index) in words.flat_map(|corner| corner.split('/').enumerate()) {
                    let index: usize = index.parse().expect("an index");
                    assert!(index <= counts[which], "{line} comes too early in\n{file}");
                }
            }
            _ => {}
        }
    }
}

#[test]
fn no_line_moves_but_faces_are_divided_and_renumbered() {
    let (mut torn, mut longer) = (0, 0);
    for seed in 0..480 {
        let mut random = Random(seed as u64);
        let style = Style::of_seed(seed);
        let file = text(&rewritten(style.file().as_bytes()));
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        work.tear(&mut random, 1 + seed % 5, true);
        let written = text(&work.written());
        assert_in_order(&written);
        let (was, is) = (skeleton(&file), skeleton(&written));
        let added = added(&was, &is).unwrap_or_else(|| panic!("seed {seed}:\n{written}"));
        for line in &added {
            let is_new = ["v ", "vt ", "vn "]
                .iter()
                .any(|start| line.starts_with(start));
            assert!(is_new, "seed {seed}: {line} was not there\n{written}");
        }
        torn += usize::from(written.contains("#tearmesh"));
        longer += usize::from(!added.is_empty());
        // Undone in another session, it is the file that was cut.
        let again = read(written.as_bytes());
        let mut work = Work::on(&again);
        work.sew_all();
        let simple = work.torn.simplified(&work.mesh, &work.positions);
        let simple = simple.expect("what we wrote can be read").document;
        let undone = simple.map_or_else(|| work.written(), |simple| Work::on(&simple).written());
        assert_eq!(text(&undone), file, "seed {seed}");
    }
    println!(
        "480 files, {torn} of them torn, {longer} with new lines, none of which moves another"
    );
    assert!(torn > 350 && longer > 300, "{torn} {longer}");
}
