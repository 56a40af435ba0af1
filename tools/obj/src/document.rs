//! The document: everything that a file holds.

use tearmesh::Point;

use crate::diagnostic::Diagnostic;
use crate::polygons::{Corner, Polygons};
use crate::record::Record;
use crate::store::{Kind, Layout, Rows, Run};

/// An OBJ file in memory: its numbers bit for bit, its faces as polygons and as triangles, and
/// every other line as bytes, in order.
///
/// Indices of this type count from 0; numbers in the file count from 1. A document takes about as much
/// memory as its file: 24 bytes per vertex and 20 per triangle, and more if corners have texture
/// coordinates or normals.
#[derive(Clone, Debug, Default)]
pub struct Document {
    pub(crate) positions: Vec<Point>,
    /// What a `v` has after its three coordinates: a weight, a colour.
    pub(crate) extras: Rows,
    pub(crate) texture: Rows,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) polygons: Polygons,
    /// `None` if every polygon is a triangle.
    pub(crate) triangulation: Option<Vec<[u32; 3]>>,
    pub(crate) layout: Layout,
    /// The text of the layout's text runs, one after the other.
    pub(crate) text: Vec<u8>,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What makes the mesh a torn one; all polygons are triangles then.
    pub(crate) record: Option<Box<Record>>,
}

impl Document {
    /// Returns the position of each vertex, by its index.
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Returns the numbers of a `v` statement after x, y and z: a weight, a colour, or both. The slice
    /// is empty if there are no such numbers.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn extra_numbers(&self, vertex: usize) -> &[f64] {
        assert_is_in("vertex", vertex, self.positions.len());
        self.extras.row(vertex)
    }

    /// Returns the number of texture coordinates (`vt`).
    #[must_use]
    pub fn texture_count(&self) -> usize {
        self.texture.len()
    }

    /// Returns the one, two or three numbers of the texture coordinate at an index.
    ///
    /// # Panics
    ///
    /// If there is no such texture coordinate.
    #[must_use]
    pub fn texture(&self, index: usize) -> &[f64] {
        assert_is_in("texture coordinate", index, self.texture.len());
        self.texture.row(index)
    }

    /// Returns the numbers of each normal (`vn`), by its index. They need not have length 1.
    #[must_use]
    pub fn normals(&self) -> &[[f64; 3]] {
        &self.normals
    }

    /// Returns the vertex indices of each triangle. The triangles of a polygon are consecutive, and
    /// polygons are in the order of the file.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        match &self.triangulation {
            Some(triangles) => triangles,
            None => self.polygons.vertices.as_chunks().0,
        }
    }

    /// Returns the vertex, texture coordinate and normal of a corner (0, 1 or 2) of a triangle.
    ///
    /// Takes time logarithmic in the number of polygons, or constant if all polygons are triangles.
    ///
    /// # Panics
    ///
    /// If there is no such triangle or corner.
    #[must_use]
    pub fn corner(&self, triangle: usize, corner: usize) -> Corner {
        self.polygons
            .corner(self.number_of_corner(triangle, corner))
    }

    /// Returns the index of a triangle's corner (0, 1 or 2) among the corners of all polygons, in the
    /// order of the file. Takes as long as [`Document::corner`].
    ///
    /// # Panics
    ///
    /// If there is no such triangle or corner.
    #[must_use]
    pub fn number_of_corner(&self, triangle: usize, corner: usize) -> usize {
        assert!(corner < 3, "a triangle has no corner {corner}");
        self.corner_of_polygon(triangle, corner, self.polygon_of(triangle))
    }

    /// Returns the number of polygons, which is the number of `f` statements.
    #[must_use]
    pub fn polygon_count(&self) -> usize {
        self.polygons.len()
    }

    /// Returns the corners of the polygon at an index, in the order of its `f` statement.
    ///
    /// # Panics
    ///
    /// If there is no such polygon.
    #[must_use]
    pub fn polygon(&self, polygon: usize) -> impl ExactSizeIterator<Item = Corner> + '_ {
        self.polygons
            .corners(polygon)
            .map(|corner| self.polygons.corner(corner))
    }

    /// Returns the index of the polygon that a triangle belongs to. Takes time logarithmic in the number
    /// of polygons, or constant if all polygons are triangles.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[must_use]
    pub fn polygon_of(&self, triangle: usize) -> usize {
        assert_is_in("triangle", triangle, self.triangles().len());
        match self.triangulation {
            Some(_) => self.polygons.of_triangle(triangle),
            None => triangle,
        }
    }

    /// Returns the line of the file, counted from 1, on which the `f` statement of a triangle begins.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[must_use]
    pub fn line_of_triangle(&self, triangle: usize) -> usize {
        self.layout.line_of_polygon(self.polygon_of(triangle))
    }

    /// Returns the line of the file, counted from 1, on which the `v` statement of a vertex begins. Copies
    /// that [`Document::repaired`] added stand on the line of the last `v`. Intended for messages: takes
    /// time linear in the number of runs of statements of one kind.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn line_of_vertex(&self, vertex: usize) -> usize {
        let line = self.layout.line_of_vertex(vertex);
        line.unwrap_or_else(|| panic!("vertex {vertex} is not in this document"))
    }

    /// Returns the number of `v` statements in the file. This is the number of vertices and of the
    /// copies that were written for further fans of a vertex ([the record](crate#the-record)).
    #[must_use]
    pub fn vertex_statement_count(&self) -> usize {
        let record = self.record.as_deref();
        self.positions.len() + record.map_or(0, |record| record.copies.len())
    }

    /// Returns the number of a vertex in the file, counted from 1. It exceeds the index plus 1 if
    /// copies of other vertices precede it. Takes time logarithmic in the number of copies.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn number_of_vertex(&self, vertex: usize) -> usize {
        assert_is_in("vertex", vertex, self.positions.len());
        let record = self.record.as_deref();
        record.map_or(vertex, |record| record.number(vertex)) + 1
    }

    /// Returns the index of the vertex whose `v` statement, or a copy of it, has this number in the file.
    /// Numbers count from 1; the result is `None` if the file has no `v` with this number.
    #[must_use]
    pub fn vertex_of_number(&self, number: usize) -> Option<usize> {
        let index = number.checked_sub(1)?;
        let record = self.record.as_deref();
        let vertex = record.map_or(index, |record| record.vertex(index));
        (vertex < self.positions.len()).then_some(vertex)
    }

    /// Returns the warnings and notes, in the order in which they should be shown.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// All numbers of the `v` of a vertex.
    pub(crate) fn numbers(&self, vertex: usize) -> Vec<f64> {
        let place: [f64; 3] = self.positions[vertex].into();
        [&place, self.extras.row(vertex)].concat()
    }

    /// The runs of statements, each with its lines if it is one of text.
    pub(crate) fn runs(&self) -> impl Iterator<Item = (Run, &[u8])> {
        let mut text = &self.text[..];
        self.layout.runs().iter().map(move |&run| {
            let length = match run.kind {
                Kind::Text => run.count as usize,
                _ => 0,
            };
            let (lines, rest) = text.split_at(length);
            text = rest;
            (run, lines)
        })
    }

    /// How many vertices, texture coordinates and normals there are.
    #[inline]
    pub(crate) fn counts(&self) -> [usize; 3] {
        [self.positions.len(), self.texture.len(), self.normals.len()]
    }

    /// The numbers of a texture coordinate (0) or a normal (1).
    pub(crate) fn value(&self, which: usize, index: u32) -> &[f64] {
        match which {
            0 => self.texture.row(index as usize),
            _ => &self.normals[index as usize],
        }
    }

    /// The corner of all polygons' corners that a corner of a triangle is.
    #[inline]
    pub(crate) fn corner_of_polygon(
        &self,
        triangle: usize,
        corner: usize,
        polygon: usize,
    ) -> usize {
        match &self.triangulation {
            Some(triangles) => {
                // A polygon has no vertex twice.
                let vertex = triangles[triangle][corner];
                let corners = self.polygons.corners(polygon);
                let vertices = &self.polygons.vertices[corners.clone()];
                let own = vertices.iter().position(|&other| other == vertex);
                corners.start + own.expect("a triangle has vertices of its polygon")
            }
            None => 3 * triangle + corner,
        }
    }
}

fn assert_is_in(what: &str, index: usize, count: usize) {
    assert!(index < count, "{what} {index} is not in this document");
}
