//! Which cut tore which links of a mesh, and which seam they belong to.

use tearmesh::{Cut, Edit, HalfEdgeId, Insert, Mesh};

use super::error::{InputError, SimulationError};
use super::report::CutId;
use crate::cloth::follow::lies_on;
use crate::cloth::seam::{Seam, joined};

/// Which cut tore each link, and of which seam it is.
#[derive(Clone, Debug)]
pub(super) struct Seams {
    /// By half-edge: the number of the cut that tore its link, and that of its seam, from 1; 0 for none. A link
    /// is of its seam for good, sewn or not.
    of: Vec<[u32; 2]>,
    cuts: u32,
    names: Vec<String>,
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
        let of = labels.into_iter().map(|seam| [0, seam]).collect();
        let names = seams.into_iter().map(|seam| seam.name).collect();
        Ok((mesh, Seams { of, cuts: 0, names }))
    }

    /// Notes what a cut tore.
    pub(super) fn add(&mut self, cut: &Cut) -> CutId {
        let id = CutId(self.cuts);
        self.cuts += 1;
        for h in cut.seam().flat_map(|line| line.lips.as_flattened()) {
            self.of[h.index()][0] = self.cuts;
        }
        id
    }

    /// The half-edges with such numbers of a cut and a seam, ascending.
    pub(super) fn links(&self, has: impl Fn([u32; 2]) -> bool) -> Vec<HalfEdgeId> {
        let all = (0..).map_while(HalfEdgeId::new).zip(&self.of);
        all.filter(|(_, of)| has(**of)).map(|(h, _)| h).collect()
    }

    /// The half-edges that a cut tore, on both sides of it.
    pub(super) fn of_cut(&self, cut: CutId) -> Result<Vec<HalfEdgeId>, InputError> {
        let is_made = cut.0 < self.cuts;
        is_made
            .then(|| self.links(|of| of[0] == cut.0 + 1))
            .ok_or(InputError::NoCut(cut))
    }

    pub(super) fn name(&self, seam: u64) -> Option<String> {
        self.names.get(seam as usize).cloned()
    }

    /// The half-edges of all seams of a name, and the number of the first of these.
    pub(super) fn named(&self, name: &str) -> Result<(u64, Vec<HalfEdgeId>), InputError> {
        let first = self.names.iter().position(|known| known == name);
        let first = first.ok_or_else(|| InputError::NoSeam(name.to_owned()))?;
        let is_named = |[_, seam]: [u32; 2]| seam > 0 && self.names[seam as usize - 1] == name;
        Ok((first as u64, self.links(is_named)))
    }

    /// The parts of a divided edge were torn by what tore the edge, and are of its seam.
    fn insert(&mut self, insert: &Insert<'_>) {
        for family in insert.families() {
            let parent = family[0].parent.half_edges();
            let before = parent.map(|h| self.of[h.index()]);
            for child in family {
                let start = 3 * child.face.index();
                self.of.resize(self.of.len().max(start + 3), [0; 2]);
                for corner in 0..3 {
                    let ends = [corner, (corner + 1) % 3].map(|i| &child.sources[i]);
                    let on = |&h: &usize| ends.into_iter().all(|end| lies_on(end, parent[h]));
                    self.of[start + corner] = (0..3).find(on).map_or([0; 2], |h| before[h]);
                }
            }
        }
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        match edit {
            Edit::Insert(insert) => self.insert(insert),
            Edit::Merge(merge) => {
                for link in merge.sewn {
                    self.of[link.stayed.index()][0] = 0;
                    self.of[link.moved.index()][0] = 0;
                }
            }
            Edit::Split(_) | Edit::Slide(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }
}
