//! The state of a cloth that tears, and one step of it.

use tearmesh::geometry::{Plane, Vector, dot, length};
use tearmesh::{Cursor, Edit, Edits, Follower, HalfEdgeId, Mesh, PerVertex, VertexId, split, tear};

use super::load::{find_stretched, strain};
use super::{Tearing, TearingError};
use crate::cloth::Cloth;
use crate::cloth::fabric::Stretch;
use crate::system::force;
use crate::system::incidence::room_for;

/// The state of tearing of a cloth: the strength of each vertex, and the tips of its tears.
///
/// It is a follower of the log. Edits between two steps, such as cuts, are replayed by
/// `edits.replay(&mut (&mut cloth, &mut tear))`, or by the next [`Tear::apply`].
#[derive(Clone, Debug)]
pub struct Tear {
    tearing: Tearing,
    strengths: PerVertex<f64>,
    /// The least strength that was given. Edits only mix strengths, so none is less.
    least: f64,
    /// Where a tear may run on, and the direction across it at rest: zero for vertices that are no
    /// tips.
    tips: PerVertex<Vector>,
    due: Vec<Due>,
    /// The edges that tore in the last step, in the order in which they did.
    pub(crate) torn: Vec<Torn>,
    seen: Cursor,
    /// The far ends of the links that a split tore.
    ahead: Vec<VertexId>,
    /// By vertex: whether it was split in this step.
    is_fresh: Vec<bool>,
}

/// An edge that may tear in this step.
#[derive(Clone, Copy, Debug)]
struct Due {
    edge: HalfEdgeId,
    load: f64,
    /// The load over the smaller strength.
    severity: f64,
}

/// An edge that tore in a step: a vertex at one of its ends was split.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Torn {
    pub(crate) edge: HalfEdgeId,
    pub(crate) vertex: VertexId,
    /// The tension of the edge by the method, in newtons; none in a fabric of triangles alone.
    pub(crate) force_n: Option<f64>,
}

/// The report of one step of tearing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TearReport {
    /// The number of vertices that were split.
    pub splits: usize,
    /// The number of overloaded edges before the step: those with a load of at least the smaller
    /// strength of their ends.
    pub overstretched: usize,
    /// Whether the cap on splits left an edge that would have torn.
    pub cap_hit: bool,
    /// The overloaded edge with the largest load divided by strength, and that quotient, which is 1
    /// or more. `None` if no edge was overloaded.
    pub worst: Option<(HalfEdgeId, f64)>,
    /// The elastic energy of the edges that tore, in joules, which turns into motion.
    pub edge_energy_j: f64,
    /// The total rest length of the edges that came apart, in metres.
    pub tear_length_m: f64,
}

impl Tear {
    /// Creates the state of tearing of a cloth that has not torn yet, with strength 1 everywhere.
    ///
    /// # Errors
    ///
    /// [`TearingError`] if a number of `tearing` cannot be used.
    pub fn new(cloth: &Cloth, tearing: Tearing) -> Result<Tear, TearingError> {
        tearing.check()?;
        let (count, seen) = (cloth.positions().len(), cloth.seen());
        Ok(Tear {
            tearing,
            strengths: PerVertex::new(vec![1.0; count]).starting_at(seen),
            least: 1.0,
            tips: PerVertex::new(vec![Vector::zeros(); count]).starting_at(seen),
            seen,
            due: Vec::new(),
            torn: Vec::new(),
            ahead: Vec::new(),
            is_fresh: Vec::new(),
        })
    }

    /// Sets the strength of each vertex, as a multiple of the threshold, in the order of the
    /// vertices.
    ///
    /// # Errors
    ///
    /// [`TearingError`] unless there is one positive finite strength per vertex.
    pub fn with_strengths(mut self, strengths: Vec<f64>) -> Result<Tear, TearingError> {
        let vertices = self.strengths.as_slice().len();
        if strengths.len() != vertices {
            return Err(TearingError::Strengths {
                given: strengths.len(),
                vertices,
            });
        }
        let unusable = |&strength: &f64| !(strength > 0.0 && strength.is_finite());
        if let Some(vertex) = strengths.iter().position(unusable) {
            let given = strengths[vertex];
            return Err(TearingError::Strength { vertex, given });
        }
        self.set_strengths(strengths);
        Ok(self)
    }

    /// Sets the strengths of vertices that are usable.
    pub(crate) fn set_strengths(&mut self, strengths: impl IntoIterator<Item = f64>) {
        self.least = f64::INFINITY;
        for (v, strength) in (0..).map_while(VertexId::new).zip(strengths) {
            self.least = self.least.min(strength);
            *self.strengths.at_mut(v) = strength;
        }
    }

    /// Makes room for all splits that can follow ([`Cloth::reserve`]), so that they allocate nothing.
    pub(crate) fn reserve(&mut self, splits: usize, corners: usize) {
        self.strengths.reserve(splits);
        self.tips.reserve(splits);
        room_for(&mut self.due, corners);
        room_for(&mut self.torn, corners);
        room_for(&mut self.ahead, corners);
        room_for(&mut self.is_fresh, corners);
    }

    /// Returns the rules by which the cloth tears.
    #[must_use]
    pub fn tearing(&self) -> &Tearing {
        &self.tearing
    }

    /// Returns the strength of a vertex as it was given, without any weakening.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn strength(&self, v: VertexId) -> f64 {
        *self.strengths.at(v)
    }

    /// Returns whether a vertex is the tip of a tear, to which [`Tearing::weakening`] applies.
    ///
    /// # Panics
    ///
    /// If there is no such vertex.
    #[must_use]
    pub fn is_tip(&self, v: VertexId) -> bool {
        *self.tips.at(v) != Vector::zeros()
    }

    /// The strength of a vertex against a pull along `edge` at rest: weakened at a tip, if that is
    /// within 45° of the direction across its tear.
    fn strength_along(&self, v: VertexId, edge: Vector) -> f64 {
        let tip = *self.tips.at(v);
        let cosine = dot(tip, edge);
        let across = self.is_tip(v) && 2.0 * cosine * cosine >= dot(tip, tip) * dot(edge, edge);
        match self.tearing.weakening {
            Some(factor) if across => *self.strengths.at(v) * factor,
            _ => *self.strengths.at(v),
        }
    }

    /// Tears the edges that are overstretched now. The mesh and the log advance, and the cloth and
    /// this state follow them. Other followers can replay the log later.
    ///
    /// Edits that are already in the log are replayed first. The cost is a pass over edges, and a
    /// walk round the ends of each overstretched edge. With
    /// [`Threshold::PrincipalStretch`](super::Threshold) the pass includes the faces beside edges.
    ///
    /// # Panics
    ///
    /// If the cloth or this state is not in step with the mesh, or edits that they have not seen
    /// were cleared from the log.
    pub fn apply(&mut self, mesh: &mut Mesh, cloth: &mut Cloth, edits: &mut Edits) -> TearReport {
        edits.replay(&mut (&mut *cloth, &mut *self));
        let report = self.find(mesh, cloth);
        self.tear(mesh, cloth, edits, report)
    }

    /// The other half: tears what was found.
    pub(crate) fn tear(
        &mut self,
        mesh: &mut Mesh,
        cloth: &mut Cloth,
        edits: &mut Edits,
        mut report: TearReport,
    ) -> TearReport {
        self.torn.clear();
        if self.due.is_empty() {
            return report;
        }
        self.is_fresh.clear();
        self.is_fresh.resize(mesh.vertex_count(), false);
        let cap = self.tearing.splits_per_step_max.unwrap_or(usize::MAX);
        let due = std::mem::take(&mut self.due);
        for due in &due {
            let ends = [mesh.origin(due.edge), mesh.target(due.edge)];
            // Among them are the edges that came apart: two lips now, for the next step to judge.
            if ends.iter().any(|v| self.is_fresh[v.index()]) {
                continue;
            }
            let Some(candidate) = self.candidate(mesh, cloth, due) else {
                continue;
            };
            if report.splits >= cap {
                report.cap_hit = true;
                break;
            }
            report.edge_energy_j += energy_j(cloth, due.edge);
            let has_force = cloth.fabric.stretch != Stretch::Slack;
            let tension_n = || force::force_n(cloth.system(), cloth.stretch(due.edge));
            self.torn.push(Torn {
                edge: due.edge,
                vertex: candidate.0,
                force_n: has_force.then(tension_n),
            });
            report.tear_length_m += self.split(mesh, cloth, edits, due.edge, candidate);
            report.splits += 1;
        }
        self.due = due;
        report
    }

    /// Finds the edges that tear, the worst first: the first half of [`apply`](Tear::apply).
    pub(crate) fn find(&mut self, mesh: &Mesh, cloth: &mut Cloth) -> TearReport {
        let least = self.least * self.tearing.weakening.unwrap_or(1.0);
        let bound = self.tearing.threshold.ratio_from(cloth, least);
        cloth.system_mut().counters.visits.detect += cloth.system().stretches().len() as u64;
        // The forces of a step that ended here may have shown that no edge is so long.
        let is_short = bound.is_some_and(|ratio| cloth.system_mut().watch(ratio));
        let mut due = std::mem::take(&mut self.due);
        due.clear();
        let judge = |edge: HalfEdgeId| {
            let load = self.tearing.threshold.edge_load(mesh, cloth, edge)?;
            let along = cloth.rest_along(edge);
            let ends = [mesh.origin(edge), mesh.target(edge)];
            let [a, b] = ends.map(|v| self.strength_along(v, along));
            let severity = load / a.min(b);
            (severity >= 1.0).then_some(Due {
                edge,
                load,
                severity,
            })
        };
        match bound {
            None => due.extend(mesh.edges().filter_map(judge)),
            Some(_) if is_short => {}
            Some(ratio) => find_stretched(cloth.system(), ratio, |id| {
                due.extend(judge(cloth.edge(id)));
            }),
        }
        let worse = |one: &Due, other: &Due| other.severity.total_cmp(&one.severity);
        due.sort_unstable_by(|one, other| worse(one, other).then(one.edge.cmp(&other.edge)));
        self.due = due;
        TearReport {
            overstretched: self.due.len(),
            worst: self.due.first().map(|due| (due.edge, due.severity)),
            ..TearReport::default()
        }
    }

    /// The vertex that the rule splits, of those that do not bear the load.
    fn candidate(&self, mesh: &Mesh, cloth: &Cloth, due: &Due) -> Option<(VertexId, Plane)> {
        let along = cloth.rest_along(due.edge);
        let mass = |v: VertexId| {
            let bears = due.load < self.strength_along(v, along);
            let is_held = cloth.system.is_held(v.index());
            (!is_held && !bears).then(|| cloth.masses.at(v))
        };
        tear::candidate(mesh, due.edge, cloth.positions(), mass)
    }

    /// Splits a vertex because of an edge; the length that came apart.
    fn split(
        &mut self,
        mesh: &mut Mesh,
        cloth: &mut Cloth,
        edits: &mut Edits,
        edge: HalfEdgeId,
        (vertex, plane): (VertexId, Plane),
    ) -> f64 {
        let across = cloth.rest_along(edge);
        let is_whole = mesh
            .corners_of(vertex)
            .flat_map(|h| [h, h.prev()])
            .all(|h| mesh.pair(h).is_some());
        let Some(split) = split::by_plane(mesh, vertex, &plane, cloth.positions(), edits) else {
            return 0.0;
        };
        let mut length_m = 0.0;
        self.ahead.clear();
        for link in split.torn {
            let ends = [mesh.origin(link.stayed), mesh.target(link.stayed)];
            let stretch = cloth.stretch(link.stayed);
            length_m += cloth.system().stretches().get(stretch).rest_length_m;
            self.ahead.push(ends[usize::from(ends[0] == vertex)]);
        }
        edits.replay(&mut (&mut *cloth, &mut *self));
        self.is_fresh[vertex.index()] = true;
        self.is_fresh.resize(mesh.vertex_count(), true);
        let tips = along_plane(cloth, vertex, &plane, &self.ahead);
        for tip in tips.take(if is_whole { 2 } else { 1 }) {
            *self.tips.at_mut(tip) = across;
        }
        length_m
    }
}

impl Follower for Tear {
    fn cursor(&mut self) -> &mut Cursor {
        &mut self.seen
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        edit.pass_on(&mut self.strengths);
        edit.pass_on(&mut self.tips);
        // The tear has gone through the vertex, which is a tip no more.
        if let Edit::Split(split) = edit {
            *self.tips.at_mut(split.old) = Vector::zeros();
            *self.tips.at_mut(split.new) = Vector::zeros();
        }
    }
}

/// The elastic energy of an edge, in joules, by the strain that it is held against its threshold
/// with.
fn energy_j(cloth: &Cloth, edge: HalfEdgeId) -> f64 {
    let (system, id) = (cloth.system(), cloth.stretch(edge));
    let spring = system.stretches().get(id);
    let extension = strain(system, id) * spring.rest_length_m;
    0.5 * spring.stiffness_n_per_m * extension * extension
}

/// The neighbours of a vertex that lie best along a plane through it: one, and another one on the
/// other side of the vertex. Lower ids break ties.
fn along_plane(
    cloth: &Cloth,
    v: VertexId,
    plane: &Plane,
    neighbours: &[VertexId],
) -> impl Iterator<Item = VertexId> + use<> {
    let x = cloth.positions();
    let to = |other: VertexId| x[other.index()] - x[v.index()];
    let slope = |neighbour: VertexId| {
        let d = to(neighbour);
        (dot(plane.normal(), d) / length(d)).abs()
    };
    let best = |opposite: Option<VertexId>| {
        let is_beside = |v: VertexId| opposite.is_some_and(|first| dot(to(v), to(first)) >= 0.0);
        let others = neighbours.iter().copied().filter(|&v| !is_beside(v));
        let others = others.filter(|&v| slope(v).is_finite());
        others.min_by(|&a, &b| slope(a).total_cmp(&slope(b)).then(a.cmp(&b)))
    };
    let first = best(None);
    let second = first.and_then(|first| best(Some(first)));
    first.into_iter().chain(second)
}
