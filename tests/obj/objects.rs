//! Files of several objects, torn, line by line: which lines stay where they were.
//!
//! A new vertex has a number above all others, and no face may come before its vertices: programs
//! that read such a file drop the face. So where an object is torn and others follow, the `v` of
//! those move up before the first face that has a new vertex. Nothing else does.

use super::random::Random;
use super::torn_record::Work;
use super::{read, text};

/// Strips of triangles, an object each, with comments; the vertices of all of them first, or those
/// of each before its own faces.
fn objects(count: usize, vertices_first: bool) -> String {
    let (mut heads, mut file) = (String::new(), String::new());
    for object in 0..count {
        let mut vertices = format!("# vertices of {object}\n");
        for i in 0..8 {
            vertices += &format!("v {} {} {object}\n", i / 2, i % 2);
        }
        let mut faces = format!("# faces of {object}\ng part{object}\n");
        for i in 8 * object + 1..8 * object + 7 {
            let [a, b, c] = if i % 2 == 1 {
                [i, i + 2, i + 1]
            } else {
                [i, i + 1, i + 2]
            };
            faces += &format!("f {a} {b} {c}\n");
        }
        let name = format!("o object{object}\n");
        if vertices_first {
            heads += &vertices;
            file += &(name + &faces);
        } else {
            file += &(name + &vertices + &faces);
        }
    }
    heads + &file
}

/// Whether lines are among others, in their order.
fn are_among(lines: &[&str], others: &[&str]) -> bool {
    let mut others = others.iter();
    lines.iter().all(|line| others.any(|other| other == line))
}

#[test]
fn no_line_but_the_vertices_of_later_objects_moves() {
    let (mut torn, mut in_place) = (0, 0);
    for seed in 0..400 {
        let mut random = Random(seed);
        let vertices_first = seed % 2 == 0;
        let file = objects(1 + seed as usize % 4, vertices_first);
        let document = read(file.as_bytes());
        let mut work = Work::on(&document);
        work.tear(&mut random, 3, false);
        let written = text(&work.written());
        let body = written.split("#tearmesh").next().expect("a body");
        let (was, is): (Vec<&str>, Vec<&str>) = (file.lines().collect(), body.lines().collect());
        let vertex = |line: &&&str| line.starts_with("v ");
        let face = |line: &&&str| line.starts_with("f ");
        let pick = |lines: &[&str], which: fn(&str) -> bool| -> Vec<String> {
            lines
                .iter()
                .filter(|line| which(line))
                .map(|line| (*line).to_owned())
                .collect()
        };
        let others = |line: &str| !line.starts_with("v ") && !line.starts_with("f ");
        assert_eq!(pick(&was, others), pick(&is, others), "seed {seed}");
        let old: Vec<&str> = was.iter().filter(vertex).copied().collect();
        let new: Vec<&str> = is.iter().filter(vertex).copied().collect();
        assert_eq!(new[..old.len()], old, "seed {seed}: `v` keep their numbers");
        let mut vertices = 0;
        for line in &is {
            vertices += usize::from(line.starts_with("v "));
            let corners = line
                .strip_prefix("f ")
                .into_iter()
                .flat_map(|all| all.split(' '));
            let corners = corners.map(|corner| corner.parse::<usize>().expect("an index"));
            assert!(
                corners.max() <= Some(vertices),
                "seed {seed}: {line} comes too early"
            );
        }
        // A plain difference: all lines but changed faces are there, in their order.
        let unchanged: Vec<&str> = was
            .iter()
            .filter(|line| !face(line) || is.contains(line))
            .copied()
            .collect();
        let stays = are_among(&unchanged, &is);
        assert!(stays || !vertices_first, "seed {seed}: {body}");
        in_place += usize::from(stays);
        torn += usize::from(new.len() > old.len());
    }
    println!("400 files, {torn} of them torn; all lines of {in_place} in place");
    assert!(torn > 200 && in_place > 200, "{torn} {in_place}");
}
