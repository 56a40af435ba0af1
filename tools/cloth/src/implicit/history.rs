//! What BDF2 remembers of the last step.

use tearmesh::geometry::{Point, Vector};

use crate::moment::Moment;

/// What the particles of a system did in the last step.
#[derive(Clone, Debug, Default)]
pub(super) struct History {
    /// The substep that it tells of, if that was taken.
    left: Moment,
    /// x₀ − x₋₁ and v₀ − v₋₁ as the step left them.
    moved: Vec<Vector>,
    sped: Vec<Vector>,
    /// v₀ as the step left it.
    velocities: Vec<Vector>,
    time_step_s: f64,
}

impl History {
    /// Tells of nothing any more.
    pub(super) fn forget(&mut self) {
        self.left = Moment::Unknown;
    }

    /// Whether it tells how the system came to the state after this substep.
    pub(super) fn leads_to(&self, moment: Moment) -> bool {
        moment != Moment::Unknown && moment == self.left
    }

    /// Whether it tells of anything.
    pub(super) fn is_known(&self) -> bool {
        self.left != Moment::Unknown
    }

    /// The length of a step of `time_step_s` seconds as a multiple of the last step.
    pub(super) fn ratio(&self, time_step_s: f64) -> f64 {
        time_step_s / self.time_step_s
    }

    /// Notes a step from here to there, which counts once it is [taken](History::leave).
    pub(super) fn note(
        &mut self,
        from: (&[Point], &[Vector]),
        to: (&[Point], &[Vector]),
        time_step_s: f64,
    ) {
        self.moved.clear();
        self.moved
            .extend(to.0.iter().zip(from.0).map(|(x, old)| x - old));
        self.sped.clear();
        self.sped
            .extend(to.1.iter().zip(from.1).map(|(v, old)| v - old));
        self.velocities.clear();
        self.velocities.extend_from_slice(to.1);
        self.time_step_s = time_step_s;
        self.left = Moment::Unknown;
    }

    /// The step that was noted last is this substep of its system.
    pub(super) fn leave(&mut self, moment: Moment) {
        self.left = moment;
    }

    /// x₀ − x₋₁ and v₀ − v₋₁ for a particle whose velocity is now `v`.
    pub(super) fn of(&self, i: usize, v: Vector) -> [Vector; 2] {
        let pushed = v - self.velocities[i];
        [self.moved[i] + pushed * self.time_step_s, self.sped[i]]
    }

    /// Where the particles will be after a step, and how fast, by going on as in the last: exact to
    /// O(Δt²).
    pub(super) fn foresee(
        &self,
        (x, v): (&[Point], &[Vector]),
        inverse_masses: &[f64],
        time_step_s: f64,
        (positions, velocities): (&mut Vec<Point>, &mut Vec<Vector>),
    ) {
        let ratio = self.ratio(time_step_s);
        positions.clear();
        velocities.clear();
        for (i, (&x, &v)) in x.iter().zip(v).enumerate() {
            let [moved, sped] = if inverse_masses[i] > 0.0 {
                self.of(i, v).map(|change| change * ratio)
            } else {
                [v * time_step_s, Vector::zeros()]
            };
            positions.push(x + moved);
            velocities.push(v + sped);
        }
    }
}
