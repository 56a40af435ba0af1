//! The forces that tear a cloth, by two rules and on meshes of several sizes.
//!
//! A trouser test ([`Scene::trouser`]): a strip is slit to its middle, and its two legs are pulled apart.
//! The paper's rule tears an edge at a stretch ratio (Souza et al. 2014 §III-A), whatever its length. So the
//! force at which an edge tears is proportional to that length, and a cloth on a mesh twice as fine is half
//! as strong. A threshold of toughness, an energy per metre of tear, does not have that fault. Both rules
//! are set to agree on the middle mesh.
//!
//! In a laboratory the tear runs from the slit. To get that here, tips are half as strong
//! ([`Tearing::weakening`]). Without that the tear also scatters, and the largest force depends more on the
//! number of edges that share it: the slopes are +0.67 and +0.06 instead of +0.91 and +0.10.

pub mod cascade;
mod csv;
mod first;
mod pulled;
mod strip;
mod svg;

pub use self::csv::csv;
pub use self::first::{FirstTear, spread};
pub use self::pulled::StudyError;
pub use self::strip::{STRIP_M, TIP};
pub use self::svg::svg;

use std::num::NonZero;

use serde::{Deserialize, Serialize};
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
use tearmesh_cloth::{Tearing, Threshold};

use self::cascade::{Cascade, Finer};
use self::pulled::{Pulled, mean};
use self::strip::strip;
use crate::parts::{Divided, Missing};
use crate::pool::side_by_side;
use crate::provenance::Provenance;

/// The default numbers of cells across the strip.
pub const CELLS: [u32; 5] = [8, 12, 16, 24, 32];

/// The stretch ratio at which an edge tears by the paper's rule.
pub const RATIO: f64 = 1.5;

/// Forces are written down so many times in a test of four seconds, each as a mean.
const SAMPLES: u64 = 240;

/// The results of both experiments on tearing.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Chart {
    /// The name and version of the file format.
    pub schema: String,
    /// The origin of the results.
    pub provenance: Provenance,
    /// The results of the trouser tests.
    #[serde(flatten)]
    pub study: Study,
    /// The results of many seeds, one entry per scene and method; empty if none were played.
    pub cascades: Vec<Cascade>,
    /// What changes as the step or the mesh gets finer, computed from `cascades`; empty if each scene was played
    /// on one mesh.
    #[serde(skip_deserializing)]
    pub finer: Vec<Finer>,
    /// The parts whose results are not there; empty for an experiment that was run to its end.
    pub missing: Vec<Missing>,
}

impl Chart {
    /// Creates a chart of both experiments.
    #[must_use]
    pub fn new(provenance: Provenance, study: Study, cascades: Vec<Cascade>) -> Chart {
        Chart {
            schema: Chart::SCHEMA.to_owned(),
            provenance,
            study,
            finer: cascade::finer(&cascades),
            cascades,
            missing: Vec::new(),
        }
    }
}

/// A part is all strips, or the ensembles of one scene by one method.
impl Divided for Chart {
    const SCHEMA: &'static str = "tearmesh.chart.tear/3";

    fn provenance(&self) -> &Provenance {
        &self.provenance
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn merged(parts: Vec<Chart>, provenance: Provenance, missing: Vec<Missing>) -> Option<Chart> {
        if parts.is_empty() {
            return None;
        }
        let (mut study, mut cascades) = (Study::default(), Vec::new());
        for part in parts {
            if !part.study.tests.is_empty() {
                study = part.study;
            }
            cascades.extend(part.cascades);
        }
        cascade::conclude(&mut cascades);
        Some(Chart {
            missing,
            ..Chart::new(provenance, study, cascades)
        })
    }
}

/// The results of the trouser tests. By default there are none.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Study {
    /// The stiffness of the edges, in N/m.
    pub stretch_n_per_m: f64,
    /// The tests, first all by stretch ratio and then all by toughness, each in the order of `cells`.
    pub tests: Vec<Test>,
    /// The slope of the largest force against the edge length, both as logarithms, by stretch ratio and by
    /// toughness. A slope of 1 means proportional, and 0 means independent. Both are 0 if there are no tests.
    pub slopes_largest: [f64; 2],
    /// The slopes of the mean force, by stretch ratio and by toughness, as in `slopes_largest`.
    pub slopes_mean: [f64; 2],
    /// The conclusion from slopes and first tears, in words.
    pub conclusion: String,
}

/// The results of one strip.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Test {
    /// The tearing rule: `stretch` or `toughness`.
    pub rule: String,
    /// The threshold of the rule: a stretch ratio, or a toughness in J/m.
    pub threshold: f64,
    /// The length of the edges along the strip, in metres.
    pub edge_m: f64,
    /// The number of cells across the strip.
    pub cells: u32,
    /// The number of vertex splits.
    pub splits: u64,
    /// The largest force between the clamps in newtons, as a mean over 1/60 s.
    pub force_largest_n: f64,
    /// The mean force between the clamps from the first tear to the last, in newtons; 0 if nothing tore.
    pub force_mean_n: f64,
    /// The first tears by two methods with two steps each, if checked. Runs that did not tear are left out.
    pub first: Vec<FirstTear>,
    /// The distances between the clamps in metres and the forces in newtons, in the order of time.
    pub curve: Vec<[f64; 2]>,
}

/// Tears one strip by each rule for each entry of `cells`, which is its number of cells across.
///
/// The numbers must be even, since the slit runs along edges. Slopes need at least two numbers. If
/// `is_checked`, the first tear of each strip is also found by two methods with two steps each, which takes
/// four times as long. `watch` is called with the number of tests done so far. Returns `None` soon after
/// `stop` returns true.
///
/// # Errors
///
/// [`StudyError`], which would be a bug.
///
/// # Panics
///
/// If `cells` is empty.
pub fn study(
    cells: &[u32],
    is_checked: bool,
    threads: NonZero<usize>,
    stop: &(dyn Fn() -> bool + Sync),
    mut watch: impl FnMut(usize),
) -> Result<Option<Study>, StudyError> {
    let k = Scene::STRETCH_N_PER_M;
    let middle = STRIP_M[0] / f64::from(cells[cells.len() / 2]);
    // ½ k ε² h: the energy of an edge at the ratio, on the mesh in the middle.
    let toughness = 0.5 * k * (RATIO - 1.0) * (RATIO - 1.0) * middle;
    let rules = [Threshold::Stretch(RATIO), Threshold::Toughness(toughness)];
    let strips = rules
        .iter()
        .flat_map(|&rule| cells.iter().map(move |&cells| (cells, rule)));
    let strips: Vec<(u32, Threshold)> = strips.collect();
    let mut count = 0;
    let done = |_| {
        count += 1;
        watch(count);
    };
    // The finest first, since it takes longest.
    let finest = |(cells, _): &(u32, Threshold)| f64::from(*cells);
    let tear = |&(cells, rule): &(u32, Threshold)| test(cells, rule, is_checked, stop);
    let tests = side_by_side(&strips, threads, finest, tear, done);
    let tests: Vec<Test> = match tests.into_iter().collect() {
        Err(StudyError::Stopped) => return Ok(None),
        tests => tests?,
    };
    let (stretch, tough) = tests.split_at(cells.len());
    let slopes = |of: fn(&Test) -> f64| [slope(stretch, of), slope(tough, of)];
    let slopes_largest = slopes(|test| test.force_largest_n);
    let slopes_mean = slopes(|test| test.force_mean_n);
    Ok(Some(Study {
        stretch_n_per_m: k,
        conclusion: conclude(stretch, tough, slopes_largest),
        tests,
        slopes_largest,
        slopes_mean,
    }))
}

/// The largest relative difference at which the forces of a first tear agree.
pub const AGREEMENT: f64 = 0.05;

fn conclude(stretch: &[Test], tough: &[Test], slopes: [f64; 2]) -> String {
    let forces = |tests: &[Test]| {
        let forces = tests.iter();
        let forces = forces.map(|test| format!("{:.3}", test.force_largest_n));
        forces.collect::<Vec<_>>().join(" / ")
    };
    let is_checked = stretch.iter().any(|test| !test.first.is_empty());
    let spreads = stretch.iter().chain(tough).map(|test| spread(&test.first));
    let agree = spreads
        .clone()
        .filter(|&spread| spread <= AGREEMENT)
        .count();
    let words = format!(
        "By the paper's stretch ratio a finer mesh tears more easily: the largest force is {} N, \
         slope {:+.2} over the edge length. By toughness it is {} N, slope {:+.2}: where forces \
         matter, use --toughness.",
        forces(stretch),
        slopes[0],
        forces(tough),
        slopes[1],
    );
    if !is_checked {
        return words;
    }
    format!(
        "{words} At the first tear, forces by Verlet and by XPBD, each at Δt and Δt/2, are within \
         {:.0} % of each other in {agree} of {} tests, {:.1} % apart at most.",
        100.0 * AGREEMENT,
        stretch.len() + tough.len(),
        100.0 * spreads.fold(0.0, f64::max),
    )
}

/// The slope of the straight line through the logarithms, by least squares.
fn slope(tests: &[Test], of: impl Fn(&Test) -> f64) -> f64 {
    let count = tests.len() as f64;
    let points = || tests.iter().map(|test| (test.edge_m.ln(), of(test).ln()));
    let mean_x = points().map(|(x, _)| x).sum::<f64>() / count;
    let mean_y = points().map(|(_, y)| y).sum::<f64>() / count;
    let above: f64 = points().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
    let below: f64 = points().map(|(x, _)| (x - mean_x) * (x - mean_x)).sum();
    above / below
}

/// Tears one strip.
fn test(
    cells: u32,
    threshold: Threshold,
    is_checked: bool,
    stop: &dyn Fn() -> bool,
) -> Result<Test, StudyError> {
    if stop() {
        return Err(StudyError::Stopped);
    }
    let (mesh, positions) = strip(cells).ok_or(StudyError::Strip)?;
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = Scene {
        tearing: Some(Tearing {
            weakening: Some(TIP),
            ..Tearing::new(threshold)
        }),
        ..Scene::trouser(&frame)
    };
    let pulled = |scene: &Scene| {
        let run = Run::new(mesh.clone(), &positions, scene.clone(), &frame);
        Ok(Pulled {
            run: run.map_err(StudyError::Run)?,
            depth: frame.depth.vector(),
        })
    };
    let first = if is_checked {
        first::first_tears(pulled, &scene, stop)?
    } else {
        Vec::new()
    };
    let mut pulled = pulled(&scene)?;
    let every = (pulled.run.steps_planned() / SAMPLES).max(1);
    let (mut curve, mut forces) = (Vec::new(), Vec::new());
    // The steps of the first tear and of the last.
    let mut torn: Option<[usize; 2]> = None;
    while !pulled.run.is_over() {
        if stop() {
            return Err(StudyError::Stopped);
        }
        let splits = pulled.run.tally().splits;
        forces.push(pulled.step()?);
        if pulled.run.tally().splits > splits {
            let last = forces.len();
            torn = Some([torn.map_or(last - 1, |[first, _]| first), last]);
        }
        if pulled.run.tally().steps % every == 0 {
            let recent = &forces[forces.len() - every as usize..];
            curve.push([pulled.apart_m(), mean(recent)]);
        }
    }
    let tearing = torn.map_or(&forces[..0], |[first, last]| &forces[first..last]);
    Ok(Test {
        rule: match threshold {
            Threshold::Stretch(_) => "stretch".to_owned(),
            _ => "toughness".to_owned(),
        },
        threshold: match threshold {
            Threshold::Stretch(x) | Threshold::Toughness(x) => x,
            _ => f64::NAN,
        },
        edge_m: STRIP_M[0] / f64::from(cells),
        cells,
        splits: pulled.run.tally().splits,
        force_largest_n: curve.iter().map(|[_, force]| *force).fold(0.0, f64::max),
        force_mean_n: mean(tearing),
        first,
        curve,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pool::workers;

    fn made(cells: &[u32], is_checked: bool) -> Study {
        let study = study(cells, is_checked, workers(), &|| false, |_| {});
        study.expect("no bug").expect("nobody stopped it")
    }

    fn whole(cells: &[u32]) -> Study {
        made(cells, false)
    }

    fn charted(study: &Study) -> Chart {
        Chart::new(Provenance::default(), study.clone(), Vec::new())
    }

    fn drawn(study: &Study) -> Option<String> {
        svg(&charted(study))
    }

    #[test]
    fn the_stretch_ratio_depends_on_the_mesh_and_toughness_hardly() {
        // Far apart, since each force is that of one tear, which takes its own way. The coarsest strip
        // tears in a handful of splits, and its mean force is nearly its largest.
        let study = whole(&[8, 24]);
        let slopes = [(study.slopes_largest, 1.2), (study.slopes_mean, 2.0)];
        for ([stretch, toughness], most) in slopes {
            assert!((0.6..most).contains(&stretch), "{stretch}");
            assert!(
                toughness.abs() < 0.6 && toughness < stretch - 0.3,
                "{toughness}"
            );
        }
        for test in &study.tests {
            assert!(test.splits > 3 && test.force_mean_n > 0.0);
            assert!(test.force_mean_n < test.force_largest_n);
        }
        assert!(study.conclusion.contains("--toughness"));
    }

    #[test]
    fn the_chart_and_the_table_say_what_the_study_says_and_always_the_same() {
        let study = whole(&[4, 8]);
        let (chart, table) = (drawn(&study).expect("a chart"), csv(&charted(&study)));
        let again = whole(&[4, 8]);
        assert_eq!(Some(&chart), drawn(&again).as_ref());
        assert_eq!(table, csv(&charted(&again)));
        assert!(chart.starts_with("<svg ") && chart.contains("slope"));
        let points: usize = study.tests.iter().map(|test| test.curve.len() + 2).sum();
        assert_eq!(table.lines().count(), 1 + points);
        let largest = format!("{}", study.tests[0].force_largest_n);
        assert!(
            table
                .lines()
                .nth(1)
                .is_some_and(|line| line.ends_with(&largest))
        );
    }

    #[test]
    fn strips_tear_first_at_the_same_force_by_methods_that_share_no_force() {
        let study = made(&[8, 12], true);
        for test in &study.tests {
            let [verlet, half, xpbd, fine] = &test.first[..] else {
                panic!("{:?}", test.first);
            };
            let by = [verlet, half, xpbd, fine].map(|tear| (&tear.method, tear.force_n));
            assert_eq!([&verlet.method, &xpbd.method], ["verlet", "xpbd"]);
            assert_eq!([half.dt_s, fine.dt_s], [verlet.dt_s / 2.0; 2]);
            assert!(spread(&test.first) < AGREEMENT, "{:?}", test.first);
            assert!(verlet.force_n > 0.5 * test.force_mean_n, "{by:?}");
        }
        assert!(
            study.conclusion.contains("in 4 of 4 tests"),
            "{}",
            study.conclusion
        );
        assert!(csv(&charted(&study)).contains(",first xpbd @"));
    }

    #[test]
    fn a_study_can_be_stopped() {
        let stopped = study(&[4, 6], true, workers(), &|| true, |_| {});
        assert!(stopped.expect("no bug").is_none());
    }
}
