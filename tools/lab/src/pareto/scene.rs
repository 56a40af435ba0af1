//! The scenes, as plain data, and the systems that they start with.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};
use tearmesh::{Point, Vector};
use tearmesh_cloth::{Loads, Path, System};

use self::Observable::*;
use crate::reference::Reference;
use crate::sheet::{DENSITY_KG_PER_M2, MeshKind, SEED, Sheet, random_vectors, system};
use crate::statistics::Random;

/// A scene of the experiment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene {
    /// The name on the command line and in the names of runs.
    pub(crate) name: &'static str,
    /// A short description of the scene.
    pub(crate) about: &'static str,
    /// The stiffness of the edges, in N/m.
    pub(crate) stiffness_n_per_m: f64,
    /// The length of a side of the sheet, in metres.
    pub(crate) side_m: f64,
    /// The gravity along the x, y and z axes, in m/s².
    pub(crate) gravity_m_per_s2: [f64; 3],
    /// The rate at which velocities decay by drag, in 1/s.
    pub(crate) drag_per_s: f64,
    /// The shape in which the sheet starts.
    pub(crate) start: Start,
    /// The factor by which the mass of the particle nearest to the centre is multiplied, as for the slivers
    /// that cuts leave; 1 for none.
    pub(crate) middle_mass_ratio: f64,
    /// The particles that are held.
    pub(crate) held: Held,
    /// The condition under which the scene ends.
    pub(crate) until: Until,
    /// The observables that are compared.
    pub(crate) observables: &'static [Observable],
}

/// The shapes in which a sheet starts, with all velocities zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Start {
    /// The flat sheet at rest.
    Flat,
    /// The flat sheet at rest, with its edges stored in random order.
    Shuffled,
    /// A bulge out of the plane, whose height in the middle is this fraction of the side. When pulled, a
    /// flat sheet would buckle to either side by chance.
    Bulged(f64),
    /// A taut sheet in its frame without gravity, with edges longer than at rest by this fraction on
    /// average.
    Taut(f64),
    /// The flat sheet, turned out of its plane by 30° around its upper edge.
    Turned,
    /// The flat sheet, scaled by this factor.
    Crushed(f64),
}

/// The particles that are held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Held {
    /// No particles.
    Nothing,
    /// The particles of the upper edge.
    Top,
    /// All particles of the boundary.
    Frame,
    /// The particles of the lower edge, and those of the upper edge, which move upward at this speed in m/s.
    Pulled(f64),
}

/// The conditions under which a scene ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Until {
    /// The scene ends after this many seconds.
    Time(f64),
    /// The scene ends at rest, as in [`REST_M_PER_S`]. A run that takes more than this many seconds fails.
    Rest(f64),
    /// The scene ends when both [`TEAR_RATIO`] and [`TOUGHNESS_J_PER_M`] have been reached. A run that takes
    /// more than this many seconds fails.
    Tears(f64),
}

impl Until {
    /// The longest time of the scene, in seconds.
    pub(super) fn seconds(self) -> f64 {
        let (Until::Time(s) | Until::Rest(s) | Until::Tears(s)) = self;
        s
    }
}

/// The speed in m/s below which a particle is at rest.
pub(crate) const REST_M_PER_S: f64 = 1e-6;

/// The stretch ratio at which an edge of the strip tears.
pub(crate) const TEAR_RATIO: f64 = 1.3;

/// The toughness at which an edge of the strip tears, in J/m. It equals a stretch ratio of 1.3 if edges are
/// a sixteenth of the strip long.
pub(crate) const TOUGHNESS_J_PER_M: f64 = 0.28;

/// The quantities by which runs are compared. Errors are relative to the reference; for positions and strains
/// the largest error of all checkpoints counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Observable {
    /// The mass-weighted L2 norm of the position errors, divided by that of the displacements from the start.
    Displacement,
    /// The rms of the relative error of the strain of edges, over those that bear more than 0.3 of the largest
    /// strain.
    StrainRms,
    /// The largest mean over 1/60 s of the force at the held particles; in a scene that ends at rest, the force
    /// at its end.
    ReactionLargest,
    /// The largest unexplained gain of energy, divided by the energy put in. The true value is 0.
    EnergyMade,
    /// The largest unexplained loss of energy, divided by the energy put in. The true value is 0.
    EnergyLost,
    /// The time at which an edge first reaches [`TEAR_RATIO`].
    TearTime,
    /// The force at the clamps at [`TearTime`](Observable::TearTime), as a mean over the last 1/60 s.
    TearForce,
    /// The time at which an edge first reaches [`TOUGHNESS_J_PER_M`]. It is recorded for the gate alone.
    ToughnessTime,
    /// The force at the clamps at [`ToughnessTime`](Observable::ToughnessTime), as a mean over the last 1/60 s.
    ToughnessForce,
}

impl Observable {
    /// Returns the name of the observable in words.
    #[must_use]
    pub(crate) fn name(self) -> &'static str {
        match self {
            Displacement => "displacement",
            StrainRms => "strain of edges (rms)",
            ReactionLargest => "force at the holds",
            EnergyMade => "energy made",
            EnergyLost => "energy lost",
            TearTime => "time of first tear",
            TearForce => "force at first tear",
            ToughnessTime => "time of first tear by toughness",
            ToughnessForce => "force at first tear by toughness",
        }
    }

    /// Whether the true value is zero, so that no reference is needed.
    pub(super) fn is_energy(self) -> bool {
        matches!(self, EnergyMade | EnergyLost)
    }
}

const G: f64 = 9.81;

/// The slowest mode of a strip that hangs by an end, ω₁ = πc/2 over its length of a metre, with c = √(k/ρ) at
/// 1000 N/m.
const SLOWEST_RAD_PER_S: f64 = PI / 2.0 * 81.649_658_092_772_6;

const SWING: Scene = Scene {
    name: "swing",
    about: "S2: held by its upper edge, let go at 30°, drag 10 /s, 1 s",
    stiffness_n_per_m: 1e3,
    side_m: 1.0,
    gravity_m_per_s2: [0.0, -G, 0.0],
    drag_per_s: 10.0,
    start: Start::Turned,
    middle_mass_ratio: 1.0,
    held: Held::Top,
    until: Until::Time(1.0),
    observables: &[Displacement, StrainRms, ReactionLargest],
};

const HANG: Scene = Scene {
    name: "hang",
    about: "S1: hangs by its upper edge at rest, 400 m/s², drag 2ω₁",
    gravity_m_per_s2: [0.0, -400.0, 0.0],
    drag_per_s: 2.0 * SLOWEST_RAD_PER_S,
    start: Start::Flat,
    until: Until::Rest(2.0),
    ..SWING
};

/// All scenes of the experiment.
pub(crate) const SCENES: [Scene; 11] = [
    HANG,
    Scene {
        name: "shuffled",
        about: "S1r: the same with edges stored at random",
        start: Start::Shuffled,
        ..HANG
    },
    SWING,
    Scene {
        name: "stiff",
        about: "S3: the swing with 1e5 N/m",
        stiffness_n_per_m: 1e5,
        ..SWING
    },
    Scene {
        name: "sliver",
        about: "S4: the swing with one vertex of mass/100",
        middle_mass_ratio: 0.01,
        ..SWING
    },
    Scene {
        name: "trampoline",
        about: "S5: held all round, falls into its middle, drag 10 /s, 0.5 s",
        gravity_m_per_s2: [0.0, 0.0, -G],
        start: Start::Flat,
        held: Held::Frame,
        until: Until::Time(0.5),
        ..SWING
    },
    Scene {
        name: "taut",
        about: "S6: a frame with 2 % pretension, drag 2 /s, 1 s",
        gravity_m_per_s2: [0.0, 0.0, -G],
        drag_per_s: 2.0,
        start: Start::Taut(0.02),
        held: Held::Frame,
        ..SWING
    },
    Scene {
        name: "undamped",
        about: "S7: the swing without drag, 10 s: energy alone",
        drag_per_s: 0.0,
        until: Until::Time(10.0),
        observables: &[EnergyMade, EnergyLost],
        ..SWING
    },
    Scene {
        name: "crushed",
        about: "S7: let go at half its size, 1 s: energy alone",
        gravity_m_per_s2: [0.0; 3],
        drag_per_s: 0.0,
        start: Start::Crushed(0.5),
        held: Held::Nothing,
        observables: &[EnergyMade, EnergyLost],
        ..SWING
    },
    Scene {
        name: "drape",
        about: "S8: held all round, sags until at rest, 1e6 N/m, drag 100 /s",
        stiffness_n_per_m: 1e6,
        gravity_m_per_s2: [0.0, 0.0, -G],
        drag_per_s: 100.0,
        start: Start::Flat,
        held: Held::Frame,
        until: Until::Rest(2.0),
        ..SWING
    },
    Scene {
        name: "strip",
        about: "S9: pulled at .1 m/s to its first tear, by stretch 1.3 and by toughness",
        side_m: 0.1,
        gravity_m_per_s2: [0.0; 3],
        start: Start::Bulged(0.01),
        held: Held::Pulled(0.1),
        until: Until::Tears(0.5),
        observables: &[TearTime, TearForce, ToughnessForce],
        ..SWING
    },
];

/// A scene on a mesh, with its own references, rows and fronts.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) scene: Scene,
    pub(super) mesh: MeshKind,
    pub(super) cells: u32,
    pub(super) sheet: Sheet,
    /// Where particles start.
    pub(super) start: Vec<Point>,
    /// The edges in the order in which they become constraints.
    pub(super) edges: Vec<[usize; 2]>,
}

impl Case {
    /// Creates the sheet of a scene and its start. Panics if `cells` is 0 or more than a mesh can have.
    pub(super) fn new(scene: &Scene, mesh: MeshKind, cells: u32) -> Case {
        let mut sheet = Sheet::new(mesh, cells, scene.side_m);
        // Also by 1, which changes nothing.
        let middle = middle(&sheet);
        sheet.masses[middle] *= scene.middle_mass_ratio;
        let mut edges = sheet.edges.clone();
        if scene.start == Start::Shuffled {
            let mut random = Random::new(SEED);
            for i in (1..edges.len()).rev() {
                edges.swap(i, random.below(i + 1));
            }
        }
        let mut case = Case {
            scene: *scene,
            mesh,
            cells,
            start: sheet.points.iter().map(|p| placed(p, scene)).collect(),
            sheet,
            edges,
        };
        if let Start::Taut(_) = scene.start {
            case.start = relaxed(case.system());
        }
        case
    }

    /// Whether energy is all that is compared, for which no other run is needed.
    pub(super) fn is_of_energy(&self) -> bool {
        self.scene.observables.iter().all(|one| one.is_energy())
    }

    /// Whether displacements are compared only if noise does not grow too much: it cannot at rest.
    pub(super) fn is_gated(&self) -> bool {
        !self.is_of_energy() && !matches!(self.scene.until, Until::Rest(_))
    }

    /// The speed at which a pull travels, c = √(k/ρ), in m/s.
    pub(super) fn speed_m_per_s(&self) -> f64 {
        (self.scene.stiffness_n_per_m / DENSITY_KG_PER_M2).sqrt()
    }

    /// The time in which a pull travels an edge of mean length, h/c, in seconds.
    pub(super) fn edge_s(&self) -> f64 {
        self.sheet.edge_m() / self.speed_m_per_s()
    }

    /// Whether the particle at this point of the flat sheet is held or led.
    pub(super) fn is_held(&self, p: &Point) -> bool {
        let side = self.scene.side_m;
        let (bottom, top) = (p.y == 0.0, p.y == side);
        match self.scene.held {
            Held::Nothing => false,
            Held::Top => top,
            Held::Frame => bottom || top || p.x == 0.0 || p.x == side,
            Held::Pulled(_) => bottom || top,
        }
    }

    /// The system at its start. Panics if the numbers of the scene are not usable; those of [`SCENES`] are.
    pub(super) fn system(&self) -> System {
        let Case { scene, sheet, .. } = self;
        let taut = match scene.start {
            Start::Taut(part) => 1.0 + part,
            _ => 1.0,
        };
        let springs = self.edges.iter();
        let springs = springs.map(|&ends| (ends, sheet.length_m(ends) / taut));
        let (masses, stiffness) = (sheet.masses.clone(), scene.stiffness_n_per_m);
        let mut system = system(&sheet.points, masses, springs, stiffness);
        system.state_mut().0.copy_from_slice(&self.start);
        let held = sheet.points.iter().enumerate();
        for (i, p) in held.filter(|(_, p)| self.is_held(p)) {
            match scene.held {
                Held::Pulled(speed) if p.y > 0.0 => {
                    let seconds = scene.until.seconds();
                    let to = p + Vector::y() * (speed * seconds);
                    let path = Path::new([(0.0, *p), (seconds, to)]);
                    system.grab(i, path.expect("seconds ascend"));
                }
                _ => system.hold(i),
            }
        }
        let loads = Loads {
            gravity_m_per_s2: Some(scene.gravity_m_per_s2.into()).filter(|g| *g != Vector::zeros()),
            drag_per_s: Some(scene.drag_per_s).filter(|drag| *drag > 0.0),
            ..Loads::default()
        };
        system.set_loads(loads).expect("a scene's loads are finite");
        system
    }

    /// The system at its start, with each free particle moved at random by up to `noise_m` metres along each
    /// axis, always in the same way.
    pub(super) fn disturbed(&self, noise_m: f64) -> System {
        let mut system = self.system();
        for (i, off_m) in random_vectors(&system, noise_m) {
            system.state_mut().0[i] += off_m;
        }
        system
    }
}

/// The starting position of a particle that is at this point at rest.
fn placed(p: &Point, scene: &Scene) -> Point {
    let side = scene.side_m;
    match scene.start {
        Start::Turned => {
            let (sin, cos) = (0.5, 0.75_f64.sqrt());
            let below = p.y - side;
            Point::new(p.x, side + below * cos, below * sin)
        }
        Start::Crushed(part) => Point::from(p.coords * part),
        Start::Bulged(part) => {
            let [x, y] = [p.x / side, p.y / side].map(|x| 4.0 * x * (1.0 - x));
            Point::new(p.x, p.y, part * side * x * y)
        }
        Start::Flat | Start::Shuffled | Start::Taut(_) => *p,
    }
}

/// The positions of a system at rest without gravity. Random diagonals are not balanced in the flat sheet, so
/// it would ring from the start, in ways that no reference resolves.
fn relaxed(mut system: System) -> Vec<Point> {
    let mut newton = Reference::to_rest();
    let loads = Loads {
        drag_per_s: Some(20.0),
        ..Loads::default()
    };
    system.set_loads(loads).expect("the loads are finite");
    for _ in 0..400 {
        let step = system.step(&mut newton, 0.02);
        step.expect("a taut sheet in its frame is solved for");
        if fastest_m_per_s(&system) < 1e-9 {
            break;
        }
    }
    system.positions().to_vec()
}

pub(crate) fn fastest_m_per_s(system: &System) -> f64 {
    let squares = system.velocities().iter().map(|v| v.norm_squared());
    squares.fold(0.0, f64::max).sqrt()
}

/// The index of the particle nearest to the centre.
pub(crate) fn middle(sheet: &Sheet) -> usize {
    let centre = Point::new(0.5, 0.5, 0.0) * sheet.side_m;
    let away = |p: &Point| (p - centre).norm_squared();
    let points = sheet.points.iter().enumerate();
    let nearest = points.min_by(|a, b| away(a.1).total_cmp(&away(b.1)));
    nearest.map_or(0, |(i, _)| i)
}
