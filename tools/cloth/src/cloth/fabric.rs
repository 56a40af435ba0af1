//! The material of a cloth: springs along edges, triangles, springs or arcs across edges, damping, and
//! what happens to them where it tears.

use tearmesh::geometry::Vector;
use tearmesh::{HalfEdgeId, Mesh};

use crate::system::bend::Buckling;
use crate::system::error::SettingError;

/// The material of a cloth, and the rules for its constraints when it tears.
#[must_use]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fabric {
    /// The resistance of edges to stretch.
    pub stretch: Stretch,
    /// The moduli of triangles that resist stretch and shear; `None` for no triangles.
    pub orthotropic: Option<Orthotropic>,
    /// The bending resistance across each interior edge; `None` for no resistance.
    pub bend: Option<Bending>,
    /// The damping as a time τ, in seconds; zero for none. A spring of stiffness k is damped along its edge
    /// by τ k, and triangles are along warp, along weft and in shear, by no more than a damping ratio of a
    /// tenth: a cloth that loses as much at the frequencies that one sees would need far more at the highest
    /// ones of a mesh, and steps many times shorter. Only [`Verlet`](crate::Verlet) damps; the other methods
    /// lose energy of their own.
    pub damping_s: f64,
    /// The bend constraints that a split removes.
    pub bend_removal: BendRemoval,
}

/// The resistance of the edges of a cloth to stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Stretch {
    /// A membrane of this modulus E, in N/m, whatever the mesh. The stiffness of an edge is the sum
    /// of E A / l² over its faces, where A is the area of a face and l the length of the edge, both
    /// at rest. So Σ k l² over the edges of a face is 3 E A. Each side of a tear keeps the shares of
    /// its own faces, and the parts of a divided face are measured anew.
    ///
    /// A net of equilateral triangles then has the modulus E and Poisson's ratio 1/3. In a grid of
    /// right triangles, an edge along a cell has the stiffness E, and a diagonal or an edge of the
    /// boundary half of it.
    Membrane {
        /// The modulus E, in N/m; positive.
        modulus_n_per_m: f64,
    },
    /// Springs of one stiffness, as in the paper. How stiff the cloth is then depends on its mesh: a
    /// net of equilateral triangles has 2/√3 times this stiffness as its modulus.
    Edges {
        /// The stiffness of an edge, in N/m; positive.
        stiffness_n_per_m: f64,
        /// How the stiffness of a torn edge is divided between its two constraints.
        torn: TornStiffness,
    },
    /// Edges that are measured, for thresholds of stretch, but exert no force. The cloth needs a [`Orthotropic`].
    Slack,
}

impl Default for Fabric {
    /// Returns the cloth of the built-in scenes: a membrane of 1000 N/m, soft for cotton, so that a pull
    /// shows; with damping of 1.6 ms, so that a tear runs on where undamped cloth bursts into crumbs.
    fn default() -> Fabric {
        Fabric {
            damping_s: 1.6e-3,
            ..Fabric::new(1000.0)
        }
    }
}

impl Fabric {
    /// Returns a membrane of this modulus in N/m, without bending resistance and damping.
    pub fn new(modulus_n_per_m: f64) -> Fabric {
        Fabric::of(Stretch::Membrane { modulus_n_per_m })
    }

    /// Returns a fabric whose edges all have this stiffness in N/m, without bending resistance and
    /// damping. Tears conserve energy ([`TornStiffness::Halved`]).
    pub fn of_edges(stiffness_n_per_m: f64) -> Fabric {
        Fabric::of(Stretch::Edges {
            stiffness_n_per_m,
            torn: TornStiffness::default(),
        })
    }

    /// Returns a fabric of triangles alone, without springs along edges and without bending
    /// resistance.
    ///
    /// ```
    /// use tearmesh_cloth::{implicit, Cloth, Fabric, Implicit, Orthotropic, Pbd, StepError};
    /// use tearmesh::{shapes, Masses, Vector};
    ///
    /// let moduli = Orthotropic {
    ///     warp_n_per_m: 800.0,
    ///     weft_n_per_m: 500.0,
    ///     shear_n_per_m: 40.0,
    ///     warp: Vector::y(),
    /// };
    /// let (mesh, positions) = shapes::grid(4, 4);
    /// let masses = Masses::area(&mesh, &positions, 0.15)?;
    /// let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::orthotropic(moduli))?;
    /// cloth.step(&mut Implicit::new(implicit::Settings::default()), 1.0 / 60.0)?;
    ///
    /// // What projects springs alone would leave it without force, and is refused.
    /// let error = cloth.step(&mut Pbd::default(), 1.0 / 60.0).unwrap_err();
    /// assert!(matches!(error, StepError::NotSprings { count: 32, .. }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn orthotropic(moduli: Orthotropic) -> Fabric {
        Fabric {
            orthotropic: Some(moduli),
            ..Fabric::of(Stretch::Slack)
        }
    }

    fn of(stretch: Stretch) -> Fabric {
        Fabric {
            stretch,
            orthotropic: None,
            bend: None,
            damping_s: 0.0,
            bend_removal: BendRemoval::default(),
        }
    }

    /// The modulus of a membrane or the stiffness of every edge, in N/m; zero of edges that exert no
    /// force.
    #[must_use]
    pub fn stretch_n_per_m(&self) -> f64 {
        match self.stretch {
            Stretch::Membrane { modulus_n_per_m } => modulus_n_per_m,
            Stretch::Edges {
                stiffness_n_per_m, ..
            } => stiffness_n_per_m,
            Stretch::Slack => 0.0,
        }
    }

    /// The speed at which a pull travels through the fabric with this areal density, c = √(k/ρ), in m/s.
    pub(crate) fn speed_m_per_s(&self, density_kg_per_m2: f64) -> f64 {
        (self.stretch_n_per_m() / density_kg_per_m2).sqrt()
    }

    /// Whether the two constraints of a torn edge have half its stiffness each.
    pub(super) fn halves_copies(&self) -> bool {
        let halved = TornStiffness::Halved;
        matches!(self.stretch, Stretch::Edges { torn, .. } if torn == halved)
    }

    /// The part of a whole edge's strength that this edge has: half where it has half the stiffness.
    pub(super) fn share(&self, mesh: &Mesh, h: HalfEdgeId) -> f64 {
        let is_half = match self.stretch {
            Stretch::Membrane { .. } => mesh.pair(h).is_none(),
            _ => self.halves_copies() && mesh.ghost_pair(h).is_some(),
        };
        if is_half { 0.5 } else { 1.0 }
    }

    pub(crate) fn check(&self) -> Result<(), SettingError> {
        if let Some(moduli) = self.orthotropic {
            SettingError::unless_above_0("orthotropic.warp_n_per_m", moduli.warp_n_per_m)?;
            SettingError::unless_above_0("orthotropic.weft_n_per_m", moduli.weft_n_per_m)?;
            SettingError::unless_at_least_0("orthotropic.shear_n_per_m", moduli.shear_n_per_m)?;
        }
        let field = match self.stretch {
            Stretch::Membrane { .. } => "modulus_n_per_m",
            Stretch::Edges { .. } => "stiffness_n_per_m",
            Stretch::Slack => "stretch",
        };
        if self.stretch != Stretch::Slack || self.orthotropic.is_none() {
            SettingError::unless_above_0(field, self.stretch_n_per_m())?;
        }
        if let Some(bend) = self.bend {
            let (field, given) = bend.number();
            SettingError::unless_above_0(field, given)?;
        }
        SettingError::unless_at_least_0("damping_s", self.damping_s)
    }
}

/// The moduli with which the triangles of a cloth resist stretch and shear. Poisson's ratio is
/// zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthotropic {
    /// The modulus along warp, in N/m; positive.
    pub warp_n_per_m: f64,
    /// The modulus along weft, across warp, in N/m; positive.
    pub weft_n_per_m: f64,
    /// The shear modulus, in N/m; zero or more.
    pub shear_n_per_m: f64,
    /// The direction of warp in space, for the cloth at rest. It is projected onto each face, and
    /// weft is perpendicular to it.
    pub warp: Vector,
}

/// The kind of bending resistance between the two vertices opposite an interior edge.
///
/// ```
/// use tearmesh_cloth::implicit::Settings;
/// use tearmesh_cloth::{Bending, Buckling, Cloth, Fabric, Implicit, StepError, Xpbd};
/// use tearmesh::{shapes, Masses};
///
/// let bend = Bending::Buckling { rigidity_n_m: 1e-5, law: Buckling::new(0.95).unwrap() };
/// let fabric = Fabric { bend: Some(bend), ..Fabric::new(500.0) };
/// let (mesh, positions) = shapes::grid(4, 4);
/// let masses = Masses::area(&mesh, &positions, 0.15)?;
/// let mut cloth = Cloth::new(&mesh, &positions, masses, fabric)?;
/// cloth.step(&mut Implicit::new(Settings::default()), 1.0 / 60.0)?;
///
/// // What projects springs would take arcs for such, and is refused.
/// let error = cloth.step(&mut Xpbd::default(), 1.0 / 60.0).unwrap_err();
/// assert!(matches!(error, StepError::NotSprings { count: 40, .. }));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Bending {
    /// A spring of the same stiffness across every edge (the flexion springs of Provot 1995, §2).
    Spring {
        /// The stiffness, in N/m; positive.
        stiffness_n_per_m: f64,
    },
    /// A strip across every edge, which buckles into an arc under compression (Choi and Ko 2002
    /// §4.2). Its width is 4 A / (3 L), where A is the area of both faces at the edge and L the
    /// length of the strip, all at rest: a net of equilateral triangles then has the rigidity B in
    /// all directions. A grid whose diagonals all go one way has .6 of it along its cells.
    ///
    /// A curve is resisted where the ends of the strip are nearer than the law's fraction of L, and a
    /// gentler one hardly at all: with 0.95, one with a curvature below about 1.1 / L.
    Buckling {
        /// The flexural rigidity B of the cloth, in N m: the bending moment per width is B times the
        /// curvature. Positive.
        rigidity_n_m: f64,
        /// The law by which a bend buckles.
        law: Buckling,
    },
}

impl Bending {
    /// The field that says how stiff it is, and its number.
    pub(super) fn number(&self) -> (&'static str, f64) {
        match *self {
            Bending::Spring { stiffness_n_per_m } => ("bend.stiffness_n_per_m", stiffness_n_per_m),
            Bending::Buckling { rigidity_n_m, .. } => ("bend.rigidity_n_m", rigidity_n_m),
        }
    }

    /// The stiffness of a bend constraint of this length, across an edge whose faces have this area:
    /// zero where they have none. `None` where it is beyond all numbers.
    pub(super) fn stiffness_n_per_m(&self, rest_length_m: f64, area_m2: f64) -> Option<f64> {
        let stiffness = match *self {
            Bending::Spring { stiffness_n_per_m } => stiffness_n_per_m,
            Bending::Buckling { rigidity_n_m, law } => {
                // Where a cylinder of curvature κ runs across an edge of an equilateral net, the strip
                // across it is bent by κ L / 2 in its middle alone: edges keep their lengths. So its ends
                // come nearer by κ² L³ / 32, three quarters of what an arc's do. Over the three
                // directions of edges the mean square is a third, and ¾ · ⅓ · w L = A / 3.
                let width_m = 4.0 / 3.0 * (area_m2 / rest_length_m);
                law.compression_n_per_m(rigidity_n_m * width_m, rest_length_m)
            }
        };
        stiffness.is_finite().then_some(stiffness)
    }
}

/// The stiffness of the two constraints that replace the constraint of a torn edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum TornStiffness {
    /// Each copy has half the stiffness, so a split does not change the energy.
    #[default]
    Halved,
    /// Each copy has the full stiffness, as in the paper (Souza et al. 2014 §IV-A). A split then
    /// adds ½ k (l − L)² per edge.
    Whole,
}

/// The bend constraints that a split removes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum BendRemoval {
    /// The bend constraints across the edges that the split tears.
    #[default]
    Seam,
    /// The bend constraints across the torn edges, and all bend constraints of the split vertex
    /// (Souza et al. 2014 §IV-A). A merge does not restore the latter.
    Vertex,
}
