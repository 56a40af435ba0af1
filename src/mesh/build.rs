//! Triangles to half-edges, or an error that lists every offender.
//!
//! The half-edges of an edge find each other by a counting sort into a bucket for the
//! smaller of its two vertices; within the bucket, which has a handful of entries, those with
//! the same larger vertex meet. No edge is hashed, no list is followed through memory, and
//! a hub does not cost a square (a large bucket is sorted). Linear in faces and
//! vertices: 20–40 ns a face where the order of faces is kind to the cache.
//!
//! The fast path only notices *that* something is wrong; what exactly is
//! worked out by `diagnose.rs`, which may take its time.

use std::fmt;

use super::diagnose::diagnose;
use super::{Link, Mesh, NO_HALF_EDGE};
use crate::id::{FaceId, HalfEdgeId, VertexId};

impl Mesh {
    /// Builds the mesh of these triangles over `vertices` vertices.
    ///
    /// The triangles must form an oriented 2-manifold, with or without boundary, in
    /// any number of components (Souza et al. 2014 §IV-B: "we assume that our
    /// initial triangle mesh is a valid 2-manifold surface"). Vertices that no face uses are
    /// allowed, and keep their ids.
    ///
    /// # Errors
    ///
    /// [`BuildError`] lists every [`Defect`], each with the ids concerned.
    ///
    /// ```
    /// use tearmesh::{Defect, Mesh};
    ///
    /// let error = Mesh::build(5, &[[0, 1, 2], [2, 1, 3], [1, 2, 4]]).unwrap_err();
    /// assert!(matches!(error.defects(), [Defect::CrowdedEdge { faces, .. }] if faces.len() == 3));
    /// ```
    #[expect(
        clippy::missing_panics_doc,
        reason = "only a bug of ours can trip the assertion"
    )]
    pub fn build(vertices: usize, triangles: &[[u32; 3]]) -> Result<Mesh, BuildError> {
        build(vertices, triangles).ok_or_else(|| {
            let defects = diagnose(vertices, triangles);
            assert!(
                !defects.is_empty(),
                "a refused mesh has a defect that can be named"
            );
            BuildError { defects }
        })
    }
}

/// The mesh, or `None` if anything at all is wrong.
fn build(vertices: usize, triangles: &[[u32; 3]]) -> Option<Mesh> {
    if vertices > Mesh::MAX_VERTICES || triangles.len() > Mesh::MAX_FACES {
        return None;
    }
    let mut bucket_ends = vec![0u32; vertices];
    for &[a, b, c] in triangles {
        if a.max(b).max(c) as usize >= vertices || a == b || b == c || c == a {
            return None;
        }
        for (from, to) in [(a, b), (b, c), (c, a)] {
            bucket_ends[from.min(to) as usize] += 1;
        }
    }
    let link = pair_half_edges(triangles, bucket_ends)?;
    let origin = triangles.as_flattened().to_vec();
    let mut outgoing = vec![NO_HALF_EDGE; vertices];
    for (h, &v) in origin.iter().enumerate().rev() {
        outgoing[v as usize] = h as u32; // The last one written is the smallest.
    }
    let mesh = Mesh {
        origin,
        link,
        outgoing,
    };
    (every_vertex_has_one_fan(&mesh) && no_face_lies_on_another(&mesh)).then_some(mesh)
}

/// A half-edge in the bucket of its smaller vertex, in one number so that entries sort
/// fast: the larger vertex, the half-edge, and whether it runs from larger to smaller.
fn entry(from: u32, to: u32, half_edge: u32) -> u64 {
    u64::from(from.max(to)) << 32 | u64::from(half_edge) << 1 | u64::from(from > to)
}

/// Above this size a bucket is sorted by the library, below by insertion.
const SMALL_BUCKET: usize = 48;

/// Links the half-edges that run along the same edge in opposite directions; `None` where
/// there are others along it. `bucket_ends` has the size of each bucket.
fn pair_half_edges(triangles: &[[u32; 3]], mut bucket_ends: Vec<u32>) -> Option<Vec<Link>> {
    // First the number of entries before each bucket; filling then moves
    // each number on to the end of its bucket.
    let mut before = 0;
    for end in &mut bucket_ends {
        before += *end;
        *end = before - *end;
    }
    let mut entries = vec![0u64; 3 * triangles.len()];
    let mut half_edge = 0;
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let slot = &mut bucket_ends[from.min(to) as usize];
            entries[*slot as usize] = entry(from, to, half_edge);
            *slot += 1;
            half_edge += 1;
        }
    }
    let mut link = vec![Link::BOUNDARY; entries.len()];
    let mut start = 0;
    for end in bucket_ends {
        let bucket = &mut entries[start..end as usize];
        start = end as usize;
        sort(bucket);
        let mut rest = &*bucket;
        while let [one, other, tail @ ..] = rest {
            if one >> 32 != other >> 32 {
                rest = &rest[1..];
                continue;
            }
            let same_direction = (one ^ other) & 1 == 0;
            if same_direction || tail.first().is_some_and(|third| third >> 32 == one >> 32) {
                return None;
            }
            let (h, g) = (*one as u32 >> 1, *other as u32 >> 1);
            link[h as usize] = Link::to(HalfEdgeId::from_u32(g));
            link[g as usize] = Link::to(HalfEdgeId::from_u32(h));
            rest = tail;
        }
    }
    Some(link)
}

fn sort(bucket: &mut [u64]) {
    if bucket.len() > SMALL_BUCKET {
        return bucket.sort_unstable();
    }
    for i in 1..bucket.len() {
        let entry = bucket[i];
        let mut at = i;
        while at > 0 && bucket[at - 1] > entry {
            bucket[at] = bucket[at - 1];
            at -= 1;
        }
        bucket[at] = entry;
    }
}

/// One walk from each vertex reaches every corner, or some vertex has a second fan.
fn every_vertex_has_one_fan(mesh: &Mesh) -> bool {
    let reached: usize = mesh
        .vertices()
        .filter_map(|v| mesh.half_edge_of(v))
        .map(|h| mesh.fan(h).count())
        .sum();
    reached == mesh.half_edge_count()
}

/// Two triangles that share two edges share all three vertices.
fn no_face_lies_on_another(mesh: &Mesh) -> bool {
    mesh.faces().all(|f| {
        let [a, b, _] = f.half_edges().map(|h| mesh.pair(h).map(HalfEdgeId::face));
        a.is_none() || a != b
    })
}

/// Why triangles were refused: every defect, in the order of [`Defect`]'s variants and
/// then by ids.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BuildError {
    defects: Vec<Defect>,
}

impl BuildError {
    /// All defects; never empty.
    #[must_use]
    pub fn defects(&self) -> &[Defect] {
        &self.defects
    }
}

/// One reason to refuse triangles, with all ids concerned.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Defect {
    /// More vertices than ids.
    TooManyVertices {
        /// How many there are.
        given: usize,
        /// [`Mesh::MAX_VERTICES`].
        limit: usize,
    },
    /// More faces than ids.
    TooManyFaces {
        /// How many there are.
        given: usize,
        /// [`Mesh::MAX_FACES`].
        limit: usize,
    },
    /// A face names a vertex that does not exist.
    IndexOutOfRange {
        /// The face.
        face: FaceId,
        /// Its corner, 0 to 2.
        corner: usize,
        /// The vertex index given there.
        index: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A face names the same vertex twice.
    RepeatedVertex {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Faces on the same three vertices, at least two of them facing the same way.
    DuplicateFaces {
        /// The vertices, ascending.
        vertices: [VertexId; 3],
        /// All faces on them, ascending.
        faces: Vec<FaceId>,
    },
    /// Two faces on the same three vertices, back to back.
    Pillow {
        /// The vertices, ascending.
        vertices: [VertexId; 3],
        /// The two faces, ascending.
        faces: [FaceId; 2],
    },
    /// Three faces or more on an edge.
    CrowdedEdge {
        /// The ends, ascending.
        ends: [VertexId; 2],
        /// All faces on the edge, ascending.
        faces: Vec<FaceId>,
    },
    /// Two faces run along an edge in the same direction: one of them is flipped.
    FlippedFace {
        /// Where both half-edges start.
        from: VertexId,
        /// Where both end.
        to: VertexId,
        /// The two faces, ascending.
        faces: [FaceId; 2],
    },
    /// A vertex with several fans of faces that share no edge (Souza et al. 2014, Fig. 2).
    BowTie {
        /// The vertex.
        vertex: VertexId,
        /// The faces of each fan, ascending.
        fans: Vec<Vec<FaceId>>,
    },
}

/// How many defects, and how many faces of one, a message shows.
const SHOWN: usize = 20;

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let count = self.defects.len();
        let plural = if count == 1 { "" } else { "s" };
        write!(f, "not an oriented 2-manifold: {count} defect{plural}")?;
        for defect in self.defects.iter().take(SHOWN) {
            write!(f, "\n  {defect}")?;
        }
        if count > SHOWN {
            write!(f, "\n  and {} more", count - SHOWN)?;
        }
        Ok(())
    }
}

impl std::error::Error for BuildError {}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Defect::TooManyVertices { given, limit } => {
                write!(f, "{given} vertices, the limit is {limit}")
            }
            Defect::TooManyFaces { given, limit } => {
                write!(f, "{given} faces, the limit is {limit}")
            }
            Defect::IndexOutOfRange {
                face,
                corner,
                index,
                vertices,
            } => write!(
                f,
                "{face} names vertex {index} at corner {corner}, but there are {vertices} vertices"
            ),
            Defect::RepeatedVertex { face, vertex } => {
                write!(f, "{face} names {vertex} more than once")
            }
            Defect::DuplicateFaces {
                vertices: [a, b, c],
                faces,
            } => {
                write!(
                    f,
                    "the vertices {a}, {b}, {c} have several faces: {}",
                    list(faces)
                )
            }
            Defect::Pillow {
                vertices: [a, b, c],
                faces,
            } => {
                write!(
                    f,
                    "two faces lie back to back on {a}, {b}, {c}: {}",
                    list(faces)
                )
            }
            Defect::CrowdedEdge {
                ends: [a, b],
                faces,
            } => {
                write!(
                    f,
                    "the edge {a}-{b} has {} faces: {}",
                    faces.len(),
                    list(faces)
                )
            }
            Defect::FlippedFace {
                from,
                to,
                faces: [a, b],
            } => {
                write!(
                    f,
                    "{a} and {b} both run from {from} to {to}: one of them is flipped"
                )
            }
            Defect::BowTie { vertex, fans } => {
                write!(f, "{vertex} joins {} fans that share no edge:", fans.len())?;
                for (i, fan) in fans.iter().take(SHOWN).enumerate() {
                    write!(f, "{}{}", if i == 0 { " " } else { " | " }, list(fan))?;
                }
                if fans.len() > SHOWN {
                    write!(f, " | …")
                } else {
                    Ok(())
                }
            }
        }
    }
}

fn list(faces: &[FaceId]) -> String {
    let mut text: Vec<String> = faces.iter().take(SHOWN).map(FaceId::to_string).collect();
    if faces.len() > SHOWN {
        text.push(format!("and {} more", faces.len() - SHOWN));
    }
    text.join(", ")
}
