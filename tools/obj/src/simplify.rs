//! Removes vertices that cuts inserted, and puts back vertices that cuts moved.
//!
//! What can be undone follows from a file and its record alone (`simplify/plan.rs`), so an edited document
//! is written and read first. Then the plan is applied to the statements.

mod history;
mod plan;

use std::collections::BTreeMap;

use tearmesh::{HalfEdgeId, Mesh, Point, Positions};

use self::plan::Undo;
use crate::diagnostic::ReadError;
use crate::document::Document;
use crate::polygons::Corner;
use crate::record::{Record, Slid, is_in, runs};
use crate::store::Kind;
use crate::torn::TornDocument;

/// A simplified document, and counts of the vertices that had to stay or were put back. Returned by
/// [`TornDocument::simplified`].
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Simplified {
    /// The simplified document; `None` if there was nothing to remove or put back. Lines, and numbers of
    /// vertices that are written several times, are known once it is written and read.
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
    /// normals of its corners. This requires that no edge at the vertex is still torn by this cut or a
    /// later one, and that all vertices inserted beside it since are removed. So the tip of a cut stays
    /// while the cut is open, although the vertex was never split. Several slides of a vertex are undone
    /// in reverse order.
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
    /// the file before the cut. Only `v` that had to be moved up before a face with new vertices, since
    /// other statements may name vertices by number, stay there.
    ///
    /// The document is written and read again first: linear in the document, with memory for one more file.
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
    /// use tearmesh::{Edits, Positions, insert::Plan};
    /// use tearmesh_obj::{Document, TornDocument};
    ///
    /// let document = Document::read(&b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"[..])?;
    /// let mut mesh = document.mesh()?;
    /// let mut positions = Positions::new(document.positions().iter().copied())?;
    /// let mut torn = TornDocument::new(&document);
    /// let mut plan = Plan::new();
    /// plan.on_edge(mesh.half_edge(0), 0.5);
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
        let mut bytes = Vec::new();
        self.write_as(mesh, positions, &mut bytes, true, false)?;
        let document = Document::read(&bytes[..])?;
        drop(bytes);
        let Some(record) = document.record.as_deref() else {
            return Ok(Simplified::default());
        };
        let mesh = document.mesh().expect("the mesh that was written");
        let undo = Undo::find(&document, record, &mesh);
        let rest = Rest::of(&document, record, &mesh, &undo);
        let mut divided = 0..record.families.all().len();
        let is_changed = divided.any(|family| undo.restored(family).is_some());
        let is_changed = is_changed || !rest.put_back.is_empty();
        Ok(Simplified {
            document: is_changed.then(|| rest.document()),
            edited: undo.edited,
            slid_back: rest.put_back.len(),
            slid_edited: undo.slid_edited(),
        })
    }
}

/// What stays of a document.
struct Rest<'d> {
    document: &'d Document,
    record: &'d Record,
    undo: &'d Undo<'d>,
    /// For each face, the corners of the one that takes its place, and the divided face that this is part
    /// of.
    faces: Vec<Option<[HalfEdgeId; 3]>>,
    families: Vec<Option<u32>>,
    /// For each vertex that stays and of which slides are undone, what its `v` has then.
    put_back: BTreeMap<u32, &'d [f64]>,
}

impl<'d> Rest<'d> {
    fn of(document: &'d Document, record: &'d Record, mesh: &Mesh, undo: &'d Undo<'d>) -> Rest<'d> {
        let mut faces: Vec<_> = mesh.faces().map(|f| Some(f.half_edges())).collect();
        let mut families: Vec<_> = (0..faces.len()).map(|f| record.families.of(f)).collect();
        // What is around takes the place of what is within, and has a lower number.
        for (number, divided) in undo.divided.iter().enumerate().rev() {
            let mut restored = undo.restored(number);
            if restored.is_some() {
                for f in &divided.faces {
                    faces[f.index()] = restored.take();
                    families[f.index()] = record.families.all()[number].above;
                }
            }
        }
        let slides = record.slides.iter().enumerate().rev();
        let undone = slides.filter(|&(slide, slid)| undo.is_back[slide] && !undo.goes(slid.vertex));
        let put_back = undone.map(|(_, slid)| (slid.vertex, slid.before()));
        Rest {
            document,
            record,
            undo,
            faces,
            families,
            put_back: put_back.collect(),
        }
    }

    /// The vertex, the texture coordinate and the normal of a corner, without the slides that are undone.
    fn corner(&self, h: HalfEdgeId) -> [Option<u32>; 3] {
        let vertex = self.document.polygons.vertices[h.index()];
        let is_back = |slide: usize| self.undo.is_back[slide];
        let [texture, normal] = self.undo.history.indices(h.index(), is_back);
        [Some(vertex), texture, normal]
    }

    /// Whether a slide stays on record.
    fn has_slide(&self, slide: usize) -> bool {
        let vertex = self.record.slides[slide].vertex;
        !self.undo.is_back[slide] && !self.undo.goes(vertex)
    }

    /// Whether each vertex, texture coordinate and normal stays. Of texture coordinates and normals that were
    /// inserted, those do that a corner or a slide has.
    fn stays(&self) -> [Vec<bool>; 3] {
        let counts = self.document.counts();
        let mut stays = [0, 1, 2].map(|of| {
            let all = 0..counts[of] as u32;
            let stays = all.map(|index| match of {
                0 => !self.undo.goes(index),
                _ => !is_in(&self.record.new_indices[of - 1], index),
            });
            stays.collect::<Vec<bool>>()
        });
        for &h in self.faces.iter().flatten().flatten() {
            for (stays, index) in stays.iter_mut().zip(self.corner(h)) {
                if let Some(index) = index {
                    stays[index as usize] = true;
                }
            }
        }
        let slides = &self.record.slides;
        for slide in (0..slides.len()).filter(|&slide| self.has_slide(slide)) {
            for exchange in &slides[slide].exchanges {
                stays[1 + exchange.which][exchange.new as usize] = true;
                stays[1 + exchange.which][exchange.old as usize] = true;
            }
        }
        stays
    }

    /// The document without what is removed.
    fn document(&self) -> Document {
        let document = self.document;
        let stays = self.stays();
        let numbers = stays.each_ref().map(|stays| numbers(stays));
        let mut simple = Document {
            layout: document.layout.clone(),
            text: document.text.clone(),
            record: Some(Box::new(self.record(&stays, &numbers))),
            ..Document::default()
        };
        let staying = |of: usize| {
            let stays = &stays[of];
            (0..stays.len()).filter(|&index| stays[index])
        };
        for v in staying(0) {
            let (at, extras) = match self.put_back.get(&(v as u32)) {
                Some([x, y, z, extras @ ..]) => (Point::new(*x, *y, *z), extras),
                _ => (document.positions[v], document.extras.row(v)),
            };
            if !extras.is_empty() {
                simple.extras.set(simple.positions.len(), extras);
            }
            simple.positions.push(at);
        }
        let texture = |index: usize| stays[1][index];
        simple.texture = document.texture.staying(document.texture.len(), texture);
        simple.normals = staying(2).map(|index| document.normals[index]).collect();
        for corners in self.faces.iter().flatten() {
            simple.polygons.add(corners.iter().map(|&h| {
                let corner = self.corner(h);
                let number = |of: usize| Some(numbers[of][corner[of]? as usize]);
                Corner {
                    vertex: number(0).expect("a corner has a vertex"),
                    texture: number(1),
                    normal: number(2),
                }
            }));
        }
        let count = |kind: Kind, number: usize| match kind {
            Kind::Vertex => usize::from(stays[0][number]),
            Kind::Texture => usize::from(stays[1][number]),
            Kind::Normal => usize::from(stays[2][number]),
            Kind::Polygon | Kind::Text => usize::from(self.faces[number].is_some()),
        };
        simple.replace_statements(count);
        simple
    }

    /// The record of what stays, by the new numbers.
    fn record(&self, stays: &[Vec<bool>; 3], numbers: &[Vec<u32>; 3]) -> Record {
        let mut record = self.record.clone();
        record.copies.clear(); // What is written again depends on what goes.
        let has = |vertex: u32| stays[0][vertex as usize];
        record.splits.retain(|split| has(split.vertex));
        record.inserted.retain(|inserted| has(inserted.vertex));
        record
            .apart
            .retain(|apart| has(apart.vertex) && !self.put_back.contains_key(&apart.vertex));
        let faces = self.faces.iter().zip(&self.families);
        let of_faces = faces.filter_map(|(corners, family)| corners.map(|_| *family));
        let is_divided = |number: usize| self.undo.restored(number).is_none();
        record.families = self.record.families.of_faces(of_faces, is_divided);
        record.new_indices = [0, 1].map(|which| {
            let all = self.record.new_indices[which].iter();
            let all = all.flat_map(|&[first, end]| first..end);
            let staying = all.filter(|&index| stays[1 + which][index as usize]);
            runs(staying.map(|index| numbers[1 + which][index as usize]))
        });
        let mut slides = 0..;
        let has_slide = |_: &Slid| slides.next().is_some_and(|slide| self.has_slide(slide));
        record.slides.retain(has_slide);
        for slid in &mut record.slides {
            slid.renumber_indices(|which, index| numbers[1 + which][index as usize]);
        }
        record.renumber(|vertex| numbers[0][vertex as usize]);
        record
    }
}

/// The number of each element that stays among those that do.
fn numbers(stays: &[bool]) -> Vec<u32> {
    let mut next = 0;
    let number = |&stays: &bool| {
        let number = next;
        next += u32::from(stays);
        number
    };
    stays.iter().map(number).collect()
}
