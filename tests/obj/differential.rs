//! What obj-rs 0.7 reads without loss, we read the same.
//!
//! The fuzz target `obj_differential` and the replay of its seeds use this. *Without loss* means:
//!
//! 1. The text is UTF-8 without control characters, a CR only before a LF, and a `\` only at the
//!    end of a line. (obj-rs takes a lone CR for a blank, and does not continue at `\` and a blank.)
//! 2. Only statements that obj-rs knows and reads as the format means them: `v`, `vt`, `vn`, `f`,
//!    `fo`, `o`, `g`, `s`, `usemtl`, `mtllib`, `l` and `p`. It panics on 22 keywords and refuses
//!    unknown ones. Other statements are taken out before either reads.
//! 3. Statements of geometry are ASCII (obj-rs takes every blank of Unicode for one), and have no
//!    `#` in the middle of a word (`1.#INF` is a number without a value, not a comment).
//! 4. obj-rs accepts it, and all its numbers are finite as `f32`.
//!
//! Then we accept the file too, unless it has no face, a face names a vertex twice, or a face has
//! more than 4096 corners; those we refuse. Faces and counts agree exactly. Numbers agree
//! exactly where an `f32` holds them, and else to one unit in the last place of an `f32`.

use obj::raw::object::{Polygon, RawObj};
use tearmesh_obj::{Corner, Document};

/// What became of an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// obj-rs does not read it without loss.
    Lossy,
    /// obj-rs reads it, and we refuse it as we should.
    Refused,
    /// Both read the same.
    Same,
}

const KNOWN: [&str; 12] = [
    "v", "vt", "vn", "f", "fo", "o", "g", "s", "usemtl", "mtllib", "l", "p",
];
const CORNERS_MAX: usize = 4096;

/// Compares.
pub(crate) fn check(bytes: &[u8]) -> Outcome {
    let Some(text) = lossless(bytes) else {
        return Outcome::Lossy;
    };
    let Ok(theirs) = obj::raw::parse_obj(text.as_bytes()) else {
        return Outcome::Lossy;
    };
    if !numbers(&theirs).iter().flatten().all(|x| x.is_finite()) {
        return Outcome::Lossy;
    }
    let polygons: Vec<Vec<Corner>> = theirs.polygons.iter().map(corners).collect();
    let is_sound = |polygon: &Vec<Corner>| {
        let mut vertices: Vec<_> = polygon.iter().map(|corner| corner.vertex).collect();
        vertices.sort_unstable();
        vertices.dedup();
        vertices.len() == polygon.len() && polygon.len() <= CORNERS_MAX
    };
    let sound = !polygons.is_empty() && polygons.iter().all(is_sound);
    let ours = match Document::read(text.as_bytes()) {
        Ok(document) => document,
        Err(error) => {
            assert!(!sound, "obj-rs reads this, and we say {error}:\n{text}");
            return Outcome::Refused;
        }
    };
    assert!(sound, "we read what we should refuse:\n{text}");

    assert_eq!(ours.polygon_count(), polygons.len(), "faces");
    for (i, polygon) in polygons.iter().enumerate() {
        assert!(ours.polygon(i).eq(polygon.iter().copied()), "face {i}");
    }
    assert_eq!(ours.positions().len(), theirs.positions.len(), "v");
    assert_eq!(ours.texture_count(), theirs.tex_coords.len(), "vt");
    assert_eq!(ours.normals().len(), theirs.normals.len(), "vn");
    let numbers = numbers(&theirs);
    let mut theirs = numbers.iter();
    for (i, p) in ours.positions().iter().enumerate() {
        let weight = ours.extra_numbers(i).first().copied().unwrap_or(1.0);
        same(&[p.x, p.y, p.z, weight], theirs.next());
    }
    for i in 0..ours.texture_count() {
        let mut padded = ours.texture(i).to_vec();
        padded.resize(3, 0.0);
        same(&padded, theirs.next());
    }
    for normal in ours.normals() {
        same(normal, theirs.next());
    }
    Outcome::Same
}

/// The text without the statements that obj-rs does not know; none if clause 1 or 3 fails.
pub(crate) fn lossless(bytes: &[u8]) -> Option<String> {
    let text = std::str::from_utf8(bytes).ok()?.replace("\r\n", "\n");
    let mut kept = String::new();
    let mut lines = text.split_inclusive('\n');
    while let Some(first) = lines.next() {
        let mut statement = first.to_owned();
        let mut last = first;
        // A comment is cut off before obj-rs looks for the `\`.
        while !last.contains('#') && last.trim_end_matches('\n').ends_with('\\') {
            last = lines.next()?;
            statement.push_str(last);
        }
        let body = statement.replace("\\\n", " ");
        if body
            .chars()
            .any(|c| c.is_control() && c != '\n' && c != '\t')
            || body.contains('\\')
        {
            return None;
        }
        let words = body.split('#').next().unwrap_or_default();
        let Some(keyword) = words.split_whitespace().next() else {
            kept.push_str(&statement);
            continue;
        };
        if !KNOWN.contains(&keyword) {
            continue;
        }
        if matches!(keyword, "v" | "vt" | "vn" | "f" | "fo") {
            let glued = words.len() < body.len() && !words.ends_with([' ', '\t']);
            if glued || !words.is_ascii() {
                return None;
            }
        }
        kept.push_str(&statement);
    }
    Some(kept)
}

fn corners(polygon: &Polygon) -> Vec<Corner> {
    let id = |index: usize| u32::try_from(index).expect("a short file");
    let corner = |(vertex, texture, normal): (usize, Option<usize>, Option<usize>)| Corner {
        vertex: id(vertex),
        texture: texture.map(id),
        normal: normal.map(id),
    };
    let all: Vec<_> = match polygon {
        Polygon::P(all) => all.iter().map(|&v| (v, None, None)).collect(),
        Polygon::PT(all) => all.iter().map(|&(v, t)| (v, Some(t), None)).collect(),
        Polygon::PN(all) => all.iter().map(|&(v, n)| (v, None, Some(n))).collect(),
        Polygon::PTN(all) => {
            let corners = all.iter();
            corners.map(|&(v, t, n)| (v, Some(t), Some(n))).collect()
        }
    };
    all.into_iter().map(corner).collect()
}

/// All numbers, a list for each statement: first `v`, then `vt`, then `vn`.
fn numbers(file: &RawObj) -> Vec<Vec<f32>> {
    let positions = file.positions.iter().map(|&(x, y, z, w)| vec![x, y, z, w]);
    let texture = file.tex_coords.iter().map(|&(u, v, w)| vec![u, v, w]);
    let normals = file.normals.iter().map(|&(x, y, z)| vec![x, y, z]);
    positions.chain(texture).chain(normals).collect()
}

fn same(ours: &[f64], theirs: Option<&Vec<f32>>) {
    let theirs = theirs.expect("as many statements");
    assert_eq!(ours.len(), theirs.len());
    for (&ours, &theirs) in ours.iter().zip(theirs) {
        let near = ours as f32;
        let is_near = near == theirs || near == theirs.next_up() || near == theirs.next_down();
        assert!(is_near, "{ours:e} for {theirs:e}");
        assert!(
            near == theirs || f64::from(near) != ours,
            "{ours:e} for {theirs:e}, though an `f32` holds it"
        );
    }
}
