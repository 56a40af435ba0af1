//! Builds half-edges from triangles, or an error that lists the defects.
//!
//! The half-edges of an edge find each other by a counting sort into a bucket for the
//! smaller of its two vertices; within the bucket, which has a handful of entries, those with
//! the same larger vertex meet. No edge is hashed, no list is followed through memory, and
//! a hub does not cost a square (a large bucket is sorted). Linear in faces and
//! vertices: 20–40 ns a face where the order of faces is kind to the cache.
//!
//! The fast path only notices *that* something is wrong; what exactly is
//! worked out by `diagnose.rs`, which may take its time.

use std::borrow::Cow;

use super::defect::{BuildError, Faces};
use super::{Link, Mesh, NO_HALF_EDGE};
use crate::id::HalfEdgeId;

impl Mesh {
    /// Builds a mesh of `vertices` vertices from triangles, each given by the indices of its vertices.
    ///
    /// The triangles must form an oriented 2-manifold, with or without boundary, in
    /// any number of components (Souza et al. 2014 §IV-B: "we assume that our
    /// initial triangle mesh is a valid 2-manifold surface"). Vertices that no face uses are
    /// allowed, and keep their ids. A `Vec` given by value becomes part of the mesh; a slice is copied.
    ///
    /// # Errors
    ///
    /// [`BuildError`] lists each [`Defect`](super::Defect) with the ids concerned, up to a thousand of a
    /// kind, and counts the others. That takes O(n log n) time and up to eight bytes per face.
    ///
    /// ```
    /// use tearmesh::{Defect, Mesh};
    ///
    /// let error = Mesh::build(5, &[[0, 1, 2], [2, 1, 3], [1, 2, 4]]).unwrap_err();
    /// assert_eq!(error.defects().len(), 1);
    /// for defect in error.defects() {
    ///     assert!(matches!(defect, Defect::CrowdedEdge { faces, .. } if faces.len() == 3));
    /// }
    /// ```
    pub fn build<'t>(
        vertices: usize,
        triangles: impl Into<Cow<'t, [[u32; 3]]>>,
    ) -> Result<Mesh, BuildError> {
        let triangles = triangles.into();
        let Some(link) = links(vertices, &triangles) else {
            return Err(refusal(vertices, &triangles));
        };
        let origin = triangles.into_owned().into_flattened();
        let mesh = Mesh {
            outgoing: first_half_edges(vertices, &origin),
            origin,
            link,
            slides: 0,
        };
        if every_vertex_has_one_fan(&mesh) && no_face_lies_on_another(&mesh) {
            return Ok(mesh);
        }
        drop((mesh.link, mesh.outgoing));
        Err(refusal(vertices, mesh.origin.as_chunks().0))
    }
}

/// The smallest half-edge that starts at each vertex.
pub(super) fn first_half_edges(vertices: usize, origin: &[u32]) -> Vec<u32> {
    let mut first = vec![NO_HALF_EDGE; vertices];
    for (h, &v) in origin.iter().enumerate().rev() {
        first[v as usize] = h as u32; // The last one written is the smallest.
    }
    first
}

/// What is wrong with triangles that are not a mesh.
fn refusal(vertices: usize, triangles: &[[u32; 3]]) -> BuildError {
    let defects = BuildError::collect(|visit| {
        Mesh::diagnose(vertices, triangles, Faces::LISTED_MAX, visit);
    });
    defects.expect("a refused mesh has a defect that can be named")
}

/// The links of a mesh, or `None` if an edge or a face cannot be one of a mesh.
fn links(vertices: usize, triangles: &[[u32; 3]]) -> Option<Vec<Link>> {
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
    // Of a crowded edge nothing is stored: a few vertices with millions of faces would take
    // 36 bytes a face before the first edge is looked at.
    let largest = bucket_ends.iter().max().copied().unwrap_or(0);
    if largest as usize > 2 * vertices {
        return None; // Two half-edges an edge, and fewer edges at a vertex than vertices.
    }
    pair_half_edges(triangles, bucket_ends)
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
