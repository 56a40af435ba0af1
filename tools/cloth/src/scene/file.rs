//! Scene files: a scene as people write it, whatever the mesh.
//!
//! A [`SceneFile`] has the tables and keys of a scene file in TOML, or in any other format that serde reads.
//! Everything is optional, and a key that is left out is that of the [base](SceneFile::base). [`SceneFile::on`]
//! makes a [`Scene`](super::Scene) of it for the frame of a mesh. The meaning, the unit and the default of each
//! key are in the command's guide to scenes, which has a row for each field here.

/// The names of fields, and whether each has a value.
macro_rules! present {
    ($table:expr, $($key:ident),+) => {
        vec![$((stringify!($key), $table.$key.is_some())),+]
    };
}

mod fabric;
mod number;
mod on;
mod packed;
pub mod rays;
mod region;
mod tear;
mod word;

use serde::Deserialize;
use tearmesh::CutMethod;

pub use self::number::{
    AboveOne, Finite, Fraction, Gravity, Name, NotFinite, NotNegative, OUT_OF_RANGE, OutOfRange,
    Positive, Range, Rows, Vertices, Whole,
};
pub use self::on::{BodyMesh, SceneFault};
pub use self::packed::PackedScene;
use self::rays::RayPair;
pub use self::word::{BendLaw, Word, Words};
use super::frame::Axis;
use super::presets::Preset;
use crate::cloth::fabric::{BendRemoval, TornStiffness};
use crate::method::{Method, implicit};

/// A scene file. Its fields are the keys at the top, and its tables.
///
/// ```
/// use tearmesh::shapes;
/// use tearmesh_cloth::scene::file::SceneFile;
/// use tearmesh_cloth::scene::{Frame, Run};
///
/// let text = r#"{ "seconds": 0.1, "hold": [{ "near": [0, 1], "radius": 0.1 }] }"#;
/// let file: SceneFile = serde_json::from_str(text)?;
/// let (mesh, positions) = shapes::grid(8, 8);
/// let frame = Frame::new(&mesh, positions.as_slice(), file.up());
/// let scene = file.on(&frame, None, &mut |_, _| unreachable!()); // it has no bodies
/// let scene = scene.map_err(|mut faults| faults.remove(0))?;
/// let mut run = Run::new(mesh, &positions, scene, &frame)?;
/// while !run.is_over() {
///     run.step()?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SceneFile {
    /// The ready-made scene to start from; `fall` unless given.
    pub base: Option<Word<Preset>>,
    /// The duration.
    pub seconds: Option<NotNegative>,
    /// The direction that is up; y unless given.
    pub up: Option<Word<Axis>>,
    /// Gravity.
    pub gravity_m_per_s2: Option<Gravity>,
    /// The amplitude of the ripple of a flat cloth.
    pub ripple_m: Option<NotNegative>,
    /// The rate at which velocities decay.
    pub drag_per_s: Option<NotNegative>,
    /// The material.
    pub fabric: Option<FabricTable>,
    /// The method.
    pub solver: Option<SolverTable>,
    /// The wind.
    pub wind: Option<WindTable>,
    /// Obstacles. Lists that are not empty replace those of the base.
    pub collider: Vec<ColliderTable>,
    /// What is held or led.
    pub hold: Vec<HoldTable>,
    /// The seams of a garment.
    pub seam: Vec<SeamTable>,
    /// Cuts.
    pub cut: Vec<CutTable>,
    /// How the cloth tears.
    pub tear: Option<TearTable>,
    /// Regions with a strength.
    pub strength: Vec<StrengthTable>,
}

impl SceneFile {
    /// The version of scene files, and of [`PackedScene`]. It is raised whenever a key is added, renamed or removed,
    /// or means something else, so that a program can refuse to hand a scene to another one that would misread it.
    pub const FORMAT: u32 = 5;
}

/// The table `[fabric]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct FabricTable {
    pub density_kg_per_m2: Option<Positive>,
    pub modulus_n_per_m: Option<Positive>,
    pub stretch_n_per_m: Option<Positive>,
    pub damping_s: Option<NotNegative>,
    pub warp_n_per_m: Option<Positive>,
    pub weft_n_per_m: Option<Positive>,
    pub shear_n_per_m: Option<NotNegative>,
    pub warp: Option<Finite<3>>,
    pub bend_law: Option<Word<BendLaw>>,
    pub bend_n_per_m: Option<NotNegative>,
    pub rigidity_n_m: Option<Positive>,
    pub buckles_below: Option<Fraction>,
    pub vt_m: Option<Positive>,
    pub copies: Option<Word<TornStiffness>>,
    pub unbend: Option<Word<BendRemoval>>,
}

/// The table `[solver]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct SolverTable {
    pub method: Option<Word<fn() -> Method>>,
    pub dt_s: Option<Positive>,
    pub sweeps: Option<Whole>,
    pub stiffness: Option<Fraction>,
    pub bend_stiffness: Option<Fraction>,
    pub limit_ratio: Option<AboveOne>,
    pub limit_passes: Option<Whole>,
    pub order: Option<Word<implicit::Method>>,
    pub tolerance: Option<Positive>,
}

/// The table `[wind]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct WindTable {
    pub velocity_m_per_s: Option<Finite<3>>,
    pub coefficient: Option<NotNegative>,
    pub from_s: Option<NotNegative>,
    pub sway_m_per_s: Option<Finite<3>>,
    pub period_s: Option<Positive>,
}

/// A table `[[collider]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct ColliderTable {
    pub point: Option<Finite<3>>,
    pub normal: Option<Finite<3>>,
    pub centre: Option<Finite<3>>,
    pub radius_m: Option<Positive>,
    pub body: Option<Name>,
    pub thickness_m: Option<Positive>,
    pub cell_m: Option<Positive>,
    pub moves: Option<Rows>,
    pub turns: Option<Rows>,
    pub about: Option<Finite<3>>,
    pub friction: Option<NotNegative>,
}

/// A table `[[hold]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct HoldTable {
    pub near: Option<Finite<2>>,
    pub radius: Option<NotNegative>,
    pub across: Option<Range>,
    pub along: Option<Range>,
    pub from: Option<Finite<3>>,
    pub to: Option<Finite<3>>,
    pub centre: Option<Finite<3>>,
    pub radius_m: Option<NotNegative>,
    pub vertices: Option<Vertices>,
    pub from_s: Option<NotNegative>,
    pub until_s: Option<Positive>,
    pub moves: Option<Rows>,
    pub turns: Option<Rows>,
    pub about: Option<Finite<3>>,
    pub grip_m: Option<NotNegative>,
}

/// A table `[[seam]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct SeamTable {
    pub name: Option<Name>,
    pub one: Option<Vertices>,
    pub other: Option<Vertices>,
    pub unpick_at_s: Option<NotNegative>,
}

/// A table `[[cut]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct CutTable {
    pub at_s: Option<NotNegative>,
    pub rays: Option<RayPair>,
    pub through: Option<bool>,
    pub method: Option<Word<CutMethod>>,
}

/// The table `[tear]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct TearTable {
    pub never: Option<bool>,
    pub threshold: Option<AboveOne>,
    pub toughness_j_per_m: Option<Positive>,
    pub threshold_n: Option<Positive>,
    pub principal_stretch: Option<AboveOne>,
    pub threshold_warp: Option<AboveOne>,
    pub threshold_weft: Option<AboveOne>,
    pub warp: Option<Finite<3>>,
    pub splits_per_step: Option<Whole>,
    pub weakening: Option<Fraction>,
}

/// A table `[[strength]]`.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[expect(missing_docs, reason = "the guide has a row for each key")]
pub struct StrengthTable {
    pub factor: Option<Positive>,
    pub near: Option<Finite<2>>,
    pub radius: Option<NotNegative>,
    pub across: Option<Range>,
    pub along: Option<Range>,
    pub from: Option<Finite<3>>,
    pub to: Option<Finite<3>>,
    pub centre: Option<Finite<3>>,
    pub radius_m: Option<NotNegative>,
    pub vertices: Option<Vertices>,
}
