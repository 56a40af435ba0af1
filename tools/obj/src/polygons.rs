//! The polygons of a file, as the file has them.

use crate::store::{Column, extend_by_some, partition_point, push};

/// The faces as the file has them, corner by corner.
#[derive(Clone, Debug, Default)]
pub(crate) struct Polygons {
    /// The vertex of each corner.
    pub(crate) vertices: Vec<u32>,
    pub(crate) texture: Column,
    pub(crate) normals: Column,
    /// The first corner of each polygon.
    pub(crate) starts: Vec<u32>,
}

/// The indices that a corner of a face refers to, counted from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Corner {
    /// The index of the vertex (`v`).
    pub vertex: u32,
    /// The index of the texture coordinate (`vt`), if the corner has one.
    pub texture: Option<u32>,
    /// The index of the normal (`vn`), if the corner has one.
    pub normal: Option<u32>,
}

impl Polygons {
    #[inline]
    pub(crate) fn len(&self) -> usize {
        self.starts.len()
    }

    /// The corners of a polygon.
    #[inline]
    pub(crate) fn corners(&self, polygon: usize) -> std::ops::Range<usize> {
        let next = self.starts.get(polygon + 1);
        let end = next.map_or(self.vertices.len(), |&end| end as usize);
        self.starts[polygon] as usize..end
    }

    #[inline]
    pub(crate) fn corner(&self, corner: usize) -> Corner {
        Corner {
            vertex: self.vertices[corner],
            texture: self.texture.get(corner),
            normal: self.normals.get(corner),
        }
    }

    /// The texture coordinate and the normal of a corner.
    #[inline]
    pub(crate) fn indices(&self, corner: usize) -> [Option<u32>; 2] {
        [self.texture.get(corner), self.normals.get(corner)]
    }

    /// The triangles of a polygon: a polygon of n corners has n − 2, so the corners before
    /// it say how many come before.
    #[inline]
    pub(crate) fn triangles(&self, polygon: usize) -> std::ops::Range<usize> {
        let corners = self.corners(polygon);
        corners.start - 2 * polygon..corners.end - 2 * (polygon + 1)
    }

    /// Appends a polygon with these corners.
    pub(crate) fn add(&mut self, corners: impl Iterator<Item = Corner>) {
        push(&mut self.starts, self.vertices.len() as u32);
        for corner in corners {
            let index = self.vertices.len();
            push(&mut self.vertices, corner.vertex);
            if let Some(texture) = corner.texture {
                self.texture.set(index, texture);
            }
            if let Some(normal) = corner.normal {
                self.normals.set(index, normal);
            }
        }
    }

    /// Appends a polygon of up to four corners, whose vertices come first of these, texture
    /// coordinates next and normals last: all of a kind `are_there`, or none.
    #[inline(always)]
    pub(crate) fn append(&mut self, corners: &[[u32; 4]; 3], are_there: [bool; 3], count: usize) {
        let first = self.vertices.len();
        push(&mut self.starts, first as u32);
        extend_by_some(&mut self.vertices, &corners[0], count);
        if are_there[1] {
            self.texture.extend_by_some(first, &corners[1], count);
        }
        if are_there[2] {
            self.normals.extend_by_some(first, &corners[2], count);
        }
    }

    /// The polygon that a triangle is a part of.
    pub(crate) fn of_triangle(&self, triangle: usize) -> usize {
        let starts_before = |polygon| self.triangles(polygon).start <= triangle;
        partition_point(self.len(), starts_before) - 1
    }

    /// Whether every polygon is a triangle.
    pub(crate) fn all_triangles(&self) -> bool {
        self.vertices.len() == 3 * self.len()
    }
}
