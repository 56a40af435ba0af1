//! The scissor: two rays or a plane, and a cut along it.
//!
//! A user picks two points on the screen; each gives a ray. The rays span a plane and a strip of it
//! (Souza et al. 2014 §V, with two errata of the paper mended: see `scissor/strip.rs`). A plane alone
//! cuts wherever it goes.
//!
//! Methods differ in which vertices they split: see [`CutMethod`]. Each returns a [`Cut`], which
//! has the sides, the seam, its tips, and the ends from which another cut can continue.
//! [`Scissor::cut_measured`] also measures the cut, and returns a [`CutReport`].

mod aim;
mod cut;
mod cut_context;
mod cut_result;
mod encode;
mod error;
mod exact;
mod hub;
mod measure;
mod neck;
mod offsets;
mod paper;
mod partition;
mod pieces;
mod seam;
mod strip;
mod survey;

pub use aim::CutAim;
pub use cut::{Cut, CutEnd, CutPieces};
pub use error::{CutError, ScissorError};
pub use exact::layers::{CutLayers, LayerHit};
pub use measure::CutReport;
pub use neck::CutNeck;
pub use partition::CutTips;
pub use seam::SeamLine;

use crate::edit::Edits;
use crate::engine::pick;
use crate::geometry::{Plane, Point, Ray, between, dot, length, max_abs};
use crate::id::VertexId;
use crate::mesh::Mesh;
use crate::place::{Place, Positions};
use aim::{ALONG_EDGES, Aim, Aims};
use cut_context::CutContext;
use cut_result::CutResult;
use exact::layers;
use measure::CutMeasurer;
use offsets::Offsets;
use strip::Strip;

/// The description of a cut: a plane and, for a cut between two rays, the two side planes that
/// bound it.
///
/// ```
/// use tearmesh::{shapes, CutMethod, Edits, Point, Positions, Ray, Scissor, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let down = Vector::new(0.0, 0.0, -1.0);
/// let a = Ray::new(Point::new(0.4, -1.0, 5.0), down)?;
/// let b = Ray::new(Point::new(0.4, 2.0, 5.0), down)?;
/// let mut edits = Edits::new();
/// let scissor = Scissor::new(a, b)?;
/// let (cut, report) =
///     scissor.cut_measured(CutMethod::Partition, &mut mesh, &mut positions, &mut edits)?;
/// assert_eq!((report.splits, report.pieces, report.separated), (9, 2, true));
/// assert_eq!(cut.seam().map(|line| line.lips.len()).sum::<usize>(), 8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// In this example a slit follows a mouse. Each cut continues from the vertex at which the previous
/// one ended.
///
/// ```
/// use tearmesh::{shapes, CutMethod, Edits, Point, Ray, Scissor, Vector};
///
/// let (mut mesh, mut positions) = shapes::grid(8, 8);
/// let mouse = |x: f64, y: f64| Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0));
/// let mut edits = Edits::new();
/// let mut scissor = Scissor::new(mouse(0.2, 0.3)?, mouse(0.4, 0.35)?)?;
/// for to in [mouse(0.6, 0.5)?, mouse(0.7, 0.7)?] {
///     let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
///     let [_, end] = cut.ends().expect("there are rays");
///     scissor = Scissor::continued(end, to, &positions)?;
///     edits.clear(); // whatever follows has followed
/// }
/// scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
/// assert_eq!(mesh.boundary_loops().len(), 2); // the sheet's, and that of one slit
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scissor {
    strip: Strip,
    /// None where a plane was given.
    rays: Option<[Ray; 2]>,
    tips: CutTips,
    layers: CutLayers,
    /// How near an end of its edge a crossing is taken for that end: 0 … 0.49 of the edge.
    snap: f64,
    /// Whether what was taken for a crossing slides onto the plane.
    snap_move: bool,
    /// Where the cut goes on from another, and where it comes back to one.
    joints: [Option<CutEnd>; 2],
}

/// The method of a cut. All methods accept the same rays and return the same report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum CutMethod {
    /// Inserts vertices where the plane crosses edges, so that the seam is straight. It adds faces,
    /// and always divides a mesh that the slit crosses completely. A snap ([`Scissor::with_snap`])
    /// avoids thin faces; the seam may then deviate from the plane by as much as the snap allows.
    #[default]
    Exact,
    /// Labels every face by its side of the plane, smooths the labels, and gives each side its own
    /// vertices along the seam. It adds no face, and always divides a mesh that the slit crosses
    /// completely. The seam runs along edges: on irregular meshes it is 1.04 to 1.15 times as long
    /// as the straight line, and up to 0.9 edge lengths away from it.
    Partition,
    /// The first method of the paper (Souza et al. 2014 §V): splits the vertices on the positive
    /// side of the plane by the normal of the plane. Irregular meshes stay in one piece.
    Uniform,
    /// The second, better method of the paper: where two vertices of a face are on the positive
    /// side, splits along the edge between them. It usually divides the mesh, but leaves crumbs and
    /// a seam up to twice as long as necessary.
    Alternating,
}

impl Scissor {
    /// Creates the scissor that cuts between two rays.
    ///
    /// The plane passes through both origins and contains the direction of `a`. If the rays are
    /// skew, the direction of `b` is not in the plane; [`Scissor::skew`] returns the deviation, and a cut
    /// turns the plane: see [`Scissor::aimed_at`].
    ///
    /// # Errors
    ///
    /// [`ScissorError::OneLine`] if both rays lie on one line, up to rounding.
    pub fn new(a: Ray, b: Ray) -> Result<Scissor, ScissorError> {
        let strip = Strip::between(&a, &b).ok_or(ScissorError::OneLine)?;
        Ok(Scissor::along(strip, Some([a, b])))
    }

    /// Creates the scissor that cuts along a whole plane, without bounds at the sides.
    ///
    /// ```
    /// use tearmesh::{shapes, CutMethod, Edits, Plane, Point, Scissor, Vector};
    ///
    /// let (mut mesh, mut positions) = shapes::grid(8, 8);
    /// let plane = Plane::new(Point::new(0.3, 0.0, 0.0), Vector::new(1.0, 0.2, 0.0))?;
    /// let mut edits = Edits::new();
    /// Scissor::by_plane(plane).cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
    /// assert_eq!(mesh.components().count(), 2);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn by_plane(plane: Plane) -> Scissor {
        Scissor::along(Strip::whole(plane), None)
    }

    fn along(strip: Strip, rays: Option<[Ray; 2]>) -> Scissor {
        Scissor {
            strip,
            rays,
            tips: CutTips::default(),
            layers: CutLayers::default(),
            snap: Scissor::SNAP,
            snap_move: false,
            joints: [None, None],
        }
    }

    /// The default value of [`Scissor::with_snap`], as a fraction of an edge.
    pub const SNAP: f64 = 0.05;

    /// Sets how close to an end of its edge a crossing may be, as a fraction of the edge, before the
    /// method `exact` uses that end instead of a new vertex. Clamped to 0 … 0.49; NaN counts as 0.
    ///
    /// With a snap of 0 the seam is straight up to rounding, and thin faces may result. With a snap
    /// of r, no new face has an altitude below r (1 − r) times that of the face it was cut from. An
    /// end of the slit that would leave a thinner face is moved as little as possible, by less than
    /// the width of one face: along the slit, or away from an edge that it is too close to. It is
    /// never moved onto a boundary. With the default snap on sheets of a few hundred triangles, an end
    /// is on average 0.004 of an edge beyond or before its ray, and 99 of 100 are within 0.05. The worst
    /// are off by a whole edge. [`CutReport::tip_overshoots`] reports the difference for each cut, and
    /// [`CutReport::aims`] the ends that are farther off than the snap accounts for.
    #[must_use]
    pub fn with_snap(mut self, snap: f64) -> Scissor {
        self.snap = if snap.is_nan() {
            0.0
        } else {
            snap.clamp(0.0, 0.49)
        };
        self
    }

    /// Sets whether the method `exact` moves a vertex that replaces a crossing onto the plane,
    /// along the edge of the crossing. The seam is then straight without thin faces, but a curved
    /// surface changes slightly. A flat sheet keeps its area and its outline. The default is false.
    ///
    /// A vertex stays where it is, and the seam deviates there, if a face would turn over or lose 70 %
    /// of its altitude, or would be cut into a face below the bound of [`Scissor::with_snap`]. So does a
    /// vertex that is already torn. A vertex on the boundary moves only along a boundary that is
    /// straight there: both its boundary edges lie on one line, of which the edge of the crossing is a
    /// part. That is judged by coordinates, and exact but for their rounding: the vertex may be off the
    /// line between its neighbours by 32 · 2⁻⁵³ of the largest of their coordinates. So corners and
    /// curved boundaries never move.
    #[must_use]
    pub fn with_snap_move(mut self, snap_move: bool) -> Scissor {
        self.snap_move = snap_move;
        self
    }

    /// Creates the scissor that continues from an end of a previous cut to another ray.
    ///
    /// After a cut by the method `exact`, the two cuts share one vertex on each sheet of the mesh
    /// that both rays meet. The new plane passes through the current position of that vertex, and
    /// contains the ray `to`. (Where tips on several sheets were moved to avoid thin faces, the plane
    /// may miss some of them.) After a cut by another method, or if the cut had no end at the ray,
    /// the result is the scissor of the two rays.
    ///
    /// # Errors
    ///
    /// [`ScissorError::NoLength`] if that vertex lies on the ray `to`, up to rounding, and
    /// [`ScissorError::OneLine`] if there is no such vertex and both rays lie on one line.
    ///
    /// # Panics
    ///
    /// If the end and the positions belong to different meshes.
    pub fn continued(
        from: &CutEnd,
        to: Ray,
        positions: &Positions,
    ) -> Result<Scissor, ScissorError> {
        Scissor::joined([from.ray, to], [Some(from), None], positions)
    }

    /// Creates the scissor that continues from an end of one cut to an end of another. Use it for
    /// the last cut of a closed polyline.
    ///
    /// The cut starts at the vertex where one cut ended, as with [`Scissor::continued`], and ends
    /// at the vertex where the other began. A cut aimed merely at the *position* of the first tip
    /// would leave the slit open if that tip is not exactly on its ray.
    ///
    /// # Errors
    ///
    /// [`ScissorError::NoLength`] if both cuts ended at one point, or the vertex of one lies on the ray
    /// of the other, up to rounding. [`ScissorError::OneLine`] if neither cut has such a vertex and both
    /// rays lie on one line.
    ///
    /// # Panics
    ///
    /// If an end and the positions belong to different meshes.
    pub fn closed(
        from: &CutEnd,
        to: &CutEnd,
        positions: &Positions,
    ) -> Result<Scissor, ScissorError> {
        Scissor::joined([from.ray, to.ray], [Some(from), Some(to)], positions)
    }

    /// The scissor from one ray to another, through the nearest of the joints at each.
    fn joined(
        rays: [Ray; 2],
        joints: [Option<&CutEnd>; 2],
        positions: &Positions,
    ) -> Result<Scissor, ScissorError> {
        let nearest = |side: usize| {
            let vertices = joints[side]?.vertices.iter().map(|&v| positions.at(v));
            let distance = |p: &Point| max_abs(p - rays[side].origin());
            vertices.min_by(|p, q| distance(p).total_cmp(&distance(q)))
        };
        let points = [nearest(0), nearest(1)];
        let strip = match points {
            [None, None] => return Scissor::new(rays[0], rays[1]),
            _ => Strip::joined(rays, points).ok_or(ScissorError::NoLength)?,
        };
        let mut scissor = Scissor::along(strip, Some(rays));
        scissor.joints = joints.map(|end| end.filter(|end| !end.vertices.is_empty()).cloned());
        Ok(scissor)
    }

    /// Sets whether to ignore the side planes and cut along the whole plane. The default is false.
    /// A scissor made by [`Scissor::by_plane`] always cuts along the whole plane.
    #[must_use]
    pub fn with_through(mut self, through: bool) -> Scissor {
        self.strip.through = through || self.rays.is_none();
        self
    }

    /// Sets the rule for where a finite cut of the method `partition` ends. Other methods ignore it.
    #[must_use]
    pub fn with_tips(self, tips: CutTips) -> Scissor {
        Scissor { tips, ..self }
    }

    /// Sets which layers of the mesh are cut if the plane meets several layers between the rays.
    ///
    /// ```
    /// use tearmesh::{CutLayers, CutMethod, Edits, Mesh, Point, Positions, Ray, Scissor, Vector};
    ///
    /// // A square, and another behind it.
    /// let sheet = |z: f64| [[0., 0., z], [1., 0., z], [1., 1., z], [0., 1., z]];
    /// let mut positions = Positions::new([sheet(1.0), sheet(0.0)].concat())?;
    /// let mut mesh = Mesh::build(8, &[[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])?;
    /// let down = |x, y| Ray::new(Point::new(x, y, 5.0), Vector::new(0.0, 0.0, -1.0));
    /// let scissor = Scissor::new(down(0.4, -1.0)?, down(0.7, 2.0)?)?.with_layers(CutLayers::First);
    /// let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut Edits::new())?;
    /// assert_eq!(mesh.components().count(), 3);
    /// let [a, b] = cut.layers().map(|hit| hit.expect("the rays pass beside the sheet"));
    /// assert_eq!((a.chain, a.at.z), (b.chain, 1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_layers(self, layers: CutLayers) -> Scissor {
        Scissor { layers, ..self }
    }

    /// Returns the plane along which the scissor cuts.
    #[must_use]
    pub fn plane(&self) -> Plane {
        self.strip.plane
    }

    /// Returns the side planes, which pass through the first and the second ray, or through the vertices
    /// at which the cut begins and ends. A point in front of both planes is between the rays. If the rays
    /// cross in front of both origins, that is a point beyond the crossing, unless the scissor was
    /// [aimed](Scissor::aimed_at). Returns `None` for a scissor made by [`Scissor::by_plane`].
    #[must_use]
    pub fn sides(&self) -> Option<[Plane; 2]> {
        self.strip.sides
    }

    /// Returns the sine of the angle between the second ray and the cutting plane. It is 0 unless
    /// the rays are skew.
    #[must_use]
    pub fn skew(&self) -> f64 {
        self.strip.skew
    }

    /// Returns the scissor as it cuts this mesh. A cut does the same, so there is no need to call this
    /// before one. The plane and the side planes can depend on the mesh in three cases:
    ///
    /// * Two rays that are skew span no plane. The plane contains the first ray and the point where the
    ///   second meets the mesh first or, if it misses the mesh, its point nearest to the middle of the
    ///   mesh. So rays from *nearly* one eye cut like rays from one eye.
    /// * Rays that cross in front of both origins have two wedges between them, one before and one beyond
    ///   the crossing. The cut is made in the one in which the plane meets the mesh.
    /// * A cut that [continues](Scissor::continued) another runs to the point where its ray meets the mesh
    ///   nearest to where it begins, on whichever side of the previous ray that is.
    ///
    /// Linear in these cases, otherwise constant.
    ///
    /// ```
    /// use tearmesh::{shapes, Point, Ray, Scissor};
    ///
    /// // Two rays that cross two units above a sheet in the plane z = 0.
    /// let (mesh, positions) = shapes::grid(8, 8);
    /// let ray = |from: Point, to: Point| Ray::new(from, to - from);
    /// let a = ray(Point::new(0.2, 0.5, 4.0), Point::new(0.8, 0.5, 0.0))?;
    /// let b = ray(Point::new(0.8, 0.5, 4.0), Point::new(0.2, 0.5, 0.0))?;
    /// let [side, _] = Scissor::new(a, b)?.aimed_at(&mesh, &positions)?.sides().unwrap();
    /// assert!(side.distance(Point::new(0.5, 0.5, 0.0)) > 0.0); // the wedge below the crossing
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    ///
    /// [`CutError::RaysCross`] if the plane meets the mesh in both wedges.
    pub fn aimed_at(
        &self,
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
    ) -> Result<Scissor, CutError> {
        let mut scissor = self.clone();
        if let Some(strip) = self.turned_to(mesh, place) {
            scissor.strip = strip;
        }
        let strip = scissor.strip.at(mesh, place);
        scissor.strip = strip.map_err(|at| CutError::RaysCross { at })?;
        Ok(scissor)
    }

    /// The strip turned to the points at which its rays meet the mesh: that of two skew rays about the first
    /// of them, and that of a cut from a joint toward the other ray. `None` if there is nothing to turn.
    fn turned_to(&self, mesh: &Mesh, place: &(impl Place + ?Sized)) -> Option<Strip> {
        let rays = self.rays?;
        let aim = |side: usize| {
            let hit = pick::first_hit(mesh, place, &rays[side]);
            hit.map(|hit| hit.point(mesh, place))
        };
        let mut strip = match &self.joints {
            [None, None] if self.strip.skew > 0.0 => {
                let at = aim(1).or_else(|| nearest_to_middle(&rays[1], mesh, place))?;
                let strip = Strip::joined(rays, [None, Some(at)])?;
                match aim(0) {
                    Some(aim) => strip.toward(1, aim),
                    None => strip,
                }
            }
            [Some(_), None] => self.turned_joint(0, mesh, place)?,
            [None, Some(_)] => self.turned_joint(1, mesh, place)?,
            _ => return None,
        };
        strip.through = self.strip.through;
        Some(strip)
    }

    /// The strip from the joint of a side toward the point nearest to that at which the other ray meets the mesh.
    /// (A joint may be on the back alone, and the rays may cross between it and the front.)
    fn turned_joint(
        &self,
        side: usize,
        mesh: &Mesh,
        place: &(impl Place + ?Sized),
    ) -> Option<Strip> {
        let joint = self.strip.sides?[side].point();
        let hits = pick::hits(mesh, place, &self.rays.as_ref()?[1 - side]);
        let points = hits.map(|hit| hit.point(mesh, place));
        let aim = points.min_by(|p, q| length(p - joint).total_cmp(&length(q - joint)))?;
        Some(self.strip.clone().toward(side, aim))
    }

    /// Cuts a mesh along the plane of this scissor, between the rays if it has any.
    ///
    /// Positions are updated at once, because later cuts read points that earlier cuts created. All
    /// other followers must replay the log. Every vertex and face is visited once to find where the
    /// plane passes. The remaining cost is proportional to the number of faces that the cut affects.
    ///
    /// # Errors
    ///
    /// [`CutError`] gives the reason for a refusal. Nothing has changed then.
    pub fn cut(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
    ) -> Result<Cut, CutError> {
        let (cut, _) = self.make(method, mesh, positions, edits, false)?;
        Ok(cut)
    }

    /// Cuts a mesh like [`Scissor::cut`], and also measures the result. Measuring visits the whole
    /// mesh a few times.
    ///
    /// # Errors
    ///
    /// [`CutError`] gives the reason for a refusal. Nothing has changed then.
    pub fn cut_measured(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
    ) -> Result<(Cut, CutReport), CutError> {
        self.make(method, mesh, positions, edits, true)
    }

    /// Cuts, and fills in the report if it is to be measured.
    fn make(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
        is_measured: bool,
    ) -> Result<(Cut, CutReport), CutError> {
        self.in_step(mesh, positions, edits)?;
        let aimed = self.aimed_at(mesh, positions)?;
        if method == CutMethod::Exact {
            aimed.has_length(mesh, positions)?;
        }
        edits.replay(positions); // They are in step, and from now on not new.
        Ok(aimed.carry_out(method, mesh, positions, edits, is_measured))
    }

    /// Cuts with a scissor that is aimed at the mesh.
    fn carry_out(
        &self,
        method: CutMethod,
        mesh: &mut Mesh,
        positions: &mut Positions,
        edits: &mut Edits,
        is_measured: bool,
    ) -> (Cut, CutReport) {
        let is_exact = method == CutMethod::Exact;
        let (vertices_before, first) = (mesh.vertex_count(), edits.cursor());
        let offsets = &Offsets::new(&self.strip.plane, is_exact, mesh, positions);
        let joints = self.joints.each_ref().map(|end| match end {
            Some(end) if is_exact => end.vertices.clone(),
            _ => Vec::new(),
        });
        let mut context = CutContext {
            strip: &self.strip,
            among: offsets.touched(),
            joints: &joints,
            offsets,
        };
        let mut choice;
        let mut hits = [None; 2];
        if let (CutLayers::First, Some(rays)) = (self.layers, &self.rays) {
            choice = layers::first(&context, rays, mesh, positions);
            hits = choice.hits;
            choice.faces = choice.beyond_the_rays(mesh, positions, offsets);
            context = CutContext {
                among: &choice.faces,
                joints: &choice.joints,
                ..context
            };
        }
        let trace = is_exact.then(|| exact::trace(&context, self.snap, mesh, positions));
        let aims = is_measured.then(|| self.aims(method, mesh, positions));
        let measurer =
            aims.map(|aims| CutMeasurer::new(&context, aims, mesh, positions, trace.as_ref()));
        let judged = |mesh: &Mesh, edits: &Edits| {
            let measurer = measurer.as_ref();
            measurer.map_or_else(Vec::new, |measurer| measurer.judged(mesh, edits, first))
        };
        let outcome: CutResult = match (method, trace) {
            (CutMethod::Uniform | CutMethod::Alternating, _) => {
                let is_alternating = method == CutMethod::Alternating;
                paper::cut(&context, is_alternating, mesh, positions, &judged, edits)
            }
            (CutMethod::Exact, Some(trace)) => {
                let snap_move = self.snap_move.then_some(self.snap);
                exact::cut(&context, trace, snap_move, mesh, positions, &judged, edits)
            }
            (CutMethod::Exact | CutMethod::Partition, _) => {
                partition::cut(&context, self.tips, mesh, positions, &judged, edits)
            }
        };
        edits.replay(positions);
        let report =
            measurer.map(|measurer| measurer.report(mesh, positions, &outcome, edits, first));
        let report = report.unwrap_or_default();
        let lines = seam::lines(edits, first, mesh, vertices_before, &outcome.touched);
        let mut ends = outcome.ends.into_iter();
        let ends = self.rays.map(|rays| {
            rays.map(|ray| CutEnd {
                ray,
                vertices: ends.next().unwrap_or_default(),
                seen: edits.cursor(),
            })
        });
        let cut = Cut {
            touched: outcome.touched,
            lines,
            hits,
            ends,
        };
        (cut, report)
    }

    /// Refuses a cut that would end in a face of the joint from which it continues, so near to it that
    /// the end would be snapped to the joint.
    fn has_length(&self, mesh: &Mesh, positions: &Positions) -> Result<(), CutError> {
        let ([Some(from), None], Some([_, to])) = (&self.joints, &self.rays) else {
            return Ok(());
        };
        let Some(hit) = pick::first_hit(mesh, positions, to) else {
            return Ok(());
        };
        let near = exact::nearest_tip(self.snap);
        let corners = mesh.face_vertices(hit.face).into_iter().zip(hit.weights);
        let is_reached =
            |&(v, weight): &(VertexId, f64)| from.vertices.contains(&v) && 1.0 - weight <= near;
        match corners.into_iter().find(is_reached) {
            Some((joint, _)) => Err(CutError::TooShort { joint }),
            None => Ok(()),
        }
    }

    /// Where the rays meet the mesh, and how far from there the seam may end.
    fn aims(&self, method: CutMethod, mesh: &Mesh, positions: &Positions) -> Aims {
        let edges = match method {
            CutMethod::Exact => 2.0 * exact::nearest_tip(self.snap),
            _ => ALONG_EDGES,
        };
        let rays = self.rays.filter(|_| !self.strip.through);
        rays.map(|rays| rays.map(|ray| Aim::of(&ray, edges, mesh, positions)))
    }

    /// Whether positions and ends have seen every edit, and the positions are those of this mesh.
    fn in_step(&self, mesh: &Mesh, positions: &Positions, edits: &Edits) -> Result<(), CutError> {
        let made = edits.cursor();
        if positions.seen() != made {
            let seen = positions.seen();
            return Err(CutError::Unreplayed { seen, made });
        }
        if positions.len() != mesh.vertex_count() {
            let (vertices, positions) = (mesh.vertex_count(), positions.len());
            return Err(CutError::Positions {
                vertices,
                positions,
            });
        }
        for end in self.joints.iter().flatten() {
            if end.seen != made {
                let seen = end.seen;
                return Err(CutError::End { seen, made });
            }
        }
        Ok(())
    }
}

/// The point of a ray that is nearest to the middle of the box round a mesh; `None` for a mesh without
/// vertices.
fn nearest_to_middle(ray: &Ray, mesh: &Mesh, place: &(impl Place + ?Sized)) -> Option<Point> {
    let mut points = mesh.vertices().map(|v| place.at(v));
    let first = points.next()?;
    let (low, high) = points.fold((first, first), |(low, high), p| (low.inf(&p), high.sup(&p)));
    let middle = between(low, high, 0.5);
    let along = ray.direction() / length(ray.direction());
    let far = dot(middle - ray.origin(), along);
    Some(ray.origin() + along * far.max(0.0))
}
