//! The record: what a torn mesh is beyond its faces, in comments at the end of its file.
//!
//! The documentation of the crate has the grammar; `read/record.rs` reads it, and
//! `write/record.rs` writes it, both by the numbers of the file. In a document it names vertices
//! by their index, which copies have not. Roots, splits and parents are all there is to know: texture
//! coordinates and normals at the corners of a divided face are those that its parts have
//! there, and the links of the mesh follow from its roots (`Mesh::build_torn`).

use tearmesh::Point;

use crate::families::Families;
use crate::store::{partition_point, push};

/// How the first and the last line of a record begin, and those between.
pub(crate) const HEADER: &[u8] = b"#tearmesh record";
pub(crate) const END: &[u8] = b"#tearmesh end";
pub(crate) const ITEM: &[u8] = b"#~";

/// The latest version. What an earlier one can say is written as that.
pub(crate) const VERSION: i64 = 4;

/// A record that fits its document. Indices count from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Record {
    /// Ascending, each from a lower vertex.
    pub(crate) splits: Vec<SplitOff>,
    /// Ascending.
    pub(crate) inserted: Vec<Inserted>,
    /// Divided faces.
    pub(crate) families: Families,
    /// Texture coordinates and normals that were inserted: the first of each run, and the one behind
    /// its last. Ascending, and apart.
    pub(crate) new_indices: [Vec<[u32; 2]>; 2],
    /// In the order in which they were made.
    pub(crate) slides: Vec<Slid>,
    /// Ascending.
    pub(crate) apart: Vec<Apart>,
    /// The `v` of the file that were copies, by their numbers there, and the vertices that they are;
    /// ascending.
    pub(crate) copies: Vec<[u32; 2]>,
}

/// A split-off vertex, as the record names it: it was one with `from`, a lower
/// vertex of its root, until `cut`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct SplitOff {
    pub(crate) vertex: u32,
    pub(crate) from: u32,
    pub(crate) cut: u32,
}

/// The runs of ascending numbers.
pub(crate) fn runs(numbers: impl Iterator<Item = u32>) -> Vec<[u32; 2]> {
    let mut runs: Vec<[u32; 2]> = Vec::new();
    for number in numbers {
        match runs.last_mut() {
            Some([_, end]) if *end == number => *end += 1,
            _ => push(&mut runs, [number, number + 1]),
        }
    }
    runs
}

/// Whether runs together are exactly the last of `count` numbers. No runs at all count as such.
pub(crate) fn are_last(runs: &[[u32; 2]], count: u32) -> bool {
    match runs {
        [] => true,
        [[_, end]] => *end == count,
        _ => false,
    }
}

/// Whether a number is in a run.
pub(crate) fn is_in(runs: &[[u32; 2]], number: u32) -> bool {
    let after = runs.partition_point(|&[first, _]| first <= number);
    after > 0 && number < runs[after - 1][1]
}

/// A vertex that was inserted: the root of its copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inserted {
    pub(crate) vertex: u32,
    pub(crate) cut: u32,
    /// The roots that it was put between, and their weights. On an edge, which is between the first
    /// two, the last weight is 0.
    pub(crate) between: [u32; 3],
    pub(crate) weights: [f64; 3],
}

impl Inserted {
    pub(crate) fn is_on_edge(&self) -> bool {
        self.weights[2] == 0.0
    }

    /// Renames the roots.
    pub(crate) fn renumbered(self, id: impl Fn(u32) -> u32) -> Inserted {
        Inserted {
            vertex: id(self.vertex),
            between: self.between.map(id),
            ..self
        }
    }
}

/// A vertex that slid along an edge. That moves it and interpolates what it has: its extra numbers, and
/// the texture coordinates and normals of its corners, which get indices of their own. No arithmetic undoes
/// that to the last bit, so what was before is on record; and what was then tells whether anybody
/// edited the vertex since.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slid {
    pub(crate) vertex: u32,
    pub(crate) cut: u32,
    /// What its `v` had before, and behind that as many numbers that it had then.
    pub(crate) numbers: Vec<f64>,
    pub(crate) exchanges: Vec<Exchange>,
}

/// A texture coordinate (0) or a normal (1) that corners of a vertex got for another when it slid.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Exchange {
    pub(crate) which: usize,
    pub(crate) new: u32,
    pub(crate) old: u32,
    /// What the new index names.
    pub(crate) value: Vec<f64>,
}

impl Slid {
    /// What its `v` had before.
    pub(crate) fn before(&self) -> &[f64] {
        &self.numbers[..self.numbers.len() / 2]
    }

    /// What its `v` had when it had slid.
    pub(crate) fn after(&self) -> &[f64] {
        &self.numbers[self.numbers.len() / 2..]
    }

    /// Renames the indices.
    pub(crate) fn renumber_indices(&mut self, number: impl Fn(usize, u32) -> u32) {
        for exchange in &mut self.exchanges {
            let indices = [exchange.new, exchange.old];
            [exchange.new, exchange.old] = indices.map(|index| number(exchange.which, index));
        }
    }
}

/// A vertex that its `v` puts elsewhere, so that the two sides of a cut do not lie on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Apart {
    pub(crate) vertex: u32,
    /// Where it is, and where its `v` says.
    pub(crate) is: Point,
    pub(crate) shown: Point,
}

/// Whether numbers are the same to the bit.
pub(crate) fn are_same(some: &[f64], others: &[f64]) -> bool {
    let [some, others] = [some, others].map(|numbers| numbers.iter().map(|x| x.to_bits()));
    some.eq(others)
}

/// Whether two points are the same to the bit.
pub(crate) fn is_same_point(one: Point, other: Point) -> bool {
    are_same(one.coords.as_slice(), other.coords.as_slice())
}

impl Record {
    /// Whether there is nothing to say.
    pub(crate) fn is_empty(&self) -> bool {
        self.splits.is_empty()
            && self.inserted.is_empty()
            && self.families.all().is_empty()
            && self.slides.is_empty()
            && self.apart.is_empty()
    }

    /// The number in the file of a vertex, from 0: copies come between.
    pub(crate) fn number(&self, vertex: usize) -> usize {
        // Before a copy there are as many vertices as its number less the copies before it.
        let is_before = |copy: usize| self.copies[copy][0] as usize - copy <= vertex;
        vertex + partition_point(self.copies.len(), is_before)
    }

    /// The vertex that has a number in the file, from 0, or that a copy is.
    pub(crate) fn vertex(&self, number: usize) -> usize {
        let before = self
            .copies
            .partition_point(|&[copy, _]| (copy as usize) < number);
        match self.copies.get(before) {
            Some(&[copy, of]) if copy as usize == number => of as usize,
            _ => number - before,
        }
    }

    /// The root of each of `count` vertices.
    pub(crate) fn roots(&self, count: usize) -> Vec<u32> {
        let mut roots: Vec<u32> = (0..count as u32).collect();
        for split in &self.splits {
            roots[split.vertex as usize] = roots[split.from as usize];
        }
        roots
    }

    /// Renames all vertices, in an order that keeps theirs.
    pub(crate) fn renumber(&mut self, id: impl Fn(u32) -> u32) {
        for split in &mut self.splits {
            [split.vertex, split.from] = [split.vertex, split.from].map(&id);
        }
        for inserted in &mut self.inserted {
            *inserted = inserted.renumbered(&id);
        }
        self.families.renumber(&id);
        for slid in &mut self.slides {
            slid.vertex = id(slid.vertex);
        }
        for apart in &mut self.apart {
            apart.vertex = id(apart.vertex);
        }
    }

    /// The highest number of a cut; 0 if there is none.
    pub(crate) fn last_cut(&self) -> u32 {
        let splits = self.splits.iter().map(|split| split.cut);
        let inserted = self.inserted.iter().map(|inserted| inserted.cut);
        let slid = self.slides.iter().map(|slid| slid.cut);
        splits.chain(inserted).chain(slid).max().unwrap_or(0)
    }
}

/// FNV-1a of 64 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Hash(pub(crate) u64);

impl Default for Hash {
    fn default() -> Self {
        Hash(0xcbf2_9ce4_8422_2325)
    }
}

impl Hash {
    #[inline]
    pub(crate) fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// A hash of faces, to begin with: of the number of vertices.
    pub(crate) fn of_faces(vertices: usize) -> Hash {
        let mut hash = Hash::default();
        hash.add(&(vertices as u64).to_le_bytes());
        hash
    }

    /// Takes in a vertex of a face.
    #[inline]
    pub(crate) fn add_corner(&mut self, vertex: u32) {
        self.add(&vertex.to_le_bytes());
    }
}
