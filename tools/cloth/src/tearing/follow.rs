//! A running tear follows the log: strengths and clocks stay with the cloth through cuts, mends
//! and its own splits.

use tearmesh::geometry::Vector;
use tearmesh::{Cursor, Edit, Follower, Insert, Merge};

use super::apply::{Clock, Tear};
use crate::follow::lies_on;

impl Follower for Tear {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        edit.pass_on(&mut self.strengths);
        edit.pass_on(&mut self.tips);
        match edit {
            // Both halves of a torn link go on with the clock of its edge. The tear has gone
            // through the vertex, which is a tip no more.
            Edit::Split(split) => {
                *self.tips.at_mut(split.old) = Vector::zeros();
                *self.tips.at_mut(split.new) = Vector::zeros();
            }
            Edit::Slide(_) => {}
            Edit::Insert(insert) => self.insert(insert),
            Edit::Merge(merge) => self.merge(merge),
        }
    }
}

impl Tear {
    /// The parts of a divided edge go on with its clock; new edges in a face begin.
    fn insert(&mut self, insert: &Insert<'_>) {
        for family in insert.families() {
            let parent = family.parent().half_edges();
            let before = parent.map(|h| self.clocks[h.index()]);
            for child in family.children() {
                let start = 3 * child.face.index();
                let end = self.clocks.len().max(start + 3);
                self.clocks.resize(end, Clock::BELOW);
                for corner in 0..3 {
                    let ends = [corner, (corner + 1) % 3].map(|i| &child.sources[i]);
                    let on = |&h: &usize| ends.into_iter().all(|end| lies_on(end, parent[h]));
                    let clock = (0..3).find(on).map_or(Clock::BELOW, |h| before[h]);
                    self.clocks[start + corner] = clock;
                }
            }
        }
    }

    /// What is sewn together waits no longer than either did.
    fn merge(&mut self, merge: &Merge<'_>) {
        for link in merge.sewn {
            let [one, other] = [link.stayed, link.moved].map(|h| self.clocks[h.index()]);
            let longer = one.longer(other, self.now);
            self.clocks[link.stayed.index()] = longer;
            self.clocks[link.moved.index()] = longer;
        }
    }
}
