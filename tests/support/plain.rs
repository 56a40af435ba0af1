//! A reader of OBJ in the simplest way, which shares no code with the library's: what the lines say.

use std::collections::BTreeMap;

/// The numbers and the faces of a file.
#[derive(Default)]
pub(crate) struct Plain {
    /// All numbers of each `v`.
    pub(crate) vertices: Vec<Vec<f64>>,
    pub(crate) texture: Vec<Vec<f64>>,
    /// Of each face, its vertices from 0.
    pub(crate) faces: Vec<Vec<usize>>,
    /// Of each face, the texture coordinate at each corner, from 0.
    pub(crate) face_textures: Vec<Vec<Option<usize>>>,
    /// Of each `l`, its vertices from 0.
    pub(crate) lines: Vec<Vec<usize>>,
}

impl Plain {
    pub(crate) fn read(text: &str) -> Plain {
        let mut plain = Plain::default();
        for line in text.lines() {
            let (keyword, rest) = line.split_once(' ').unwrap_or((line, ""));
            let words = || rest.split_whitespace();
            let numbers = || {
                words()
                    .map(|word| word.parse().expect("a number"))
                    .collect()
            };
            let index = |corner: &str, which| {
                let index = corner.split('/').nth(which)?.parse::<usize>();
                Some(index.ok()? - 1)
            };
            match keyword {
                "v" => plain.vertices.push(numbers()),
                "vt" => plain.texture.push(numbers()),
                "f" => {
                    let vertices = words().map(|corner| index(corner, 0).expect("a vertex"));
                    plain.faces.push(vertices.collect());
                    let textures = words().map(|corner| index(corner, 1));
                    plain.face_textures.push(textures.collect());
                }
                "l" => {
                    let vertices = words().map(|word| index(word, 0).expect("a vertex"));
                    plain.lines.push(vertices.collect());
                }
                _ => {}
            }
        }
        plain
    }

    /// Where a vertex is.
    pub(crate) fn at(&self, vertex: usize) -> [f64; 3] {
        let place = &self.vertices[vertex];
        [place[0], place[1], place[2]]
    }

    /// The vertices of all faces, each face as a fan round its first corner.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        let faces = self.faces.iter();
        let vertices = faces.flat_map(|face| fan(face));
        vertices.map(|three| three.map(|v| v as u32)).collect()
    }

    /// Where it is, to the bit.
    pub(crate) fn bits(&self, vertex: usize) -> [u64; 3] {
        self.at(vertex).map(f64::to_bits)
    }

    /// Where the corners of all faces are, in order, to the bit.
    pub(crate) fn corners(&self) -> impl Iterator<Item = [u64; 3]> + '_ {
        let corners = self.faces.iter().flatten();
        corners.map(|&vertex| self.bits(vertex))
    }

    /// The lengths of the sides of a triangle, by Pythagoras.
    pub(crate) fn sides(&self, face: &[usize]) -> [f64; 3] {
        [0, 1, 2].map(|i| {
            let [a, b] = [face[i], face[(i + 1) % 3]].map(|vertex| self.at(vertex));
            (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
        })
    }

    /// The area of all triangles, by Heron's rule.
    pub(crate) fn area(&self) -> f64 {
        let areas = self.faces.iter().map(|face| {
            let [a, b, c] = self.sides(face);
            let half = (a + b + c) / 2.0;
            (half * (half - a) * (half - b) * (half - c))
                .max(0.0)
                .sqrt()
        });
        areas.sum()
    }
}

/// The triangles of a polygon round its first corner.
pub(crate) fn fan<T: Copy>(corners: &[T]) -> impl Iterator<Item = [T; 3]> + '_ {
    let two = corners[1..].windows(2);
    two.map(|two| [corners[0], two[0], two[1]])
}

/// For each thing the least that it is joined with, directly or not, by what they have in common.
pub(crate) fn pieces<K: Ord>(things: impl Iterator<Item = Vec<K>>) -> Vec<usize> {
    fn least(piece: &mut [usize], mut thing: usize) -> usize {
        while piece[thing] != thing {
            piece[thing] = piece[piece[thing]];
            thing = piece[thing];
        }
        thing
    }
    let (mut first, mut piece) = (BTreeMap::new(), Vec::new());
    for (thing, parts) in things.enumerate() {
        piece.push(thing);
        for part in parts {
            let other = *first.entry(part).or_insert(thing);
            let [one, other] = [thing, other].map(|thing| least(&mut piece, thing));
            piece[one.max(other)] = one.min(other);
        }
    }
    (0..piece.len())
        .map(|thing| least(&mut piece, thing))
        .collect()
}
