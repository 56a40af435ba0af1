//! The record: what a torn mesh is beyond its faces, in comments at the end of its file.
//!
//! The documentation of the crate has the grammar; `read/record.rs` reads it, and
//! `write/record.rs` writes it. Roots, splits and parents are all there is to know: texture
//! coordinates and normals at the corners of a divided face are those that its parts have
//! there, and the links of the mesh follow from its roots (`Mesh::build_torn`).

pub(crate) use crate::torn::SplitOff;

/// How the first and the last line of a record begin, and those between.
pub(crate) const HEADER: &[u8] = b"#tearmesh record";
pub(crate) const END: &[u8] = b"#tearmesh end";
pub(crate) const ITEM: &[u8] = b"#~";

/// The version that is written, and the only one that is read.
pub(crate) const VERSION: i64 = 1;

/// A record that fits its document. Indices count from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Record {
    /// Ascending, each from a lower vertex.
    pub(crate) splits: Vec<SplitOff>,
    /// Ascending.
    pub(crate) inserted: Vec<Inserted>,
    /// Ascending, and apart.
    pub(crate) parents: Vec<Parent>,
    /// How many texture coordinates and normals there were before any was inserted.
    pub(crate) texture_before: usize,
    pub(crate) normals_before: usize,
}

/// A vertex that was inserted: the root of its copies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Inserted {
    pub(crate) vertex: u32,
    pub(crate) cut: u32,
    pub(crate) at: At,
}

/// Where a vertex was inserted, between roots.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum At {
    Edge {
        ends: [u32; 2],
        t: f64,
    },
    Face {
        corners: [u32; 3],
        weights: [f64; 3],
    },
}

impl At {
    /// The roots that it names.
    pub(crate) fn roots(&self) -> &[u32] {
        match self {
            At::Edge { ends, .. } => ends,
            At::Face { corners, .. } => corners,
        }
    }

    pub(crate) fn map(self, f: impl Fn(u32) -> u32) -> At {
        match self {
            At::Edge { ends, t } => At::Edge {
                ends: ends.map(f),
                t,
            },
            At::Face { corners, weights } => At::Face {
                corners: corners.map(f),
                weights,
            },
        }
    }
}

/// Faces that cover what was one face: `first` and those behind it, before `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Parent {
    pub(crate) first: u32,
    pub(crate) end: u32,
    /// The roots at its corners, in its order.
    pub(crate) corners: [u32; 3],
}

impl Record {
    /// Whether there is nothing to say.
    pub(crate) fn is_empty(&self) -> bool {
        self.splits.is_empty() && self.inserted.is_empty() && self.parents.is_empty()
    }

    /// The root of each of `count` vertices.
    pub(crate) fn roots(&self, count: usize) -> Vec<u32> {
        let mut roots: Vec<u32> = (0..count as u32).collect();
        for split in &self.splits {
            roots[split.vertex as usize] = roots[split.from as usize];
        }
        roots
    }

    /// The highest number of a cut; 0 if there is none.
    pub(crate) fn last_cut(&self) -> u32 {
        let splits = self.splits.iter().map(|split| split.cut);
        let inserted = self.inserted.iter().map(|inserted| inserted.cut);
        splits.chain(inserted).max().unwrap_or(0)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv_1a() {
        for (text, expected) in [
            ("", 0xcbf2_9ce4_8422_2325),
            ("a", 0xaf63_dc4c_8601_ec8c),
            ("foobar", 0x8594_4171_f739_67e8),
        ] {
            let mut hash = Hash::default();
            hash.add(text.as_bytes());
            assert_eq!(hash.0, expected);
        }
    }
}
