//! Space against time: whether a finer mesh or a shorter step is the better buy.
//!
//! Every method plays a scene on several meshes, each at several steps. A run's error is its distance from
//! the same scene on a mesh that is finer than all of them ([`Options::finest`]). It has two parts: what is
//! left of the step is the distance from the same mesh's shortest step, and what is left of the mesh is the
//! error of that shortest step. From each run there are two ways to buy precision: halving the step, and
//! halving the edge. A [`Buy`] says which lowers the error more per factor of cost.
//!
//! How to read the numbers:
//!
//! * The finest mesh has two runs, by Verlet's method and by Newton's, which share no stepping. Their
//!   distance is the *floor*. An error below ten times the floor is known no better than that, and no buy
//!   lowers it.
//! * The finest mesh stands for the continuum, but is not it. Errors of the mesh next to it are told too
//!   small: with half the edge and order one, by half. So the last halving of the edge looks better than it
//!   is.
//! * Meshes have diagonals in random directions. Those of a finer mesh are another draw, and no refinement
//!   of the coarser ones. Only the lattice of vertices nests, and displacements are compared on the lattice
//!   of the coarsest mesh, each of whose points counts the same.
//! * When the edge is halved, the step stays the same part of its method's base step. That is half as long
//!   for explicit methods and those that sweep, and as long as before for implicit ones.
//! * Not every measure has a value as edges get shorter. A toughness has one at the tip of a slit, and none in
//!   a whole strip, where an edge of half the length needs √2 times the strain. A stretch ratio has none at
//!   the tip of a slit, where strains grow without bound. The summary tells what is left of each mesh.
//! * Provot's limiter moves particles by no force. Its forces are errors, and its chart shows how large.

mod assess;
mod csv;
mod measure;
mod row;
mod scene;
mod svg;
#[cfg(test)]
mod tests;
mod words;

pub use self::csv::csv;
pub use self::measure::Measure;
pub use self::row::{Better, Buy, Error, Floor, ReferenceRun, Row, SceneStudy};
pub use self::scene::SpaceScene;
pub use self::svg::svg;
pub use self::words::summary;

use std::num::NonZero;

use serde::{Deserialize, Serialize};

use self::assess::{Ran, assess};
use crate::pareto::{Bounds, Case, METHODS, Outcome, PARTS, Planned, Role, finest, plan, undone};
use crate::parts::{Divided, Missing};
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The options of the experiment on space against time.
#[derive(Clone, Debug)]
pub struct Options {
    /// The scenes to run.
    pub scenes: Vec<SpaceScene>,
    /// The numbers of cells along each side of the meshes that are compared. Each must be a multiple of the
    /// smallest.
    pub cells: Vec<u32>,
    /// The number of cells along each side of the mesh with which they are compared. It must be larger than
    /// all of `cells`, and a multiple of the smallest.
    pub finest: u32,
    /// The names of the methods, from [`METHODS`].
    pub methods: Vec<String>,
    /// The fractions of the base step, from [`PARTS`]. One must be half of another.
    pub parts: Vec<f64>,
    /// The number of runs to execute at a time.
    pub threads: NonZero<usize>,
    /// The largest number of visits of edges per row. Runs on the finest mesh have no limit.
    pub visits_max: u64,
}

/// The default numbers of cells of [`Options::cells`].
pub const CELLS: [u32; 3] = [16, 32, 64];

/// The default number of cells of [`Options::finest`].
pub const FINEST: u32 = 128;

/// The default fractions of [`Options::parts`].
pub const STEPS: [f64; 4] = [2.0, 1.0, 0.5, 0.25];

/// The default methods of [`Options::methods`]: one setting for each way of stepping that the program
/// offers, and BDF2, since backward Euler's error of the step may hide that of the mesh. PBD is rigid and has
/// no limit, so that it has no part here.
pub const SERIES: [&str; 5] = ["verlet", "xpbd-4", "euler-back-100", "bdf2-100", "provot"];

/// The default limit of [`Options::visits_max`], some twenty seconds of CPU time.
pub const VISITS_MAX: u64 = 2_000_000_000;

/// An error of [`Options`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OptionsError {
    /// There are no meshes, or one without cells.
    NoCells,
    /// The vertices of the coarsest mesh are not all vertices of this one.
    NotNested {
        /// The number of cells of the mesh.
        given: u32,
        /// The number of cells of the coarsest mesh.
        coarsest: u32,
    },
    /// The mesh with which others are compared is not finer than all of them.
    NotFiner {
        /// The number of cells of the mesh with which others are compared.
        given: u32,
        /// The largest number of cells of the others.
        limit: u32,
    },
    /// No fraction of the base step is half of another.
    NoHalf,
}

impl std::fmt::Display for OptionsError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            OptionsError::NoCells => f.write_str("a mesh needs cells"),
            OptionsError::NotNested { given, coarsest } => write!(
                f,
                "{given} cells are no multiple of {coarsest}, so meshes share no lattice"
            ),
            OptionsError::NotFiner { given, limit } => write!(
                f,
                "the finest mesh has {given} cells, and another has {limit}: it must have more"
            ),
            OptionsError::NoHalf => f.write_str("no step is half of another"),
        }
    }
}

impl std::error::Error for OptionsError {}

impl Options {
    /// Checks that meshes share a lattice, that the finest is finer, and that some step is halved.
    ///
    /// # Errors
    ///
    /// [`OptionsError`] if one of this is not so.
    pub fn check(&self) -> Result<(), OptionsError> {
        let coarsest = self.coarsest();
        let limit = self.cells.iter().copied().max().unwrap_or(0);
        if coarsest == 0 {
            return Err(OptionsError::NoCells);
        }
        let mut all = self.cells.iter().chain([&self.finest]);
        if let Some(&given) = all.find(|cells| *cells % coarsest != 0) {
            return Err(OptionsError::NotNested { given, coarsest });
        }
        if self.finest <= limit {
            let given = self.finest;
            return Err(OptionsError::NotFiner { given, limit });
        }
        let has_half = |part: &f64| self.parts.contains(&(part / 2.0));
        match self.parts.iter().any(has_half) {
            true => Ok(()),
            false => Err(OptionsError::NoHalf),
        }
    }

    fn coarsest(&self) -> u32 {
        self.cells.iter().copied().min().unwrap_or(0)
    }
}

/// The results of the experiment on space against time.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Study {
    /// The name and version of the file format.
    pub schema: String,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The numbers of cells along each side of the meshes, in ascending order.
    pub cells: Vec<u32>,
    /// The number of cells along each side of the mesh with which they are compared.
    pub finest: u32,
    /// The fractions of the base step, in descending order.
    pub parts: Vec<f64>,
    /// The largest number of visits of edges that a row was allowed.
    pub visits_max: u64,
    /// Whether the experiment was interrupted. Runs that were not finished have
    /// [`Status::Interrupted`](crate::pareto::Status::Interrupted).
    pub is_interrupted: bool,
    /// The results of each scene.
    pub scenes: Vec<SceneStudy>,
    /// The parts whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

/// A part is a scene, or several.
impl Divided for Study {
    const SCHEMA: &'static str = "tearmesh.chart.space/1";

    fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn merged(parts: Vec<Study>, provenance: Provenance, missing: Vec<Missing>) -> Option<Study> {
        let is_interrupted = parts.iter().any(|part| part.is_interrupted);
        let mut parts = parts.into_iter();
        let mut whole = parts.next()?;
        whole.scenes.extend(parts.flat_map(|part| part.scenes));
        Some(Study {
            provenance,
            is_interrupted,
            missing,
            ..whole
        })
    }
}

/// A run, and the place of its mesh among those of the scene.
struct Job {
    place: usize,
    planned: Planned,
}

/// The meshes of a scene, of which the last is the finest, and their runs.
struct Prepared {
    scene: SpaceScene,
    cases: Vec<Case>,
    jobs: Vec<Job>,
}

/// An experiment that is ready to be run.
pub struct Plan {
    options: Options,
    scenes: Vec<Prepared>,
}

impl std::fmt::Debug for Plan {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Plan").finish_non_exhaustive()
    }
}

impl Plan {
    /// Prepares an experiment.
    ///
    /// # Errors
    ///
    /// [`OptionsError`] if [`Options::check`] fails.
    ///
    /// # Panics
    ///
    /// If a number of cells is more than a mesh can have.
    pub fn new(options: &Options) -> Result<Plan, OptionsError> {
        options.check()?;
        let mut options = options.clone();
        options.cells.sort_unstable();
        options.cells.dedup();
        options.parts.sort_by(|a, b| b.total_cmp(a));
        options.parts.dedup();
        let scenes = options.scenes.iter();
        let scenes = scenes.map(|&scene| prepared(scene, &options)).collect();
        Ok(Plan { options, scenes })
    }

    /// Returns the number of runs.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.scenes.iter().map(|scene| scene.jobs.len()).sum()
    }

    /// Returns an estimate of the visits of edges of all runs.
    #[must_use]
    pub fn guessed_visits(&self) -> f64 {
        let jobs = self.scenes.iter().flat_map(|scene| &scene.jobs);
        jobs.map(|job| self.guess(job)).sum()
    }

    /// No row costs more than it may.
    fn guess(&self, job: &Job) -> f64 {
        match job.planned.role {
            Role::Budget { .. } => job.planned.guess.min(self.options.visits_max as f64),
            _ => job.planned.guess,
        }
    }

    /// Runs the experiment. The same options give the same study.
    ///
    /// When `stop` returns true, all runs end as soon as possible and are marked as interrupted. `watch` is
    /// called after each run with its name and the estimated fraction of all work that is done.
    #[must_use]
    pub fn study(
        &self,
        provenance: Provenance,
        stop: &(dyn Fn() -> bool + Sync),
        mut watch: impl FnMut(&str, f64),
    ) -> Study {
        let (whole, mut done) = (self.guessed_visits(), 0.0);
        let (mut scenes, mut missing) = (Vec::new(), Vec::new());
        for prepared in &self.scenes {
            let outcomes = side_by_side(
                &prepared.jobs,
                self.options.threads,
                |job| self.guess(job),
                |job| self.carry_out(prepared, job, stop),
                |i| {
                    let job = &prepared.jobs[i];
                    done += self.guess(job);
                    let name = prepared.cases[job.place].name();
                    watch(&format!("{name}/{}", job.planned.name), done / whole);
                },
            );
            missing.extend(undone(prepared.scene.name().to_owned(), &outcomes));
            scenes.push(self.assessed(prepared, &outcomes));
        }
        Study {
            schema: Study::SCHEMA.to_owned(),
            provenance,
            cells: self.options.cells.clone(),
            finest: self.options.finest,
            parts: self.options.parts.clone(),
            visits_max: self.options.visits_max,
            is_interrupted: !missing.is_empty(),
            scenes,
            missing,
        }
    }

    fn carry_out(
        &self,
        prepared: &Prepared,
        job: &Job,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Outcome {
        if stop() {
            return Outcome::interrupted();
        }
        let visits_max = match job.planned.role {
            Role::Budget { .. } => self.options.visits_max,
            _ => u64::MAX,
        };
        let bounds = Bounds {
            visits_max,
            clock: None,
            stop,
        };
        job.planned.carry_out(&prepared.cases[job.place], &bounds)
    }

    fn assessed(&self, prepared: &Prepared, outcomes: &[Outcome]) -> SceneStudy {
        let ran = prepared
            .jobs
            .iter()
            .zip(outcomes)
            .map(|(job, outcome)| Ran {
                case: &prepared.cases[job.place],
                planned: &job.planned,
                outcome,
            });
        let ran: Vec<Ran<'_>> = ran.collect();
        assess(prepared.scene, self.options.coarsest(), &ran)
    }
}

fn prepared(scene: SpaceScene, options: &Options) -> Prepared {
    let cells = options.cells.iter().chain([&options.finest]);
    let cases: Vec<Case> = cells.map(|&cells| scene.case(cells)).collect();
    let mut jobs = Vec::new();
    for (place, case) in cases.iter().enumerate() {
        let planned = if place + 1 == cases.len() {
            finest(case)
        } else {
            let is_wanted = |planned: &Planned| is_wanted(&planned.role, options);
            plan(case).into_iter().filter(is_wanted).collect()
        };
        jobs.extend(planned.into_iter().map(|planned| Job { place, planned }));
    }
    Prepared { scene, cases, jobs }
}

fn is_wanted(role: &Role, options: &Options) -> bool {
    let Role::Budget { method, part } = *role else {
        return false;
    };
    let is_named = options
        .methods
        .iter()
        .any(|name| name == METHODS[method].name);
    is_named && options.parts.contains(&PARTS[part])
}
