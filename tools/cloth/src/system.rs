//! Particles and constraints, with no mesh in sight.
//!
//! A [`System`] is a list of particles and two families of springs between them: *stretch*
//! constraints, and *bend* constraints that reach across something, which may buckle instead; and
//! triangles of particles that resist stretch and shear. A chain, a net or a cloth is one. Units
//! are SI throughout: metres, kilograms, seconds, newtons.

pub mod air;
pub(crate) mod balance;
pub(crate) mod bend;
pub(crate) mod blow_up;
pub(crate) mod body;
pub(crate) mod collide;
pub(crate) mod constraint;
pub(crate) mod contact;
pub(crate) mod counters;
pub(crate) mod crush;
pub(crate) mod damping;
pub(crate) mod drawn;
pub mod energy;
pub(crate) mod error;
pub mod force;
pub(crate) mod guard;
pub(crate) mod incidence;
pub(crate) mod load;
pub(crate) mod mass_scaling;
pub(crate) mod matrix;
pub(crate) mod model;
pub(crate) mod net;
pub(crate) mod pair;
pub(crate) mod path;
pub(crate) mod pull;
pub(crate) mod triangle;

use std::collections::BTreeSet;

use tearmesh::Mix;
use tearmesh::geometry::{Point, Vector, check_point};

use self::bend::Buckling;
use self::constraint::{Constraint, ConstraintId, Constraints};
use self::contact::{Contact, ContactCache, Impulses, Pressed};
use self::counters::Counters;
use self::error::{SettingError, SystemError};
use self::guard::Guard;
use self::incidence::room_for;
use self::load::{Loads, Wind};
use self::mass_scaling::Response;
use self::model::{Model, Recorded};
use self::path::Path;
use self::triangle::Triangle;

/// A mass-spring system: particles, constraints, triangles and loads.
///
/// ```
/// use tearmesh_cloth::{Loads, System, Verlet};
/// use tearmesh::{Point, Vector};
///
/// // A chain of ten springs, without any mesh.
/// let points = (0..11).map(|i| Point::new(0.0, 0.0, -0.1 * f64::from(i)));
/// let mut chain = System::new(points, vec![0.01; 11])?;
/// for i in 0..10 {
///     chain.stretch([i, i + 1], 0.1, 50.0)?;
/// }
/// chain.hold(0);
/// chain.set_loads(Loads {
///     gravity_m_per_s2: Some(Vector::new(0.0, 0.0, -9.81)),
///     drag_per_s: Some(5.0),
///     ..Loads::default()
/// })?;
/// for _ in 0..5000 {
///     chain.step(&mut Verlet, 0.005)?;
/// }
/// // N L + m g N (N + 1) / (2 k)
/// assert!((chain.positions()[10].z + 1.10791).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct System {
    pub(crate) positions: Vec<Point>,
    pub(crate) velocities: Vec<Vector>,
    pub(crate) model: Model,
    pub(crate) counters: Counters,
    pub(crate) guard: Guard,
    pub(crate) scratch: Scratch,
    pub(crate) elapsed_s: f64,
    pub(crate) unstable: Unstable,
    /// What material damping took in all, in joules.
    pub(crate) damped_j: f64,
    /// What it took to draw pairs together in all, in joules.
    pub(crate) drawn_j: f64,
}

/// Room for a step, so that none allocates.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scratch {
    pub(crate) accelerations: Vec<Vector>,
    /// The forces that these are of, without gravity.
    pub(crate) forces: Vec<Vector>,
    /// Whether these are the accelerations now, but for particles that an edit has touched.
    pub(crate) is_fresh: bool,
    /// Whether they are by the weights of now.
    pub(crate) is_weighed: bool,
    /// So many times its rest length no stretch constraint had where these were taken; infinite where that is not
    /// known.
    pub(crate) none_reaches: f64,
    /// The power in watts that damping takes where these are of a guarded step.
    pub(crate) damped_w: f64,
    /// The step in seconds for which they are guarded; zero without guards.
    pub(crate) guarded_s: f64,
    /// The part of a step's limit that wind takes in a second, as a step found it.
    pub(crate) air_per_s: f64,
    /// Whether a step began, and positions and velocities are still those of then.
    pub(crate) is_beginning: bool,
    /// Where the step began, once it is no longer there: the last good state.
    pub(crate) positions: Vec<Point>,
    pub(crate) velocities: Vec<Vector>,
    /// Those who were led where the step began, and their velocities then.
    pub(crate) led: Vec<(u32, Vector)>,
    /// Where the substep began.
    pub(crate) before: Vec<Point>,
    /// The times at which this substep begins and ends.
    pub(crate) span_s: [f64; 2],
    /// The contacts of the last substep, and how the particles were pressed in it, if any were.
    pub(crate) contacts: Vec<Contact>,
    pub(crate) pressed: Vec<Pressed>,
    pub(crate) impulses: Impulses,
    /// How far particles are from bodies.
    pub(crate) contact: ContactCache,
    /// What forces on the two particles of a pair do.
    pub(crate) responses: [Response; 2],
    /// The work of drawing particles in the half of a step that is to come, in joules.
    pub(crate) owed: Vec<(u32, f64)>,
    /// Where a limiter found the particles.
    pub(crate) unlimited: Vec<Point>,
    /// The velocities that wind blows at, where they are predicted.
    pub(crate) predicted: Vec<Vector>,
    /// The area of the faces of each particle, where there is wind.
    pub(crate) areas: Vec<f64>,
}

impl Scratch {
    /// Has everything looked at again for contact, since particles were moved or renamed.
    pub(crate) fn lose_contact(&mut self) {
        self.contact.invalidate();
        self.contacts.clear();
    }
}

/// How a system treats a step beyond the stability limit of an explicit method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Unstable {
    /// Refuses the step with an error that gives the limit, and changes nothing. The limit is that
    /// of the [bound](crate::frequency_bound) of frequencies, which holds in every configuration.
    #[default]
    Refuse,
    /// Divides the step into enough substeps to be stable in every configuration by the linear
    /// theory, and reports their number. Crushed cloth can still gain energy with a method that has
    /// no guards ([`Provot`](crate::Provot)): springs
    /// under compression push sideways, which no bound for small motions captures.
    Substep,
    /// Takes the step. No frequency is computed, but blow-up is still noticed.
    Allow,
}

impl System {
    /// Creates a system of particles at rest at these points, with these masses in kilograms.
    ///
    /// # Errors
    ///
    /// [`SystemError`] if a coordinate is not finite or too large, or a mass is not positive and finite.
    ///
    /// # Panics
    ///
    /// If there is not one mass for each point.
    pub fn new(
        points: impl IntoIterator<Item = Point>,
        masses_kg: Vec<f64>,
    ) -> Result<System, SystemError> {
        let system = System::with_massless(points, masses_kg);
        let particles = system.positions.iter().zip(&system.model.masses);
        for (particle, (&point, &mass)) in particles.enumerate() {
            let is_usable = mass > 0.0 && mass.is_finite() && (1.0 / mass).is_finite();
            let usable = SettingError::unless(is_usable, "mass_kg", mass, "finite and above 0");
            let given = check_point(point).err();
            let is_near = SettingError::unless(
                given.is_none(),
                "point",
                given.unwrap_or(0.0),
                "finite and not too far away",
            );
            usable.and(is_near).map_err(|number| SystemError {
                particles: [particle; 2],
                number,
            })?;
        }
        Ok(system)
    }

    /// Makes a system without checking its numbers. Particles without mass are held.
    pub(crate) fn with_massless(
        points: impl IntoIterator<Item = Point>,
        masses: Vec<f64>,
    ) -> System {
        let positions: Vec<Point> = points.into_iter().collect();
        let count = positions.len();
        assert_eq!(masses.len(), count, "there is one mass for each point");
        let mut model = Model {
            stretch_ratio_max: 100.0,
            ratio_watched: f64::INFINITY,
            ..Model::default()
        };
        for mass in masses {
            model.push_particle(mass, false);
        }
        System {
            velocities: vec![Vector::zeros(); positions.len()],
            positions,
            model,
            counters: Counters::default(),
            guard: Guard::default(),
            scratch: Scratch::default(),
            elapsed_s: 0.0,
            unstable: Unstable::default(),
            damped_j: 0.0,
            drawn_j: 0.0,
        }
    }

    /// Makes room for so many particles and stretch constraints in all, and for steps of them.
    pub(crate) fn reserve(&mut self, particles: usize, stretches: usize) {
        let (model, scratch) = (&mut self.model, &mut self.scratch);
        room_for(&mut self.positions, particles);
        room_for(&mut self.velocities, particles);
        room_for(&mut scratch.positions, particles);
        room_for(&mut scratch.velocities, particles);
        room_for(&mut scratch.accelerations, particles);
        room_for(&mut scratch.forces, particles);
        room_for(&mut scratch.before, particles);
        room_for(&mut scratch.unlimited, particles);
        room_for(&mut scratch.contacts, particles);
        room_for(&mut scratch.pressed, particles);
        room_for(&mut scratch.predicted, particles);
        room_for(&mut scratch.areas, particles);
        room_for(&mut model.masses, particles);
        room_for(&mut model.inverse_masses, particles);
        room_for(&mut model.held, particles);
        let (bends, triangles) = (model.bend.len(), model.triangles.list.len());
        model.stretch.reserve(particles, stretches);
        model.bend.reserve(particles, bends);
        model.triangles.reserve(particles);
        self.guard
            .reserve(particles, stretches + bends + 3 * triangles);
    }

    /// Adds a stretch constraint between two particles, with its rest length in metres and its
    /// stiffness in N/m, and returns its id.
    ///
    /// # Errors
    ///
    /// [`SystemError`]: a number is not positive and finite, or the ends are not two different
    /// particles.
    ///
    /// # Panics
    ///
    /// If the system is that of a cloth, whose constraints follow its mesh.
    pub fn stretch(
        &mut self,
        ends: [usize; 2],
        rest_length_m: f64,
        stiffness_n_per_m: f64,
    ) -> Result<ConstraintId, SystemError> {
        let given = self.checked(ends, rest_length_m, stiffness_n_per_m)?;
        Ok(self.model.stretch.add(given))
    }

    /// Adds a bend constraint and returns its id. It is a spring between two particles that are
    /// also joined in another way, so that it resists folding (the flexion springs of Provot 1995,
    /// §2).
    ///
    /// # Errors
    ///
    /// The errors of [`System::stretch`].
    ///
    /// # Panics
    ///
    /// If the system is that of a cloth, whose constraints follow its mesh.
    pub fn bend(
        &mut self,
        ends: [usize; 2],
        rest_length_m: f64,
        stiffness_n_per_m: f64,
    ) -> Result<ConstraintId, SystemError> {
        let given = self.checked(ends, rest_length_m, stiffness_n_per_m)?;
        Ok(self.model.bend.add(given))
    }

    /// Sets the law by which all bend constraints buckle, present and future ones; `None` makes
    /// them springs. A bend below its rest length then acts as an arc ([`Buckling`], Choi and Ko
    /// 2002 §4.2), and one beyond it exerts no force. The stiffness of a bend is the one against
    /// compression before it buckles. [`Pbd`](crate::Pbd) and [`Xpbd`](crate::Xpbd), which project
    /// springs, are then refused.
    ///
    /// ```
    /// use tearmesh_cloth::{Buckling, System, energy, force};
    /// use tearmesh::Point;
    ///
    /// let points = [Point::origin(), Point::new(0.06, 0.0, 0.0)];
    /// let mut system = System::new(points, vec![1.0; 2])?;
    /// system.bend([0, 1], 0.1, 2.0)?;
    /// assert_eq!(energy::elastic_j(&system), 0.5 * 2.0 * (0.1_f64 - 0.06).powi(2));
    /// let spring = force::reaction_n(&system, 0).x;
    /// system.set_buckling(Buckling::new(0.95));
    /// // Once it has buckled it pushes less than the spring, and than the load that buckled it.
    /// assert!(force::reaction_n(&system, 0).x > 0.0);
    /// assert!(force::reaction_n(&system, 0).x < 0.3 * spring);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    ///
    /// If the system is that of a cloth, whose bends follow its fabric.
    pub fn set_buckling(&mut self, buckling: Option<Buckling>) {
        self.is_no_cloth();
        self.model.bend.law = buckling;
        self.guard.mark_all(self.positions.len());
        self.rebuilt();
    }

    /// Adds a triangle that resists stretch and shear (Baraff and Witkin 1998 §4), and returns its
    /// index, from 0. A triangle has three particles, their coordinates (u, v) in the material in
    /// metres, and the stiffness along u, along v and in shear in N/m.
    ///
    /// Returns `None` if a stiffness is negative, a number is not finite, the coordinates span no area,
    /// or the corners are not three different particles.
    ///
    /// # Panics
    ///
    /// If the system is that of a cloth, whose triangles follow its mesh.
    pub fn triangle(
        &mut self,
        corners: [usize; 3],
        material_m: [[f64; 2]; 3],
        stiffness_n_per_m: [f64; 3],
    ) -> Option<usize> {
        self.is_no_cloth();
        let [a, b, c] = corners;
        let distinct = a != b && b != c && c != a && a.max(b).max(c) < self.positions.len();
        let vertices = corners.map(|corner| corner as u32);
        let triangle = Triangle::new(vertices, material_m, stiffness_n_per_m);
        Some(self.push_triangle(triangle.filter(|_| distinct)?))
    }

    pub(crate) fn push_triangle(&mut self, triangle: Triangle) -> usize {
        let index = self.model.triangles.list.len();
        self.model.triangles.put(index, triangle);
        self.rebuilt();
        index
    }

    /// A constraint that can be added.
    fn checked(
        &mut self,
        ends: [usize; 2],
        rest_length_m: f64,
        stiffness_n_per_m: f64,
    ) -> Result<Constraint, SystemError> {
        self.is_no_cloth();
        let given = Constraint {
            ends,
            rest_length_m,
            stiffness_n_per_m,
        };
        let [a, b] = ends;
        let are_two = a != b && a.max(b) < self.positions.len();
        SettingError::unless_above_0("rest_length_m", rest_length_m)
            .and(SettingError::unless_above_0(
                "stiffness_n_per_m",
                stiffness_n_per_m,
            ))
            .and(SettingError::unless(
                are_two,
                "ends",
                b as f64,
                "two particles",
            ))
            .map_err(|number| SystemError {
                particles: ends,
                number,
            })?;
        self.rebuilt();
        Ok(given)
    }

    fn is_no_cloth(&self) {
        assert!(
            self.model.faces.is_empty(),
            "the constraints of a cloth follow its mesh and fabric"
        );
    }

    /// Whether a particle is held, a wind blows or there is a collider.
    pub(crate) fn is_acted_on(&self) -> bool {
        let loads = &self.model.loads;
        loads.blows() || !loads.colliders.is_empty() || self.model.held.contains(&true)
    }

    /// Notes that constraints have changed otherwise than by edits of a mesh.
    fn rebuilt(&mut self) {
        self.edited();
        self.scratch.is_fresh = false;
        self.guard.suited_rate = None;
    }

    /// Notes that an edit of a mesh changed masses or constraints. Forces that a method has kept are lost only where
    /// there is wind, whose force on a single particle is not known.
    pub(crate) fn edited(&mut self) {
        self.scratch.is_fresh &= !self.model.loads.blows();
        self.scratch.none_reaches = f64::INFINITY;
        self.scratch.lose_contact();
        self.guard.is_known = false;
    }

    /// Removes a stretch constraint, as when a link of a chain tears. A later constraint may reuse
    /// its id.
    ///
    /// # Panics
    ///
    /// If there is no such constraint, or the system is that of a cloth, whose constraints follow
    /// the mesh.
    pub fn cut(&mut self, id: ConstraintId) -> Constraint {
        self.is_no_cloth();
        let constraint = self.model.stretch.remove(id);
        self.rebuilt();
        constraint
    }

    /// Pins a particle at its present position, with velocity zero.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    pub fn hold(&mut self, particle: usize) {
        self.keep();
        self.model.held[particle] = true;
        self.velocities[particle] = Vector::zeros();
        self.weigh(particle);
        self.scratch.is_fresh = false;
    }

    /// Releases a pinned or grabbed particle.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    pub fn release(&mut self, particle: usize) {
        self.model.unlead(particle);
        self.model.held[particle] = false;
        self.weigh(particle);
        self.scratch.is_fresh = false;
    }

    /// Leads a particle along a path. The particle moves at once to the point of the path at the
    /// present time.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    pub fn grab(&mut self, particle: usize, path: Path) {
        self.release(particle);
        self.hold(particle);
        let from = path.at(self.elapsed_s);
        self.positions[particle] = from;
        self.model.grabbed.push((particle as u32, path));
        room_for(&mut self.scratch.led, self.model.grabbed.capacity());
    }

    /// Holds a particle between others, wherever these are led from now on. If one of them is not held, nothing
    /// changes.
    pub(crate) fn hold_between(&mut self, particle: usize, between: Mix<usize>) {
        let (mut paths, mut are_held, mut are_led) = (Vec::new(), true, false);
        let mix = between.map(|end| {
            let mut led = self.model.grabbed.iter();
            let path = led.find(|(led, _)| *led as usize == end);
            are_led |= path.is_some();
            are_held &= self.model.held[end];
            let still = || Path::still(self.positions[end]);
            paths.push(path.map_or_else(still, |(_, path)| path.clone()));
            paths.len() - 1
        });
        match (are_held, are_led) {
            (false, _) => {}
            (true, true) => self.grab(particle, Path::between(mix, paths)),
            (true, false) => {
                self.release(particle); // Of its path.
                self.hold(particle);
            }
        }
    }

    /// Brings the inverse mass up to date with the mass and with whether the particle is held.
    pub(crate) fn weigh(&mut self, particle: usize) {
        let model = &mut self.model;
        model.inverse_masses[particle] =
            model::inverse(model.masses[particle], model.held[particle]);
        self.guard.changed.mark(particle);
        self.edited();
    }

    /// Sets the external loads.
    ///
    /// # Errors
    ///
    /// [`SettingError`] if a number is not finite, or is negative where it must not be.
    pub fn set_loads(&mut self, loads: Loads) -> Result<(), SettingError> {
        loads.check()?;
        self.scratch.is_fresh = false;
        self.scratch.lose_contact();
        self.model.loads = loads;
        Ok(())
    }

    /// Has another wind blow, or none, and forgets nothing unless that begins or ends: a wind that sways is set before
    /// every step, which costs what a steady one does. Forces that a method has kept of the end of the last step are those
    /// of the wind before, as a step that begins with them takes the mean of both.
    ///
    /// # Errors
    ///
    /// [`SettingError`] if a number of the wind is not finite, or is negative where it must not be.
    pub(crate) fn set_wind(&mut self, wind: Option<Wind>) -> Result<(), SettingError> {
        wind.as_ref().map_or(Ok(()), Wind::check)?;
        let blew = self.model.loads.blows();
        self.model.loads.wind = wind;
        self.scratch.is_fresh &= blew == self.model.loads.blows();
        Ok(())
    }

    /// Damps the stretch constraints with this time τ in seconds; zero for no damping, which is the
    /// default. A constraint of stiffness k exerts c dl/dt besides, where c is τ k, and no more than gives it a
    /// damping ratio of a tenth. Methods that do not
    /// damp ([`Abilities::damps`](crate::Abilities::damps)) leave it out.
    ///
    /// # Errors
    ///
    /// [`SettingError`] if the time is negative or not finite.
    pub fn set_damping(&mut self, time_s: f64) -> Result<(), SettingError> {
        SettingError::unless_at_least_0("damping_s", time_s)?;
        self.model.damping_s = time_s;
        self.guard.mark_all(self.positions.len());
        self.rebuilt();
        Ok(())
    }

    /// Returns the time of the damping of the stretch constraints, in seconds.
    #[must_use]
    pub fn damping_s(&self) -> f64 {
        self.model.damping_s
    }

    /// Sets how to treat a step beyond the stability limit. The default is to refuse it.
    pub fn when_unstable(&mut self, unstable: Unstable) {
        self.unstable = unstable;
    }

    /// Sets the stretch ratio above which the system counts as blown up. The default is 100. (PBD
    /// stretches a hanging sheet of 64 × 64 cells twelvefold.) The next step refuses a ratio that
    /// is not above 0.
    pub fn set_stretch_ratio_max(&mut self, ratio: f64) {
        self.model.stretch_ratio_max = ratio;
    }

    /// Returns the positions of the particles, in metres.
    #[must_use]
    pub fn positions(&self) -> &[Point] {
        &self.positions
    }

    /// Returns the velocities of the particles, in m/s.
    #[must_use]
    pub fn velocities(&self) -> &[Vector] {
        &self.velocities
    }

    /// Returns mutable access to positions and velocities. The next step notices values that are
    /// not finite. The forces and ratios that the last step recorded in constraints
    /// ([`force_n`](crate::force::force_n)) are discarded.
    #[must_use]
    pub fn state_mut(&mut self) -> (&mut [Point], &mut [Vector]) {
        self.keep();
        self.scratch.is_fresh = false;
        self.scratch.lose_contact();
        self.model.recorded = Recorded::Nothing;
        (&mut self.positions, &mut self.velocities)
    }

    /// Returns the masses of the particles, in kilograms.
    #[must_use]
    pub fn masses(&self) -> &[f64] {
        &self.model.masses
    }

    /// Returns the inverse masses of the particles, in 1/kg: zero for a held particle.
    #[must_use]
    pub fn inverse_masses(&self) -> &[f64] {
        &self.model.inverse_masses
    }

    /// Returns whether a particle is pinned or grabbed.
    ///
    /// # Panics
    ///
    /// If there is no such particle.
    #[must_use]
    pub fn is_held(&self, particle: usize) -> bool {
        self.model.held[particle]
    }

    /// Returns the stretch constraints.
    #[must_use]
    pub fn stretches(&self) -> &Constraints {
        &self.model.stretch
    }

    /// Returns the bend constraints.
    #[must_use]
    pub fn bends(&self) -> &Constraints {
        &self.model.bend
    }

    /// Returns the triangles that resist stretch and shear, by index.
    #[must_use]
    pub fn triangles(&self) -> &[Triangle] {
        &self.model.triangles.list
    }

    /// Returns the external loads.
    #[must_use]
    pub fn loads(&self) -> &Loads {
        &self.model.loads
    }

    /// Returns counts of the work done so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Returns the time simulated so far, in seconds.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.elapsed_s
    }

    /// Returns the length of a stretch constraint as a multiple of its rest length.
    ///
    /// # Panics
    ///
    /// If there is no such constraint.
    #[must_use]
    pub fn stretch_ratio(&self, id: ConstraintId) -> f64 {
        self.ratio_at(&self.positions, id)
    }

    /// The length of a stretch constraint as a multiple of its rest length, as it was in the last step
    /// before a limiter shortened it.
    pub(crate) fn unlimited_ratio(&self, id: ConstraintId) -> f64 {
        self.ratio_at(self.unlimited(), id)
    }

    fn ratio_at(&self, x: &[Point], id: ConstraintId) -> f64 {
        let constraint = self.model.stretch.get(id);
        pair::span(x, constraint.ends) / constraint.rest_length_m
    }

    /// Whether the forces of now are known to be those of stretch constraints all of which are shorter than so many
    /// times their rest length; has the next ones take note of it.
    pub(crate) fn watch(&mut self, ratio: f64) -> bool {
        self.model.ratio_watched = ratio;
        self.scratch.is_fresh && self.scratch.none_reaches <= ratio
    }

    /// The positions of the last step before a limiter moved any.
    pub(crate) fn unlimited(&self) -> &[Point] {
        match self.model.recorded {
            Recorded::Limiter => &self.scratch.unlimited,
            _ => &self.positions,
        }
    }

    /// Returns the particles at which there was contact in the last substep, and those of faces at which there was.
    pub(crate) fn touching(&self) -> BTreeSet<usize> {
        let contacts = self.scratch.contacts.iter();
        contacts
            .flat_map(|contact| contact.corners.each())
            .collect()
    }

    /// Keeps the state in which a step began, if it is still there. Who changes positions or velocities
    /// calls this first.
    pub(crate) fn keep(&mut self) {
        let scratch = &mut self.scratch;
        if std::mem::take(&mut scratch.is_beginning) {
            scratch.positions.clone_from(&self.positions);
            scratch.velocities.clone_from(&self.velocities);
        }
    }
}
