//! Closed answers, and what each method makes of y′ = i ω y: x and v/ω of an oscillator as one complex
//! number.

use std::f64::consts::PI;

use nalgebra::Complex;

use crate::parts::{G, bisect};

/// The position after 0, 1, 2, … steps of an oscillator that starts from 1 at rest, as the method
/// makes it with z = ω Δt. `None` for PBD, which has no frequency.
pub(super) fn oscillation(method: &str, z: f64, steps: usize) -> Option<Vec<f64>> {
    let turn = (1.0 - z * z / 2.0).acos();
    let times = 0..=steps;
    let powers = |factor: Complex<f64>| -> Vec<f64> {
        let power = |n| factor.powu(n).re;
        (0..=steps as u32).map(power).collect()
    };
    match method {
        "Verlet" | "guarded" => Some(times.map(|n| (turn * n as f64).cos()).collect()),
        // The same recurrence, but velocities stand half a step apart.
        "Provot" => {
            let sine = ((1.0 - z * z) - turn.cos()) / turn.sin();
            let of = |n: usize| (turn * n as f64).cos() + sine * (turn * n as f64).sin();
            Some(times.map(of).collect())
        }
        "RK4" => {
            let even = 1.0 - z * z / 2.0 + z * z * z * z / 24.0;
            Some(powers(Complex::new(even, z - z * z * z / 6.0)))
        }
        "Euler" | "XPBD" => Some(powers(Complex::new(1.0, -z).inv())),
        "BDF2" => {
            let mut before = Complex::new(1.0, 0.0);
            let mut y = Complex::new(1.0, -z).inv();
            let mut all = vec![before.re];
            for _ in 0..steps {
                all.push(y.re);
                let sum = (y * 4.0 - before) / 3.0;
                before = y;
                y = sum / Complex::new(1.0, -2.0 * z / 3.0);
            }
            Some(all)
        }
        _ => None,
    }
}

/// How far the method falls under G m/s² in a number of steps of Δt, from rest.
pub(super) fn fall(method: &str, dt: f64, steps: usize) -> f64 {
    let (mut x, mut v) = (0.0, 0.0);
    let (mut x_before, mut v_before) = (0.0, 0.0);
    for step in 0..steps {
        let (x_now, v_now) = (x, v);
        match method {
            "Verlet" | "guarded" | "RK4" => {
                x += v * dt + 0.5 * G * dt * dt;
                v += G * dt;
            }
            "BDF2" if step > 0 => {
                v = (4.0 * v_now - v_before + 2.0 * G * dt) / 3.0;
                x = (4.0 * x_now - x_before + 2.0 * v * dt) / 3.0;
            }
            _ => {
                v += G * dt;
                x += v * dt;
            }
        }
        (x_before, v_before) = (x_now, v_now);
    }
    x
}

/// The period of a pendulum of one metre by the arithmetic–geometric mean.
pub(super) fn period(angle: f64) -> f64 {
    let (mut a, mut b) = (1.0, (angle / 2.0).cos());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    2.0 * PI / (G.sqrt() * a)
}

/// The sag of a net of `n` links between nails a metre apart, and its horizontal force: link by link from
/// the middle, each as long as `length` says for its tension.
pub(super) fn net(n: usize, length: impl Fn(f64) -> f64) -> [f64; 2] {
    let half = |h: f64| {
        let (mut span, mut sag) = (0.0, 0.0);
        for i in 0..n / 2 {
            let v = 0.01 * G * (i as f64 + 0.5);
            let tension = h.hypot(v);
            span += 2.0 * length(tension) * h / tension;
            sag += length(tension) * v / tension;
        }
        [span, sag]
    };
    let h = bisect(1e-6, 10.0, |h| half(h)[0] - 1.0);
    [half(h)[1], h]
}
