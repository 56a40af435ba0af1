//! Repair: a document of triangles that are no mesh, made into one where that takes no guess.
//!
//! Three things are done, in this order, and only on request.
//!
//! 1. **Faces on the same three vertices**, duplicates and pillows alike: the first in the order
//!    of the file stays.
//! 2. **Superfluous faces of an edge.** Faces are gone through in the order of the file;
//!    one is dropped if on an edge that has three faces or more, one that stays runs the same
//!    way. So of each such edge the first two faces stay that run in opposite directions, and a
//!    face that is dropped on account of one edge takes no room on another.
//! 3. **Bow-ties.** Each fan of a vertex gets a vertex of its own. The fan with the smallest
//!    half-edge keeps the vertex; the others get copies behind all vertices, ordered by the
//!    vertex and then by their smallest half-edge, as a split would number them.
//!
//! One round of these is enough. Dropping a face makes no edge more crowded and puts no faces on
//! the same vertices, so 2 undoes nothing of 1; a face that goes may leave two fans behind, so 3
//! comes last; and to part fans moves no face off an edge.
//!
//! A flipped face is never repaired: which of the two neighbours is wrong, the file does
//! not say, and to turn one silently would turn its texture and its normals around.

use tearmesh::{BuildError, Defect, FaceId, Mesh, VertexId};

use crate::diagnostic::{Diagnostic, Level, Location};
use crate::document::{Document, Polygons};
use crate::read::attached_length;
use crate::store::{Kind, Layout};
use crate::triangulate::Triangulation;

/// How many repairs of a kind are reported one by one; the rest is counted.
const REPORTED: usize = 100;

/// What [`Document::repaired`] may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Repair {
    /// Give each fan of a bow-tie vertex a vertex of its own. No face is dropped.
    SeparateFans,
    /// Drop all faces but one on the same three vertices, and the superfluous faces of an edge; then
    /// separate fans.
    All,
}

impl Document {
    /// Repairs what keeps the triangles from being a mesh, as far as `repair` goes. A document
    /// that has a mesh is returned as it is.
    ///
    /// Each repair is a warning among the [`diagnostics`](Document::diagnostics), with its line
    /// (the first hundred of a kind; the rest are counted). A triangle of a larger polygon may be
    /// dropped alone; what is left of the polygon then counts as a polygon for each triangle.
    /// Vertices, texture coordinates and normals keep their numbers, so that elements and foreign
    /// statements stay right; a copy of a vertex has its position and extra numbers.
    ///
    /// A file with a record of tears is not repaired.
    /// What is beyond repair, such as a flipped face, is left for [`Document::mesh`] to refuse.
    ///
    /// ```
    /// use tearmesh_obj::{Document, Repair};
    ///
    /// let bytes = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n";
    /// let document = Document::read(&bytes[..])?.repaired(Repair::SeparateFans);
    /// assert_eq!(document.triangles(), [[0, 1, 2], [5, 3, 4]]);
    /// assert_eq!(
    ///     document.diagnostics()[0].to_string(),
    ///     "line 1: vertex 1 joins 2 fans of faces that share no edge; the fan on line 7 gets the new vertex 6"
    /// );
    /// assert!(document.mesh().is_ok());
    /// # Ok::<(), tearmesh_obj::ReadError>(())
    /// ```
    #[must_use]
    pub fn repaired(mut self, repair: Repair) -> Document {
        if self.record.is_some() {
            return self; // What would be a bow-tie without its record is none.
        }
        let Err(mut error) = self.build() else {
            return self;
        };
        if repair == Repair::All {
            for drops in [Document::on_the_same_vertices, Document::superfluous] {
                let dropped = drops(&self, error.defects());
                if dropped.is_empty() {
                    continue;
                }
                self.drop_triangles(&dropped, error.defects());
                match self.build() {
                    Ok(_) => return self,
                    Err(left) => error = left,
                }
            }
        }
        self.separate_fans(error.defects());
        self
    }

    fn build(&self) -> Result<Mesh, BuildError> {
        Mesh::build(self.positions.len(), self.triangles())
    }

    /// All triangles but the first on the same three vertices.
    fn on_the_same_vertices(&self, defects: &[Defect]) -> Vec<Drop> {
        let mut dropped = Vec::new();
        for (number, defect) in defects.iter().enumerate() {
            let faces = match defect {
                Defect::DuplicateFaces { faces, .. } => &faces[..],
                Defect::Pillow { faces, .. } => &faces[..],
                _ => continue,
            };
            dropped.reserve(faces.len() - 1);
            dropped.extend(faces[1..].iter().map(|&face| Drop {
                face,
                kept: faces[0],
                defect: number as u32,
            }));
        }
        dropped.sort_unstable_by_key(|drop| drop.face);
        dropped
    }

    /// The triangles for which a crowded edge has no room.
    fn superfluous(&self, defects: &[Defect]) -> Vec<Drop> {
        let mut claims = Vec::new();
        for (number, defect) in defects.iter().enumerate() {
            if let Defect::CrowdedEdge { faces, .. } = defect {
                claims.extend(faces.iter().map(|&face| (face, number)));
            }
        }
        claims.sort_unstable();
        // The face that stays on each crowded edge, for each direction.
        let mut taken: Vec<[Option<FaceId>; 2]> = vec![[None; 2]; defects.len()];
        let mut dropped = Vec::new();
        for of_face in claims.chunk_by(|(a, _), (b, _)| a == b) {
            let face = of_face[0].0;
            let place = |number: usize| {
                let Defect::CrowdedEdge { ends, .. } = defects[number] else {
                    unreachable!("only crowded edges are claimed");
                };
                (ends, usize::from(self.runs_along(face, ends)))
            };
            let earlier = of_face.iter().find_map(|&(_, number)| {
                let (_, direction) = place(number);
                Some((number, taken[number][direction]?))
            });
            if let Some((number, kept)) = earlier {
                let defect = number as u32;
                dropped.push(Drop { face, kept, defect });
                continue;
            }
            for &(_, number) in of_face {
                let (_, direction) = place(number);
                taken[number][direction] = Some(face);
            }
        }
        dropped
    }

    /// Whether a triangle runs from the first of two vertices to the second, and not back.
    fn runs_along(&self, face: FaceId, [from, to]: [VertexId; 2]) -> bool {
        let [a, b, c] = self.triangles()[face.index()].map(|v| v as usize);
        [(a, b), (b, c), (c, a)].contains(&(from.index(), to.index()))
    }

    /// Drops triangles, which are in ascending order, and says so.
    fn drop_triangles(&mut self, dropped: &[Drop], defects: &[Defect]) {
        self.report_drops(dropped, defects);
        let mut gone = dropped.iter().map(|drop| drop.face.index()).peekable();
        let mut polygons = Polygons::default();
        let mut triangulation = Triangulation::default();
        let mut layout = Layout::default();
        let mut polygon = 0;
        for &run in self.layout.runs() {
            if run.kind != Kind::Polygon {
                layout.append(run);
                continue;
            }
            for line in run.lines() {
                let triangles = self.polygons.triangles(polygon);
                if gone.peek().is_none_or(|&first| first >= triangles.end) {
                    let corners = self.polygons.corners(polygon);
                    polygons.add(corners.map(|corner| self.polygons.corner(corner)));
                    for triangle in triangles {
                        let corners = self.triangulation.as_ref().map(|all| all.corners(triangle));
                        let vertices = self.triangles()[triangle];
                        triangulation.add(vertices, corners.unwrap_or([0, 1, 2]));
                    }
                    layout.push(Kind::Polygon, line);
                } else {
                    for triangle in triangles {
                        if gone.next_if_eq(&triangle).is_some() {
                            continue;
                        }
                        let corner = |corner| {
                            let of_polygon = self.corner_of_polygon(triangle, corner, polygon);
                            self.polygons.corner(of_polygon)
                        };
                        polygons.add([0, 1, 2].map(corner).into_iter());
                        triangulation.add(self.triangles()[triangle], [0, 1, 2]);
                        layout.push(Kind::Polygon, line);
                    }
                }
                polygon += 1;
            }
        }
        self.triangulation = (!polygons.all_triangles()).then_some(triangulation);
        self.polygons = polygons;
        self.layout = layout;
    }

    fn report_drops(&mut self, dropped: &[Drop], defects: &[Defect]) {
        for code in [
            "W-OBJ-REPAIR-DUPLICATE",
            "W-OBJ-REPAIR-PILLOW",
            "W-OBJ-REPAIR-EDGE",
        ] {
            let because = |drop: &Drop| reason(&defects[drop.defect as usize]);
            let mut of_code = dropped.iter().filter(|drop| because(drop).0 == code);
            for drop in of_code.by_ref().take(REPORTED) {
                let line = self.line_of_triangle(drop.face.index());
                let polygon = self.polygon_of(drop.face.index());
                let what = match self.polygons.corners(polygon).len() {
                    3 => "this face",
                    _ => "a triangle of this face",
                };
                let kept = self.line_of_triangle(drop.kept.index());
                let (_, why, place) = because(drop);
                let message = format!("{what} is dropped: it {why} one on line {kept}{place}");
                self.diagnostics.push(warning(code, line, message));
            }
            if let Some(next) = of_code.next() {
                let line = self.line_of_triangle(next.face.index());
                let more = 1 + of_code.count();
                let message = format!("and {more} more faces are dropped (the first here)");
                self.diagnostics.push(warning(code, line, message));
            }
        }
    }

    /// Gives a vertex to each fan of a bow-tie but the first, and says so.
    fn separate_fans(&mut self, defects: &[Defect]) {
        let bow_ties: Vec<(VertexId, &[Vec<FaceId>])> = defects
            .iter()
            .filter_map(|defect| match defect {
                Defect::BowTie { vertex, fans } => Some((*vertex, &fans[..])),
                _ => None,
            })
            .collect();
        let copies: usize = bow_ties.iter().map(|(_, fans)| fans.len() - 1).sum();
        if copies == 0 || self.positions.len() + copies > Mesh::MAX_VERTICES {
            return; // Too many vertices for a mesh: it stays refused.
        }
        self.report_fans(&bow_ties);
        let lines = self.lines_of(bow_ties.iter().map(|(vertex, _)| vertex.index()));
        let mut added = Vec::with_capacity(copies);
        for (&(vertex, fans), &line) in bow_ties.iter().zip(&lines) {
            for fan in &fans[1..] {
                let copy = self.positions.len();
                self.positions.push(self.positions[vertex.index()]);
                let extra = self.extras.row(vertex.index()).to_vec();
                if !extra.is_empty() {
                    self.extras.set(copy, &extra);
                }
                for face in fan {
                    self.move_corner(face.index(), vertex.index() as u32, copy as u32);
                }
                added.push(line);
            }
        }
        self.lay_out_vertices(&added);
    }

    /// Puts another vertex in the place of one of a triangle's.
    fn move_corner(&mut self, triangle: usize, from: u32, to: u32) {
        let polygon = self.polygon_of(triangle);
        let corner = self.triangles()[triangle]
            .iter()
            .position(|&vertex| vertex == from)
            .expect("the faces of a fan have its vertex");
        let of_polygon = self.corner_of_polygon(triangle, corner, polygon);
        self.polygons.vertices[of_polygon] = to;
        if let Some(triangulation) = &mut self.triangulation {
            triangulation.replace(triangle, corner, to);
        }
    }

    /// The lines of vertices, which ascend. Linear, where [`Document::line_of_vertex`] is so for each.
    fn lines_of(&self, vertices: impl Iterator<Item = usize>) -> Vec<u32> {
        let runs = self.layout.runs().iter();
        let mut lines = runs
            .filter(|run| run.kind == Kind::Vertex)
            .flat_map(|run| run.lines())
            .enumerate();
        let line = |vertex| lines.find(|&(number, _)| number == vertex);
        vertices
            .map(line)
            .map(|found| found.expect("every vertex has a line").1)
            .collect()
    }

    /// Makes room in the layout for new vertices, each on the line of the one it copies: behind
    /// the last vertex and the foreign statements attached to it, where a split's would be.
    fn lay_out_vertices(&mut self, added: &[u32]) {
        let runs = self.layout.runs();
        let last = runs
            .iter()
            .rposition(|run| run.kind == Kind::Vertex)
            .expect("a bow-tie is a vertex");
        let mut layout = Layout::default();
        let mut text = &self.text[..];
        for &run in &runs[..=last] {
            layout.append(run);
            if run.kind == Kind::Text {
                text = &text[run.count as usize..];
            }
        }
        let mut rest = &runs[last + 1..];
        if let [run, behind @ ..] = rest
            && run.kind == Kind::Text
        {
            let attached = attached_length(&text[..run.count as usize]);
            layout.append_text(attached, *run);
            layout.add_vertices(added);
            layout.append_text(run.count as usize - attached, *run);
            rest = behind;
        } else {
            layout.add_vertices(added);
        }
        for &run in rest {
            layout.append(run);
        }
        self.layout = layout;
    }

    fn report_fans(&mut self, bow_ties: &[(VertexId, &[Vec<FaceId>])]) {
        const CODE: &str = "W-OBJ-REPAIR-BOWTIE";
        let mut copy = self.positions.len();
        for (vertex, fans) in bow_ties.iter().take(REPORTED) {
            let new: Vec<String> = fans[1..]
                .iter()
                .take(20)
                .map(|fan| {
                    copy += 1;
                    let line = self.line_of_triangle(fan[0].index());
                    format!("the fan on line {line} gets the new vertex {copy}")
                })
                .collect();
            copy += (fans.len() - 1).saturating_sub(20);
            let more = if fans.len() > 21 { ", …" } else { "" };
            let message = format!(
                "vertex {} joins {} fans of faces that share no edge; {}{more}",
                vertex.index() + 1,
                fans.len(),
                new.join(", ")
            );
            let line = self.line_of_vertex(vertex.index());
            self.diagnostics.push(warning(CODE, line, message));
        }
        if let Some((next, _)) = bow_ties.get(REPORTED) {
            let line = self.line_of_vertex(next.index());
            let message = format!(
                "and {} more vertices with several fans get new vertices (the first here)",
                bow_ties.len() - REPORTED
            );
            self.diagnostics.push(warning(CODE, line, message));
        }
    }
}

/// A triangle to drop.
struct Drop {
    face: FaceId,
    /// The one that stays in its place.
    kept: FaceId,
    /// Why, among the defects.
    defect: u32,
}

/// The code for a face that is dropped on account of a defect, what it has to do with the one
/// that stays, and where.
fn reason(defect: &Defect) -> (&'static str, &'static str, String) {
    match defect {
        Defect::Pillow { .. } => (
            "W-OBJ-REPAIR-PILLOW",
            "lies back to back with",
            String::new(),
        ),
        Defect::CrowdedEdge { ends: [a, b], .. } => (
            "W-OBJ-REPAIR-EDGE",
            "runs the same way as",
            format!(
                " along the crowded edge {}-{}",
                a.index() + 1,
                b.index() + 1
            ),
        ),
        _ => (
            "W-OBJ-REPAIR-DUPLICATE",
            "has the same vertices as",
            String::new(),
        ),
    }
}

fn warning(code: &'static str, line: usize, message: String) -> Diagnostic {
    Diagnostic {
        level: Level::Warning,
        code,
        location: Some(Location { line, column: 1 }),
        message,
        excerpt: None,
        help: None,
    }
}
