//! Removes vertices that cuts inserted, and puts back vertices that cuts moved.

use tearmesh::{Mesh, Positions};

use crate::diagnostic::ReadError;
use crate::document::Document;
use crate::torn::TornDocument;
use crate::write::{Prepared, write};

/// A simplified document, and counts of the vertices that had to stay or were put back. Returned by
/// [`TornDocument::simplified`].
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Simplified {
    /// The simplified document; `None` if there was nothing to remove or put back.
    pub document: Option<Document>,
    /// The number of inserted vertices that stay only because they were edited after the insertion.
    /// Other vertices may have to stay with them, and are not counted.
    pub edited: usize,
    /// The number of vertices that cuts had slid and that were put back.
    pub slid_back: usize,
    /// The number of vertices that cuts had slid and that stay in place only because they were edited
    /// after the slide.
    pub slid_edited: usize,
}

impl TornDocument<'_> {
    /// Removes the vertices that mended cuts inserted, restores the faces that these vertices divided,
    /// and puts back the vertices that the cuts slid.
    ///
    /// Mending sews the sides of a cut, but leaves the vertices along it. An inserted vertex is removed
    /// if every face that it divided is restored. A divided face is restored if every vertex inserted in
    /// it or on its edges is removed, all its parts agree on the vertex, the texture coordinate and the
    /// normal at each of its corners, and no tear runs between its parts or along a part of an edge. So
    /// faces are restored along the whole length of a cut, up to where it is still open, and open cuts
    /// become neither longer nor shorter. A face that was part of a divided one is restored by itself.
    /// Inserted texture coordinates and normals are removed if no remaining face uses them.
    ///
    /// A vertex that a cut slid is put back, with its extra numbers and the texture coordinates and
    /// normals of its corners. This requires that no tear of this cut or a later one still holds the
    /// vertex apart, and that all vertices inserted beside it since are removed. Several slides of a
    /// vertex are undone in reverse order.
    ///
    /// An inserted vertex stays if it was *edited* after the insertion. The recorded insertion determines
    /// its position, its extra numbers, and its texture coordinate and normal at each corner from those
    /// of the vertices that it was inserted between, as they were then. If any of these values differs by
    /// more than the rounding of a few operations on `f64`, the vertex was edited. This is so if the
    /// vertex or an end of its edge was moved, if its copies lay apart and were sewn somewhere between,
    /// or if a program rounded all coordinates of the file. The faces around an edited vertex, and those
    /// that depend on them, stay divided, so the surface does not move. [`Simplified::edited`] counts the
    /// edited vertices. A vertex that slid was edited if its numbers are not bit-equal to those that the
    /// slide gave it; it stays where it is, and [`Simplified::slid_edited`] counts it. Edited vertices stay
    /// in the record.
    ///
    /// If a cut is mended completely and nothing was edited, the result when written is byte for byte
    /// the file before the cut.
    ///
    /// The result is written and read again: linear in the document, with memory for one more file.
    ///
    /// # Errors
    ///
    /// The errors of [`Document::read`], if a position exceeds the limits of a file.
    ///
    /// # Panics
    ///
    /// If `mesh` is not the mesh whose log was followed to its end, or if the number of positions is
    /// not its number of vertices.
    ///
    /// ```
    /// use tearmesh::{Edits, HalfEdgeId, Positions, insert::Plan};
    /// use tearmesh_obj::{Document, TornDocument};
    ///
    /// let document = Document::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"[..])?;
    /// let mut mesh = document.mesh()?;
    /// let mut positions = Positions::new(document.positions().iter().copied())?;
    /// let mut torn = TornDocument::new(&document);
    /// let mut plan = Plan::new();
    /// plan.on_edge(HalfEdgeId::new(0).expect("small"), 0.5);
    /// let mut edits = Edits::new();
    /// plan.apply(&mut mesh, &mut edits)?;
    /// edits.replay(&mut (&mut positions, &mut torn));
    ///
    /// let simple = torn.simplified(&mesh, &positions)?.document;
    /// let simple = simple.expect("the vertex holds nothing apart");
    /// assert_eq!(simple.triangles(), document.triangles());
    /// assert_eq!(simple.positions(), document.positions());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn simplified(&self, mesh: &Mesh, positions: &Positions) -> Result<Simplified, ReadError> {
        self.assert_in_step(mesh, positions);
        let (removal, found) = self.removal(mesh, positions);
        let simplified = Simplified {
            document: None,
            edited: found.edited,
            slid_back: found.slid_back,
            slid_edited: found.slid_edited,
        };
        let Some(removal) = removal else {
            return Ok(simplified);
        };
        let mut bytes = Vec::new();
        write(
            self,
            &Prepared::new(self, mesh, Some(&removal), self.apart(positions)),
            positions,
            &mut bytes,
        )?;
        let document = Some(Document::read(&bytes[..])?);
        Ok(Simplified {
            document,
            ..simplified
        })
    }
}
