//! R1–R11 by every method, with chains of springs and with strips of triangles; and orders of convergence.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use tearmesh::{Point, Vector};
use tearmesh_cloth::{Cloth, Orthotropic, Solver, System, energy, force, frequency_bound};

use super::{Links, METHODS, theory};
use crate::parts::nets::{framed, relaxed, relaxed_net, row};
use crate::parts::vibration::largest_frequency;
use crate::parts::woven::{self, moduli, weave};
use crate::parts::{gravity, mechanical_j, method, near, order, run_with};

/// An error, and the largest that it may be; `None` where the answer is none of the method's.
type Cell = Option<(f64, f64)>;

/// A row of the table: what is compared, and how.
type Row = (&'static str, fn(Links, &str) -> Cell);

/// Takes steps by a method until so many seconds have passed.
fn go(system: &mut System, name: &str, sweeps: u32, dt_s: f64, seconds: f64) {
    let steps = (seconds / dt_s).round() as usize;
    run_with(system, &mut *method(name, sweeps), dt_s, steps);
}

fn projects(name: &str) -> bool {
    name == "XPBD" || name == "PBD"
}

/// A step of any length is stable.
fn is_stiff(name: &str) -> bool {
    projects(name) || name == "Euler" || name == "BDF2"
}

/// The largest difference from the method's own discrete oscillation, relative to the amplitude.
fn oscillation(
    name: &str,
    z: f64,
    steps: usize,
    mut step: impl FnMut(&mut dyn Solver) -> f64,
) -> Option<f64> {
    let theory = theory::oscillation(name, z, steps)?;
    let mut solver = method(name, 400);
    let apart = theory[1..].iter().map(|x| (step(&mut *solver) - x).abs());
    Some(apart.fold(0.0, f64::max))
}

fn r1(links: Links, name: &str) -> Cell {
    if name == "guarded" && links == Links::Triangles {
        return None; // What is crushed is damped.
    }
    let mut system = links.row(1, 0.01, 40.0, 1.0, Vector::x());
    links.change(&mut system, 1, |p, _| p.x = 1.1);
    let z = 4000.0_f64.sqrt() * 0.01;
    let error = oscillation(name, z, 60, |solver| {
        run_with(&mut system, solver, 0.01, 1);
        (links.point(&system, 1).x - 1.0) / 0.1
    })?;
    Some((error, 1e-9))
}

fn r2(links: Links, name: &str) -> Cell {
    let own = [[0.004, 0.008], [1.0 / 60.0, 0.1]][usize::from(is_stiff(name))];
    let errors = own.map(|dt| {
        let mut chain = links.row(10, 0.01, 50.0, 0.1, Vector::z() * -0.1);
        chain.set_loads(gravity(4.0)).expect("loads");
        go(&mut chain, name, 400, dt, 30.0);
        (-links.point(&chain, 10).z - 1.107_91).abs()
    });
    Some((errors[0].max(errors[1]), 1e-8))
}

/// A mode of a chain in motion, against the oscillation of the method with the mode's frequency.
fn mode(links: Links, name: &str, j: f64, across: bool) -> Cell {
    if name == "guarded" {
        return None; // So near the limit particles are carried.
    }
    let pitch = if across { 1.0 / 32.0 } else { 0.03 };
    let mut chain = links.row(32, 0.02, 1000.0, 0.03, Vector::x() * pitch);
    links.hold(&mut chain, 32);
    let ways = [(Vector::x(), 1e-3), (Vector::z(), 1e-5)];
    let (direction, amplitude) = ways[usize::from(across)];
    let shape = |i: usize| (j * PI * i as f64 / 32.0).sin();
    for i in 1..32 {
        let by = direction * (amplitude * shape(i));
        links.change(&mut chain, i, |p, _| *p += by);
    }
    let stiffness = 1000.0 * (1.0 - if across { 0.03 / pitch } else { 0.0 });
    let of_mode = |k: f64, j: f64| 2.0 * (k / 0.02_f64).sqrt() * (j * PI / 64.0).sin();
    let (omega, dt) = (of_mode(stiffness, j), 0.9 * 2.0 / of_mode(1000.0, 31.0));
    let error = oscillation(name, omega * dt, 60, |solver| {
        run_with(&mut chain, solver, dt, 1);
        let p = links.point(&chain, 7).coords - Vector::x() * (7.0 * pitch);
        p.dot(&direction) / (amplitude * shape(7))
    })?;
    // Across, tension grows with the square of the amplitude, and sweeps converge slowly (F8).
    let tolerance = match (across, name) {
        (false, _) => 1e-8,
        (true, "XPBD") => 1e-3,
        (true, _) => 1e-6,
    };
    Some((error, tolerance))
}

/// Twice the time between every second passage of the lowest point.
fn period(links: Links, name: &str, stiffness: f64, dt: f64, angle: f64) -> f64 {
    let start = Vector::new(angle.sin(), 0.0, -angle.cos());
    let mut system = links.row(1, 1.0, stiffness, 1.0, start);
    system.set_loads(gravity(0.0)).expect("loads");
    let mut solver = method(name, 1);
    let mut crossings = Vec::new();
    let mut last = links.point(&system, 1).x;
    while crossings.len() < 3 {
        run_with(&mut system, &mut *solver, dt, 1);
        let now = links.point(&system, 1).x;
        if (last < 0.0) != (now < 0.0) {
            crossings.push(system.elapsed_s() - dt * now / (now - last));
        }
        last = now;
    }
    crossings[2] - crossings[0]
}

fn r5(links: Links, name: &str, angle: f64) -> Cell {
    let answer = theory::period(angle);
    let dt = if is_stiff(name) { 2e-4 } else { 1e-4 };
    if name == "PBD" {
        return Some(((period(links, name, 1.0, dt, angle) - answer).abs(), 4e-3));
    }
    // What the rod's stiffness leaves is linear in 1/k.
    let [soft, stiff] = [1e5, 2e5].map(|k| period(links, name, k, dt, angle));
    let tolerance = match name {
        "Euler" | "XPBD" => 4e-3,
        // Linearised, of which the error goes with the square of the step as well.
        "BDF2" => 2e-5,
        _ => 1e-5,
    };
    Some(((2.0 * stiff - soft - answer).abs(), tolerance))
}

/// Sixteen links between two nails a metre apart, sagging as a parabola at first.
fn sagging(links: Links, stiffness: f64, rest: f64) -> System {
    let mut net = links.row(16, 0.01, stiffness, rest, Vector::x() / 16.0);
    links.hold(&mut net, 16);
    net.set_loads(gravity(5.0)).expect("loads");
    for i in 1..16 {
        let x = i as f64 / 16.0;
        links.change(&mut net, i, |p, _| p.z = -2.0 * x * (1.0 - x));
    }
    net
}

fn r6b(links: Links, name: &str) -> Cell {
    if name != "PBD" {
        return None;
    }
    let mut net = sagging(links, 1.0, 1.5 / 16.0);
    run_with(&mut net, &mut *method(name, 300), 1.0 / 960.0, 9600);
    let [sag, _] = theory::net(16, |_| 1.5 / 16.0);
    Some(((-net.positions()[8].z - sag).abs(), 2e-6))
}

fn r6c(links: Links, name: &str) -> Cell {
    let mut net = sagging(links, 200.0, 0.08);
    let (dt, tolerance) = match name {
        "XPBD" => (1.0 / 3840.0, 2e-6),
        "Euler" | "BDF2" => (0.1, 1e-9),
        _ => (0.004, 1e-9),
    };
    go(&mut net, name, 10, dt, 20.0);
    let [sag, pull] = theory::net(16, |tension| 0.08 + tension / 200.0);
    let sag_off = (-links.point(&net, 8).z - sag).abs();
    let pulls = links.at(0).map(|held| -force::reaction_n(&net, held).x);
    let pull_off = (pulls.sum::<f64>() - pull).abs();
    // XPBD shares forces wrongly.
    let off = sag_off.max(if projects(name) { 0.0 } else { pull_off });
    Some((off, tolerance))
}

/// The strain of the top link under the force that is to bring it to its threshold, as a weight.
fn r7(links: Links, name: &str) -> Cell {
    // 1.519 N more at the end: m g N + F = k L ε.
    let mut chain = links.row(1, 0.01 * 10.0 + 1.519 / 9.81, 50.0, 0.1, Vector::z() * -0.1);
    chain.set_loads(gravity(6.0)).expect("loads");
    let dt = if is_stiff(name) { 0.1 } else { 0.01 };
    go(&mut chain, name, 400, dt, 30.0);
    let strain = -links.point(&chain, 1).z / 0.1 - 1.0;
    let energy = energy::elastic_j(&chain);
    Some(((strain - 0.5).abs().max((energy - 0.0625).abs()), 1e-9))
}

fn r9(links: Links, name: &str) -> Cell {
    let mut sheet = links.row(4, 0.1, 20.0, 0.25, Vector::x() * 0.25);
    links.at(0).for_each(|particle| sheet.release(particle));
    sheet.set_loads(gravity(0.0)).expect("loads");
    run_with(&mut sheet, &mut *method(name, 3), 1.0 / 60.0, 60);
    let fallen = theory::fall(name, 1.0 / 60.0, 60);
    let strain = energy::elastic_j(&sheet).sqrt();
    let off = sheet.positions().iter().map(|p| (p.z + fallen).abs());
    Some((off.fold(strain, f64::max), 1e-12))
}

fn r10(links: Links, name: &str) -> Cell {
    let r = 100.0 / 190.0;
    let mut pair = links.row(1, 0.1, 100.0, 1.0, Vector::x() * (2.0 * r));
    links.at(0).for_each(|particle| pair.release(particle));
    for i in 0..2 {
        let side = 2.0 * i as f64 - 1.0;
        links.change(&mut pair, i, |p, v| {
            p.x -= r;
            v.z = side * 10.0 * r;
        });
    }
    let (dt, tolerance) = match name {
        "Verlet" | "guarded" => (2e-4, 1e-5),
        "RK4" => (1e-3, 1e-8),
        "Provot" => (1e-4, 1e-2),
        "BDF2" => (2e-4, 1e-3),
        _ => (1e-5, 1e-2),
    };
    go(&mut pair, name, 1, dt, 0.5);
    let energy = mechanical_j(&pair);
    let radius = (links.point(&pair, 1) - links.point(&pair, 0)).norm() / 2.0;
    let answer = 10.0 * r * r + 50.0 * (2.0 * r - 1.0).powi(2);
    let [radius_off, energy_off] = [radius / r, energy / answer].map(|part| (part - 1.0).abs());
    Some((radius_off.max(energy_off), tolerance))
}

/// A net or a sheet in a frame, against an answer by relaxation.
fn r11(links: Links, name: &str) -> Cell {
    let (dt, tolerance) = match name {
        "XPBD" => (0.02 / 16.0, 1e-4),
        "Euler" | "BDF2" => (0.05, 1e-9),
        _ => (0.004, 1e-9),
    };
    let (mut net, answer) = match links {
        Links::Springs => {
            let net = framed(6, 100.0, 8.0);
            (net.clone(), relaxed_net(&net))
        }
        Links::Triangles => {
            let sheet = woven::framed(6, weave());
            (sheet.system().clone(), relaxed_sheet(&sheet))
        }
    };
    go(&mut net, name, 20, dt, 15.0);
    let apart = net.positions().iter().zip(&answer);
    let off = apart.map(|(p, q)| (p - q).norm());
    Some((off.fold(0.0, f64::max), tolerance))
}

/// Where a sheet of triangles rests that is flat without loads.
fn relaxed_sheet(sheet: &Cloth) -> Vec<Point> {
    let Orthotropic {
        warp_n_per_m: k_u,
        weft_n_per_m: k_v,
        shear_n_per_m: k_s,
        warp,
    } = weave();
    let e = warp.normalize();
    let f = Vector::new(-e.y, e.x, 0.0);
    let rest = sheet.rest_positions();
    // By face: corners, area, and how w_u and w_v change with each corner.
    let faces: Vec<_> = sheet
        .indices()
        .chunks_exact(3)
        .map(|face| {
            let corners = [0, 1, 2].map(|i| face[i] as usize);
            let [p, q, r] = corners.map(|v| rest[v].coords);
            let normal = (q - p).cross(&(r - p));
            // The height over each side, turned a quarter, over twice the area.
            let slope = |from: Vector, to: Vector| normal.cross(&(to - from)) / normal.dot(&normal);
            let slopes = [slope(q, r), slope(r, p), slope(p, q)];
            (
                corners,
                0.5 * normal.norm(),
                slopes.map(|s| [s.dot(&e), s.dot(&f)]),
            )
        })
        .collect();
    relaxed(sheet.system(), |points, i| {
        let (mut force, mut stiffness) = (Vector::zeros(), 0.0);
        for (corners, area, slopes) in &faces {
            let Some(own) = corners.iter().position(|&v| v == i) else {
                continue;
            };
            let w = |c: usize| {
                let parts = corners.iter().zip(slopes);
                parts.fold(Vector::zeros(), |w, (&v, s)| w + points[v].coords * s[c])
            };
            let (w_u, w_v) = (w(0), w(1));
            let shear = k_s * w_u.dot(&w_v);
            let p_u = w_u * (k_u * (1.0 - 1.0 / w_u.norm())) + w_v * shear;
            let p_v = w_v * (k_v * (1.0 - 1.0 / w_v.norm())) + w_u * shear;
            let [g, h] = slopes[own];
            force -= (p_u * g + p_v * h) * *area;
            stiffness += area * ((k_u + 2.0 * k_s) * g * g + (k_v + 2.0 * k_s) * h * h);
        }
        (force, stiffness)
    })
}

/// R8 is of the net, not of the method: E, ν and the shear by pulling of springs in three directions alike,
/// and of one diagonal a cell.
#[test]
fn r8_moduli_of_nets() {
    let height = 0.75_f64.sqrt();
    let alike = [[1.0, 0.0], [0.5, height], [-0.5, height]];
    let diagonal = [[1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    for (area, springs, answers) in [
        (height, alike, [1_154.700_538_379_25, 1.0 / 3.0, 0.0]),
        (1.0, diagonal, [1000.0, 0.0, -1.0]),
    ] {
        let ends = springs.map(|[x, y]| [[0.0; 3], [x, y, 0.0]]).concat();
        let mut cell = System::new(ends.into_iter().map(Point::from), vec![1.0; 6]).expect("ends");
        for i in [0, 2, 4] {
            let length_m = (cell.positions()[i + 1] - cell.positions()[i]).norm();
            cell.stretch([i, i + 1], length_m, 1000.0)
                .expect("a spring");
        }
        let [[xx, xy, xs], [_, yy, _], [_, _, ss]] =
            moduli(&cell, area, [Vector::x(), Vector::y()]);
        // Pulled along x and free otherwise; shear couples with x and y alike.
        let ys = if area < 1.0 { 0.0 } else { xs };
        let det = yy * ss - ys * ys;
        let (across, shear) = (-(xy * ss - xs * ys) / det, -(xs * yy - xy * ys) / det);
        let e = xx + xy * across + xs * shear;
        near(e, answers[0], 1e-5);
        near(-across, answers[1], 1e-8);
        near(shear, answers[2], 1e-8);
    }
}

const ROWS: [Row; 13] = [
    ("R1 oscillator, discrete motion (of amplitude)", r1),
    ("R2 hanging chain, 1.10791 (m)", r2),
    ("R3 mode 1 along, discrete motion", |links, name| {
        mode(links, name, 1.0, false)
    }),
    ("R3 mode 31 along, discrete motion", |links, name| {
        mode(links, name, 31.0, false)
    }),
    ("R4 mode 1 across, discrete motion", |links, name| {
        mode(links, name, 1.0, true)
    }),
    ("R5 pendulum from 45°, period (s)", |links, name| {
        r5(links, name, FRAC_PI_4)
    }),
    ("R5 pendulum from 90°, period (s)", |links, name| {
        r5(links, name, FRAC_PI_2)
    }),
    ("R6b rigid catenary, sag (m)", r6b),
    ("R6c elastic catenary, sag (m) and pull (N)", r6c),
    ("R7 onset at 1.519 N, strain and J", r7),
    ("R9 free fall (m) and strain", r9),
    ("R10 rotating pair, r and E, relative", r10),
    ("R11 drape in a frame (m)", r11),
];

#[test]
fn table_of_reference_answers() {
    let mut wrong = Vec::new();
    for links in [Links::Springs, Links::Triangles] {
        let takes = |name: &&&str| links == Links::Springs || !projects(name);
        for (title, row) in ROWS {
            let is_soft = ["R2", "R6c", "R7", "R10", "R11"]
                .iter()
                .any(|of| title.starts_with(of));
            for name in METHODS.iter().filter(takes) {
                // The links of PBD have no stiffness.
                if is_soft && *name == "PBD" {
                    continue;
                }
                let Some((error, tolerance)) = row(links, name) else {
                    continue; // The answer is none of the method's.
                };
                if error.is_nan() || error > tolerance {
                    wrong.push(format!(
                        "{title}, {links:?}, {name}: {error:e} > {tolerance:e}"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// By a dense matrix, and never beyond the bound.
#[test]
fn largest_frequencies_of_chains_are_those_of_closed_forms() {
    let mut held = row(32, 0.02, 1000.0, 0.03, Vector::x() * 0.03);
    held.hold(32);
    let free = row(31, 0.02, 1000.0, 0.03, Vector::x() * 0.03);
    let oscillator = row(1, 0.01, 40.0, 1.0, Vector::x());
    let most = 2.0 * 50_000.0_f64.sqrt();
    for (mut system, answer, bound) in [
        (oscillator, 4000.0_f64.sqrt(), 4000.0_f64.sqrt()),
        (held, most * (31.0 * PI / 64.0).sin(), most),
        (free, most * (61.0 * PI / 126.0).sin(), most),
    ] {
        near(largest_frequency(&system) / answer, 1.0, 1e-6);
        near(frequency_bound(&mut system).omega_rad_per_s, bound, 1e-9);
    }
}

/// The relative error in x and v/ω after 0.25 s.
fn error(links: Links, name: &str, dt: f64) -> f64 {
    let omega = 4000.0_f64.sqrt();
    let mut system = links.row(1, 0.01, 40.0, 1.0, Vector::x());
    links.change(&mut system, 1, |p, _| p.x = 1.1);
    let steps = (0.25 / dt).round() as usize;
    run_with(&mut system, &mut *method(name, 1), dt, steps);
    let x = links.point(&system, 1).x - 1.0 - 0.1 * (omega * 0.25).cos();
    let v = system.velocities()[links.at(1).start].x / omega + 0.1 * (omega * 0.25).sin();
    (x * x + v * v).sqrt() / 0.1
}

/// PBD has none: as Δt → 0 it converges to no solution (F7).
#[test]
fn table_of_orders() {
    for links in [Links::Springs, Links::Triangles] {
        for &name in METHODS {
            let (dt, expected) = match name {
                "Verlet" | "guarded" => (1.0 / 4096.0, 2.0),
                "BDF2" => (1.0 / 8192.0, 2.0),
                "RK4" => (1.0 / 1024.0, 4.0),
                "PBD" => continue,
                "XPBD" if links == Links::Triangles => continue,
                _ => (1.0 / 32_768.0, 1.0),
            };
            let errors = [dt, dt / 2.0].map(|dt| error(links, name, dt));
            near(order(errors), expected, 0.05);
        }
    }
}
