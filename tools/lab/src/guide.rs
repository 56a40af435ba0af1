//! The page that answers which method to use for which scene.
//!
//! The ready scenes are played by every method at its default, and with a step four times and twice as long and
//! half as long (a flag not half as long). The cost is CPU time per simulated second. The error is that of what the
//! scene is about (`Topic`): the shape at rest of a sheet that hangs by two corners, the mean place and the spread
//! of the free corner of a flag, and the time and the force of the first tear of a rip and of a trouser test. What
//! follows the first tear is chaotic, so for that there are distributions over many seeds and no error.
//!
//! Errors are relative to a reference on the same mesh. A second reference, by a method that shares no stepping
//! code, gives the *error floor*: no error below ten times their distance is told from zero. The *mesh error* is
//! that of the first reference or of Verlet's method on meshes with other diagonals: nothing below it is worth
//! paying for. The gate of [`pareto`](crate::pareto) is run on each mesh.

mod chart;
mod play;

pub(crate) use self::play::{Role, Row, Topic};

use std::ops::RangeInclusive;

use self::play::{NEWTON, Stage, error};
use crate::experiment::{Bounds, Experiment, Status};
use crate::method::{DEFAULT, DEFAULTS};
use crate::pareto::AMPLIFICATION_MAX;
use crate::statistics::median;

/// The multiples of its default step that each method is played with, beside the default.
pub(crate) const STEP_MULTIPLES: [f64; 3] = [4.0, 2.0, 0.5];

/// The difference between the seeds of references and those of methods.
const REFERENCE_SEEDS: u64 = 1000;

/// The experiment behind the page.
#[derive(Debug)]
pub struct Guide {
    /// The number of seeds of ensembles of a flag.
    seeds: u64,
    stages: Vec<Stage>,
}

impl Guide {
    /// Creates the experiment: on meshes with this many cells along their longest side, with this many seeds of
    /// ensembles of a flag (torn lengths take half of them), and this many meshes with other diagonals.
    ///
    /// What is dear or only context takes a quarter of the seeds, and at least two: half of the cells, steps other
    /// than the default, and the second reference. Other diagonals take two each.
    ///
    /// # Panics
    ///
    /// If the number of cells is less than 8 or more than a mesh can have.
    #[must_use]
    pub fn new(cells: u32, seeds: u64, diagonals: u64) -> Guide {
        assert!(cells >= 8, "at least 8 cells along a side");
        let mut stages = Vec::new();
        for topic in Topic::ALL {
            // Half of the cells only where there is a curve.
            if topic != Topic::Aftermath {
                stages.push(Stage::new(topic, cells / 2, 1));
            }
            let all = (1..=diagonals).map(|seed| Stage::new(topic, cells, seed));
            stages.extend(all);
        }
        Guide { seeds, stages }
    }

    fn stage(&self, key: &Row) -> &Stage {
        let is_it = |stage: &&Stage| {
            (stage.topic, stage.cells, stage.diagonals) == (key.topic, key.cells, key.diagonals)
        };
        let stage = self.stages.iter().find(is_it);
        stage.expect("the key is one of the plan")
    }

    /// The keys of a stage: all roles on the first mesh of a topic, and one on its other meshes.
    fn keys(&self, stage: &Stage) -> Vec<Row> {
        let topic = stage.topic;
        let seeds = match topic {
            Topic::Flag => self.seeds,
            Topic::Aftermath => (self.seeds / 2).max(2),
            Topic::Hang | Topic::Rip | Topic::Trouser => 0,
        };
        // Without an ensemble there is one run without noise.
        let (first, few) = (seeds.min(1), seeds.min((seeds / 4).max(2)));
        let mut keys = Vec::new();
        let mut add = |role, method: &str, step_multiple, seeds: RangeInclusive<u64>| {
            keys.extend(seeds.map(|seed| Row {
                topic,
                cells: stage.cells,
                diagonals: stage.diagonals,
                role,
                method: method.to_owned(),
                step_multiple,
                seed,
                ..Row::default()
            }));
        };
        if stage.diagonals > 1 {
            add(Role::Mesh, DEFAULT, None, first..=few.min(2));
            return keys;
        }
        let is_finest = stage.cells == self.stages.last().map_or(0, |stage| stage.cells);
        let seeds = if is_finest { seeds } else { few };
        let mut multiples = vec![None];
        if topic != Topic::Aftermath {
            // Seeds of its own, as the same runs would have no error.
            let own = first * REFERENCE_SEEDS;
            add(Role::Reference, DEFAULT, None, own + first..=own + seeds);
            add(Role::Second, NEWTON, None, own + first..=own + few);
            add(Role::Gate, DEFAULT, None, 0..=1);
            // The error of a flag is chance, which no shorter step changes.
            let worth = STEP_MULTIPLES.into_iter();
            let worth = worth.filter(|multiple| topic != Topic::Flag || *multiple > 1.0);
            multiples.extend(worth.map(Some));
        }
        for method in &DEFAULTS {
            for &multiple in &multiples {
                let seeds = multiple.map_or(seeds, |_| few);
                add(Role::Method, method.name, multiple, first..=seeds);
            }
        }
        keys
    }
}

impl Experiment for Guide {
    type Row = Row;

    const IS_TIMED: bool = true;

    fn plan(&self) -> Vec<Vec<Row>> {
        let group = |stage: &Stage| (stage.topic, stage.cells);
        let groups = self.stages.chunk_by(|a, b| group(a) == group(b));
        let keys = |of: &[Stage]| of.iter().flat_map(|stage| self.keys(stage)).collect();
        groups.map(keys).collect()
    }

    fn guess_s(&self, key: &Row) -> f64 {
        self.stage(key).guess_s(key)
    }

    fn run(&self, key: &Row, bounds: &Bounds<'_>) -> Option<Vec<Row>> {
        let mut row = key.clone();
        let end = self.stage(key).measure(&mut row, bounds).err();
        (row.status, row.why) = end.unwrap_or((Status::Ok, String::new()));
        (row.status != Status::Interrupted).then(|| vec![row])
    }

    fn assessed(&self, mut rows: Vec<Row>) -> Vec<Row> {
        let of = |role| -> Vec<&Row> { rows.iter().filter(|row| row.role == role).collect() };
        let (mut known, second) = (of(Role::Reference), of(Role::Second));
        let (noise_amplification, error_noise) = match of(Role::Gate)[..] {
            [calm, noisy] => (calm.amplification(noisy), error(&[noisy], &[calm])),
            _ => (None, None),
        };
        // Noise bars displacements, and only a shape at rest is judged by them.
        let grows = noise_amplification.is_none_or(|grown| grown > AMPLIFICATION_MAX);
        let is_barred = grows && rows[0].topic == Topic::Hang;
        if second.iter().all(|run| run.answer.is_none()) || is_barred {
            known.clear();
        }
        let error = |ensemble: &[&Row]| error(ensemble, &known);
        let error_floor = error(&second);
        let on_meshes = of(Role::Mesh);
        let on_meshes = on_meshes.chunk_by(|a, b| a.diagonals == b.diagonals);
        let error_mesh = median(on_meshes.filter_map(error).collect());
        let ensembles = rows.chunk_by(|a, b| a.ensemble() == b.ensemble());
        let errors = ensembles.flat_map(|of| {
            let is_method = of[0].role == Role::Method;
            let own = is_method.then(|| error(&of.iter().collect::<Vec<_>>()));
            vec![own.flatten(); of.len()]
        });
        let errors: Vec<Option<f64>> = errors.collect();
        for (row, error) in rows.iter_mut().zip(errors) {
            (row.error, row.error_floor) = (error, error_floor);
            (row.error_mesh, row.error_noise) = (error_mesh, error_noise);
            row.noise_amplification = noise_amplification;
            (row.answer, row.last) = (None, Vec::new());
        }
        rows
    }
}

#[cfg(test)]
mod tests;
