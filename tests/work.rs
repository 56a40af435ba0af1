//! A mesh and all that follows it, cut and mended; what holds of every cut is checked after each.
//!
//! The fuzz target `cut_mend` uses this too.

use std::collections::BTreeMap;

use tearmesh::{
    Cut, CutError, CutMethod, CutReport, Edit, Edits, Masses, Mesh, PerCorner, Point, Positions,
    Ray, Scissor, Vector, VertexId, mend,
};

/// Two rays: an origin and a direction each.
pub(crate) type Rays = [([f64; 3], [f64; 3]); 2];

/// All ways to cut, first the one that adds faces.
pub(crate) const METHODS: [CutMethod; 4] = [
    CutMethod::Exact,
    CutMethod::Partition,
    CutMethod::Uniform,
    CutMethod::Alternating,
];

/// The ways to cut along edges, that add no face.
pub(crate) const ALONG_EDGES: [CutMethod; 3] = [METHODS[1], METHODS[2], METHODS[3]];

pub(crate) fn ray((origin, along): ([f64; 3], [f64; 3])) -> Ray {
    Ray::new(Point::from(origin), Vector::from(along)).expect("a ray")
}

pub(crate) fn scissor([a, b]: Rays) -> Scissor {
    Scissor::new(ray(a), ray(b)).expect("a plane")
}

/// A ray down on a point of the plane z = 0.
pub(crate) fn down([x, y]: [f64; 2]) -> ([f64; 3], [f64; 3]) {
    ([x, y, 5.0], [0.0, 0.0, -1.0])
}

/// The cut from above between two points of the plane z = 0.
pub(crate) fn between(a: [f64; 2], b: [f64; 2]) -> Scissor {
    scissor([down(a), down(b)])
}

/// The triangles of a mesh.
pub(crate) fn triangles(mesh: &Mesh) -> &[[u32; 3]] {
    mesh.indices().as_chunks().0
}

/// The sum of the areas of all faces.
pub(crate) fn area(mesh: &Mesh, positions: &Positions) -> f64 {
    let of = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    mesh.faces().map(of).sum()
}

/// A mesh and its followers.
#[derive(Clone, Debug)]
pub(crate) struct Work {
    pub(crate) mesh: Mesh,
    pub(crate) positions: Positions,
    pub(crate) masses: Masses,
    /// For each corner where it is: linear data, which has to stay so.
    pub(crate) corners: PerCorner<[f64; 3]>,
    pub(crate) edits: Edits,
}

impl Work {
    pub(crate) fn new((mesh, positions): (Mesh, Positions)) -> Work {
        let place = |h| positions.at(mesh.origin(h)).into();
        let mut work = Work {
            masses: Masses::area(&mesh, &positions, 1.0).expect("it has an area"),
            corners: PerCorner::new(mesh.half_edges().map(place).collect()),
            edits: Edits::new(),
            mesh,
            positions,
        };
        work.follow();
        work
    }

    /// Cuts, and checks what holds of every cut.
    pub(crate) fn cut(&mut self, method: CutMethod, scissor: &Scissor) -> (Cut, CutReport) {
        let made = self.try_cut(method, scissor);
        made.expect("positions are in step, and it is clear what to cut")
    }

    /// Cuts, or changes nothing if that is refused; and checks what holds of every cut.
    pub(crate) fn try_cut(
        &mut self,
        method: CutMethod,
        scissor: &Scissor,
    ) -> Result<(Cut, CutReport), CutError> {
        let (first, mesh_before) = (self.edits.cursor(), self.mesh.clone());
        let before = Whole::of(&self.mesh, &self.positions);
        let (mesh, positions) = (&mut self.mesh, &mut self.positions);
        let made = scissor.cut_measured(method, mesh, positions, &mut self.edits);
        let (cut, report) = made.inspect_err(|_| {
            assert!(self.edits.cursor() == first && self.mesh == mesh_before);
        })?;
        self.follow();
        self.is_sound();
        Whole::of(&self.mesh, &self.positions).is_reported(&before, &report);
        assert_eq!(report.pieces, self.mesh.components().count());
        let seam: usize = cut.seam().map(|line| 2 * line.lips.len()).sum();
        assert_eq!(report.ghost_pairs, seam);
        Ok((cut, report))
    }

    /// Has all that follows the mesh replay the log.
    pub(crate) fn follow(&mut self) {
        let beside = (&mut self.masses, &mut self.corners);
        self.edits.replay(&mut (&mut self.positions, beside));
    }

    /// Sews all copies of the chosen vertices; the number of merges.
    pub(crate) fn sew(&mut self, chosen: impl Fn(VertexId) -> bool) -> usize {
        let stitches = mend::stitches(&self.mesh, chosen);
        let (weight, far) = (|v| self.masses.at(v), f64::INFINITY);
        let (mesh, edits) = (&mut self.mesh, &mut self.edits);
        let merges = mend::sew(mesh, &self.positions, &stitches, weight, far, edits);
        self.follow();
        self.is_sound();
        merges.expect("copies have one root")
    }

    /// Sews everything, and checks that nothing is torn any more.
    pub(crate) fn sew_all(&mut self) {
        self.sew(|_| true);
        assert_eq!(self.torn(), 0, "all is sewn");
    }

    /// The number of half-edges that are torn.
    pub(crate) fn torn(&self) -> usize {
        let is_torn = |&h: &_| self.mesh.ghost_pair(h).is_some();
        self.mesh.half_edges().filter(is_torn).count()
    }

    /// What holds whatever was done, as long as copies stay together.
    pub(crate) fn is_sound(&self) {
        let Work {
            mesh, positions, ..
        } = self;
        assert_eq!(mesh.check(), []);
        assert!(self.masses.ledger().is_balanced(), "mass stays");
        for (h, &corner) in mesh.half_edges().zip(self.corners.as_slice()) {
            let at = positions.at(mesh.origin(h));
            let apart = (at - Point::from(corner)).norm();
            let large = at.coords.amax().max(1.0);
            assert!(apart < 1e-12 * large, "the data of {h} is {apart} off");
        }
        let again = Mesh::build_torn(triangles(mesh), &mesh.roots());
        assert_eq!(again.as_ref(), Ok(mesh), "triangles and roots are all");
    }

    /// The smallest altitude of each face.
    pub(crate) fn altitudes(&self) -> Vec<f64> {
        let of = |f| {
            let [a, b, c] = self.mesh.face_vertices(f).map(|v| self.positions.at(v));
            let sides = [b - a, c - b, a - c].map(|side| side.norm());
            sides[0].max(sides[1]).max(sides[2]).recip() * (b - a).cross(&(c - a)).norm()
        };
        self.mesh.faces().map(of).collect()
    }

    /// For each face the part of an altitude that it keeps of the face from which the edits cut it.
    pub(crate) fn kept(&self, before: &[f64]) -> Vec<f64> {
        self.kept_by(self.edits.iter(), before)
    }

    /// The same of some of the edits, before which the altitudes were these.
    pub(crate) fn kept_by<'e>(
        &self,
        edits: impl Iterator<Item = Edit<'e>>,
        before: &[f64],
    ) -> Vec<f64> {
        let mut parents: Vec<usize> = (0..before.len()).collect();
        for edit in edits {
            if let Edit::Insert(insert) = edit {
                let new = insert.children.iter().filter(|c| c.face != c.parent);
                for child in new {
                    parents.push(parents[child.parent.index()]);
                }
            }
        }
        let after = self.altitudes().into_iter().zip(parents);
        after
            .map(|(after, parent)| after / before[parent])
            .collect()
    }
}

/// Measures of a whole mesh, by loops over all of it. They have the bits of those of a report.
#[derive(Debug)]
struct Whole {
    pieces: usize,
    altitude_min: f64,
    mean_edge: f64,
}

impl Whole {
    fn of(mesh: &Mesh, positions: &Positions) -> Whole {
        let triangles = triangles(mesh);
        let length = |v: [f64; 3]| (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        let (mut altitudes, mut edges): (Vec<f64>, Vec<f64>) = Default::default();
        // The face of each directed edge. One that is not torn has its two faces in opposite directions.
        let mut faces: BTreeMap<[u32; 2], usize> = BTreeMap::new();
        for (&triangle, f) in triangles.iter().zip(0..) {
            let at = triangle.map(|v| positions.as_slice()[v as usize]);
            let side = |i: usize, k: usize| {
                let (from, to) = (at[i % 3], at[k % 3]);
                [to.x - from.x, to.y - from.y, to.z - from.z]
            };
            let (u, v) = (side(0, 1), side(0, 2));
            let [i, j, k] = [0, 1, 2];
            let normal = [(j, k), (k, i), (i, j)].map(|(a, b)| u[a] * v[b] - u[b] * v[a]);
            let lengths = [0, 1, 2].map(|i| length(side(i, i + 1)));
            let longest = lengths.into_iter().fold(0.0, f64::max);
            altitudes.push(if longest > 0.0 {
                length(normal) / longest
            } else {
                0.0
            });
            for i in 0..3 {
                faces.insert([triangle[i], triangle[(i + 1) % 3]], f);
            }
        }
        let mut pieces = 0;
        let mut seen = vec![false; triangles.len()];
        for f in 0..triangles.len() {
            pieces += usize::from(!seen[f]);
            let mut stack = vec![f];
            while let Some(f) = stack.pop() {
                if !std::mem::replace(&mut seen[f], true) {
                    let across = (0..3).map(|i| [triangles[f][(i + 1) % 3], triangles[f][i]]);
                    stack.extend(across.filter_map(|edge| faces.get(&edge)));
                }
            }
        }
        for (&triangle, f) in triangles.iter().zip(0..) {
            for i in 0..3 {
                let [from, to] = [triangle[i], triangle[(i + 1) % 3]];
                if faces.get(&[to, from]).is_none_or(|&other| f < other) {
                    let [p, q] = [from, to].map(|v| positions.as_slice()[v as usize]);
                    edges.push(length([q.x - p.x, q.y - p.y, q.z - p.z]));
                }
            }
        }
        Whole {
            pieces,
            altitude_min: altitudes.into_iter().reduce(f64::min).unwrap_or(0.0),
            mean_edge: edges.iter().fold(0.0, |sum, edge| sum + edge) / edges.len().max(1) as f64,
        }
    }

    /// Asserts that a report of a cut has the measures after it, and those `before`.
    fn is_reported(&self, before: &Whole, report: &CutReport) {
        let Whole {
            pieces,
            altitude_min,
            ..
        } = *self;
        assert_eq!(
            (report.pieces_before, report.pieces),
            (before.pieces, pieces)
        );
        assert_eq!(report.altitude_min.to_bits(), altitude_min.to_bits());
        let in_edges = match report.seam_deviation_max / before.mean_edge {
            ratio if ratio.is_finite() => ratio,
            _ => 0.0,
        };
        assert_eq!(
            report.seam_deviation_max_edges.to_bits(),
            in_edges.to_bits()
        );
    }
}

/// Asserts that the report has the smallest altitude and the mean edge of plain
/// loops; the last is that before the cut.
pub(crate) fn is_measured(report: &CutReport, work: &Work, mean_edge: f64, name: &str) {
    let mut altitude = f64::INFINITY;
    for f in work.mesh.faces() {
        let corners = work.mesh.face_vertices(f).map(|v| work.positions.at(v));
        for i in 0..3 {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
            let (along, across) = ((b - a).normalize(), c - a);
            altitude = altitude.min((across - along * across.dot(&along)).norm());
        }
    }
    let off = report.altitude_min - altitude;
    assert!(off.abs() < 1e-9, "{name}: {altitude}, {report:?}");
    let edges = report.seam_deviation_max_edges * mean_edge;
    let off = report.seam_deviation_max - edges;
    assert!(off.abs() < 1e-12, "{name}: {mean_edge}, {report:?}");
}
