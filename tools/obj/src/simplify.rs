//! Taking out again what cuts inserted.

use tearmesh::{Mesh, Positions};

use crate::diagnostic::ReadError;
use crate::document::Document;
use crate::torn::TornDocument;
use crate::write::{Prepared, write};

impl TornDocument<'_> {
    /// The document without the vertices that cuts inserted and that keep nothing apart any more,
    /// and with the faces that they divided whole again; `None` if nothing can go.
    ///
    /// Mending sews the sides of a cut, and leaves the vertices along it. An inserted vertex goes if
    /// all its copies are one again and every face that it divided is restored. A divided
    /// face is restored if every vertex inserted in it or on its edges goes, and all its parts
    /// agree on the vertex, the texture coordinate and the normal at each of its corners. So
    /// faces go together along the whole length of a cut, up to where it is still open.
    /// Texture coordinates and normals that were inserted go if no face is left that has them.
    ///
    /// After a cut is mended altogether, this gives what was there before it, bit for bit; but for
    /// the positions of vertices that were moved, and in a file that has `v` after `f`, for the place
    /// of `v` statements that the cut had to move up.
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
    /// use tearmesh::{Edits, HalfEdgeId, Positions, subdivide::Plan};
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
    /// let simple = torn.simplified(&mesh, &positions)?.expect("the vertex holds nothing apart");
    /// assert_eq!(simple.triangles(), document.triangles());
    /// assert_eq!(simple.positions(), document.positions());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn simplified(
        &self,
        mesh: &Mesh,
        positions: &Positions,
    ) -> Result<Option<Document>, ReadError> {
        self.assert_in_step(mesh, positions);
        let Some(removal) = self.removal(mesh) else {
            return Ok(None);
        };
        let mut bytes = Vec::new();
        write(
            self,
            &Prepared::new(self, mesh, Some(&removal)),
            positions,
            &mut bytes,
        )?;
        Document::read(&bytes[..]).map(Some)
    }
}
