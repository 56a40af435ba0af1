//! The triangles that a mesh is built from.

use tearmesh::Mesh;

/// A mesh as a list of triangles.
pub(super) struct Triangles {
    pub(super) name: &'static str,
    pub(super) vertices: usize,
    pub(super) corners: Vec<[u32; 3]>,
}

impl Triangles {
    pub(super) fn of(name: &'static str, mesh: &Mesh) -> Triangles {
        Triangles {
            name,
            vertices: mesh.vertex_count(),
            corners: mesh.indices().as_chunks::<3>().0.to_vec(),
        }
    }

    /// The same by another name, shuffled as Fisher and Yates do, with Knuth's generator.
    pub(super) fn shuffled(&self, name: &'static str) -> Triangles {
        let (mut corners, mut state) = (self.corners.clone(), 2014_u64);
        for i in (1..corners.len()).rev() {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            corners.swap(i, (state >> 33) as usize % (i + 1));
        }
        Triangles {
            name,
            vertices: self.vertices,
            corners,
        }
    }
}

/// How many faces a walk comes to, and the sum of their numbers.
pub(super) fn counted(faces: impl Iterator<Item = usize>) -> (usize, usize) {
    faces.fold((0, 0), |(count, sum), face| {
        (count + 1, sum.wrapping_add(face))
    })
}
