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

use tearmesh::{Defect, FaceId, Fans, Mesh, VertexId};

use crate::diagnostic::Diagnostic;
use crate::document::Document;
use crate::polygons::Polygons;
use crate::read::text::attached_length;
use crate::store::{Kind, push};

/// How many repairs of a kind are reported one by one; the rest is counted.
const REPORTED: usize = 100;

/// The kinds of repair that [`Document::repaired`] may make.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Repair {
    /// Adds vertices so that each fan of a bow-tie vertex has its own vertex. No face is dropped.
    SeparateFans,
    /// Drops all but the first of several faces on the same three vertices, drops the superfluous
    /// faces of an edge, and then separates fans as [`Repair::SeparateFans`] does.
    All,
}

impl Document {
    /// Repairs defects that keep the triangles from forming a mesh, as far as `repair` allows. A
    /// document whose triangles already form a mesh is returned unchanged.
    ///
    /// Each repair adds a warning with its line to the [`diagnostics`](Document::diagnostics); beyond
    /// the first hundred repairs of a kind, the others are only counted. A single triangle of a larger
    /// polygon may be dropped; each remaining triangle then becomes a polygon of its own.
    /// Vertices, texture coordinates and normals keep their numbers, so that lines, points and foreign
    /// statements remain valid. A copy of a vertex has its position and extra numbers.
    ///
    /// A file with a record of tears is not repaired. Defects beyond repair, such as a flipped face,
    /// remain, and [`Document::mesh`] reports them.
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
        if Mesh::build(self.positions.len(), self.triangles()).is_ok() {
            return self;
        }
        if repair == Repair::All {
            for choose in [Document::on_the_same_vertices, Document::superfluous] {
                let dropped = choose(&self);
                if dropped.iter().any(|&drop| drop != STAYS) {
                    self.drop_triangles(&dropped);
                }
            }
        }
        self.separate_fans();
        self
    }

    /// Calls `visit` for each defect, with at most `listed` faces of each.
    fn diagnose(&self, listed: usize, visit: impl FnMut(Defect)) {
        Mesh::diagnose(self.positions.len(), self.triangles(), listed, visit);
    }

    /// All triangles but the first on the same three vertices.
    fn on_the_same_vertices(&self) -> Vec<Drop> {
        let mut dropped = vec![STAYS; self.triangles().len()];
        self.diagnose(usize::MAX, |defect| match defect {
            Defect::DuplicateFaces { faces, .. } => {
                let later = faces.iter().skip(1);
                later.for_each(|face| dropped[face.index()] = faces.first().into());
            }
            Defect::Pillow { faces, .. } => {
                dropped[faces[1].index()] = PILLOW | u32::from(faces[0]);
            }
            _ => {}
        });
        dropped
    }

    /// The triangles for which a crowded edge has no room.
    fn superfluous(&self) -> Vec<Drop> {
        // Crowded edges, ascending, each with the face that stays for each direction.
        let mut edges = Vec::new();
        self.diagnose(1, |defect| {
            if let Defect::CrowdedEdge { ends, .. } = defect {
                push(&mut edges, (ends.map(u32::from), [STAYS; 2]));
            }
        });
        let mut dropped = vec![STAYS; self.triangles().len()];
        if edges.is_empty() {
            return dropped;
        }
        for (f, corners) in self.triangles().iter().enumerate() {
            // In the order of the edges, so that the first of them is named.
            let mut crowded = sides(*corners).map(|(from, to)| {
                let ends = [from.min(to), from.max(to)];
                let edge = edges.binary_search_by_key(&ends, |&(ends, _)| ends);
                (edge.ok(), usize::from(from < to))
            });
            crowded.sort_unstable();
            let crowded = crowded.into_iter();
            let crowded = crowded.filter_map(|(edge, direction)| Some((edge?, direction)));
            let mut taken = crowded
                .clone()
                .map(|(edge, direction)| edges[edge].1[direction]);
            match taken.find(|&taken| taken != STAYS) {
                Some(earlier) => dropped[f] = EDGE | earlier,
                None => crowded.for_each(|(edge, direction)| edges[edge].1[direction] = f as u32),
            }
        }
        dropped
    }

    /// Drops triangles, and says so.
    fn drop_triangles(&mut self, dropped: &[Drop]) {
        self.report_drops(dropped);
        let stays = |triangle: usize| dropped[triangle] == STAYS;
        let mut polygons = Polygons::default();
        // Cut in place: the memory for two of them may not be there.
        let mut triangulation = self.triangulation.take();
        let mut kept = 0;
        // How many polygons stand for each.
        let mut counts: Vec<u16> = Vec::with_capacity(self.polygons.len());
        for polygon in 0..self.polygons.len() {
            let triangles = self.polygons.triangles(polygon);
            let corners = self.polygons.corners(polygon);
            let corners = corners.map(|corner| self.polygons.corner(corner));
            let before = polygons.len();
            let all = triangulation.as_mut();
            if triangles.clone().all(stays) {
                polygons.add(corners);
                if let Some(all) = all {
                    all.copy_within(triangles.clone(), kept);
                }
                kept += triangles.len();
            } else if let Some(all) = all {
                for triangle in triangles.filter(|&triangle| stays(triangle)) {
                    all[kept] = all[triangle];
                    let corner = |vertex| corners.clone().find(|corner| corner.vertex == vertex);
                    polygons.add(all[kept].into_iter().filter_map(corner));
                    kept += 1;
                }
            }
            counts.push((polygons.len() - before) as u16);
        }
        self.triangulation = triangulation.filter(|_| !polygons.all_triangles());
        if let Some(triangulation) = &mut self.triangulation {
            triangulation.truncate(kept);
        }
        self.polygons = polygons;
        let count = |kind, number: usize| match kind {
            Kind::Polygon => usize::from(counts[number]),
            _ => 1,
        };
        self.replace_statements(count);
    }

    fn report_drops(&mut self, dropped: &[Drop]) {
        for (marks, code) in [(0, DUPLICATE), (PILLOW, PILLOWS), (EDGE, CROWDED)] {
            let all = dropped.iter().copied().zip(0..);
            let all = all.filter(|&(drop, _)| drop != STAYS && drop & (PILLOW | EDGE) == marks);
            let count = all.clone().count();
            let first = all.take(REPORTED + 1).map(|(drop, triangle)| {
                let why = self.why(triangle, (drop ^ marks) as usize, code);
                (self.line_of_triangle(triangle), why)
            });
            let first = first.collect();
            self.report(code, first, count, "faces are dropped");
        }
    }

    /// Reports some repairs one by one, each with its line, and counts the rest.
    fn report(
        &mut self,
        code: &'static str,
        first: Vec<(usize, String)>,
        count: usize,
        rest: &str,
    ) {
        let warnings = first.into_iter().enumerate();
        let warnings = warnings.map(|(number, (line, message))| {
            let message = match number {
                REPORTED => format!("and {} more {rest} (the first here)", count - REPORTED),
                _ => message,
            };
            Diagnostic::warning(code, line, message)
        });
        self.diagnostics.extend(warnings);
    }

    fn why(&self, triangle: usize, kept: usize, code: &str) -> String {
        let what = match self.polygons.corners(self.polygon_of(triangle)).len() {
            3 => "this face",
            _ => "a triangle of this face",
        };
        let line = self.line_of_triangle(kept);
        let why = match code {
            DUPLICATE => format!("has the same vertices as one on line {line}"),
            PILLOWS => format!("lies back to back with one on line {line}"),
            _ => {
                // They have no other edge in common, or they would have the same vertices.
                let [one, other] = [triangle, kept].map(|face| sides(self.triangles()[face]));
                let common = one.into_iter().find(|side| other.contains(side));
                let (a, b) = common.expect("they run the same way");
                let [a, b] = [a.min(b), a.max(b)].map(|end| u64::from(end) + 1);
                format!("runs the same way as one on line {line} along the crowded edge {a}-{b}")
            }
        };
        format!("{what} is dropped: it {why}")
    }

    /// Gives a vertex to each fan of a bow-tie but the first, and says so.
    fn separate_fans(&mut self) {
        // The vertex of each copy; each face that gets one, with its number; and what is reported.
        let (mut sources, mut moves): (Vec<VertexId>, Vec<(FaceId, u32)>) = Default::default();
        let mut first: Vec<(VertexId, Fans)> = Vec::new();
        self.diagnose(usize::MAX, |defect| {
            let Defect::BowTie { vertex, fans } = defect else {
                return;
            };
            for fan in fans.iter().skip(1) {
                let copy = sources.len() as u32;
                fan.iter().for_each(|face| push(&mut moves, (face, copy)));
                push(&mut sources, vertex);
            }
            if first.len() <= REPORTED {
                first.push((vertex, fans));
            }
        });
        let copies = self.positions.len();
        if sources.is_empty() || copies + sources.len() > Mesh::MAX_VERTICES {
            return; // Too many vertices for a mesh: it stays refused.
        }
        let mut vertices: Vec<usize> = sources.iter().map(|vertex| vertex.index()).collect();
        vertices.dedup();
        self.report_fans(&first, vertices.len());
        drop(first);
        self.positions.reserve_exact(sources.len()); // To double them would be the peak of a repair.
        for vertex in &sources {
            let extra = self.extras.row(vertex.index()).to_vec();
            if !extra.is_empty() {
                self.extras.set(self.positions.len(), &extra);
            }
            self.positions.push(self.positions[vertex.index()]);
        }
        for (face, copy) in moves {
            let (from, to) = (u32::from(sources[copy as usize]), copies as u32 + copy);
            let corners = self.polygons.corners(self.polygon_of(face.index()));
            // Another triangle of the polygon may have moved it already.
            let replace = |vertices: &mut [u32]| {
                let own = vertices.iter_mut().find(|vertex| **vertex == from);
                own.into_iter().for_each(|vertex| *vertex = to);
            };
            replace(&mut self.polygons.vertices[corners]);
            if let Some(triangles) = &mut self.triangulation {
                replace(&mut triangles[face.index()]);
            }
        }
        // Where a split's would be.
        let attached = self.attached_to_last_vertex();
        self.layout.add_vertices(sources.len(), attached);
        self.report_unspoken(&vertices);
    }

    /// How many bytes are attached to the last vertex.
    fn attached_to_last_vertex(&self) -> usize {
        let (mut attached, mut is_behind) = (0, false);
        for (run, lines) in self.runs() {
            if run.kind == Kind::Vertex {
                attached = 0;
            } else if is_behind {
                attached = attached_length(lines);
            }
            is_behind = run.kind == Kind::Vertex;
        }
        attached
    }

    /// Warns of statements about vertices of which there are more now.
    fn report_unspoken(&mut self, copied: &[usize]) {
        let about = self.statements_about_vertices().into_iter();
        let mut about = about.filter(|(vertex, _)| copied.binary_search(vertex).is_ok());
        let Some((first, _)) = about.next() else {
            return;
        };
        let message = format!(
            "copies of vertices do not have what `nl`, `ny`, `nv` or `vv` says of these ({} statements, the first of this one)",
            1 + about.count()
        );
        let line = self.line_of_vertex(first);
        self.diagnostics
            .push(Diagnostic::warning("W-OBJ-FOREIGN", line, message));
    }

    fn report_fans(&mut self, first: &[(VertexId, Fans)], count: usize) {
        let mut copy = self.positions.len();
        let first = first.iter().map(|(vertex, fans)| {
            let new = fans.iter().skip(1).take(20).map(|fan| {
                copy += 1;
                let line = self.line_of_triangle(fan.first().index());
                format!("the fan on line {line} gets the new vertex {copy}")
            });
            let new: Vec<String> = new.collect();
            copy += (fans.len() - 1).saturating_sub(20);
            let more = if fans.len() > 21 { ", …" } else { "" };
            let message = format!(
                "vertex {} joins {} fans of faces that share no edge; {}{more}",
                vertex.index() + 1,
                fans.len(),
                new.join(", ")
            );
            (self.line_of_vertex(vertex.index()), message)
        });
        let (first, rest) = (
            first.collect(),
            "vertices with several fans get new vertices",
        );
        self.report("W-OBJ-REPAIR-BOWTIE", first, count, rest);
    }
}

/// What becomes of a triangle: [`STAYS`], or the one that stays in its place, with a mark for the reason. A
/// file of large polygons has so many that a word for each is what its bound of memory leaves.
type Drop = u32;

const STAYS: Drop = u32::MAX;
const PILLOW: Drop = 1 << 31;
const EDGE: Drop = 1 << 30;

const DUPLICATE: &str = "W-OBJ-REPAIR-DUPLICATE";
const PILLOWS: &str = "W-OBJ-REPAIR-PILLOW";
const CROWDED: &str = "W-OBJ-REPAIR-EDGE";

fn sides([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}
