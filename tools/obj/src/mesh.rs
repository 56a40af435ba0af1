//! The mesh of a document, or what is wrong with it in the terms of the file.
//!
//! The kernel speaks of faces and vertices by id; a person who has to repair a file wants
//! lines, and vertices as the file counts them, from 1.

use std::fmt;

use tearmesh::{BuildError, Defect, FaceId, Faces, Fans, Mesh, TornError, VertexId};

use crate::diagnostic::{Diagnostic, Location};
use crate::document::Document;

/// How many defects are put into words, and how many lines one of them lists.
const SHOWN: usize = 20;

impl Document {
    /// Builds the mesh of the triangles. Face `i` is triangle `i`, and vertices keep their indices. If
    /// the file has a record of tears, the result is the torn mesh that was written, with every pair
    /// and ghost pair.
    ///
    /// # Errors
    ///
    /// [`MeshError`] lists the defects if the triangles do not form an oriented 2-manifold.
    ///
    /// ```
    /// use tearmesh_obj::Document;
    ///
    /// let bytes = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
    /// let error = Document::read(&bytes[..])?.mesh().unwrap_err();
    /// assert_eq!(error.shown()[0].to_string(), "line 8: edge 1-2 has 3 faces (lines 6, 7, 8)");
    /// # Ok::<(), tearmesh_obj::ReadError>(())
    /// ```
    pub fn mesh(&self) -> Result<Mesh, MeshError> {
        let built = match &self.record {
            None => Mesh::build(self.positions.len(), self.triangles()),
            Some(record) => {
                let roots = record.roots(self.positions.len());
                Mesh::build_torn(self.triangles(), &roots).map_err(|error| match error {
                    TornError::Build(error) => error,
                    _ => unreachable!("the reader has checked the roots of a record: {error}"),
                })
            }
        };
        built.map_err(|error| {
            let first = error.defects().iter().take(SHOWN);
            let shown = first.map(|defect| self.describe(defect)).collect();
            MeshError { error, shown }
        })
    }

    /// Describes a defect of this document's triangles, with the line and vertex numbers of the file.
    ///
    /// # Panics
    ///
    /// If the defect names a face or vertex that is not in this document.
    #[must_use]
    pub fn describe(&self, defect: &Defect) -> Diagnostic {
        let number = |vertex: VertexId| self.number_of_vertex(vertex.index());
        let lines = |faces: &Faces| self.lines(faces.len(), faces.iter());
        let lines_of_two = |faces: [FaceId; 2]| self.lines(2, faces.into_iter());
        let (code, face, message, help) = match *defect {
            Defect::CrowdedEdge { ends, ref faces } => {
                let ([a, b], count, lines) = (ends.map(number), faces.len(), lines(faces));
                (
                    "E-MESH-EDGE",
                    faces.iter().last(),
                    format!("edge {a}-{b} has {count} faces ({lines})"),
                    "an edge of a surface has at most two faces: delete the surplus ones",
                )
            }
            Defect::FlippedFace { from, to, faces } => {
                let ([from, to], lines) = ([from, to].map(number), lines_of_two(faces));
                (
                    "E-MESH-FLIP",
                    Some(faces[1]),
                    format!(
                        "two faces run from vertex {from} to vertex {to} ({lines}): \
                         one of them is flipped"
                    ),
                    "make the orientation consistent: neighbours run along their common edge in \
                     opposite directions",
                )
            }
            Defect::BowTie { vertex, ref fans } => {
                let (line, count) = (self.line_of_vertex(vertex.index()), fans.len());
                let (vertex, lines) = (number(vertex), self.lines_of_fans(fans));
                (
                    "E-MESH-BOWTIE",
                    fans.iter().last().map(Faces::first),
                    format!(
                        "vertex {vertex} (line {line}) joins {count} fans of faces \
                         that share no edge ({lines})"
                    ),
                    "give each fan a vertex of its own at the same place",
                )
            }
            Defect::DuplicateFaces {
                vertices,
                ref faces,
            } => {
                let ([a, b, c], count, lines) = (vertices.map(number), faces.len(), lines(faces));
                (
                    "E-MESH-DUPLICATE",
                    faces.iter().last(),
                    format!("{count} faces have the same vertices {a}, {b}, {c} ({lines})"),
                    "delete all of these faces but one",
                )
            }
            Defect::Pillow { vertices, faces } => {
                let ([a, b, c], lines) = (vertices.map(number), lines_of_two(faces));
                (
                    "E-MESH-PILLOW",
                    Some(faces[1]),
                    format!("two faces lie back to back on the vertices {a}, {b}, {c} ({lines})"),
                    "delete one of the two: cloth is drawn from both sides, but modelled once",
                )
            }
            // The reader refuses what would give another defect that this crate knows.
            _ => (
                "E-MESH-OTHER",
                None,
                defect.to_string(),
                "repair the model in the program that made it",
            ),
        };
        let location = face.map(|face| Location {
            line: self.line_of_triangle(face.index()),
            column: 1,
        });
        Diagnostic::error(code, location, message, help)
    }

    /// `lines 3, 4, 9`, each once: triangles of one polygon stand on one line.
    fn lines(&self, count: usize, faces: impl Iterator<Item = FaceId>) -> String {
        let more = match count.saturating_sub(SHOWN) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let mut lines: Vec<usize> = faces
            .take(SHOWN)
            .map(|face| self.line_of_triangle(face.index()))
            .collect();
        lines.dedup();
        let plural = if lines.len() == 1 { "" } else { "s" };
        let list: Vec<String> = lines.iter().map(usize::to_string).collect();
        format!("line{plural} {}{more}", list.join(", "))
    }

    fn lines_of_fans(&self, fans: &Fans) -> String {
        let shown = fans.iter().take(SHOWN);
        let shown: Vec<String> = shown.map(|fan| self.lines(fan.len(), fan.iter())).collect();
        let more = if fans.len() > SHOWN { " | …" } else { "" };
        format!("{}{more}", shown.join(" | "))
    }
}

/// Why the triangles of a document do not form a mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MeshError {
    error: BuildError,
    shown: Vec<Diagnostic>,
}

impl MeshError {
    /// Returns what is wrong with the triangles. Face `i` of a defect is triangle `i` of the document, and
    /// vertex `i` is its vertex `i`. [`Document::describe`] describes a defect with the line numbers of the
    /// file.
    #[must_use]
    pub fn error(&self) -> &BuildError {
        &self.error
    }

    /// Returns descriptions of the first twenty defects, with the line and vertex numbers of the file.
    #[must_use]
    pub fn shown(&self) -> &[Diagnostic] {
        &self.shown
    }
}

impl fmt::Display for MeshError {
    /// Writes one line for each of the first twenty defects, and then the number of further defects.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.shown.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            write!(f, "{separator}{diagnostic}  [{}]", diagnostic.code)?;
        }
        match self.error.count() - self.shown.len() {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

impl std::error::Error for MeshError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        Some(&self.error)
    }
}
