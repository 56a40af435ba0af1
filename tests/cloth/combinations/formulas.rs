//! Formulas of the oracles: wind, gravity, drag, springs, energy, and how far points are outside of colliders. They
//! share no code with what they judge.

use tearmesh::{Mesh, Point, Vector};
use tearmesh_cloth::{Cloth, System};

use super::factors::Case;
use super::text::{
    BALL, BLOWN, BOX, BOX_ABOUT, BOX_MOVES_M, BOX_TURNS, COEFFICIENT, FRAMES, PERIOD_S, PLANE,
    SWAY, WIND, at_s,
};

/// The velocity of the air that a case asks for; none while no wind blows.
pub(super) fn air(case: &Case, time_s: f64) -> Option<Vector> {
    let from_s = if case.is("wind", "later") {
        at_s(BLOWN)
    } else {
        0.0
    };
    // A time is rounded to a step, which may begin a rounding error earlier.
    if case.is("wind", "still") || time_s + 1e-9 < from_s {
        return None;
    }
    let sway = match case.is("wind", "swaying") {
        true => Vector::from(SWAY),
        false => Vector::zeros(),
    };
    let phase = (time_s - from_s) / PERIOD_S;
    let part = phase - phase.floor();
    let triangle = match part {
        part if part < 0.25 => 4.0 * part,
        part if part < 0.75 => 2.0 - 4.0 * part,
        part => 4.0 * part - 4.0,
    };
    Some(Vector::from(WIND) + sway * triangle)
}

/// The gravity of a case, and its drag.
pub(super) fn gravity(case: &Case) -> (Vector, f64) {
    let gravity = match case.get("gravity") {
        "down" => Vector::new(0.0, -9.81, 0.0),
        "aslant" => Vector::new(1.0, -9.0, 2.0),
        _ => Vector::zeros(),
    };
    (gravity, if case.is("drag", "some") { 0.5 } else { 0.0 })
}

/// How far a point is outside of the collider of a case.
pub(super) fn outside_m(case: &Case, time_s: f64, p: Point) -> f64 {
    match case.get("collider") {
        "none" => f64::INFINITY,
        "plane" => {
            let [point, normal] = PLANE.map(Vector::from);
            (p.coords - point).dot(&normal) / normal.norm()
        }
        "ball" => (p.coords - Vector::from(BALL.0)).norm() - BALL.1,
        "body" => outside_box_m(p.coords),
        _ => {
            // Back to where the box was made: without its way, and turned back about its place.
            let part = (time_s / at_s(FRAMES)).min(1.0);
            let about = Vector::from(BOX_ABOUT);
            let seen = p.coords - Vector::from(BOX_MOVES_M) * part - about;
            let (sine, cosine) = (BOX_TURNS * part).to_radians().sin_cos();
            let turned = Vector::new(
                cosine * seen.x - sine * seen.z,
                seen.y,
                sine * seen.x + cosine * seen.z,
            );
            outside_box_m(turned + about)
        }
    }
}

fn outside_box_m(p: Vector) -> f64 {
    let [low, high] = BOX.map(Vector::from);
    let beyond = Vector::from_fn(|i, _| (low[i] - p[i]).max(p[i] - high[i]));
    let outside = beyond.map(|x| x.max(0.0)).norm();
    outside + beyond.max().min(0.0)
}

pub(super) fn momentum(cloth: &Cloth, vertices: &[usize]) -> Vector {
    let system = cloth.system();
    vertices
        .iter()
        .map(|&v| system.velocities()[v] * system.masses()[v])
        .sum()
}

pub(super) fn rest_area(mesh: &Mesh, cloth: &Cloth) -> f64 {
    let corners = cloth.rest_corners();
    let area = |[a, b, c]: [Point; 3]| 0.5 * (b - a).cross(&(c - a)).norm();
    mesh.faces()
        .map(|f| area(f.half_edges().map(|h| corners[h.index()])))
        .sum()
}

/// The force of the wind of a time on each vertex: of each face the pressure by how fast the air meets it, a third each.
pub(super) fn wind_n(case: &Case, system: &System, indices: &[u32], time_s: f64) -> Vec<Vector> {
    let (x, v) = (system.positions(), system.velocities());
    let mut forces = vec![Vector::zeros(); x.len()];
    if let Some(air) = air(case, time_s) {
        for face in indices.as_chunks::<3>().0 {
            let [a, b, c] = face.map(|corner| corner as usize);
            let double = (x[b] - x[a]).cross(&(x[c] - x[a]));
            if double.norm() > 0.0 {
                let normal = double.normalize();
                let speed = normal.dot(&(air - (v[a] + v[b] + v[c]) / 3.0));
                let force = normal * (COEFFICIENT * 0.5 * double.norm() * speed / 3.0);
                [a, b, c]
                    .into_iter()
                    .for_each(|corner| forces[corner] += force);
            }
        }
    }
    forces
}

fn blown_n(case: &Case, cloth: &Cloth, time_s: f64) -> Vec<Vector> {
    wind_n(case, cloth.system(), cloth.indices(), time_s)
}

pub(super) fn held(cloth: &Cloth) -> usize {
    let system = cloth.system();
    (0..system.positions().len())
        .filter(|&v| system.is_held(v))
        .count()
}

/// Whether the force of every spring follows from its length alone, and nothing else pulls.
pub(super) fn pulls_by_length(case: &Case) -> bool {
    // Only Verlet damps, and a method of two steps feels what was.
    let is_undamped = match case.get("method") {
        "verlet" => case.is("damping", "none"),
        "implicit" => case.is("settings", "default"),
        _ => false,
    };
    is_undamped && !case.is("fabric", "woven") && !case.is("bending", "buckling")
}

/// The force of the wind of a time, and of springs to vertices that are held, where it follows from their lengths.
pub(super) fn outer_n(case: &Case, cloth: &Cloth, time_s: f64) -> Vec<Vector> {
    let (system, mut forces) = (cloth.system(), blown_n(case, cloth, time_s));
    if pulls_by_length(case) {
        for family in [system.stretches(), system.bends()] {
            for spring in family.iter().map(|id| family.get(id)) {
                let [a, b] = spring.ends.map(|end| system.positions()[end]);
                let line = b - a;
                let pull =
                    line * (spring.stiffness_n_per_m * (1.0 - spring.rest_length_m / line.norm()));
                match spring.ends.map(|end| system.is_held(end)) {
                    [false, true] => forces[spring.ends[0]] += pull,
                    [true, false] => forces[spring.ends[1]] -= pull,
                    _ => {}
                }
            }
        }
    }
    forces
}

/// The power of drag and of wind on what is free.
pub(super) fn power_w(case: &Case, cloth: &Cloth, time_s: f64) -> [f64; 2] {
    let (system, (_, drag_per_s)) = (cloth.system(), gravity(case));
    let forces = blown_n(case, cloth, time_s);
    let free = (0..forces.len()).filter(|&v| !system.is_held(v));
    free.fold([0.0; 2], |[drag, wind], v| {
        let (speed, mass) = (system.velocities()[v], system.masses()[v]);
        [
            drag - drag_per_s * mass * speed.norm_squared(),
            wind + forces[v].dot(&speed),
        ]
    })
}

/// The potential of gravity.
pub(super) fn weight_j(case: &Case, cloth: &Cloth) -> f64 {
    let (system, (gravity, _)) = (cloth.system(), gravity(case));
    let particles = system.positions().iter().zip(system.masses());
    -particles
        .map(|(x, m)| m * gravity.dot(&x.coords))
        .sum::<f64>()
}

/// The weight of the whole cloth, which lifts it by no more than this times how far it is lifted.
pub(super) fn weight_n(case: &Case, cloth: &Cloth) -> f64 {
    gravity(case).0.norm() * cloth.system().masses().iter().sum::<f64>()
}

/// The energy of motion and of springs.
pub(super) fn stored_j(cloth: &Cloth) -> [f64; 2] {
    let system = cloth.system();
    let free = (0..system.positions().len()).filter(|&v| !system.is_held(v));
    let kinetic = free.map(|v| 0.5 * system.masses()[v] * system.velocities()[v].norm_squared());
    let families = [system.stretches(), system.bends()].into_iter();
    let elastic = families.flat_map(|family| {
        family.iter().map(move |id| {
            let spring = family.get(id);
            let [a, b] = spring.ends.map(|end| system.positions()[end]);
            0.5 * spring.stiffness_n_per_m * ((b - a).norm() - spring.rest_length_m).powi(2)
        })
    });
    [kinetic.sum(), elastic.sum()]
}
