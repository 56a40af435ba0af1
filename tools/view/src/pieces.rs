//! The numbers of pieces, by which they are coloured: a piece keeps its number while others tear off.

use std::cmp::Reverse;
use std::collections::BTreeSet;

use tearmesh::Mesh;

/// The numbers so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pieces {
    /// Of each face.
    numbers: Vec<u32>,
    /// The first number that no piece has had.
    next: u32,
}

impl Pieces {
    /// The number of each face's piece in the mesh that comes next. What comes apart keeps its number where
    /// most faces are, and gets new ones elsewhere.
    pub(crate) fn next(&mut self, mesh: &Mesh) -> Vec<u32> {
        let components = mesh.components();
        let mut faces = vec![Vec::new(); components.count()];
        for f in mesh.faces() {
            faces[components.of(f)].push(f.index());
        }
        faces.sort_by_key(|piece| Reverse(piece.len()));
        let mut numbers = vec![0; mesh.face_count()];
        let mut taken = BTreeSet::new();
        for piece in faces {
            let had = piece.iter().filter_map(|&f| self.numbers.get(f).copied());
            let number = most(had.collect()).filter(|number| !taken.contains(number));
            let number = number.unwrap_or(self.next);
            self.next = self.next.max(number + 1);
            taken.insert(number);
            for f in piece {
                numbers[f] = number;
            }
        }
        self.numbers.clone_from(&numbers);
        numbers
    }
}

/// The number that is there most often, and of several the smallest.
fn most(mut numbers: Vec<u32>) -> Option<u32> {
    numbers.sort_unstable();
    let runs = numbers.chunk_by(|a, b| a == b);
    runs.min_by_key(|run| Reverse(run.len())).map(|run| run[0])
}
