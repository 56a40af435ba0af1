//! What the `v` of vertices have behind z: weights, colours.

use tearmesh::{Blend, Edit, Mix, VertexOp};

use crate::document::Document;
use crate::store::Rows;

/// The extra numbers of the vertices of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Extras<'d> {
    /// The row of each vertex. Empty if the document has no extra numbers.
    of: Vec<u32>,
    rows: AllRows<'d>,
}

impl<'d> Extras<'d> {
    pub(super) fn new(document: &'d Document) -> Extras<'d> {
        let has_any = document.extras.len() > 0;
        let count = document.positions.len() as u32;
        let new = Rows::default();
        Extras {
            of: (0..count).filter(|_| has_any).collect(),
            rows: AllRows { document, new },
        }
    }

    /// The extra numbers of a vertex.
    pub(super) fn row(&self, vertex: usize) -> &[f64] {
        let row = self.of.get(vertex);
        row.map_or(&[], |&row| self.rows.get(row))
    }

    /// Follows an edit. Of two vertices that are merged, the one that is kept keeps its numbers,
    /// whatever the other one has.
    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        let is_merge = matches!(edit, Edit::Merge(_));
        for op in edit.vertex_ops() {
            match op {
                VertexOp::Set { .. } if is_merge => {}
                op => self.apply(op),
            }
        }
    }

    /// Follows a part of an edit. Where sources do not have as many numbers as each other, there are
    /// none between them: a new vertex has none, and one that is set keeps its own.
    pub(super) fn apply(&mut self, op: VertexOp) {
        if self.of.is_empty() {
            return;
        }
        let own = match op {
            VertexOp::Set { at, .. } => Some(self.of[at.index()]),
            VertexOp::Push { .. } | VertexOp::SwapRemove { .. } => None,
        };
        let rows = &mut self.rows;
        op.apply(&mut self.of, |mix| match mix {
            Mix::Copy(&row) => row,
            mix => match (rows.mixed(mix.map(|&row| row)), own) {
                (None, Some(own)) => own,
                (row, _) => rows.push(&row.unwrap_or_default()),
            },
        });
    }
}

/// The rows of the document, and behind those new ones.
#[derive(Clone, Debug)]
struct AllRows<'d> {
    document: &'d Document,
    new: Rows,
}

impl AllRows<'_> {
    fn get(&self, row: u32) -> &[f64] {
        match (row as usize).checked_sub(self.document.positions.len()) {
            None => self.document.extras.row(row as usize),
            Some(new) => self.new.row(new),
        }
    }

    fn push(&mut self, row: &[f64]) -> u32 {
        let index = self.new.len();
        self.new.set(index, row);
        (self.document.positions.len() + index) as u32
    }

    /// What rows give, number by number; `None` if they are not of one length.
    fn mixed(&self, rows: Mix<u32>) -> Option<Vec<f64>> {
        let rows = rows.map(|row| self.get(row));
        let length = rows.nearest().len();
        let are_alike = rows.map(<[f64]>::len) == rows.map(|_| length);
        let number = |i: usize| f64::blend(rows.map(|row| &row[i]));
        are_alike.then(|| (0..length).map(number).collect())
    }
}
