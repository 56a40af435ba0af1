//! The holds of a scene while it runs: who is held now, and by which step that ends.

use super::RunError;
use crate::cloth::load::Path;
use crate::cloth::scene::{Frame, Hold};
use crate::cloth::system::System;
use crate::edit::{Edit, Edits};
use crate::geometry::Point;
use crate::id::VertexId;
use crate::mesh::Mesh;

/// A hold, and its vertices.
#[derive(Clone, Debug)]
pub(super) struct Held {
    hold: Hold,
    vertices: Vec<VertexId>,
    state: State,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Waiting,
    Holding,
    Released,
}

/// The step at whose beginning something is to happen.
pub(super) fn step_at(time_s: f64, step_s: f64) -> u64 {
    (time_s / step_s).round() as u64
}

impl Held {
    pub(super) fn new(
        number: usize,
        hold: &Hold,
        mesh: &Mesh,
        points: &[Point],
        frame: &Frame,
    ) -> Result<Held, RunError> {
        let vertices = hold.region.vertices(mesh, points, frame);
        if vertices.is_empty() {
            return Err(RunError::NothingHeld { number });
        }
        let later = |until_s: f64| until_s > hold.from_s;
        let finite = hold.from_s >= 0.0 && hold.from_s.is_finite();
        let way = hold.moves.iter().map(|&(s, d)| (s, Point::from(d)));
        let leads = hold.moves.is_empty() || Path::new(way).is_some();
        if !finite || !hold.until_s.is_none_or(later) || !leads {
            return Err(RunError::Moves { number });
        }
        Ok(Held {
            hold: hold.clone(),
            vertices,
            state: State::Waiting,
        })
    }

    /// Takes the vertices, or lets them go, if that is to happen at the beginning of this step.
    pub(super) fn take_or_release(&mut self, now: u64, step_s: f64, system: &mut System) {
        if self.state == State::Waiting && step_at(self.hold.from_s, step_s) <= now {
            self.state = State::Holding;
            for &v in &self.vertices {
                self.take(v, system);
            }
        }
        let ends = |until_s: f64| step_at(until_s, step_s) <= now;
        if self.state == State::Holding && self.hold.until_s.is_some_and(ends) {
            self.state = State::Released;
            for v in &self.vertices {
                system.release(v.index());
            }
        }
    }

    fn take(&self, v: VertexId, system: &mut System) {
        let from = system.positions()[v.index()];
        let way = self.hold.moves.iter().map(|&(s, d)| (s, from + d));
        // The way itself was looked at when the scene was set; from the edge of what is usable it
        // leads a little beyond, and not to nowhere.
        let points: Vec<_> = way.collect();
        if points.is_empty() {
            system.hold(v.index());
        } else {
            system.grab(v.index(), Path { points });
        }
    }

    /// The copies of held vertices are held as well.
    pub(super) fn follow(&mut self, edits: &Edits) {
        for edit in edits.iter() {
            if let Edit::Split(split) = edit
                && self.vertices.contains(&split.old)
            {
                self.vertices.push(split.new);
            }
        }
    }

    pub(super) fn now(&self) -> &[VertexId] {
        match self.state {
            State::Holding => &self.vertices,
            State::Waiting | State::Released => &[],
        }
    }

    /// How many of its vertices are joined to no other of them.
    pub(super) fn pins(&self, mesh: &Mesh) -> usize {
        let mut held = vec![false; mesh.vertex_count()];
        self.vertices.iter().for_each(|v| held[v.index()] = true);
        let mut alone = held.clone();
        for h in mesh.half_edges() {
            let ends = [mesh.origin(h), mesh.target(h)].map(VertexId::index);
            if ends.iter().all(|&v| held[v]) {
                ends.iter().for_each(|&v| alone[v] = false);
            }
        }
        alone.into_iter().filter(|&alone| alone).count()
    }
}
