//! What became of faces and their corners.

use std::collections::BTreeMap;
use std::ops::Range;

use tearmesh::{Blend, ChildFace, HalfEdgeId, Insert, Mix, Slide, VertexId};

use crate::document::Document;
use crate::families::{Families, Family};
use crate::record::Exchange;
use crate::store::Rows;

/// No index.
const NONE: u32 = u32::MAX;

/// The faces and corners of a mesh, once faces were divided.
#[derive(Clone, Debug)]
pub(crate) struct Corners<'d> {
    document: &'d Document,
    /// The triangle of the document where each face stands.
    pub(super) slots: Vec<u32>,
    /// The texture coordinate and the normal of each corner; empty where no corner has one, so that a file
    /// without them takes no memory here.
    corners: [Vec<u32>; 2],
    /// Texture coordinates and normals behind those of the document.
    new_values: [Rows; 2],
    /// For each of these, the one of the document in whose section it belongs.
    pub(super) anchors: [Vec<u32>; 2],
}

/// What a new corner lies between: the class of its vertex, which tells the edge and how far
/// along, and the indices at the sources.
type Between = (u32, [u32; 3]);

impl<'d> Corners<'d> {
    pub(super) fn new(document: &'d Document) -> Corners<'d> {
        let count = document.triangles().len();
        let columns = [&document.polygons.texture, &document.polygons.normals];
        let corners = columns.map(|column| {
            let mut corners = Vec::new();
            if column.is_empty() {
                return corners;
            }
            corners.reserve_exact(3 * count);
            for polygon in 0..document.polygons.len() {
                for triangle in document.polygons.triangles(polygon) {
                    corners.extend([0, 1, 2].map(|corner| {
                        let of_polygon = document.corner_of_polygon(triangle, corner, polygon);
                        column.get(of_polygon).unwrap_or(NONE)
                    }));
                }
            }
            corners
        });
        Corners {
            document,
            slots: (0..count as u32).collect(),
            corners,
            new_values: Default::default(),
            anchors: Default::default(),
        }
    }

    /// How many texture coordinates and normals there are.
    pub(crate) fn counts(&self) -> [usize; 2] {
        let [_, texture, normals] = self.document.counts();
        [
            texture + self.new_values[0].len(),
            normals + self.new_values[1].len(),
        ]
    }

    /// The numbers of a texture coordinate (0) or a normal (1).
    pub(crate) fn value(&self, which: usize, index: u32) -> &[f64] {
        let known = self.document.counts()[1 + which];
        match (index as usize).checked_sub(known) {
            None => self.document.value(which, index),
            Some(new) => self.new_values[which].row(new),
        }
    }

    /// The texture coordinate and the normal of a corner of the mesh.
    #[inline]
    pub(crate) fn at(&self, half_edge: usize) -> [Option<u32>; 2] {
        [0, 1].map(|which| Some(self.raw(which, half_edge)).filter(|&index| index != NONE))
    }

    #[inline]
    fn raw(&self, which: usize, half_edge: usize) -> u32 {
        self.corners[which].get(half_edge).copied().unwrap_or(NONE)
    }

    pub(crate) fn slots(&self) -> Slots {
        Slots::sorted(&self.slots, self.document.triangles().len())
    }

    /// Follows an insertion; `class` is that of each vertex, the inserted ones included.
    pub(super) fn insert(
        &mut self,
        insert: &Insert<'_>,
        class: impl Fn(VertexId) -> u32,
        families: &mut Families,
    ) {
        let mut made = [BTreeMap::new(), BTreeMap::new()];
        for family in insert.families() {
            let parent = family[0].parent.index();
            let slot = self.slots[parent];
            let corners = original(family, &class);
            let (number, above) = (families.all().len() as u32, families.of(parent));
            families.add(Family { corners, above });
            let before =
                [0, 1].map(|which| [0, 1, 2].map(|corner| self.raw(which, 3 * parent + corner)));
            for child in family {
                let face = child.face.index();
                families.give(face, number);
                if face >= self.slots.len() {
                    assert_eq!(face, self.slots.len(), "new faces come without a gap");
                    self.slots.push(slot);
                    let some = self.corners.iter_mut().filter(|of| !of.is_empty());
                    some.for_each(|of| of.extend([NONE; 3]));
                }
                for corner in 0..3 {
                    let class = class(child.vertices[corner]);
                    let source = child.sources[corner];
                    for which in [0, 1] {
                        let made = &mut made[which];
                        let index = self.index(source, before[which], class, which, made);
                        if let Some(own) = self.corners[which].get_mut(3 * face + corner) {
                            *own = index;
                        }
                    }
                }
            }
        }
    }

    /// Follows a vertex that slides: the corners in the faces of the edge get an index between
    /// those at its ends, and corners that had the same index as these get it with them. A corner with
    /// another index of the same value, as in a file that gives each face indices of its own, gets one of
    /// its own with the same new value, so that it can be exchanged back. Gives what was exchanged.
    pub(super) fn slide(&mut self, slide: &Slide<'_>) -> Vec<Exchange> {
        let mut exchanges = Vec::new();
        let weights = [1.0 - slide.t, slide.t, 0.0];
        for which in 0..2 {
            let mut changes: Vec<(HalfEdgeId, [u32; 2], u32)> = Vec::new();
            for [corner, toward] in slide.along.into_iter().flatten() {
                let ends @ [from, to] = [corner, toward].map(|h| self.raw(which, h.index()));
                if from == to || from == NONE || to == NONE {
                    continue;
                }
                let made = changes.iter().find(|(_, of, _)| *of == ends);
                let index = match made {
                    Some(&(.., index)) => index,
                    // Whoever gets it had the one at the start, and perhaps never that at the end.
                    None => {
                        let new = self.new_between(which, &[from], [from, to, to], weights);
                        exchanges.push(self.exchange(which, new, from));
                        new
                    }
                };
                changes.push((corner, ends, index));
            }
            for &h in slide.corners {
                let Some(&index) = self.corners[which].get(h.index()) else {
                    break;
                };
                let own = changes.iter().find(|(corner, ..)| *corner == h);
                let same = || changes.iter().find(|(_, [from, _], _)| *from == index);
                let alike = || {
                    let value = (index != NONE).then(|| self.value(which, index))?;
                    let mut changes = changes.iter();
                    changes.find(|(_, [from, _], _)| self.value(which, *from) == value)
                };
                let change = own.or_else(same).or_else(alike).copied();
                let Some((_, [from, to], mut after)) = change else {
                    continue;
                };
                if from != index {
                    after = self.new_between(which, &[index], [from, to, to], weights);
                    changes.push((h, [index, to], after));
                    exchanges.push(self.exchange(which, after, index));
                }
                self.corners[which][h.index()] = after;
            }
        }
        exchanges
    }

    fn exchange(&self, which: usize, new: u32, old: u32) -> Exchange {
        Exchange {
            which,
            new,
            old,
            value: self.value(which, new).to_vec(),
        }
    }

    /// The index of a texture coordinate (0) or normal (1) at a place in a face whose corners
    /// have these.
    fn index(
        &mut self,
        source: Mix<HalfEdgeId>,
        before: [u32; 3],
        class: u32,
        which: usize,
        made: &mut BTreeMap<Between, u32>,
    ) -> u32 {
        let (between, weights) = match source {
            Mix::Copy(h) => return before[h.corner()],
            Mix::Between { ends, t } => {
                let [a, b] = ends.map(|h| before[h.corner()]);
                ([a, b, b], [1.0 - t, t, 0.0])
            }
            Mix::Weighted { weights, .. } => (before, weights),
            _ => unreachable!("there is no other mix"),
        };
        if between.contains(&NONE) {
            return NONE;
        }
        if between.iter().all(|&index| index == between[0]) {
            return between[0];
        }
        // The corners of two faces with a common edge come in opposite order; what a
        // place on the edge lies between does not.
        if let Some(&index) = made.get(&(class, between)) {
            return index;
        }
        let index = self.new_between(which, &between, between, weights);
        made.insert((class, between), index);
        index
    }

    /// A new texture coordinate (0) or normal (1) between others, in the section of the last of some.
    fn new_between(
        &mut self,
        which: usize,
        behind: &[u32],
        between: [u32; 3],
        weights: [f64; 3],
    ) -> u32 {
        let anchors = behind.iter().map(|&index| self.anchor(which, index));
        let last = anchors.max().expect("it has sources");
        let sources = between.map(|index| self.value(which, index));
        let row = match which {
            0 => numbers_between(sources, weights),
            _ => {
                let (sum, wanted) = normal_between(sources, weights);
                let scale = wanted / length(&sum);
                match scale.is_finite() {
                    true => sum.iter().map(|x| x * scale).collect(),
                    false => sources[0].to_vec(),
                }
            }
        };
        let new = self.counts()[which];
        self.anchors[which].push(last);
        let rows = &mut self.new_values[which];
        rows.set(rows.len(), &row);
        new as u32
    }

    fn anchor(&self, which: usize, index: u32) -> u32 {
        let known = self.document.counts()[1 + which];
        match (index as usize).checked_sub(known) {
            None => index,
            Some(new) => self.anchors[which][new],
        }
    }
}

/// The faces of a mesh by the triangle of the document where they stand.
#[derive(Debug)]
pub(crate) struct Slots {
    pub(crate) faces: Vec<u32>,
    starts: Vec<u32>,
}

impl Slots {
    /// Sorts faces by the triangle at which each stands. There are `triangles` triangles.
    fn sorted(places: &[u32], triangles: usize) -> Slots {
        let mut starts = vec![0_u32; triangles + 1];
        for &place in places {
            starts[place as usize + 1] += 1;
        }
        for i in 0..triangles {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut faces = vec![0; places.len()];
        for (face, &place) in places.iter().enumerate() {
            faces[next[place as usize] as usize] = face as u32;
            next[place as usize] += 1;
        }
        Slots { faces, starts }
    }

    /// Where each face stands among all.
    pub(crate) fn ranks(&self) -> Vec<u32> {
        let mut ranks = vec![0; self.faces.len()];
        for (rank, &face) in self.faces.iter().enumerate() {
            ranks[face as usize] = rank as u32;
        }
        ranks
    }

    /// Where the faces of triangles are in `faces`.
    pub(crate) fn of(&self, triangles: Range<usize>) -> Range<usize> {
        self.starts[triangles.start] as usize..self.starts[triangles.end] as usize
    }
}

/// The numbers between those of three rows; one that a row does not have counts as 0.
pub(crate) fn numbers_between(rows: [&[f64]; 3], weights: [f64; 3]) -> Vec<f64> {
    let count = rows.map(<[f64]>::len).into_iter().max().unwrap_or(0);
    let values = |i: usize| rows.map(|row| row.get(i).copied().unwrap_or(0.0));
    (0..count).map(|i| blend(values(i), weights)).collect()
}

/// The sum of normals by weights, and how long the normal between them is.
pub(crate) fn normal_between(normals: [&[f64]; 3], weights: [f64; 3]) -> (Vec<f64>, f64) {
    let wanted = blend(normals.map(length), weights);
    (numbers_between(normals, weights), wanted)
}

/// The value between three by these weights; if the last of these is 0, on the edge of the first two.
fn blend([a, b, c]: [f64; 3], weights: [f64; 3]) -> f64 {
    if weights[2] == 0.0 {
        a.between(&b, weights[1])
    } else {
        f64::weighted([&a, &b, &c], weights)
    }
}

/// The length of a normal.
pub(crate) fn length(normal: &[f64]) -> f64 {
    normal.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The classes of the corners of a divided face: each corner is one of a child.
fn original(family: &[ChildFace], class: impl Fn(VertexId) -> u32) -> [u32; 3] {
    let mut corners = [NONE; 3];
    for child in family {
        for (source, &vertex) in child.sources.iter().zip(&child.vertices) {
            if let Mix::Copy(h) = source {
                corners[h.corner()] = class(vertex);
            }
        }
    }
    corners
}
