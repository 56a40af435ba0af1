//! Where the vertices of a document are divided into those of one object and those of the next.
//!
//! What a cut adds is written behind the statements of its kind in the section that it comes from, so
//! that every object keeps its vertices. A section of vertices ends where a face is written (with all parts
//! of it, if it is divided), or an `o`; so does one of texture coordinates, and one of normals. A face
//! that comes before what it names has that moved up before it, as in all that is written (`write.rs`).
//!
//! Numbers behind a section change when something is added to it. Faces follow. Statements that
//! are kept without being understood do not, and so where there are some that may name a
//! vertex by its number, the whole file is one section.

use crate::document::Document;
use crate::keyword::may_have_indices;
use crate::read::text::statements;
use crate::store::Kind;

/// Where the sections of vertices, of texture coordinates and of normals end.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sections {
    /// By kind: how many statements there are up to the end of each section but the last,
    /// ascending.
    ends: [Vec<u32>; 3],
    counts: [u32; 3],
}

impl Sections {
    /// The whole file as one section.
    pub(crate) fn one(document: &Document) -> Sections {
        Sections {
            ends: Default::default(),
            counts: document.counts().map(|count| count as u32),
        }
    }

    /// Linear in the document.
    pub(crate) fn of(document: &Document) -> Sections {
        let mut sections = Sections::one(document);
        if document.statement_with_indices().is_some() {
            return sections;
        }
        // How many are written so far, some perhaps before their turn; and how many had theirs.
        let (mut written, mut had) = ([0; 3], [0; 3]);
        let record = document.record.as_deref();
        let families = record.map(|record| &record.families);
        let mut end = 0;
        let mut polygons = 0;
        for (run, lines) in document.runs() {
            let count = run.count as usize;
            let which = match run.kind {
                Kind::Polygon => {
                    for polygon in polygons..polygons + count {
                        for triangle in document.polygons.triangles(polygon) {
                            document.raise_to_needs(triangle, polygon, &mut written);
                            if triangle == end {
                                let parts = families.map(|families| families.parts_from(triangle));
                                end = parts.map_or(triangle + 1, |parts| parts.end);
                            }
                            if triangle + 1 == end {
                                sections.end_at(written);
                            }
                        }
                    }
                    polygons += count;
                    continue;
                }
                Kind::Text => {
                    if statements(lines).any(|(keyword, _)| keyword == b"o") {
                        sections.end_at(written);
                    }
                    continue;
                }
                kind => kind as usize,
            };
            had[which] += run.count;
            written[which] = written[which].max(had[which]);
        }
        sections
    }

    fn end_at(&mut self, written: [u32; 3]) {
        for ((ends, end), count) in self.ends.iter_mut().zip(written).zip(self.counts) {
            if end > 0 && end < count && ends.last() != Some(&end) {
                ends.push(end);
            }
        }
    }

    /// How many statements there are up to the end of the section that one of them is in.
    pub(crate) fn end(&self, kind: Kind, statement: u32) -> u32 {
        let ends = &self.ends[kind as usize];
        let next = ends.partition_point(|&end| end <= statement);
        let end = ends.get(next).copied();
        end.unwrap_or(self.counts[kind as usize])
    }
}

impl Document {
    /// The keyword of the first statement that is kept as text and may name a vertex, a texture
    /// coordinate or a normal by its number.
    pub(crate) fn statement_with_indices(&self) -> Option<&[u8]> {
        let statements = self.runs().flat_map(|(_, lines)| statements(lines));
        let mut keywords = statements.map(|(keyword, _)| keyword);
        keywords.find(|keyword| may_have_indices(keyword))
    }

    /// Raises how many statements are written to what a triangle of a polygon needs.
    fn raise_to_needs(&self, triangle: usize, polygon: usize, written: &mut [u32; 3]) {
        for corner in 0..3 {
            let corner = self.corner_of_polygon(triangle, corner, polygon);
            let corner = self.polygons.corner(corner);
            let indices = [Some(corner.vertex), corner.texture, corner.normal];
            for (written, index) in written.iter_mut().zip(indices) {
                *written = (*written).max(index.map_or(0, |index| index + 1));
            }
        }
    }
}
