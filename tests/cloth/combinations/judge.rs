//! Oracles that watch a cloth while it moves: mass, the momentum of free pieces, energy, and bodies that
//! nothing enters. They read the state of the cloth, and compute by formulas of their own.

use tearmesh::{Mesh, Point, Vector};
use tearmesh_cloth::{Cloth, EnergyBalance};

use super::factors::Case;
use super::formulas::{
    gravity, held, momentum, outer_n, outside_m, power_w, pulls_by_length, rest_area, stored_j,
    weight_j, weight_n,
};

/// What an oracle found.
#[derive(Clone, Debug)]
pub(super) struct Fault {
    pub(super) oracle: &'static str,
    pub(super) message: String,
}

pub(super) fn fault(oracle: &'static str, message: impl Into<String>) -> Fault {
    let message = message.into();
    Fault { oracle, message }
}

/// What is to be watched of a piece of cloth that nothing touches, over a frame.
struct Piece {
    /// The vertices that are not held.
    vertices: Vec<usize>,
    /// Whether some are held: then their springs pull.
    is_held: bool,
    began: Vector,
    /// The impulse of gravity, wind and drag since then, and the sum of their sizes.
    impulse: Vector,
    size: f64,
}

/// The state of the watch.
pub(super) struct Judge<'c> {
    case: &'c Case,
    mass_kg: f64,
    vertices: usize,
    pieces: Vec<Piece>,
    /// The force of the wind and of springs to what is held on each vertex, where the next step begins.
    outer_n: Vec<Vector>,
    /// How many vertices are held.
    held: usize,
    /// The power of drag and of wind at the last step, in watts, and their work, in joules.
    power_w: [f64; 2],
    work_j: [f64; 2],
    began_j: f64,
    /// Faults after which the cloth goes on to be judged, the first of each oracle.
    pub(super) soft: Vec<Fault>,
    /// How many pieces were followed through a frame.
    pub(super) followed: usize,
    /// How often energy, and contact, was looked at.
    pub(super) balanced: usize,
    pub(super) touched: usize,
}

impl<'c> Judge<'c> {
    pub(super) fn new(case: &'c Case, mesh: &Mesh, cloth: &Cloth) -> Judge<'c> {
        let mut judge = Judge {
            case,
            mass_kg: rest_area(mesh, cloth) * 0.2,
            vertices: 0,
            pieces: Vec::new(),
            outer_n: Vec::new(),
            held: 0,
            power_w: power_w(case, cloth, 0.0),
            work_j: [0.0; 2],
            began_j: weight_j(case, cloth),
            soft: Vec::new(),
            followed: 0,
            balanced: 0,
            touched: 0,
        };
        judge.begin(mesh, cloth);
        if case.is("seams", "sewn") {
            judge.skip();
        }
        judge
    }

    /// After a step.
    pub(super) fn step(&mut self, mesh: &Mesh, cloth: &Cloth, step_s: f64) {
        // The wind of a step is that of its beginning.
        let began_s = cloth.system().elapsed_s() - step_s;
        let now_w = power_w(self.case, cloth, began_s);
        let powers = self.power_w.into_iter().zip(now_w);
        for (work_j, (before_w, now_w)) in self.work_j.iter_mut().zip(powers) {
            *work_j += 0.5 * step_s * (before_w + now_w);
        }
        let ended_s = began_s + step_s;
        self.power_w = power_w(self.case, cloth, ended_s);
        if mesh.vertex_count() != self.vertices {
            self.pieces.clear();
        }
        let (system, (gravity, drag_per_s)) = (cloth.system(), gravity(self.case));
        let time_s = system.elapsed_s();
        let forces = outer_n(self.case, cloth, began_s);
        let held = held(cloth);
        for piece in &mut self.pieces {
            for &v in &piece.vertices {
                let momentum = system.velocities()[v] * system.masses()[v];
                let outer_n = match self.case.is("method", "implicit") && piece.is_held {
                    true => forces[v],
                    false => (self.outer_n[v] + forces[v]) / 2.0,
                };
                let parts = [
                    gravity * system.masses()[v],
                    outer_n,
                    momentum * -drag_per_s,
                ];
                piece.impulse += parts.iter().sum::<Vector>() * step_s;
                piece.size += parts.iter().map(Vector::norm).sum::<f64>() * step_s;
            }
        }
        self.outer_n = outer_n(self.case, cloth, ended_s);
        let (case, x) = (self.case, system.positions());
        let is_same = held == self.held;
        self.pieces.retain(|piece| {
            let mut vertices = piece.vertices.iter();
            (is_same || !piece.is_held)
                && vertices.all(|&v| !system.is_held(v) && outside_m(case, time_s, x[v]) > NEAR_M)
        });
    }

    /// Follows no piece through this frame.
    pub(super) fn skip(&mut self) {
        self.pieces.clear();
    }

    /// After a frame: judges what was watched, and begins anew.
    pub(super) fn frame(
        &mut self,
        mesh: &Mesh,
        cloth: &Cloth,
        is_sewing: bool,
    ) -> Result<(), Fault> {
        self.finite(cloth)?;
        self.mass(mesh, cloth)?;
        self.momentum(cloth)?;
        self.bodies(cloth, is_sewing)?;
        self.begin(mesh, cloth);
        if is_sewing {
            self.pieces.clear();
        }
        Ok(())
    }

    fn note(&mut self, found: Fault) {
        if self.soft.iter().all(|soft| soft.oracle != found.oracle) {
            self.soft.push(found);
        }
    }

    fn finite(&self, cloth: &Cloth) -> Result<(), Fault> {
        let (system, time_s) = (cloth.system(), cloth.system().elapsed_s());
        let mut places = system.positions().iter().enumerate();
        let is_inside = |x: &Point| outside_m(self.case, time_s, *x) < 0.0;
        // What is led into a body, which keeps all round it out, is pulled apart at any step.
        let most = match places.any(|(v, x)| system.is_held(v) && is_inside(x)) {
            true => f64::MAX,
            false => 1000.0,
        };
        let is_near = |x: &Point| x.coords.norm() < 0.1 * most;
        let is_slow = |v: &Vector| v.norm() < most;
        let is_sane =
            system.positions().iter().all(is_near) && system.velocities().iter().all(is_slow);
        let speeds = system.velocities().iter().map(Vector::norm);
        let fastest = speeds.fold(0.0, f64::max);
        let text = || format!("after {time_s} s a vertex is far away or goes at {fastest} m/s");
        is_sane.then_some(()).ok_or_else(|| fault("finite", text()))
    }

    /// All mass is there: that of the area at rest, from the beginning on.
    fn mass(&self, mesh: &Mesh, cloth: &Cloth) -> Result<(), Fault> {
        let now: f64 = cloth.system().masses().iter().sum();
        let by_area = rest_area(mesh, cloth) * 0.2;
        for (name, mass) in [
            ("the vertices weigh", now),
            ("the area at rest weighs", by_area),
        ] {
            if (mass / self.mass_kg - 1.0).abs() > 1e-9 {
                return Err(fault(
                    "mass",
                    format!("{name} {mass} kg, not {}", self.mass_kg),
                ));
            }
        }
        Ok(())
    }

    /// What nothing holds, touches or sews goes where gravity, wind and drag push it.
    fn momentum(&mut self, cloth: &Cloth) -> Result<(), Fault> {
        // What a step feels of wind that changes lies within it, and is summed here at its ends; and a method of two
        // steps remembers what was before.
        let is_implicit = self.case.is("method", "implicit");
        let is_unsteady =
            self.case.is("wind", "swaying") || is_implicit && self.case.is("wind", "later");
        let remembered = if is_implicit { 1e-3 } else { 0.0 };
        // Undamped springs to what is held swing between two looks.
        let is_loose = is_implicit || self.case.is("damping", "none");
        for piece in &self.pieces {
            // One triangle or two tumble in wind, by half a turn in a step: the oracle of wind has their vertices.
            if piece.vertices.len() <= 4 && !self.case.is("wind", "still") {
                continue;
            }
            let share = match is_unsteady {
                _ if piece.is_held && is_loose => 2.0 * HELD,
                _ if piece.is_held => HELD,
                true if is_implicit => 4.0 * MOMENTUM,
                true => 2.0 * MOMENTUM,
                false => MOMENTUM,
            };
            let system = cloth.system();
            let sizes = piece
                .vertices
                .iter()
                .map(|&v| system.velocities()[v].norm() * system.masses()[v]);
            let least = 1e-9 + remembered * sizes.sum::<f64>();
            let off = momentum(cloth, &piece.vertices) - piece.began - piece.impulse;
            if off.norm() > share * piece.size + least {
                let text = format!(
                    "after {} s a piece of {} vertices gained {:?} more than {:?}, of {} N s",
                    cloth.system().elapsed_s(),
                    piece.vertices.len(),
                    off.as_slice(),
                    piece.impulse.as_slice(),
                    piece.size
                );
                return Err(fault("momentum", text));
            }
        }
        self.followed += self.pieces.len();
        Ok(())
    }

    /// No vertex that is free is inside of the collider. (Sewing may draw it in by a step's way: a fault of its own.)
    fn bodies(&mut self, cloth: &Cloth, is_sewing: bool) -> Result<(), Fault> {
        let (system, time_s) = (cloth.system(), cloth.system().elapsed_s());
        for (v, x) in system
            .positions()
            .iter()
            .enumerate()
            .filter(|(v, _)| !system.is_held(*v))
        {
            let outside = outside_m(self.case, time_s, *x);
            self.touched += usize::from(outside < NEAR_M);
            if outside < -1e-9 {
                let text = format!("after {time_s} s vertex {v} is {} m inside", -outside);
                if !is_sewing || outside < -DRAWN_M {
                    return Err(fault("bodies", text));
                }
                self.note(fault("sewn in", text));
            }
        }
        Ok(())
    }

    /// The parts of a balance that have a formula are those, and what the method made is not much.
    pub(super) fn energy(
        &mut self,
        cloth: &Cloth,
        (balance, ripple_m): (&EnergyBalance, f64),
        is_told: bool,
    ) -> Result<(), Fault> {
        let wrong = |name: &str, found: f64, own: f64| {
            let time_s = cloth.system().elapsed_s();
            Err(fault(
                "energy",
                format!("after {time_s} s {name} is {found} J, not {own} J"),
            ))
        };
        let put_in = balance.put_in_j();
        let [kinetic, elastic] = stored_j(cloth);
        let gravity = self.began_j - weight_j(self.case, cloth);
        let is_by_length =
            self.case.is("method", "verlet implicit") && !self.case.is("bending", "buckling");
        let is_of_springs = is_by_length && !self.case.is("fabric", "woven");
        let exact = [
            ("kinetic", balance.kinetic_j, kinetic, true),
            ("gravity", balance.gravity_j, gravity, true),
            ("elastic", balance.elastic_j, elastic, is_of_springs),
        ];
        for (name, found, own, _) in exact.into_iter().filter(|part| part.3) {
            // A cloth that was flat begins out of its plane.
            let lifted_j = ripple_m * weight_n(self.case, cloth);
            if (found - own).abs() > 1e-9 * (1.0 + put_in) + lifted_j {
                return wrong(name, found, own);
            }
        }
        for (name, found, own) in [
            ("drag", balance.drag_j, self.work_j[0]),
            ("wind", balance.wind_j, self.work_j[1]),
        ] {
            if (found - own).abs() > AIR * (own.abs() + found.abs()) + 0.03 * put_in + 1e-6 {
                return wrong(name, found, own);
            }
        }
        let made = balance.made_j();
        let is_exact = self.case.is("method", "verlet");
        if made > MADE * put_in + 1e-6 && !is_told && !self.case.is("method", "provot") {
            return wrong("made by the method", made, 0.0);
        }
        if is_exact && put_in < CALM_J_PER_KG * self.mass_kg && made < -LOST * put_in - 1e-6 {
            let text = format!(
                "after {} s the method lost {} of {put_in} J",
                cloth.system().elapsed_s(),
                -made
            );
            self.note(fault("lost", text));
        }
        self.balanced += 1;
        Ok(())
    }

    /// Begins to follow the pieces that nothing holds or touches.
    fn begin(&mut self, mesh: &Mesh, cloth: &Cloth) {
        let system = cloth.system();
        self.vertices = mesh.vertex_count();
        self.outer_n = outer_n(self.case, cloth, system.elapsed_s());
        self.held = held(cloth);
        self.pieces.clear();
        let components = mesh.components();
        let mut of = vec![Vec::new(); components.count()];
        for f in mesh.faces() {
            of[components.of(f)].extend(mesh.face_vertices(f).map(|v| v.index()));
        }
        // Pieces may touch at a vertex.
        let mut owner = vec![usize::MAX; mesh.vertex_count()];
        let mut joined = vec![false; of.len()];
        for (piece, vertices) in of.iter_mut().enumerate() {
            vertices.sort_unstable();
            vertices.dedup();
            for &v in vertices.iter() {
                if owner[v] != usize::MAX {
                    (joined[piece], joined[owner[v]]) = (true, true);
                }
                owner[v] = piece;
            }
        }
        let is_far =
            |v: &usize| outside_m(self.case, system.elapsed_s(), system.positions()[*v]) > NEAR_M;
        let may_hold = pulls_by_length(self.case);
        for (mut vertices, _) in of
            .into_iter()
            .zip(joined)
            .filter(|(_, is_joined)| !is_joined)
        {
            let all = vertices.len();
            vertices.retain(|&v| !system.is_held(v));
            let is_held = vertices.len() < all;
            // A few vertices swing too fast for steps to show.
            let may_follow = !vertices.is_empty() && !is_held || may_hold && vertices.len() >= 8;
            if may_follow && vertices.iter().all(is_far) {
                self.pieces.push(Piece {
                    began: momentum(cloth, &vertices),
                    is_held,
                    vertices,
                    impulse: Vector::zeros(),
                    size: 0.0,
                });
            }
        }
    }
}

/// What is nearer to a collider may touch it within a step.
const NEAR_M: f64 = 0.08;

/// How far sewing draws a vertex in the longest step, of 1/120 s.
const DRAWN_M: f64 = 0.0125;

/// How far momentum may be off, as a fraction of the impulses; work of the air, as a fraction of it; and what a
/// method may make and Verlet may lose, as fractions of what was put in.
const MOMENTUM: f64 = 0.1;
const HELD: f64 = 0.1;
const AIR: f64 = 0.25;
const MADE: f64 = 0.03;
const LOST: f64 = 0.25;

/// The energy up to which Verlet is exact: more, as where a hand draws one vertex far, is violent, and guards work.
const CALM_J_PER_KG: f64 = 5.0;
