//! What the `v` of vertices have behind z: weights, colours.

use tearmesh::{Blend, Edit, Mix, VertexOp};

use crate::document::Document;

/// The extra numbers of each vertex of a mesh. Empty if the document has none at all.
#[derive(Clone, Debug)]
pub(super) struct Extras(Vec<Vec<f64>>);

impl Extras {
    pub(super) fn new(document: &Document) -> Extras {
        let has_any = document.extras.len() > 0;
        let vertices = (0..document.positions.len()).filter(|_| has_any);
        Extras(vertices.map(|v| document.extras.row(v).to_vec()).collect())
    }

    /// The extra numbers of a vertex.
    pub(super) fn row(&self, vertex: usize) -> &[f64] {
        self.0.get(vertex).map_or(&[], Vec::as_slice)
    }

    /// Follows an edit. Of two vertices that are merged, the one that is kept keeps its numbers,
    /// whatever the other one has.
    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        if self.0.is_empty() {
            return;
        }
        for op in edit.vertex_ops() {
            // Where sources do not have as many numbers as each other, there are none between them: a new
            // vertex has none, and one that is set keeps its own.
            let own = match op {
                VertexOp::Set { .. } if matches!(edit, Edit::Merge(_)) => continue,
                VertexOp::Set { at, .. } => self.0[at.index()].clone(),
                VertexOp::Push { .. } | VertexOp::SwapRemove { .. } => Vec::new(),
            };
            op.apply(&mut self.0, |mix| mixed(mix).unwrap_or_else(|| own.clone()));
        }
    }
}

/// What rows give, number by number; `None` if they are not of one length.
fn mixed(rows: Mix<&Vec<f64>>) -> Option<Vec<f64>> {
    let length = rows.nearest().len();
    let are_alike = rows.map(Vec::len) == rows.map(|_| length);
    let number = |i: usize| f64::blend(rows.map(|row| &row[i]));
    are_alike.then(|| (0..length).map(number).collect())
}
