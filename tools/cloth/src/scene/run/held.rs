//! The holds of a scene while it runs: who is held now, and by which step that ends.
//!
//! Where several hold one vertex the one that took it last leads it, and the last in the scene of
//! those that took it at one time. When that ends, the one before it holds on to the vertex. What a cut
//! inserts between vertices of a hold stays between them, whichever hold leads these.

use std::sync::Arc;

use tearmesh::geometry::{Point, Vector};
use tearmesh::{Edit, Mesh, VertexId};

use super::error::RunError;
use crate::cloth::held_set::HeldSet;
use crate::scene::frame::Frame;
use crate::scene::{HeldVertices, Region};
use crate::system::System;
use crate::system::balance::Balance;
use crate::system::path::{Path, RigidMotion};

/// A hold, and its vertices.
#[derive(Clone, Debug)]
pub(in crate::scene) struct Held {
    hold: HeldVertices,
    set: HeldSet,
    /// How it moves, if it turns.
    turning: Option<Arc<RigidMotion>>,
    /// The step at whose beginning it took its vertices; `None` before that, and after it let go.
    since: Option<u64>,
}

/// The step at whose beginning something is to happen.
pub(super) fn step_at(time_s: f64, step_s: f64) -> u64 {
    (time_s / step_s).round() as u64
}

/// The vertices of a region for a hold or a strength of this number; all that it names have to
/// be there.
pub(in crate::scene) fn vertices_in(
    region: &Region,
    (named_by, number): (&'static str, usize),
    mesh: &Mesh,
    points: &[Point],
    frame: &Frame,
) -> Result<Vec<VertexId>, RunError> {
    let vertices = mesh.vertex_count();
    if let Region::Vertices(named) = region
        && let Some(&vertex) = named.iter().find(|v| v.index() >= vertices)
    {
        return Err(RunError::NoVertex {
            named_by,
            number,
            vertex,
            vertices,
        });
    }
    let found = region.vertices(mesh, points, frame);
    if found.is_empty() {
        return Err(RunError::NoVertices { named_by, number });
    }
    Ok(found)
}

/// Takes vertices, and lets vertices go, where that is to happen at the beginning of this step.
pub(super) fn take_and_release(
    all: &mut [Held],
    now: u64,
    step_s: f64,
    system: &mut System,
    balance: &mut Balance,
) {
    let mut has_changed = false;
    for held in all.iter_mut() {
        if held.since.is_none() && step_at(held.hold.from_s, step_s) == now {
            (held.since, has_changed) = (Some(now), true);
            for &v in held.set.vertices() {
                held.take(v, system.positions()[v.index()], system, balance);
            }
        }
    }
    for number in 0..all.len() {
        let until_s = all[number].hold.until_s;
        if until_s.is_none_or(|until_s| step_at(until_s, step_s) > now) {
            continue;
        }
        // Its vertices are free, or those of others that hold them as well.
        let since = all[number].since.take();
        has_changed |= since.is_some();
        let vertices = all[number].set.vertices().iter();
        for &v in vertices.filter(|_| since.is_some()) {
            let others = (0..).zip(all.iter());
            let others = others.filter(|(_, held)| held.now().contains(v));
            match others.max_by_key(|&(other, held)| (held.since, other)) {
                Some((other, held)) if (held.since, other) > (since, number) => {} // It leads it already.
                Some((_, held)) => held.take_back(v, system, balance),
                None => balance.handle(system, v.index(), |system| system.release(v.index())),
            }
        }
    }
    if has_changed {
        bind(all, system, balance);
    }
}

/// Has what cuts inserted within holds stay between the vertices that it was inserted between.
pub(super) fn bind(all: &[Held], system: &mut System, balance: &mut Balance) {
    for (v, between) in all.iter().flat_map(|held| held.now().inserted()) {
        let between = between.map(VertexId::index);
        balance.handle(system, v.index(), |system| {
            system.hold_between(v.index(), between);
        });
    }
}

/// The path of vectors, from rows of a time and a vector.
pub(in crate::scene) fn path_of(rows: &[(f64, Vector)]) -> Option<Path> {
    Path::new(rows.iter().map(|&(s, d)| (s, Point::from(d))))
}

/// The motion of a hold that turns.
fn turning(hold: &HeldVertices) -> Option<RigidMotion> {
    Some(RigidMotion {
        turns: Some(path_of(&hold.turns)?),
        moves: path_of(&hold.moves),
        about: hold.about,
    })
}

impl Held {
    pub(super) fn new(
        number: usize,
        hold: &HeldVertices,
        mesh: &Mesh,
        points: &[Point],
        frame: &Frame,
    ) -> Result<Held, RunError> {
        let name = ("hold", number);
        Ok(Held {
            hold: hold.clone(),
            set: HeldSet::new(vertices_in(&hold.region, name, mesh, points, frame)?),
            turning: turning(hold).map(Arc::new),
            since: None,
        })
    }

    /// Takes a vertex that was at this place when its way began.
    fn take(&self, v: VertexId, from: Point, system: &mut System, balance: &mut Balance) {
        balance.handle(system, v.index(), |system| match self.path(from) {
            Some(path) => system.grab(v.index(), path),
            None => {
                system.release(v.index()); // Of a path of another hold.
                system.hold(v.index());
            }
        });
    }

    /// Takes a vertex back that another hold has led: it goes on from where it is.
    fn take_back(&self, v: VertexId, system: &mut System, balance: &mut Balance) {
        let (at, now_s) = (system.positions()[v.index()], system.elapsed_s());
        let began = match (&self.turning, self.path(at)) {
            (Some(motion), _) => motion.at(now_s).to_body(at),
            (None, Some(path)) => at - (path.at(now_s) - at),
            (None, None) => at,
        };
        self.take(v, began, system, balance);
    }

    /// The way of a vertex that is taken at a place; `None` of one that stays there.
    fn path(&self, from: Point) -> Option<Path> {
        if let Some(motion) = &self.turning {
            return Some(Path::carried(from, motion.clone()));
        }
        // The way itself was looked at when the scene was set; from the edge of what is usable it
        // leads a little beyond, and not to nowhere.
        let points = self.hold.moves.iter().map(|&(s, d)| (s, from + d));
        (!self.hold.moves.is_empty()).then(|| Path::through(points.collect()))
    }

    pub(super) fn follow(&mut self, edit: &Edit<'_>) {
        self.set.follow(edit, self.since.is_some());
    }

    /// What it holds now.
    pub(super) fn now(&self) -> &HeldSet {
        const NOTHING: &HeldSet = &HeldSet::EMPTY;
        self.since.map_or(NOTHING, |_| &self.set)
    }

    /// Whether it holds from the beginning.
    pub(in crate::scene) fn is_first(&self) -> bool {
        self.hold.from_s <= 0.0
    }

    /// The vertices that are held, or are to be.
    pub(in crate::scene) fn vertices(&self) -> impl Iterator<Item = VertexId> {
        self.set.vertices().iter().copied()
    }

    /// How many of its vertices are joined to no other of them. The strain around such a pin grows as
    /// 1/h with the edge length h of the mesh; the strain around a clamp does not.
    pub(in crate::scene) fn pins(&self, mesh: &Mesh) -> usize {
        let mut held = vec![false; mesh.vertex_count()];
        let vertices = self.set.vertices().iter();
        vertices.for_each(|v| held[v.index()] = true);
        let is_alone = |v: &VertexId| {
            let corners = mesh.corners_of(*v);
            let mut others = corners.flat_map(|h| [mesh.target(h), mesh.origin(h.prev())]);
            held[v.index()] && others.all(|other| !held[other.index()])
        };
        mesh.vertices().filter(is_alone).count()
    }
}
