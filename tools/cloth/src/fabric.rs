//! The material of a cloth: springs along edges, triangles, springs or arcs across edges, and what
//! happens to them where it tears.

use tearmesh::geometry::Vector;

use crate::bend::Buckling;
use crate::sheet::error::ClothError;

/// The material of a cloth, and the rules for its constraints when it tears.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fabric {
    /// The stiffness of each edge, in N/m. In a regular net of triangles the modulus is 2/√3 times
    /// this stiffness. It may be zero together with a [`Weave`]: edges are then measured, for
    /// [`Cloth::overstretched`](crate::Cloth::overstretched), but exert no force.
    pub stretch_n_per_m: f64,
    /// The moduli of triangles that resist stretch and shear; `None` for no triangles.
    pub weave: Option<Weave>,
    /// The bending resistance across each interior edge; `None` for no resistance.
    pub bend: Option<Bending>,
    /// How the stiffness of a torn edge is divided between its two constraints.
    pub copies: Copies,
    /// The bend constraints that a split removes.
    pub unbend: Unbend,
}

impl Fabric {
    /// Returns a fabric whose edges have this stiffness in N/m, without bending resistance, and
    /// with the rules for tearing that conserve energy.
    #[must_use]
    pub fn new(stretch_n_per_m: f64) -> Fabric {
        Fabric {
            stretch_n_per_m,
            weave: None,
            bend: None,
            copies: Copies::default(),
            unbend: Unbend::default(),
        }
    }

    /// Returns a fabric of triangles alone, without springs along edges and without bending
    /// resistance.
    ///
    /// ```
    /// use tearmesh_cloth::{implicit, Cloth, Fabric, Implicit, Pbd, StepError, Weave};
    /// use tearmesh::{shapes, Masses, Vector};
    ///
    /// let weave = Weave {
    ///     warp_n_per_m: 800.0,
    ///     weft_n_per_m: 500.0,
    ///     shear_n_per_m: 40.0,
    ///     warp: Vector::y(),
    /// };
    /// let (mesh, positions) = shapes::grid(4, 4);
    /// let masses = Masses::area(&mesh, &positions, 0.15)?;
    /// let mut cloth = Cloth::new(&mesh, &positions, masses, Fabric::woven(weave))?;
    /// cloth.step(&mut Implicit::new(implicit::Settings::default()), 1.0 / 60.0)?;
    ///
    /// // What projects springs alone would leave it without force, and is refused.
    /// let error = cloth.step(&mut Pbd::default(), 1.0 / 60.0).unwrap_err();
    /// assert_eq!(error, StepError::Triangles { count: 32 });
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn woven(weave: Weave) -> Fabric {
        Fabric {
            weave: Some(weave),
            ..Fabric::new(0.0)
        }
    }
}

impl Fabric {
    pub(super) fn check(&self) -> Result<(), ClothError> {
        let positive = |x: f64| x > 0.0 && x.is_finite();
        let is_woven_alone = self.stretch_n_per_m == 0.0 && self.weave.is_some();
        if !(is_woven_alone || positive(self.stretch_n_per_m)) {
            return Err(ClothError::Stiffness {
                field: "stretch_n_per_m",
                given: self.stretch_n_per_m,
            });
        }
        let weave = self.weave.and_then(|weave| weave.fault());
        let bend = self.bend.map(|bend| bend.number());
        let bend = bend.filter(|(_, given)| !positive(*given));
        match weave.or(bend) {
            Some((field, given)) => Err(ClothError::Stiffness { field, given }),
            None => Ok(()),
        }
    }
}

/// The moduli with which the triangles of a cloth resist stretch and shear. Poisson's ratio is
/// zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weave {
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

impl Weave {
    /// The first number that can be no modulus: its field, and the number as given.
    pub(super) fn fault(&self) -> Option<(&'static str, f64)> {
        let usable = |x: f64| x >= 0.0 && x.is_finite();
        [
            ("weave.warp_n_per_m", self.warp_n_per_m, true),
            ("weave.weft_n_per_m", self.weft_n_per_m, true),
            ("weave.shear_n_per_m", self.shear_n_per_m, false),
        ]
        .into_iter()
        .find(|&(_, given, is_needed)| !usable(given) || is_needed && given == 0.0)
        .map(|(field, given, _)| (field, given))
    }
}

/// The kind of bending resistance between the two vertices opposite an interior edge.
///
/// ```
/// use tearmesh_cloth::implicit::Settings;
/// use tearmesh_cloth::{Bending, Buckling, Cloth, Fabric, Implicit, StepError, Xpbd};
/// use tearmesh::{shapes, Masses};
///
/// let bend = Bending::Buckling { flexural_n_m2: 1e-6, law: Buckling::new(0.95).unwrap() };
/// let fabric = Fabric { bend: Some(bend), ..Fabric::new(500.0) };
/// let (mesh, positions) = shapes::grid(4, 4);
/// let masses = Masses::area(&mesh, &positions, 0.15)?;
/// let mut cloth = Cloth::new(&mesh, &positions, masses, fabric)?;
/// cloth.step(&mut Implicit::new(Settings::default()), 1.0 / 60.0)?;
///
/// // What projects springs would take arcs for such, and is refused.
/// let error = cloth.step(&mut Xpbd::default(), 1.0 / 60.0).unwrap_err();
/// assert_eq!(error, StepError::Buckling { count: 40 });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bending {
    /// A spring of the same stiffness across every edge (the flexion springs of Provot 1995, §2).
    Spring {
        /// The stiffness, in N/m; positive.
        stiffness_n_per_m: f64,
    },
    /// A strip of the same flexural stiffness across every edge, which buckles into an arc under
    /// compression (Choi and Ko 2002 §4.2). Before it buckles, its stiffness against compression is
    /// inversely proportional to the third power of its length.
    Buckling {
        /// The flexural stiffness k, in N m²: the bending moment is k times the curvature.
        /// Positive.
        flexural_n_m2: f64,
        /// The law by which a bend buckles.
        law: Buckling,
    },
}

impl Bending {
    /// The field that says how stiff it is, and its number.
    pub(super) fn number(&self) -> (&'static str, f64) {
        match *self {
            Bending::Spring { stiffness_n_per_m } => ("bend.stiffness_n_per_m", stiffness_n_per_m),
            Bending::Buckling { flexural_n_m2, .. } => ("bend.flexural_n_m2", flexural_n_m2),
        }
    }

    pub(super) fn law(&self) -> Option<Buckling> {
        match *self {
            Bending::Spring { .. } => None,
            Bending::Buckling { law, .. } => Some(law),
        }
    }

    /// The stiffness of a bend constraint of this length. `None` where it is beyond all numbers.
    pub(super) fn stiffness_n_per_m(&self, rest_length_m: f64) -> Option<f64> {
        let stiffness = match *self {
            Bending::Spring { stiffness_n_per_m } => stiffness_n_per_m,
            Bending::Buckling { flexural_n_m2, law } => {
                law.compression_n_per_m(flexural_n_m2, rest_length_m)
            }
        };
        (stiffness > 0.0 && stiffness.is_finite()).then_some(stiffness)
    }
}

/// The stiffness of the two constraints that replace the constraint of a torn edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Copies {
    /// Each copy has half the stiffness, so a split does not change the energy.
    #[default]
    Halved,
    /// Each copy has the full stiffness, as in the paper (Souza et al. 2014 §IV-A). A split then
    /// adds ½ k (l − L)² per edge.
    Whole,
}

/// The bend constraints that a split removes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unbend {
    /// The bend constraints across the edges that the split tears.
    #[default]
    Seam,
    /// The bend constraints across the torn edges, and all bend constraints of the split vertex
    /// (Souza et al. 2014 §IV-A). A merge does not restore the latter.
    Vertex,
}
