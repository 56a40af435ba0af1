//! The page of a simulation: 30 moments a second, and plots over time.

use tearmesh::geometry::length;
use tearmesh_cloth::scene::{HoldForces, Run, TearLog};
use tearmesh_cloth::{Collider, ColliderShape};
use tearmesh_view::{Moment, Page};

use super::frames::{RATE_PER_S, places};
use crate::exit::Stop;
use crate::page;
use crate::picture::no_camera;

/// The page of a run, as far as it is recorded.
pub(super) struct Recorder {
    page: Page,
    /// The bodies and balls that are drawn.
    solids: Vec<Collider>,
    /// The largest stretch of each moment.
    stretch: Vec<[f64; 2]>,
}

impl Recorder {
    pub(super) fn new(title: &str, up: tearmesh::Vector, colliders: &[Collider]) -> Recorder {
        let mut page = Page::new(title, up);
        let is_solid = |one: &&Collider| !matches!(one.shape, ColliderShape::Plane(_));
        let solids: Vec<Collider> = colliders.iter().filter(is_solid).cloned().collect();
        for (points, faces) in solids.iter().map(Collider::surface) {
            page.add_solid(points, &faces);
        }
        Recorder {
            page,
            solids,
            stretch: Vec::new(),
        }
    }

    /// Records a moment if it is time for one.
    pub(super) fn record(&mut self, run: &Run) -> Result<(), Stop> {
        let due = (self.stretch.len() as f64 / RATE_PER_S / run.step_s()).round();
        match (run.tally().steps as f64) < due {
            true => Ok(()),
            false => self.take(run),
        }
    }

    fn take(&mut self, run: &Run) -> Result<(), Stop> {
        let placing = |solid: &Collider| solid.pose(run.elapsed_s()).matrix();
        let moment = Moment {
            placings: self.solids.iter().map(placing).collect(),
            time_s: Some(run.elapsed_s()),
            torn_at_rest_m: Some(run.torn_length_m()),
            ..Moment::default()
        };
        let added = self.page.add(run.mesh(), &places(run)?, moment);
        added.map_err(no_camera)?;
        self.stretch.push([run.elapsed_s(), largest_stretch(run)]);
        Ok(())
    }

    /// Takes the end, which was written into the file of this name, and gives the page.
    pub(super) fn finish(
        mut self,
        run: &Run,
        tear_log: &TearLog,
        name: Option<&str>,
        facts: &[(&str, String)],
    ) -> Result<Page, Stop> {
        let last_s = self.stretch.last().map(|&[time_s, _]| time_s);
        if last_s != Some(run.elapsed_s()) {
            self.take(run)?;
        }
        let last = self.page.last_mut().expect("the beginning was taken");
        last.cut = name.map(|name| page::cut_line(name, ""));
        if name.is_some() {
            last.label = page::title(name);
        }
        for (name, what) in facts {
            self.page.tell(*name, what);
        }
        let lines = [(String::new(), self.stretch)];
        self.page
            .plot("largest stretch", "of the length at rest", &lines);
        let frames = tear_log.hold_forces();
        let holds = frames.first().map_or(0, |frame| frame.forces_n.len());
        let line = |hold: usize| {
            let force = |frame: &HoldForces| [frame.end_s, length(frame.forces_n[hold])];
            let points = frames.iter().map(force).collect();
            (format!("hold {}", hold + 1), points)
        };
        if holds > 0 {
            let lines: Vec<_> = (0..holds.min(LINES)).map(line).collect();
            self.page.plot("force at holds", "N", &lines);
        }
        Ok(self.page)
    }
}

/// How many holds have a line at most: more cannot be told apart.
const LINES: usize = 4;

/// The largest ratio of an edge's length to its length at rest.
fn largest_stretch(run: &Run) -> f64 {
    let cloth = run.cloth();
    let ratio = |h| cloth.system().stretch_ratio(cloth.stretch(h));
    let ratios = run.mesh().edges().map(ratio).filter(|x| x.is_finite());
    ratios.fold(0.0, f64::max)
}
