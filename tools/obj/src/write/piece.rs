//! A piece of a torn mesh as a file of its own.
//!
//! A piece is written for other programs, and for whoever goes on with it alone: its vertices, each with
//! the numbers behind z, its faces with their texture coordinates and normals, and what the document
//! says of those faces: `o`, `g`, `usemtl`, `s`, and every `mtllib`. The record stays with the whole, since
//! what a cut parted it names on both sides: a piece cannot be sewn, and what was inserted cannot be taken
//! out. Comments and other statements stay with the whole, too.

use std::collections::BTreeSet;
use std::io::{self, Write};

use tearmesh::{DerivedMesh, FaceId, HalfEdgeId, Positions};

use super::WriteSummary;
use super::output::Output;
use super::separate::Separated;
use crate::read::text::statements;
use crate::store::Kind;
use crate::torn::TornDocument;

/// A writer of the pieces of a torn document, each to a file of its own.
///
/// A file has the vertices and faces of the piece, its texture coordinates and normals, and the `o`, `g`,
/// `usemtl`, `s` and `mtllib` statements that apply to it. It has no record, comments or other statements.
///
/// ```
/// use tearmesh::{Edits, Positions, split};
/// use tearmesh_obj::{Document, PieceWriter, TornDocument};
///
/// let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\no left\nf 1 2 3\no right\ng hem\nf 3 2 4\n";
/// let document = Document::read(&file[..])?;
/// let mut mesh = document.mesh()?;
/// let mut positions = Positions::new(document.positions().iter().copied())?;
/// let mut torn = TornDocument::new(&document);
/// let mut edits = Edits::new();
/// for v in [1, 2] {
///     let (v, face) = (mesh.vertex(v), mesh.face(1));
///     split::vertex(&mut mesh, v, &[face], &mut edits)?;
/// }
/// edits.replay(&mut (&mut positions, &mut torn));
///
/// let pieces = mesh.pieces(&mesh.components());
/// let writer = PieceWriter::new(&torn);
/// let mut out = Vec::new();
/// writer.write(&pieces[1], &positions, &mut out)?;
/// assert_eq!(String::from_utf8(out)?, "v 1 1 0\nv 1 0 0\nv 0 1 0\no right\ng hem\nf 3 2 1\n");
/// assert_eq!(writer.names(&pieces[1]).objects, ["right"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct PieceWriter<'t> {
    torn: &'t TornDocument<'t>,
    /// Where each face of the mesh stands among all, and which of the states it has.
    ranks: Vec<u32>,
    states: Vec<u32>,
    /// What statements say of faces: all `mtllib`, and the statements in force, by [`KEYWORDS`].
    libraries: Vec<&'t [u8]>,
    said: Vec<[Option<&'t [u8]>; KEYWORDS.len()]>,
}

/// The names of the objects, groups and materials of a piece. Each name is listed once, in the order
/// of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PieceNames {
    /// The names of the objects (`o`) of the faces.
    pub objects: Vec<String>,
    /// The names of the groups (`g`) of the faces.
    pub groups: Vec<String>,
    /// The names of the materials (`usemtl`) of the faces.
    pub materials: Vec<String>,
}

impl<'t> PieceWriter<'t> {
    /// Creates a writer of the pieces of a torn document. Linear in the document.
    #[must_use]
    pub fn new(torn: &'t TornDocument<'t>) -> PieceWriter<'t> {
        let document = torn.document();
        let slots = torn.corners.slots();
        let mut writer = PieceWriter {
            torn,
            ranks: slots.ranks(),
            states: vec![0; slots.faces.len()],
            libraries: Vec::new(),
            said: vec![[None; KEYWORDS.len()]],
        };
        let mut polygons = 0;
        for (run, lines) in document.runs() {
            statements(lines).for_each(|(keyword, line)| writer.take(keyword, line));
            let state = writer.said.len() as u32 - 1;
            if run.kind == Kind::Polygon {
                for polygon in polygons..polygons + run.count as usize {
                    for &face in &slots.faces[slots.of(document.polygons.triangles(polygon))] {
                        writer.states[face as usize] = state;
                    }
                }
                polygons += run.count as usize;
            }
        }
        writer
    }

    fn take(&mut self, keyword: &[u8], statement: &'t [u8]) {
        if keyword == b"mtllib" {
            self.libraries.push(statement);
        }
        if let Some(which) = KEYWORDS.iter().position(|own| *own == keyword) {
            let mut state = self.said[self.said.len() - 1];
            state[which] = Some(statement);
            self.said.push(state);
        }
    }

    /// Writes a piece of the mesh whose log the torn document has followed to its end. `positions` are
    /// those of the whole mesh. A vertex with several fans is written once for each fan.
    ///
    /// # Errors
    ///
    /// Any I/O error of `out`.
    ///
    /// # Panics
    ///
    /// If the number of positions is not the number of vertices of the whole mesh, or if the piece
    /// belongs to another mesh.
    pub fn write(
        &self,
        piece: &DerivedMesh,
        positions: &Positions,
        out: &mut impl Write,
    ) -> io::Result<WriteSummary> {
        let torn = self.torn;
        assert_eq!(
            positions.len(),
            torn.vertex_count(),
            "every vertex has a position"
        );
        let mut out = Output::new(out);
        for library in &self.libraries {
            out.text(library)?;
        }
        let separated = Separated::new(&piece.mesh, u32::from);
        let copies = separated.copies.iter().copied();
        for v in piece.mesh.vertices().chain(copies) {
            let source = piece.vertices[v.index()];
            let place: [f64; 3] = positions.at(source).into();
            out.statement(b"v", &place, torn.extra_numbers(source.index()))?;
        }
        let faces = self.in_order(piece);
        let corners = |f: FaceId| f.half_edges().map(|h| (h, self.indices_of(piece, h)));
        let all = || faces.iter().copied().flat_map(corners);
        let used = [0, 1].map(|which| {
            let mut used: Vec<u32> = all().filter_map(|(_, indices)| indices[which]).collect();
            used.sort_unstable();
            used.dedup();
            used
        });
        for (which, keyword) in [b"vt", b"vn"].into_iter().enumerate() {
            for &index in &used[which] {
                out.statement(keyword, torn.corners.value(which, index), &[])?;
            }
        }
        let mut said = [None; KEYWORDS.len()];
        for &f in &faces {
            let now = self.said_of(piece, f);
            for (said, now) in said.iter_mut().zip(now) {
                if let Some(statement) = now.filter(|_| *said != now) {
                    out.text(statement)?;
                }
                *said = now;
            }
            out.pending.push(b'f');
            for (h, indices) in corners(f) {
                let numbers = [0, 1].map(|which| {
                    let at = used[which].binary_search(&indices[which]?);
                    Some(at.expect("it is used") as u32)
                });
                out.corner(separated.indices[h.index()], numbers);
            }
            out.pending.push(b'\n');
            out.flush_if_full()?;
        }
        out.flush()?;
        Ok(WriteSummary {
            vertices: piece.mesh.vertex_count() + separated.copies.len(),
            faces: faces.len(),
            separated: separated.copies.len(),
            unspoken: 0,
        })
    }

    /// Returns the names of the objects, groups and materials of a piece.
    ///
    /// # Panics
    ///
    /// If the piece belongs to another mesh.
    #[must_use]
    pub fn names(&self, piece: &DerivedMesh) -> PieceNames {
        let mut names = PieceNames::default();
        let mut seen = BTreeSet::new();
        let mut before = [None; KEYWORDS.len()];
        for f in self.in_order(piece) {
            let said = self.said_of(piece, f);
            if said == before {
                continue;
            }
            before = said;
            let [object, group, material, _] = said.map(rest_of_statement);
            let groups = group.split_whitespace().map(|name| (1, name.to_owned()));
            for (which, name) in [(0, object), (2, material)].into_iter().chain(groups) {
                if !name.is_empty() && seen.insert((which, name.clone())) {
                    [&mut names.objects, &mut names.groups, &mut names.materials][which].push(name);
                }
            }
        }
        names
    }

    /// The faces of a piece in the order of the file.
    fn in_order(&self, piece: &DerivedMesh) -> Vec<FaceId> {
        let mut faces: Vec<FaceId> = piece.mesh.faces().collect();
        faces.sort_unstable_by_key(|f| self.ranks[piece.faces[f.index()].index()]);
        faces
    }

    fn said_of(&self, piece: &DerivedMesh, f: FaceId) -> [Option<&'t [u8]>; KEYWORDS.len()] {
        self.said[self.states[piece.faces[f.index()].index()] as usize]
    }

    /// The texture coordinate and the normal of a corner of a piece.
    fn indices_of(&self, piece: &DerivedMesh, h: HalfEdgeId) -> [Option<u32>; 2] {
        self.torn.corners.at(piece.corners[h.index()].index())
    }
}

/// The statements that hold for all faces behind them, up to the next of their kind.
const KEYWORDS: [&[u8]; 4] = [b"o", b"g", b"usemtl", b"s"];

/// What stands behind the keyword, without a comment.
fn rest_of_statement(statement: Option<&[u8]>) -> String {
    let text = String::from_utf8_lossy(statement.unwrap_or_default());
    let text = text.split('#').next().unwrap_or_default().trim();
    let rest = text.split_once(char::is_whitespace);
    rest.map_or(String::new(), |(_, rest)| rest.trim().to_owned())
}
