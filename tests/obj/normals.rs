//! Normals at inserted corners, judged from the text of the file alone.

use std::collections::BTreeMap;

use super::random::Random;
use super::vectors::length;
use super::work::Work;
use super::{read, text};

/// A strip of triangles, each vertex with a normal of its own that all its corners have.
fn strip(random: &mut Random) -> String {
    let mut file = String::new();
    for i in 0..8 {
        file += &format!("v {} {} 0\n", i / 2, i % 2);
    }
    for _ in 0..8 {
        // Of any length; they lean to one side, so that no two cancel each other.
        let [x, y, z] = [(); 3].map(|()| random.next() - 0.5);
        file += &format!("vn {x} {y} {}\n", 0.6 + z);
    }
    for i in 1..7 {
        let [a, b, c] = [i, i + 1 + i % 2, i + 2 - i % 2];
        file += &format!("f {a}//{a} {b}//{b} {c}//{c}\n");
    }
    file
}

/// The mean of normals: its direction by adding them up, its length by adding up lengths.
fn mean(sources: &[([f64; 3], f64)]) -> [f64; 3] {
    let sum = [0, 1, 2].map(|axis| sources.iter().map(|(n, w)| n[axis] * w).sum::<f64>());
    let wanted: f64 = sources.iter().map(|(n, w)| length(*n) * w).sum();
    sum.map(|x| x / length(sum) * wanted)
}

#[test]
fn an_inserted_normal_is_the_mean_of_those_it_is_between() {
    let (mut on_edges, mut in_faces) = (0, 0);
    for seed in 0..500 {
        let mut random = Random(seed);
        let document = read(strip(&mut random).as_bytes());
        let mut work = Work::on(&document);
        work.tear(&mut random, 6, false);
        let written = text(&work.written());
        let document = read(written.as_bytes());
        let mut normals = BTreeMap::new();
        for corner in (0..document.polygon_count()).flat_map(|face| document.polygon(face)) {
            let number = document.number_of_vertex(corner.vertex as usize);
            let normal = document.normals()[corner.normal.expect("all have one") as usize];
            let known = normals.insert(number, normal);
            assert!(known.is_none_or(|known| known == normal), "one a vertex");
        }
        for line in written.lines() {
            let words: Vec<&str> = line.split(' ').collect();
            let vertex = |at: usize| words[at].parse::<usize>().expect("a vertex");
            let weight = |at: usize| words[at].parse::<f64>().expect("a weight");
            let sources: Vec<(usize, f64)> = match words[..2] {
                ["#~", "edge"] => vec![(vertex(4), 1.0 - weight(6)), (vertex(5), weight(6))],
                ["#~", "face"] => (0..3).map(|i| (vertex(4 + i), weight(7 + i))).collect(),
                _ => continue,
            };
            on_edges += usize::from(sources.len() == 2);
            in_faces += usize::from(sources.len() == 3);
            let sources: Vec<_> = sources.iter().map(|(v, w)| (normals[v], *w)).collect();
            let (is, wanted) = (normals[&vertex(2)], mean(&sources));
            for axis in 0..3 {
                let off = (is[axis] - wanted[axis]).abs();
                assert!(off <= 1e-14, "seed {seed}: {line}: {is:?}, not {wanted:?}");
            }
        }
    }
    assert!(on_edges > 500 && in_faces > 200, "{on_edges} {in_faces}");
}
