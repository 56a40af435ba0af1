//! `chart plane`: the cheapest method at a fixed error, by stiffness and mass ratio.

use indicatif::ProgressDrawTarget;
use tearmesh_lab::parts::Missing;
use tearmesh_lab::plane::{self, Options, Study};
use tearmesh_lab::{Provenance, pool};

use super::experiment::{Experiment, Parted, Stop, Watch, list, work_in_parts};
use super::files::{Ended, some_time};
use super::parts::Part;
use super::progress::VISIT_S;
use crate::args::PlaneArgs;
use crate::exit::Exit;
use crate::streams::Streams;

pub(super) fn work(
    args: &PlaneArgs,
    target: ProgressDrawTarget,
    streams: &mut Streams<'_>,
) -> Ended<Exit> {
    let plane = Plane(Options {
        stiffness_n_per_m: args.stiffness.clone(),
        mass_ratios: args.ratio.clone(),
        cells: args.size,
        methods: args.method.clone(),
        cost_max: args.cost_max,
        threads: args.threads.unwrap_or_else(pool::workers),
    });
    work_in_parts(&plane, &args.parts, &args.draw, target, streams)
}

struct Plane(Options);

impl Experiment for Plane {
    type Study = Study;

    fn command(&self) -> String {
        command(&self.0)
    }

    fn expected(&self) -> String {
        let (runs, visits) = plane::expected(&self.0);
        let about = some_time(VISIT_S * visits / self.0.threads.get() as f64);
        format!("{runs} runs, some {about}")
    }

    fn study(
        &self,
        provenance: Provenance,
        stop: Stop<'_>,
        watch: Watch<'_>,
    ) -> Ended<Option<Study>> {
        Ok(plane::study(&self.0, provenance, stop, watch))
    }

    fn svg(study: &Study) -> Option<String> {
        plane::svg(study)
    }

    fn csv(study: &Study) -> String {
        plane::csv(study)
    }

    fn summary(study: &Study) -> String {
        plane::summary(study)
    }

    fn missing(study: &Study) -> &[Missing] {
        &study.missing
    }
}

/// A part is a place of the plane.
impl Parted for Plane {
    fn parts(&self) -> Vec<Part> {
        let options = &self.0;
        let places = options.stiffness_n_per_m.iter();
        let places = places.flat_map(|&k| options.mass_ratios.iter().map(move |&ratio| (k, ratio)));
        let part = |(k, ratio): (f64, f64)| {
            let alone = Options {
                stiffness_n_per_m: vec![k],
                mass_ratios: vec![ratio],
                ..options.clone()
            };
            Part {
                name: plane::place_name(k, ratio),
                command: command(&alone),
            }
        };
        places.map(part).collect()
    }
}

fn command(options: &Options) -> String {
    format!(
        "tearmesh chart plane --stiffness {} --ratio {} --method {} --size {} --cost-max {}",
        list(&options.stiffness_n_per_m),
        list(&options.mass_ratios),
        list(&options.methods),
        options.cells,
        options.cost_max,
    )
}
