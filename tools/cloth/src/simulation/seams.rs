//! The labels of torn links: the cut that tore each, and the seam that it belongs to.

use tearmesh::{Cut, Edit, HalfEdgeId, Insert, Mesh};

use super::error::{InputError, SimulationError};
use super::report::CutId;
use crate::cloth::follow::lies_on;
use crate::cloth::seam::{Seam, joined};

/// Which cut tore each link, and of which seam it is.
#[derive(Clone, Debug)]
pub(super) struct Seams {
    /// By half-edge.
    of: Vec<Label>,
    cuts: u32,
    names: Vec<String>,
}

/// Where a link came from.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Label {
    /// The number of the cut that tore it, from 1; 0 for none.
    cut: u32,
    /// The number of its seam, from 1; 0 for none. A link is of its seam for good, sewn or not.
    pub(super) seam: u32,
    /// Whether it was sewn, and not unpicked since.
    is_sewn: bool,
}

impl Seams {
    /// Joins panels to a mesh that is torn along the seams.
    pub(super) fn open(panels: Mesh, seams: Vec<Seam>) -> Result<(Mesh, Seams), SimulationError> {
        let (mesh, labels) = match seams.is_empty() {
            true => {
                let none = vec![0; panels.half_edge_count()];
                (panels, none)
            }
            false => joined(&panels, &seams).map_err(SimulationError::Seams)?,
        };
        let label = |seam| Label {
            seam,
            ..Label::default()
        };
        let of = labels.into_iter().map(label).collect();
        let names = seams.into_iter().map(|seam| seam.name).collect();
        Ok((mesh, Seams { of, cuts: 0, names }))
    }

    /// Notes what a cut tore.
    pub(super) fn add(&mut self, cut: &Cut) -> CutId {
        let id = CutId(self.cuts);
        self.cuts += 1;
        for h in cut.seam().flat_map(|line| line.lips.as_flattened()) {
            self.of[h.index()].cut = self.cuts;
        }
        id
    }

    /// The half-edges with such labels, ascending.
    pub(super) fn links(&self, has: impl Fn(Label) -> bool) -> Vec<HalfEdgeId> {
        let all = (0..).map_while(HalfEdgeId::new).zip(&self.of);
        all.filter(|(_, of)| has(**of)).map(|(h, _)| h).collect()
    }

    /// The half-edges that a cut tore, on both sides of it.
    pub(super) fn of_cut(&self, cut: CutId) -> Result<Vec<HalfEdgeId>, InputError> {
        let is_made = cut.0 < self.cuts;
        is_made
            .then(|| self.links(|of| of.cut == cut.0 + 1))
            .ok_or(InputError::NoCut(cut))
    }

    /// Notes that these links are unpicked.
    pub(super) fn unpick(&mut self, links: &[HalfEdgeId]) {
        for h in links {
            self.of[h.index()].is_sewn = false;
        }
    }

    /// Whether a link of a seam is open that nothing else tore: it was never sewn, or was unpicked.
    pub(super) fn is_open_seam(&self, h: HalfEdgeId) -> bool {
        let label = self.of[h.index()];
        label.seam > 0 && label.cut == 0 && !label.is_sewn
    }

    pub(super) fn name(&self, seam: u64) -> Option<String> {
        self.names.get(seam as usize).cloned()
    }

    /// The half-edges of all seams of a name, and the number of the first of these.
    pub(super) fn named(&self, name: &str) -> Result<(u64, Vec<HalfEdgeId>), InputError> {
        let first = self.names.iter().position(|known| known == name);
        let first = first.ok_or_else(|| InputError::NoSeam(name.to_owned()))?;
        let is_named = |of: Label| of.seam > 0 && self.names[of.seam as usize - 1] == name;
        Ok((first as u64, self.links(is_named)))
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            // The parts of a divided edge were torn by what tore the edge, and are of its seam.
            Edit::Insert(insert) => divided(insert, |parent, children| {
                let before = parent.map(|h| self.of[h.index()]);
                for (h, on) in children {
                    self.of
                        .resize(self.of.len().max(h.index() + 1), Label::default());
                    self.of[h.index()] = on.map_or_else(Label::default, |side| before[side]);
                }
            }),
            Edit::Merge(merge) => {
                for h in merge.sewn.iter().flat_map(|link| [link.stayed, link.moved]) {
                    let label = &mut self.of[h.index()];
                    label.cut = 0;
                    label.is_sewn = label.seam > 0;
                }
            }
            Edit::Split(_) | Edit::Slide(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }
}

/// Visits the faces that were divided: the half-edges of each, and those of its children, with the side of it that each
/// lies on.
pub(super) fn divided(
    insert: &Insert<'_>,
    mut visit: impl FnMut([HalfEdgeId; 3], &[(HalfEdgeId, Option<usize>)]),
) {
    for family in insert.families() {
        let parent = family[0].parent.half_edges();
        let children = family.iter().flat_map(|child| {
            let ends = |corner: usize| [corner, (corner + 1) % 3].map(|i| &child.sources[i]);
            let is_on = move |side: usize, corner: usize| {
                let mut ends = ends(corner).into_iter();
                ends.all(|end| lies_on(end, parent[side]))
            };
            let half_edges = child.face.half_edges().into_iter().enumerate();
            half_edges.map(move |(corner, h)| (h, (0..3).find(|&side| is_on(side, corner))))
        });
        let children: Vec<_> = children.collect();
        visit(parent, &children);
    }
}
