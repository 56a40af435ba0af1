//! The reason why a cut split nothing.

use tearmesh::{
    CutMethod, CutReport, Edits, FaceId, HalfEdgeId, Mesh, Point, Positions, Scissor, Side,
};

/// A reason for which a cut splits nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoOpReason {
    /// It follows the seam of an earlier cut.
    Seam,
    /// It meets the mesh in a corner or along the boundary, and goes through no face.
    Touch,
    /// Its crossings are all within the snap of vertices; without a snap it splits some.
    Snap,
    /// Beyond the rays, the plane crosses this many faces and splits this many vertices.
    Elsewhere { faces: usize, splits: usize },
    /// None that is known.
    Unknown,
}

/// Finds the reason for which a cut split nothing; `snap` is that of the scissor. Takes linear
/// time.
///
/// Cuts without the snap, and beyond the rays, are tried on a copy, so that the advice to make one
/// works.
pub(crate) fn reason(
    (scissor, method, snap): (&Scissor, CutMethod, f64),
    through: bool,
    (mesh, positions): (&Mesh, &Positions),
    done: &CutReport,
) -> NoOpReason {
    let is_exact = method == CutMethod::Exact;
    let slit = Slit {
        scissor,
        near: is_exact.then_some(snap.max(ROUNDING)),
        through,
        mesh,
        positions,
    };
    if mesh.half_edges().any(|h| slit.follows(h)) {
        return NoOpReason::Seam;
    }
    let lengths = mesh.half_edges().map(|h| slit.length(h));
    let longest = lengths.fold(0.0, f64::max);
    if done.faces_crossed == 0 && done.nearest_vertex <= ROUNDING * longest {
        return NoOpReason::Touch;
    }
    let tried = |scissor| tried(&scissor, method, mesh, positions);
    // Copies take memory, and most cuts that miss do so by far.
    if done.missed && !through && mesh.faces().any(|f| slit.meets(f)) {
        let elsewhere = tried(scissor.clone().with_through(true));
        let elsewhere = elsewhere.map(|[faces, splits]| NoOpReason::Elsewhere { faces, splits });
        return elsewhere.unwrap_or(NoOpReason::Unknown);
    }
    let can_snap = !done.missed && is_exact && snap > 0.0;
    match can_snap && tried(scissor.clone().with_snap(0.0)).is_some() {
        true => NoOpReason::Snap,
        false => NoOpReason::Unknown,
    }
}

/// How far from the plane, in edges, a vertex may be that was inserted on it. It only chooses
/// words.
const ROUNDING: f64 = 1e-6;

/// The faces crossed and the vertices split by another cut; `None` if it splits nothing either.
fn tried(
    scissor: &Scissor,
    method: CutMethod,
    mesh: &Mesh,
    positions: &Positions,
) -> Option<[usize; 2]> {
    // A scissor that goes on from a cut knows the place in the log.
    let mut edits = Edits::starting_at(positions.seen());
    let (mut mesh, mut positions) = (mesh.clone(), positions.clone());
    let made = scissor.cut_measured(method, &mut mesh, &mut positions, &mut edits);
    let (_, done) = made.ok()?;
    (done.splits > 0).then_some([done.faces_crossed, done.splits])
}

/// Where the cut was to go.
struct Slit<'a> {
    scissor: &'a Scissor,
    /// How far from the plane, in edges, the ends of its seam may be; none for a method whose
    /// seam follows the edges that there are.
    near: Option<f64>,
    through: bool,
    mesh: &'a Mesh,
    positions: &'a Positions,
}

impl Slit<'_> {
    /// Whether a half-edge is torn, and its faces lie as those on a seam of this cut do: on two
    /// sides of the plane, and between the rays.
    fn follows(&self, h: HalfEdgeId) -> bool {
        let Some(ghost) = self.mesh.ghost_pair(h) else {
            return false;
        };
        let plane = self.scissor.plane();
        let ends = [self.mesh.origin(h), self.mesh.target(h)].map(|v| self.positions.at(v));
        let middle = ends[0] + (ends[1] - ends[0]) * 0.5;
        let sides = self.scissor.sides();
        let mut sides = sides.iter().flatten();
        let is_between = self.through || sides.all(|side| side.offset(middle) >= 0.0);
        let is_near = self.near.is_none_or(|near| {
            let far = near * self.longest(h).max(self.longest(ghost));
            ends.iter().all(|&end| plane.distance(end).abs() <= far)
        });
        let [one, other] = [h, ghost].map(|h| Side::of(plane.offset(self.centre(h))));
        is_between && is_near && one != other
    }

    /// Whether a face has vertices on both sides of the plane.
    fn meets(&self, f: FaceId) -> bool {
        let plane = self.scissor.plane();
        let corners = self.mesh.face_vertices(f);
        let [a, b, c] = corners.map(|v| Side::of(plane.offset(self.positions.at(v))));
        a != b || b != c
    }

    /// The centre of the face of a half-edge.
    fn centre(&self, h: HalfEdgeId) -> Point {
        let corners = self.mesh.face_vertices(h.face());
        let [a, b, c] = corners.map(|v| self.positions.at(v));
        Point::from((a.coords + b.coords + c.coords) / 3.0)
    }

    /// The longest edge of the face of a half-edge.
    fn longest(&self, h: HalfEdgeId) -> f64 {
        let lengths = h.face().half_edges().map(|h| self.length(h));
        lengths.into_iter().fold(0.0, f64::max)
    }

    fn length(&self, h: HalfEdgeId) -> f64 {
        (self.positions.at(self.mesh.target(h)) - self.positions.at(self.mesh.origin(h))).norm()
    }
}
