//! A document whose vertices are declared to be parts of others, without a record that says so.

use std::fmt;

use tearmesh::Mesh;

use crate::document::Document;
use crate::mesh::MeshError;
use crate::record::{Record, SplitOff, are_last, runs};

impl Document {
    /// Returns whether the file has a valid record of its tears ([the record](crate#the-record)).
    #[must_use]
    pub fn has_record(&self) -> bool {
        self.record.is_some()
    }

    /// Returns this document, with the record that cut 1 split each vertex from its root, and its mesh.
    /// `roots` are as [`Mesh::roots`] lists them. Those of seams that coincide are
    /// [`UnsewnSeams::lowest`](tearmesh::unsewn::UnsewnSeams::lowest); once they are
    /// [sewn](tearmesh::mend::sew), nothing of this record is left.
    ///
    /// # Errors
    ///
    /// [`TornFromError`] if the sewn mesh would not be an oriented 2-manifold, or if sewing would
    /// change vertex numbers to which other statements of the file may refer.
    ///
    /// # Panics
    ///
    /// If the document has a record, or if `roots` are not those of a mesh with its triangles.
    ///
    /// ```
    /// use tearmesh::{Positions, mend, unsewn::UnsewnSeams};
    /// use tearmesh_obj::Document;
    ///
    /// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 6 5 4\n";
    /// let document = Document::read(&file[..])?;
    /// let (mesh, positions) = (document.mesh()?, Positions::new(document.positions().to_vec())?);
    /// let seams = UnsewnSeams::find(&mesh, &positions);
    /// let (torn, mesh) = document.torn_from(&seams.lowest(&mesh))?;
    /// assert_eq!((torn.has_record(), mesh.roots()), (true, vec![0, 1, 2, 3, 1, 2]));
    /// assert_eq!(mend::stitches(&mesh, |_| true).len(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn torn_from(mut self, roots: &[u32]) -> Result<(Document, Mesh), TornFromError> {
        assert!(!self.has_record(), "what is on record is not guessed");
        let split = |(vertex, &from): (u32, &u32)| {
            let cut = 1;
            (from != vertex).then_some(SplitOff { vertex, from, cut })
        };
        let splits: Vec<SplitOff> = (0..).zip(roots).filter_map(split).collect();
        let going = runs(splits.iter().map(|split| split.vertex));
        if let Some(keyword) = self.statement_with_indices()
            && !are_last(&going, self.positions.len() as u32)
        {
            let keyword = String::from_utf8_lossy(keyword).into_owned();
            return Err(TornFromError::Numbers { keyword });
        }
        self.record = Some(Box::new(Record {
            splits,
            ..Record::default()
        }));
        match self.mesh() {
            Ok(mesh) => Ok((self, mesh)),
            Err(error) => Err(TornFromError::Mesh(error)),
        }
    }
}

/// The reason why vertices of a document cannot be parts of others.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TornFromError {
    /// A statement may name a vertex by a number that sewing would change.
    Numbers {
        /// The keyword of the statement.
        keyword: String,
    },
    /// The sewn mesh would not be an oriented 2-manifold.
    Mesh(MeshError),
}

impl fmt::Display for TornFromError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TornFromError::Numbers { keyword } => write!(
                f,
                "`{keyword}` may name a vertex by its number, which sewing would change"
            ),
            TornFromError::Mesh(error) => {
                write!(f, "once sewn, they would not form a surface: {error}")
            }
        }
    }
}

impl std::error::Error for TornFromError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            TornFromError::Mesh(error) => Some(error),
            _ => None,
        }
    }
}
