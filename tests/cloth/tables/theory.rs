//! What each method makes of y′ = i ω y: x and v/ω of an oscillator as one complex number.

use nalgebra::Complex;

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

/// How far the method falls under 9.81 m/s² in a number of steps of Δt, from rest.
pub(super) fn fall(method: &str, dt: f64, steps: usize) -> f64 {
    let (mut x, mut v) = (0.0, 0.0);
    let (mut x_before, mut v_before) = (0.0, 0.0);
    for step in 0..steps {
        let (x_now, v_now) = (x, v);
        match method {
            "Verlet" | "guarded" | "RK4" => {
                x += v * dt + 0.5 * 9.81 * dt * dt;
                v += 9.81 * dt;
            }
            "BDF2" if step > 0 => {
                v = (4.0 * v_now - v_before + 2.0 * 9.81 * dt) / 3.0;
                x = (4.0 * x_now - x_before + 2.0 * v * dt) / 3.0;
            }
            _ => {
                v += 9.81 * dt;
                x += v * dt;
            }
        }
        (x_before, v_before) = (x_now, v_now);
    }
    x
}
