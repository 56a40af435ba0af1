//! Removes vertices that cuts inserted, and puts back vertices that cuts moved.

use tearmesh::{Mesh, Positions};

use crate::diagnostic::ReadError;
use crate::document::Document;
use crate::torn::TornDocument;
use crate::write::{Prepared, write};

/// The result of [`TornDocument::simplified`].
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Simplified {
    /// The document without the vertices that could be removed; `None` if none could.
    pub document: Option<Document>,
    /// The number of inserted vertices that stay only because they were edited since. Other
    /// vertices may have to stay with them.
    pub edited: usize,
    /// The number of vertices that had slid and were put back.
    pub slid_back: usize,
    /// The number of vertices that had slid and stay where they are only because they were edited
    /// since.
    pub slid_edited: usize,
}

impl TornDocument<'_> {
    /// The document without the vertices that cuts inserted and that keep nothing apart any more,
    /// with the faces that they divided whole again, and with the vertices that they slid put back.
    ///
    /// Mending sews the sides of a cut, and leaves the vertices along it. An inserted vertex goes if
    /// all its copies are one again and every face that it divided is restored. A divided
    /// face is restored if every vertex inserted in it or on its edges goes, and all its parts
    /// agree on the vertex, the texture coordinate and the normal at each of its corners. So
    /// faces go together along the whole length of a cut, up to where it is still open.
    /// Texture coordinates and normals that were inserted go if no face is left that has them.
    ///
    /// A vertex that a cut slid is put back, with its extra numbers and the texture coordinates and
    /// normals of its corners: if nothing that this cut or a later one tore holds it apart, and
    /// everything goes that was put beside it since. Several slides of a vertex are undone in
    /// reverse order.
    ///
    /// An inserted vertex stays if it was *edited* since, by another program: if its position, its
    /// extra numbers, or its texture coordinate or normal at some corner is not,
    /// but for the rounding of a few operations on `f64`, what the recorded insertion makes of those
    /// at the vertices that it was put between, as these were then. A vertex was edited, then, if it
    /// was moved, if an end of its edge was, if its copies lay apart and were sewn
    /// somewhere between, or if a program rounded all coordinates of the file. The faces round
    /// it stay divided, and so does what hangs together with them; so the surface is
    /// where it was. [`Simplified::edited`] counts these vertices. A vertex that slid and has not, to the
    /// bit, what the slide left it, was edited too, and stays where it is:
    /// [`Simplified::slid_edited`] counts those. Both stay on record.
    ///
    /// After a cut is mended altogether and nothing was edited, this gives what was there before it,
    /// byte for byte.
    ///
    /// The document is made by writing and reading: linear, in the memory of a file more.
    ///
    /// # Errors
    ///
    /// Those of [`Document::read`], where a position is beyond what a file may have.
    ///
    /// # Panics
    ///
    /// If the mesh is not the one whose log was followed, to its end, or if there is not a
    /// position for each vertex.
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
