//! Files that were edited by a text editor between a cut and its mending: what is simplified loses
//! nothing of that.

use std::collections::BTreeMap;

use super::random::Random;
use super::work::{Work, files, simplified_later};
use super::{read, text};

/// The lines of a file, to be edited, and its vertices, looked up as a person would.
struct Lines(Vec<String>);

impl Lines {
    fn of(file: &[u8]) -> Lines {
        Lines(text(file).lines().map(str::to_owned).collect())
    }

    fn bytes(&self) -> Vec<u8> {
        (self.0.join("\n") + "\n").into_bytes()
    }

    /// Where the statements of a keyword stand.
    fn all(&self, keyword: &str) -> Vec<usize> {
        let is = |line: &str| line.split(' ').next() == Some(keyword);
        (0..self.0.len()).filter(|&i| is(&self.0[i])).collect()
    }

    /// Vertices that are on record as inserted, from 1.
    fn inserted(&self) -> Vec<usize> {
        let items = self.0.iter().filter_map(|line| {
            let edge = line.strip_prefix("#~ edge ");
            edge.or(line.strip_prefix("#~ face "))
        });
        let number = |item: &str| item.split(' ').next()?.parse().ok();
        items.filter_map(number).collect()
    }

    /// The area of all triangles.
    fn area(&self) -> f64 {
        let document = read(&self.bytes());
        let areas = document.triangles().iter().map(|corners| {
            let [a, b, c] = corners.map(|v| document.positions()[v as usize]);
            (b - a).cross(&(c - a)).norm() / 2.0
        });
        areas.sum()
    }
}

/// A file that was cut at random twice, and sewn: its name, what comes next at random, and its lines.
fn sewn(seed: usize, first: usize) -> (String, Random, Lines) {
    let number = if seed.is_multiple_of(6) {
        1 + seed / 6 % 4
    } else {
        0
    };
    let (name, file) = files().swap_remove(number);
    let mut random = Random((first + seed) as u64);
    let document = read(&file);
    let mut work = Work::on(&document);
    for _ in 0..2 {
        work.tear(&mut random, 10, true);
        work.torn.next_cut();
    }
    work.sew_all();
    let lines = Lines::of(&work.written());
    (name, random, lines)
}

/// What is left of a file once it is simplified, and how many vertices stay for their edits.
fn simplified(file: &[u8]) -> (Lines, usize) {
    let (left, [edited, ..]) = simplified_later(file);
    (Lines::of(left.as_bytes()), edited)
}

/// Any vertices, inserted ones or others, moved by little or by much.
#[test]
fn the_surface_stays_whatever_was_moved() {
    let (mut kept, mut smaller) = (0, 0);
    for seed in 0..600 {
        let (name, mut random, mut lines) = sewn(seed, 9000);
        let statements = lines.all("v");
        let inserted = lines.inserted();
        let mut moved: BTreeMap<usize, String> = BTreeMap::new();
        for _ in 0..random.below(3) {
            let vertex = match inserted.len() {
                0 => random.below(statements.len()),
                count if random.next() < 0.6 => inserted[random.below(count)] - 1,
                _ => random.below(statements.len()),
            };
            let far = [1e-7, 0.125, 3.0][random.below(3)];
            let line = &mut lines.0[statements[vertex]];
            let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
            let axis = 1 + random.below(3);
            let number: f64 = words[axis].parse().expect("a number");
            words[axis] = (number + far).to_string();
            *line = words.join(" ");
            moved.insert(vertex, words[..4].join(" "));
        }
        let (after, edited) = simplified(&lines.bytes());
        let [was, is] = [&lines, &after].map(Lines::area);
        assert!(
            (was - is).abs() <= 1e-12 * was,
            "{name}, seed {seed}: {was} became {is}"
        );
        for place in moved.values() {
            let is_there = after.0.iter().any(|line| line.starts_with(place));
            assert!(is_there, "{name}, seed {seed}: {place} is gone");
        }
        let is_right = edited == 0 || !moved.is_empty();
        assert!(is_right, "{name}, seed {seed}: nothing was edited");
        kept += usize::from(edited > 0);
        smaller += usize::from(after.0.len() < lines.0.len());
    }
    assert!(kept > 100 && smaller > 100, "{kept} {smaller}");
}

/// An inserted vertex, or a corner of a face there, is given numbers that no other has.
#[test]
fn other_numbers_at_an_inserted_vertex_are_kept() {
    let mut tried = BTreeMap::new();
    for seed in 0..600 {
        let (name, mut random, mut lines) = sewn(seed, 7000);
        let inserted = lines.inserted();
        if inserted.is_empty() {
            continue;
        }
        let vertex = inserted[random.below(inserted.len())].to_string();
        let which = random.below(3);
        let kind = ["v", "vt", "vn"][which];
        // The vertex, or what a corner of it has.
        let faces = lines.all("f").into_iter().map(|i| lines.0[i].split(' '));
        let mut corners = faces
            .flatten()
            .map(|corner| corner.split('/').collect::<Vec<_>>());
        let own = corners.find_map(|corner| {
            let index = corner.get(which)?.parse::<usize>().ok();
            index.filter(|_| corner[0] == vertex)
        });
        let Some(index) = own else {
            continue;
        };
        let statement = lines.all(kind)[index - 1];
        let words: Vec<&str> = lines.0[statement].split(' ').collect();
        let bare = match kind {
            "v" if words.len() == 4 => continue,
            "v" => words[..4].join(" "),
            _ => kind.to_owned(),
        };
        lines.0[statement] = format!("{bare} 0.375 0.4375 -0.5");
        let (after, edited) = simplified(&lines.bytes());
        let is_marked =
            |line: &String| line.starts_with(kind) && line.ends_with(" 0.375 0.4375 -0.5");
        let is_there = after.0.iter().any(is_marked);
        assert!(is_there, "{name}, seed {seed}: the {kind} is gone");
        *tried.entry((kind, edited > 0)).or_insert(0) += 1;
    }
    let kept = ["v", "vt", "vn"].map(|kind| tried[&(kind, true)]);
    assert!(kept.into_iter().all(|count| count > 3), "{tried:?}");
}
