//! Finds boundary edges that lie on each other. They remain of cuts if another program dropped the
//! record, or of texture seams if a program wrote each vertex there twice.

use std::fmt;

use tearmesh::{DisjointSets, HalfEdgeId, Mesh, VertexId};

use crate::document::Document;
use crate::mesh::MeshError;
use crate::record::{Record, SplitOff, are_last, runs};

/// The pairs of boundary edges that have bit-equal ends and run in opposite directions, with no third
/// boundary edge at the same place. Created by [`Document::coincident`].
#[derive(Clone, Debug, Default)]
pub struct Coincident {
    edges: usize,
    /// Ascending, each from the lowest vertex that is to be one with it.
    splits: Vec<SplitOff>,
}

impl Coincident {
    /// Returns the number of pairs of edges.
    #[must_use]
    pub fn edges(&self) -> usize {
        self.edges
    }

    /// Returns the number of vertices that sewing would remove by merging them into others.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.splits.len()
    }
}

impl Document {
    /// Returns whether the file has a valid record of its tears ([the record](crate#the-record)).
    #[must_use]
    pub fn has_record(&self) -> bool {
        self.record.is_some()
    }

    /// Finds the pairs of coincident boundary edges of `mesh`, which must be the mesh of this document.
    ///
    /// Linear in the document, plus the time to sort the boundary edges.
    ///
    /// # Panics
    ///
    /// If the mesh has more vertices than the document.
    #[must_use]
    pub fn coincident(&self, mesh: &Mesh) -> Coincident {
        let place = |v: VertexId| {
            let at = self.positions[v.index()];
            [at.x, at.y, at.z].map(f64::to_bits)
        };
        // Where its ends are, the lower first, and whether that is the one it begins at.
        let key = |&h: &HalfEdgeId| {
            let [from, to] = [mesh.origin(h), mesh.target(h)].map(place);
            (from.min(to), from.max(to), from < to)
        };
        let boundary = mesh
            .half_edges()
            .filter(|&h| mesh.pair_or_ghost(h).is_none());
        let mut edges: Vec<HalfEdgeId> = boundary.collect();
        edges.sort_unstable_by_key(key);
        let mut joined = DisjointSets::new(self.positions.len() as u32);
        let mut pairs = 0;
        let lie_together = |one: &HalfEdgeId, next: &HalfEdgeId| {
            let [(a, b, _), (c, d, _)] = [one, next].map(key);
            (a, b) == (c, d)
        };
        for at_one_place in edges.chunk_by(lie_together) {
            let &[one, other] = at_one_place else {
                continue;
            };
            let (is_one, is_other) = (key(&one).2, key(&other).2);
            if is_one == is_other || one.face() == other.face() {
                continue; // They run the same way, or have no length, or are of a face without area.
            }
            pairs += 1;
            for (a, b) in [
                (mesh.origin(one), mesh.target(other)),
                (mesh.target(one), mesh.origin(other)),
            ] {
                joined.join(a.into(), b.into());
            }
        }
        let all = 0..self.positions.len() as u32;
        let splits = all.filter_map(|vertex| {
            let (from, cut) = (joined.leader(vertex), 1);
            (from != vertex).then_some(SplitOff { vertex, from, cut })
        });
        Coincident {
            edges: pairs,
            splits: splits.collect(),
        }
    }

    /// Returns this document and its mesh with these pairs of edges marked as torn by cut 1. In the mesh
    /// they are ghost pairs, for which [`mend::stitches`](tearmesh::mend::stitches) finds the stitches.
    ///
    /// # Errors
    ///
    /// [`CoincidentError`] if the sewn mesh would not be an oriented 2-manifold, or if sewing would
    /// change vertex numbers to which other statements of the file may refer.
    ///
    /// # Panics
    ///
    /// If the document has a record.
    ///
    /// ```
    /// use tearmesh::mend;
    /// use tearmesh_obj::Document;
    ///
    /// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 6 5 4\n";
    /// let document = Document::read(&file[..])?;
    /// let pairs = document.coincident(&document.mesh()?);
    /// assert_eq!((pairs.edges(), pairs.vertices()), (1, 2));
    /// let (_, mesh) = document.torn_at(&pairs)?;
    /// assert_eq!(mend::stitches(&mesh, |_| true).len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn torn_at(mut self, pairs: &Coincident) -> Result<(Document, Mesh), CoincidentError> {
        assert!(!self.has_record(), "what is on record is not guessed");
        let going = runs(pairs.splits.iter().map(|split| split.vertex));
        if let Some(keyword) = self.statement_with_indices()
            && !are_last(&going, self.positions.len() as u32)
        {
            let keyword = String::from_utf8_lossy(keyword).into_owned();
            return Err(CoincidentError::Numbers { keyword });
        }
        self.record = Some(Box::new(Record {
            splits: pairs.splits.clone(),
            ..Record::default()
        }));
        match self.mesh() {
            Ok(mesh) => Ok((self, mesh)),
            Err(error) => Err(CoincidentError::Mesh(error)),
        }
    }

    /// Returns this document, with the record that cut 1 split each vertex from its root, and its mesh.
    /// `roots` are as [`Mesh::roots`] lists them.
    ///
    /// # Errors
    ///
    /// For the same reasons as [`Document::torn_at`].
    ///
    /// # Panics
    ///
    /// If the document has a record, or if `roots` are not those of a mesh with its triangles.
    ///
    /// ```
    /// use tearmesh_obj::Document;
    ///
    /// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nf 1 2 3\nf 3 5 4\n";
    /// let (torn, mesh) = Document::read(&file[..])?.torn_from(&[0, 1, 2, 3, 1])?;
    /// assert_eq!((torn.has_record(), mesh.roots()), (true, vec![0, 1, 2, 3, 1]));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn torn_from(self, roots: &[u32]) -> Result<(Document, Mesh), CoincidentError> {
        let split = |(vertex, &from): (u32, &u32)| {
            let cut = 1;
            (from != vertex).then_some(SplitOff { vertex, from, cut })
        };
        let splits = (0..).zip(roots).filter_map(split).collect();
        self.torn_at(&Coincident { edges: 0, splits })
    }
}

/// The reason why coincident edges cannot be sewn.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum CoincidentError {
    /// A statement may name a vertex by a number that sewing would change.
    Numbers {
        /// The keyword of the statement.
        keyword: String,
    },
    /// The sewn mesh would not be an oriented 2-manifold.
    Mesh(MeshError),
}

impl fmt::Display for CoincidentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CoincidentError::Numbers { keyword } => write!(
                f,
                "`{keyword}` may name a vertex by its number, which sewing would change"
            ),
            CoincidentError::Mesh(error) => {
                write!(f, "once sewn, they would not form a surface: {error}")
            }
        }
    }
}

impl std::error::Error for CoincidentError {}
