//! Which cut tore which links of a mesh.

use tearmesh::{Cut, Edit, HalfEdgeId, Insert};

use super::report::CutId;
use crate::follow::lies_on;

/// Which cut tore each link.
#[derive(Clone, Debug, Default)]
pub(super) struct Seams {
    /// By half-edge: the number of the cut that tore its link, from 1; 0 for none.
    pub(super) cut_of: Vec<u32>,
    cuts: u32,
}

impl Seams {
    /// Notes what a cut tore.
    pub(super) fn add(&mut self, cut: &Cut) -> CutId {
        let id = CutId(self.cuts);
        self.cuts += 1;
        for h in cut.seam().flat_map(|line| line.lips.as_flattened()) {
            self.cut_of[h.index()] = self.cuts;
        }
        id
    }

    /// The half-edges that a cut tore, on both sides of it; `None` if there was no such cut.
    pub(super) fn torn_by(&self, cut: CutId) -> Option<impl Iterator<Item = HalfEdgeId> + '_> {
        let number = cut.0.checked_add(1).filter(|number| *number <= self.cuts)?;
        let torn = self.cut_of.iter().enumerate();
        let torn = torn.filter(move |&(_, by)| *by == number);
        Some(torn.filter_map(|(index, _)| HalfEdgeId::new(index)))
    }

    /// The parts of a divided edge were torn by what tore the edge.
    fn insert(&mut self, insert: &Insert<'_>) {
        for family in insert.families() {
            let parent = family[0].parent.half_edges();
            let before = parent.map(|h| self.cut_of[h.index()]);
            for child in family {
                let start = 3 * child.face.index();
                self.cut_of.resize(self.cut_of.len().max(start + 3), 0);
                for corner in 0..3 {
                    let ends = [corner, (corner + 1) % 3].map(|i| &child.sources[i]);
                    let on = |&h: &usize| ends.into_iter().all(|end| lies_on(end, parent[h]));
                    self.cut_of[start + corner] = (0..3).find(on).map_or(0, |h| before[h]);
                }
            }
        }
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Insert(insert) => self.insert(insert),
            Edit::Merge(merge) => {
                for link in merge.sewn {
                    self.cut_of[link.stayed.index()] = 0;
                    self.cut_of[link.moved.index()] = 0;
                }
            }
            Edit::Split(_) | Edit::Slide(_) => {}
        }
    }
}
