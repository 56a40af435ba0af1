//! The moment of a run whose picture is drawn.

use tearmesh::{Mesh, Point};
use tearmesh_cloth::scene::Run;

use super::frames::RATE_PER_S;
use crate::picture::Texture;

/// A moment, kept until the run is over: the one that was asked for, or the end of the frame in which most
/// vertices were split by tearing, or by cuts if nothing tore. What is torn hangs beside its counterpart then; later it has often fallen out of
/// sight.
#[derive(Default)]
pub(super) struct Still {
    at_s: Option<f64>,
    kept: Option<(Mesh, Vec<Point>, Texture, f64)>,
    /// Up to date with the run.
    pub(super) texture: Texture,
    /// The most splits of a frame so far, by tearing and by cuts, and all splits before this frame.
    most: [u64; 2],
    before: [u64; 2],
    cut_splits: u64,
    frames: u64,
}

impl Still {
    pub(super) fn new(at_s: Option<f64>, texture: Texture) -> Still {
        Still {
            at_s,
            texture,
            ..Still::default()
        }
    }

    /// Looks at a run after a step.
    pub(super) fn record(&mut self, run: &Run) {
        let cuts = run.cuts_made().iter().map(|cut| cut.splits as u64);
        self.cut_splits += cuts.sum::<u64>();
        let now_s = run.elapsed_s();
        if let Some(at_s) = self.at_s {
            if self.kept.is_none() && now_s >= at_s {
                self.keep(run);
            }
            return;
        }
        if now_s * RATE_PER_S < (self.frames + 1) as f64 {
            return;
        }
        self.frames += 1;
        let splits = [run.tally().splits, self.cut_splits];
        let now = [0, 1].map(|kind| splits[kind] - self.before[kind]);
        if now > self.most {
            self.most = now;
            self.keep(run);
        }
        self.before = splits;
    }

    fn keep(&mut self, run: &Run) {
        let points = run.cloth().positions().to_vec();
        let (mesh, texture) = (run.mesh().clone(), self.texture.clone());
        self.kept = Some((mesh, points, texture, run.elapsed_s()));
    }

    /// The moment, or the end.
    pub(super) fn shown<'s>(
        &'s self,
        (mesh, points): (&'s Mesh, &'s [Point]),
        end_s: f64,
    ) -> ((&'s Mesh, &'s [Point], &'s Texture), f64) {
        match &self.kept {
            Some((mesh, points, texture, time_s)) => ((mesh, points, texture), *time_s),
            None => ((mesh, points, &self.texture), end_s),
        }
    }
}
