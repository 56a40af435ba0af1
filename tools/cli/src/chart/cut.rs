//! `chart cut`: what cuts take, and how far their seams are off.

use std::num::NonZero;
use std::path::Path;
use std::time::Duration;

use cpu_time::ThreadTime;
use indicatif::ProgressDrawTarget;
use tearmesh_lab::Provenance;
use tearmesh_lab::cut::{self, Options, Rival, Study};
use tearmesh_lab::parts::Missing;

use super::experiment::{self, Experiment, Stop, Watch, list};
use super::files::{Ended, some_time};
use crate::args::CutChartArgs;
use crate::exit::Exit;
use crate::input::cannot_read;
use crate::say::Fault;
use crate::streams::Streams;

/// A cut of a face, with all that is measured of it, took so many seconds on the machine that charts were
/// first made on.
const FACE_S: f64 = 2e-6;

pub(super) fn work(
    args: &CutChartArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let cuts = Cuts {
        options: Options {
            cells: args.size.clone(),
            cuts: args.cuts,
            // Times of cuts beside each other are those of a memory that both wait for.
            threads: NonZero::<usize>::MIN,
        },
        rivals: args.record.as_deref().map(read).transpose()?,
    };
    experiment::work(&cuts, &args.draw, target, streams)
}

struct Cuts {
    options: Options,
    /// The rows of a record, if there is one.
    rivals: Option<Vec<Rival>>,
}

impl Experiment for Cuts {
    type Study = Study;

    fn is_timed(&self) -> bool {
        true
    }

    fn command(&self) -> String {
        let record = match self.rivals {
            Some(_) => " --record …",
            None => "",
        };
        format!(
            "tearmesh chart cut --size {} --cuts {}{record}",
            list(&self.options.cells),
            self.options.cuts
        )
    }

    fn expected(&self) -> String {
        let sizes = &self.options.cells;
        let cuts = cut::cuts(&self.options);
        let faces: f64 = sizes.iter().map(|&n| 2.0 * f64::from(n).powi(2)).sum();
        let each = cuts as f64 / sizes.len() as f64;
        format!("{cuts} cuts, some {}", some_time(FACE_S * faces * each))
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        let rivals = self.rivals.clone().unwrap_or_default();
        let clock = || -> Duration { ThreadTime::now().as_duration() };
        let cuts = cut::cuts(&self.options) as f64;
        let mut done = 0.0;
        let heard = |name: &str| {
            done += 1.0;
            watch(name, done / cuts);
        };
        let study = cut::study(&self.options, provenance, rivals, Some(&clock), stop, heard);
        Ok(study)
    }

    fn svg(study: &Study) -> Option<String> {
        cut::svg(study)
    }

    fn csv(study: &Study) -> String {
        cut::csv(study)
    }

    fn summary(study: &Study) -> String {
        cut::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
}

/// The rows of a record.
fn read(path: &Path) -> Ended<Vec<Rival>> {
    let name = path.display().to_string();
    let text = std::fs::read_to_string(path);
    let text = text.map_err(|error| (Exit::Input, cannot_read(&name, &error)))?;
    cut::rivals(&text).map_err(|error| {
        let message = format!("{name} is no record of cuts: {error}");
        let help = "one that `tearmesh-bench cut` wrote, as in tools/bench/record";
        (
            Exit::Input,
            Fault::error("E-CHART-RECORD", message).help(help),
        )
    })
}
