//! `chart fig7`: what splitting vertices takes.

use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::Provenance;
use tearmesh_lab::fig7::{self, Study};
use tearmesh_lab::parts::Missing;

use super::experiment::{self, Experiment, Stop, Watch, list};
use super::files::{Ended, bug, some_time};
use crate::args::Fig7Args;
use crate::exit::Exit;
use crate::streams::Streams;

/// The seconds that a rip with one cell per side would take, as measured on the machine on which
/// charts were first made. A rip with n cells per side has n² cells, and steps n times as short.
const CELL_S: f64 = 3e-5;

pub(super) fn work(
    args: &Fig7Args,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let cells = args.size.clone();
    experiment::work(&Fig7 { cells }, &args.draw, target, streams)
}

struct Fig7 {
    cells: Vec<u32>,
}

impl Fig7 {
    /// What rips cost beside each other.
    fn costs(&self) -> Vec<f64> {
        self.cells.iter().map(|&n| f64::from(n).powi(3)).collect()
    }
}

impl Experiment for Fig7 {
    type Study = Study;

    fn is_timed(&self) -> bool {
        true
    }

    fn command(&self) -> String {
        format!("tearmesh chart fig7 --size {}", list(&self.cells))
    }

    fn expected(&self) -> String {
        let about = some_time(CELL_S * self.costs().iter().sum::<f64>());
        format!("{} rips, some {about}", self.cells.len())
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        let costs = self.costs();
        let whole: f64 = costs.iter().sum();
        let clock = || -> Duration { ThreadTime::now().as_duration() };
        let heard = |rip: usize, part: f64| {
            let before: f64 = costs[..rip].iter().sum();
            let name = format!("{} cells", self.cells[rip]);
            watch(&name, (before + part * costs[rip]) / whole);
            !stop()
        };
        let study = fig7::study(&self.cells, fig7::ROUNDS, provenance, &clock, heard);
        study.map_err(|error| bug(error.to_string()))
    }

    fn svg(study: &Study) -> Option<String> {
        fig7::svg(study)
    }

    fn csv(study: &Study) -> String {
        fig7::csv(study)
    }

    fn summary(study: &Study) -> String {
        study.conclusion.clone()
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
}
