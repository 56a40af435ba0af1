//! The document: everything that a file holds.

use tearmesh::Point;

use crate::diagnostic::Diagnostic;
use crate::polygons::{Corner, Polygons};
use crate::record::Record;
use crate::store::{Layout, Rows};
use crate::triangulate::Triangulation;

/// An OBJ file in memory: its numbers bit for bit, its faces as polygons and as triangles, and
/// every other line as bytes, in order.
///
/// Indices count from 0 here, and from 1 in files. A document takes about as much memory as its
/// file: 24 bytes per vertex and 20 per triangle, and more if corners have texture coordinates or
/// normals.
#[derive(Clone, Debug, Default)]
pub struct Document {
    pub(crate) positions: Vec<Point>,
    /// What a `v` has after its three coordinates: a weight, a colour.
    pub(crate) extras: Rows,
    pub(crate) texture: Rows,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) polygons: Polygons,
    /// `None` if every polygon is a triangle.
    pub(crate) triangulation: Option<Triangulation>,
    pub(crate) layout: Layout,
    /// The text of the layout's text runs, one after the other.
    pub(crate) text: Vec<u8>,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// What makes the mesh a torn one; all polygons are triangles then.
    pub(crate) record: Option<Box<Record>>,
}

impl Document {
    /// The positions of the vertices.
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// The numbers of a `v` statement after x, y and z: a weight, a colour, or both.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn extra_numbers(&self, vertex: usize) -> &[f64] {
        assert!(
            vertex < self.positions.len(),
            "vertex {vertex} is not in this document"
        );
        self.extras.row(vertex)
    }

    /// The number of texture coordinates.
    #[must_use]
    pub fn texture_count(&self) -> usize {
        self.texture.len()
    }

    /// A texture coordinate, as the one, two or three numbers that the file gives.
    ///
    /// # Panics
    ///
    /// If there is no such texture coordinate.
    #[must_use]
    pub fn texture(&self, index: usize) -> &[f64] {
        assert!(
            index < self.texture.len(),
            "texture coordinate {index} is not in this document"
        );
        self.texture.row(index)
    }

    /// The normals of the file.
    #[must_use]
    pub fn normals(&self) -> &[[f64; 3]] {
        &self.normals
    }

    /// The vertices of all triangles. The triangles of a polygon are neighbours, and polygons
    /// are in the order of the file.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        match &self.triangulation {
            Some(triangulation) => triangulation.triangles(),
            None => self.polygons.vertices.as_chunks().0,
        }
    }

    /// The vertex, texture coordinate and normal that a corner (0, 1 or 2) of a triangle refers to.
    /// Logarithmic in the number of polygons, unless all are triangles.
    ///
    /// # Panics
    ///
    /// If there is no such triangle or corner.
    #[must_use]
    pub fn corner(&self, triangle: usize, corner: usize) -> Corner {
        assert!(corner < 3, "a triangle has no corner {corner}");
        assert!(
            triangle < self.triangles().len(),
            "triangle {triangle} is not in this document"
        );
        self.polygons
            .corner(self.corner_of_polygon(triangle, corner, self.polygon_of(triangle)))
    }

    /// The number of a corner (0, 1 or 2) of a triangle among the corners of all polygons, counted
    /// from 0 through the polygons in order. Takes as long as [`Document::corner`].
    ///
    /// # Panics
    ///
    /// If there is no such triangle or corner.
    #[must_use]
    pub fn number_of_corner(&self, triangle: usize, corner: usize) -> usize {
        assert!(corner < 3, "a triangle has no corner {corner}");
        self.corner_of_polygon(triangle, corner, self.polygon_of(triangle))
    }

    /// The number of polygons: the `f` statements.
    #[must_use]
    pub fn polygon_count(&self) -> usize {
        self.polygons.len()
    }

    /// The corners of a polygon, in order.
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

    /// The polygon that a triangle belongs to. Logarithmic in the number of polygons, unless all
    /// are triangles.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[must_use]
    pub fn polygon_of(&self, triangle: usize) -> usize {
        assert!(
            triangle < self.triangles().len(),
            "triangle {triangle} is not in this document"
        );
        match self.triangulation {
            Some(_) => self.polygons.of_triangle(triangle),
            None => triangle,
        }
    }

    /// The line of the file, counted from 1, on which the `f` statement of a triangle begins.
    ///
    /// # Panics
    ///
    /// If there is no such triangle.
    #[must_use]
    pub fn line_of_triangle(&self, triangle: usize) -> usize {
        self.layout.line_of_polygon(self.polygon_of(triangle))
    }

    /// The line of the file, counted from 1, on which the `v` statement of a vertex begins. Meant
    /// for messages: linear in the number of runs of statements of one kind.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn line_of_vertex(&self, vertex: usize) -> usize {
        let line = self.layout.line_of_vertex(vertex);
        line.unwrap_or_else(|| panic!("vertex {vertex} is not in this document"))
    }

    /// The number of `v` statements in the file: the vertices, and the copies of vertices that were
    /// written for their fans ([the record](crate#the-record)).
    #[must_use]
    pub fn vertex_statement_count(&self) -> usize {
        let copies = self
            .record
            .as_deref()
            .map_or(0, |record| record.copies.len());
        self.positions.len() + copies
    }

    /// The number of a vertex in the file, counted from 1. It exceeds the index plus 1 if copies of
    /// vertices for their fans come before it. Logarithmic in the number of copies.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn number_of_vertex(&self, vertex: usize) -> usize {
        assert!(
            vertex < self.positions.len(),
            "vertex {vertex} is not in this document"
        );
        let record = self.record.as_deref();
        record.map_or(vertex, |record| record.number(vertex)) + 1
    }

    /// The vertex that has this number in the file, counted from 1, or that the `v` with this
    /// number is a copy of; `None` if the file has no such `v`.
    #[must_use]
    pub fn vertex_of_number(&self, number: usize) -> Option<usize> {
        let index = number.checked_sub(1)?;
        let record = self.record.as_deref();
        let vertex = record.map_or(index, |record| record.vertex(index));
        (vertex < self.positions.len()).then_some(vertex)
    }

    /// Warnings and notes, in the order in which they should be shown.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
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
            Some(triangulation) => {
                let nth = triangle - self.polygons.triangles(polygon).start;
                let [a, b, c] = triangulation.corners(triangle, nth);
                self.polygons.starts[polygon] as usize + usize::from([a, b, c][corner])
            }
            None => 3 * triangle + corner,
        }
    }
}
