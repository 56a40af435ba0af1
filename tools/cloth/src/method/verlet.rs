//! Velocity Verlet: the method that is exact at rest, with two guards.
//!
//! One force evaluation a step, and nothing that depends on the order of storage: where forces
//! vanish nothing moves, so the strains of a cloth at rest are those of its fabric at every step.
//! Two things make velocity Verlet unfit for cloth as it stands in textbooks, and each has a guard:
//!
//! * One light particle shortens the stable step of all. It is *carried* by its neighbours
//!   ([`mass_scaling`](crate::system::mass_scaling)), and the step that suits most particles serves all
//!   ([`recommended_step_s`](crate::recommended_step_s)).
//! * Crushed springs make energy below every limit. They are damped ([`crush`](crate::system::crush)).
//!
//! Where nothing is carried and nothing is crushed, the guards change no bit.
//!
//! What chose it as the default is made by a test (`tests/cloth/defaults/table.rs`): sheets of 10 × 10
//! cells with diagonals at random that hang by their top edge under 400 m/s², each step with three
//! orders of storage. How far the largest strain, the 99th percentile and the rms over loaded edges
//! are off at rest, in per cent, worst of the orders; and the largest energy of the sheet crushed to
//! half, as a multiple of what it had. Steps are parts of h/c, the time in which a pull travels an
//! edge; the one that suits is .36 (even), .31 (uneven: vertices moved by up to .45 of a cell) and .36
//! (sliver: a vertex of a hundredth of its mass). A dash says that it blew up.
//!
//! ```text
//!                       even                  uneven                sliver
//!                step   largest 99 % rms  E   largest 99 % rms  E   largest 99 % rms   E
//! XPBD            .25      7   28  12   .91     14   33  14   .85     81   65  33    .90
//!                 .5      43  101  46   .74     56  117  53   .63    169  152  70    .73
//!                1       212  346 172   .63    224  401 197   .54    382  476 204    .61
//!                2       841 1246 622   .69    856 1489 703   .52   1060 1616 687    .69
//! two sweeps      .25     .2    3  .7   .91     .1    3   1   .85     36   47  20    .89
//!                 .5       3   27   9   .69      6   34  13   .58    101   79  36    .69
//!                1        57  137  62   .39     74  163  73   .35    208  197  88    .39
//!                2       360  561 283   .34    370  669 327   .30    572  773 325    .36
//! four sweeps     .25     .0   .1  .0   .91     .1   .2  .1   .85      2   30  12    .89
//!                 .5      .0    2  .7   .69     .2    5   2   .58     65   65  27    .69
//!                1         4   48  16   .36     11   56  22   .29    123   87  44    .36
//!                2       124  232 112   .22    141  293 132   .17    303  340 143    .24
//! no guards       .25     .0   .0  .0  4.6      .0   .0  .0  10.7     –    –   –    –
//!                 .5      .0   .0  .0   –       –    –   –    –       –    –   –    –
//!                1        –    –   –    –       –    –   –    –       –    –   –    –
//! Verlet          .25     .0   .0  .0   .99     .0   .0  .0   .99     .0   .0  .0    .99
//!                 .5      .0   .0  .0   .90     .0   .0  .0   .83     .0   .0  .0    .90
//!                1        .0   .0  .0   .78     .0   .0  .0   .73     .0   .0  .0    .77
//!                2        –    –   –    –       –    –   –    –       –    –   –    –
//! ```
//!
//! The last row is unwatched: a step of more than twice the one that suits is divided. A step costs
//! .85 of one of XPBD with one sweep where little is carried, and 1.1 where most is.
//!
//! Without guards the middle of three particles between two nails, pushed aside by a thousandth
//! at nine tenths of the bound, has 150 times its energy, and a sheet crushed to half 2.7 to 5.1
//! times at half the limit; with the guards both keep what they have. So no step has to be redone
//! with shorter ones.

use crate::method::draw::Acts;
use crate::method::motion::{kick, kick_and_drift};
use crate::method::solver::{Abilities, Failure, Quality, Solver};
use crate::method::stability::weigh_for;
use crate::system::System;
use crate::system::collide;
use crate::system::force::{accelerate, accelerate_edited};

/// Velocity Verlet, of second order and symplectic without drag; one force evaluation a step.
///
/// Particles that are too light for the step are carried by their neighbours, and constraints
/// shorter than nine tenths of their rest length are damped. So it is stable at steps of up to twice
/// [`recommended_step_s`](crate::recommended_step_s) in every configuration, and exact at rest; for
/// wind alone it is stable up to λ Δt = 1 ([`air_rate`](crate::air::air_rate)). In motion the guards
/// make light particles swing more slowly about their neighbours; at half the recommended step or less
/// hardly any particle is carried.
///
/// Drag is applied in a backward and a forward half step, and wind by a prediction of the
/// velocities at which it acts: both keep the second order. Contact is of first order.
///
/// ```
/// use tearmesh::Point;
/// use tearmesh_cloth::{System, Verlet, energy};
///
/// // A particle between two nails, all but crushed.
/// let points = [-0.5, 0.0, 0.5].map(|x| Point::new(x, if x == 0.0 { 0.001 } else { 0.0 }, 0.0));
/// let mut system = System::new(points, vec![1.0; 3])?;
/// for ends in [[0, 1], [1, 2]] {
///     system.stretch(ends, 1.0, 100.0)?;
/// }
/// [0, 2].map(|end| system.hold(end));
/// let before = energy::elastic_j(&system);
/// let mut verlet = Verlet;
/// for _ in 0..1000 {
///     system.step(&mut verlet, 0.13)?;
///     assert!(energy::kinetic_j(&system) + energy::elastic_j(&system) < 1.05 * before);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Verlet;

impl Solver for Verlet {
    /// Returns the abilities of the method. With wind at predicted velocities, z² − (1 − 3μ/2) z −
    /// μ/2 has the root −1 at μ = λΔt = 1.
    fn abilities(&self) -> Abilities {
        Abilities {
            carries_light: true,
            damps: true,
            ..Abilities::of_forces(Some(2.0), 1.0)
        }
    }

    fn advance(&mut self, system: &mut System, dt_s: f64) -> Result<(), Failure> {
        let half_s = dt_s / 2.0;
        weigh_for(system, dt_s);
        let is_fresh = is_fresh(system, dt_s);
        if is_fresh {
            // Where forces are taken anew, none draws in this half.
            let draws = |particle| !system.guard.unheeded.contains(particle);
            let owed = system.scratch.owed.iter();
            let owed_j = owed.filter(|(particle, _)| draws(*particle as usize));
            system.drawn_j += owed_j.map(|(_, joules)| joules).sum::<f64>();
            accelerate_edited(system, dt_s);
        }
        let began_sane = is_fresh || accelerate(system, false, Some(dt_s));
        let before_w = system.scratch.damped_w;
        kick_and_drift(system, half_s, dt_s);
        // Forces are then those of where the step ends, and serve the next one.
        system.scratch.impulses.is_halfway = true;
        collide::move_out(system, 1.0 / dt_s);
        system.scratch.impulses.is_halfway = false;
        // The velocities at the end of the step, at which wind blows, as far as they are known in its
        // middle: by the accelerations at its beginning. They err by O(Δt²), and so the step by O(Δt³),
        // as without wind. (Those of the middle err by O(Δt).)
        let blows = system.model.loads.wind.is_some();
        if blows {
            let scratch = &mut system.scratch;
            scratch.predicted.clone_from(&system.velocities);
            let predicted = &mut scratch.predicted;
            kick(&system.model, &scratch.accelerations, half_s, predicted);
        }
        let is_sane = accelerate(system, blows, Some(dt_s));
        system.draw(dt_s, Acts::Evenly);
        let accelerations = &system.scratch.accelerations;
        kick(&system.model, accelerations, half_s, &mut system.velocities);
        system.scratch.is_fresh = true;
        system.damped_j += half_s * (before_w + system.scratch.damped_w);
        Failure::unless(began_sane && is_sane)
    }

    fn quality(&self, system: &System) -> Quality {
        let (carry, model) = (&system.guard.carry, &system.model);
        Quality::Carried {
            carried: carry.len(),
            mass_ratio_max: carry.mass_ratio_max.max(1.0),
            damping_capped: model.stretch.damping_capped(model.damping_s),
        }
    }
}

/// Whether the last accelerations of the step before are those of now: unless something has changed
/// in between, or the guards are those of another step.
fn is_fresh(system: &System, dt_s: f64) -> bool {
    let had_s = system.scratch.guarded_s;
    let differs = had_s != dt_s && (had_s > 0.0 || system.guard.carry.len() > 0);
    system.scratch.is_fresh && !differs
}
