//! What the `v` of vertices have behind z: weights, colours.

use tearmesh::{Blend, Location, Slide, VertexId};

use crate::document::Document;
use crate::store::Rows;

/// The extra numbers of the vertices of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Extras<'d> {
    document: &'d Document,
    /// The row of each vertex: one of the document, or behind those one of `new`. Empty if the document
    /// has no extra numbers.
    rows: Vec<u32>,
    new: Rows,
}

impl<'d> Extras<'d> {
    pub(super) fn new(document: &'d Document) -> Extras<'d> {
        let has_any = document.extras.len() > 0;
        let count = document.positions.len() as u32;
        Extras {
            document,
            rows: (0..count).filter(|_| has_any).collect(),
            new: Rows::default(),
        }
    }

    /// The extra numbers of a vertex.
    pub(super) fn row(&self, vertex: usize) -> &[f64] {
        let Some(&row) = self.rows.get(vertex) else {
            return &[];
        };
        match (row as usize).checked_sub(self.document.positions.len()) {
            None => self.document.extras.row(row as usize),
            Some(new) => self.new.row(new),
        }
    }

    /// Adds a vertex that has those of another.
    pub(super) fn split(&mut self, old: usize) {
        if let Some(&row) = self.rows.get(old) {
            self.rows.push(row);
        }
    }

    /// Adds a vertex that has those between others.
    pub(super) fn insert(&mut self, at: &Location) {
        if !self.rows.is_empty() {
            let row = self.between(at);
            let row = self.new_row(&row);
            self.rows.push(row);
        }
    }

    /// The last vertex takes the place of one that is gone.
    pub(super) fn merge(&mut self, gone: usize) {
        if !self.rows.is_empty() {
            self.rows.swap_remove(gone);
        }
    }

    /// A vertex that slides gets those between it and where it slides to, if they have as many.
    pub(super) fn slide(&mut self, slide: &Slide<'_>) {
        if !self.rows.is_empty() {
            let ends = [slide.vertex, slide.toward];
            let row = self.between(&Location::Edge { ends, t: slide.t });
            if !row.is_empty() {
                self.rows[slide.vertex.index()] = self.new_row(&row);
            }
        }
    }

    fn new_row(&mut self, row: &[f64]) -> u32 {
        let index = self.new.len();
        self.new.set(index, row);
        (self.document.positions.len() + index) as u32
    }

    /// Those at a place; none where those of its sources are not of one length.
    fn between(&self, at: &Location) -> Vec<f64> {
        let row = |v: VertexId| self.row(v.index());
        let alike = |rows: &[&[f64]]| rows.iter().all(|row| row.len() == rows[0].len());
        match *at {
            Location::Edge { ends, t } => {
                let [a, b] = ends.map(row);
                let both = a.iter().zip(b).filter(|_| alike(&[a, b]));
                both.map(|(a, b)| a.between(b, t)).collect()
            }
            Location::Face { vertices, weights } => {
                let rows @ [a, b, c] = vertices.map(row);
                let all = (0..a.len()).filter(|_| alike(&rows));
                all.map(|i| f64::weighted([&a[i], &b[i], &c[i]], weights))
                    .collect()
            }
        }
    }
}
