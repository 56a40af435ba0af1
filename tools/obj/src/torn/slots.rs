//! Where the faces of a mesh stand in its document.

use std::ops::Range;

/// The faces of a mesh by the triangle of the document where they stand.
#[derive(Debug)]
pub(crate) struct Slots {
    pub(crate) faces: Vec<u32>,
    starts: Vec<u32>,
}

impl Slots {
    /// Sorts faces by the triangle at which each stands. There are `triangles` triangles.
    pub(super) fn sorted(places: &[u32], triangles: usize) -> Slots {
        let mut starts = vec![0_u32; triangles + 1];
        for &place in places {
            starts[place as usize + 1] += 1;
        }
        for i in 0..triangles {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut faces = vec![0; places.len()];
        for (face, &place) in places.iter().enumerate() {
            faces[next[place as usize] as usize] = face as u32;
            next[place as usize] += 1;
        }
        Slots { faces, starts }
    }

    /// Where each face stands among all.
    pub(crate) fn ranks(&self) -> Vec<u32> {
        let mut ranks = vec![0; self.faces.len()];
        for (rank, &face) in self.faces.iter().enumerate() {
            ranks[face as usize] = rank as u32;
        }
        ranks
    }

    /// Where the faces of triangles are in `faces`.
    pub(crate) fn of(&self, triangles: Range<usize>) -> Range<usize> {
        self.starts[triangles.start] as usize..self.starts[triangles.end] as usize
    }
}
