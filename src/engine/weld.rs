//! The construction of meshes from an engine's buffers, in which vertices are repeated along
//! texture seams and hard edges.
//!
//! An engine's vertex combines a position, a texture coordinate and a normal. Where one of these
//! differs from face to face, the buffer has several vertices at one place. A mesh with these vertices
//! would be cut along every seam. Here vertices at one place are welded. The values that differed
//! belong to the corners, and [`DrawBuffers`](crate::engine::DrawBuffers) turns them back into a vertex buffer.

use std::fmt;

use crate::id::VertexId;
use crate::mesh::{BuildError, Mesh};
use crate::place::{PositionError, Positions};

/// The result of welding an engine's buffers: see [`by_place`].
#[derive(Clone, Debug)]
pub struct Welded {
    /// The mesh. Its faces are those of the index buffer, in the same order.
    pub mesh: Mesh,
    /// The positions of the vertices of the mesh.
    pub positions: Positions,
    /// The vertex of the mesh that each vertex of the buffer became, indexed by vertex of the buffer.
    pub vertices: Vec<VertexId>,
}

/// Builds a mesh from an engine's vertex and index buffers, and merges vertices at the same place.
///
/// Two places are the same if all coordinates are equal as numbers. There is no tolerance, because
/// engines copy the vertices that they repeat. The vertices of the mesh are numbered in the order
/// in which their places first appear in the buffer.
///
/// ```
/// use tearmesh::engine::{weld, DrawBuffers};
///
/// // A square of two triangles, with a texture seam along the diagonal.
/// let places = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
/// let uv = [[0.0_f32, 0.0], [0.5, 0.0], [0.5, 1.0], [0.5, 0.0], [1.0, 1.0], [0.5, 1.0]];
/// let triangles = [[0, 1, 2], [3, 4, 5]];
///
/// let welded = weld::by_place(&places, &triangles)?;
/// assert_eq!((welded.mesh.vertex_count(), welded.vertices[3].index()), (4, 0));
/// let uv = triangles.as_flattened().iter().map(|&i| uv[i as usize]);
/// let buffers = DrawBuffers::new(&welded.mesh, uv.collect());
/// assert_eq!(buffers.len(), 6);
/// # Ok::<(), tearmesh::engine::weld::WeldError>(())
/// ```
///
/// # Errors
///
/// [`WeldError`] if the buffers are invalid. If a surface touches itself at a vertex, the welded mesh
/// is not a manifold, and is refused with a list of the defects. Give such vertices different places.
pub fn by_place(places: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Welded, WeldError> {
    let known = places.len();
    let indices = triangles.as_flattened();
    if let Some(&index) = indices.iter().find(|&&index| index as usize >= known) {
        return Err(WeldError::Index { index, known });
    }
    // The error names the vertices of the buffer.
    positions(places)?;
    // Minus zero is zero, and only then do equal numbers have equal bits.
    let key = |i: u32| places[i as usize].map(|x| (x + 0.0).to_bits());
    let mut by_place: Vec<u32> = (0..known as u32).collect();
    by_place.sort_unstable_by_key(|&i| (key(i), i));
    let mut first = vec![0; known];
    for run in by_place.chunk_by(|&a, &b| key(a) == key(b)) {
        run.iter().for_each(|&i| first[i as usize] = run[0]);
    }
    let mut vertices: Vec<VertexId> = Vec::with_capacity(known);
    let mut welded = Vec::new();
    for (i, &first) in first.iter().enumerate() {
        if first as usize == i {
            vertices.push(VertexId::from_u32(welded.len() as u32));
            welded.push(places[i]);
        } else {
            vertices.push(vertices[first as usize]);
        }
    }
    let faces = triangles.iter();
    let faces = faces.map(|face| face.map(|i| u32::from(vertices[i as usize])));
    let mesh = Mesh::build(welded.len(), faces.collect::<Vec<_>>()).map_err(WeldError::Build)?;
    Ok(Welded {
        mesh,
        positions: positions(&welded)?,
        vertices,
    })
}

fn positions(places: &[[f32; 3]]) -> Result<Positions, WeldError> {
    let places = places.iter().map(|place| place.map(f64::from));
    Positions::new(places).map_err(WeldError::Place)
}

/// The reason why buffers were refused.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum WeldError {
    /// A triangle refers to a vertex that the buffer does not have.
    Index {
        /// The vertex index in the triangle.
        index: u32,
        /// The number of vertices in the buffer.
        known: usize,
    },
    /// Some vertices of the buffer have coordinates that are not finite. The error lists them.
    Place(PositionError),
    /// After welding, the triangles do not form an oriented 2-manifold. The error names faces of
    /// the index buffer and vertices of the welded mesh.
    Build(BuildError),
}

impl fmt::Display for WeldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            WeldError::Index { index, known } => {
                write!(
                    f,
                    "a triangle names vertex {index}, but there are {known} vertices"
                )
            }
            WeldError::Place(error) => error.fmt(f),
            WeldError::Build(error) => write!(f, "welded, this is {error}"),
        }
    }
}

impl std::error::Error for WeldError {}
