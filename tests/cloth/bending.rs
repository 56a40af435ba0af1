//! Bends that buckle, in systems and cloths: against the formulas of Choi and Ko, the implicit
//! solver by itself, and dense eigenvalues.

use tearmesh::{Point, Positions, Vector, shapes};
use tearmesh_cloth::implicit::Method;
use tearmesh_cloth::{
    Bending, Buckling, Cloth, Fabric, Implicit, Loads, Pbd, Solver, Xpbd, energy, force,
    frequency_bound,
};

use crate::parts::cloths::{cloth, loaded};
use crate::parts::vibration::largest_frequency;
use crate::parts::woven::weave;
use crate::parts::{bisect, implicit_to, near, on_a_line, pulled, run, shake};
use crate::random::Random;

fn law(buckles_below: f64) -> Buckling {
    Buckling::new(buckles_below).expect("between 0 and 1")
}

fn arcs(rigidity_n_m: f64, buckles_below: f64) -> Fabric {
    let law = law(buckles_below);
    Fabric {
        bend: Some(Bending::Buckling { rigidity_n_m, law }),
        ..Fabric::of_edges(200.0)
    }
}

/// A sheet of 3 × 3 cells, whose vertices were all thrown up to `by` metres.
fn crumpled(fabric: Fabric, by: f64, seed: u64) -> Cloth {
    let (_, mut cloth) = loaded(3, fabric, Loads::default());
    shake(cloth.system_mut(), 2.0 * by, 0.0, &mut Random(seed));
    cloth
}

/// Half the angle of an arc of length 1 whose ends are this far apart: sin t = t d, by bisection.
fn half_angle(d: f64) -> f64 {
    bisect(0.0, std::f64::consts::PI, |t| t * d - t.sin())
}

/// The arc's force by the formula of the paper, with sines.
fn arc_force(k: f64, l: f64, d: f64) -> f64 {
    let t = half_angle(d / l);
    let kappa = 2.0 * t / l;
    k * kappa * kappa / (t.cos() - t.sin() / t)
}

/// Its energy, ½ k κ² L.
fn arc_energy(k: f64, l: f64, d: f64) -> f64 {
    0.5 * k * (2.0 * half_angle(d / l) / l).powi(2) * l
}

#[test]
fn a_bend_has_the_force_of_an_arc_or_the_spring_before() {
    let (l, c) = (0.2, 7.0);
    for below in [0.6, 0.8, 0.95, 0.999] {
        let mut system = on_a_line([0.0, l], 1.0);
        system.bend([0, 1], l, c).expect("a bend");
        system.set_buckling(Some(law(below)));
        // The flexural stiffness is the one whose arc has the spring's force at the change-over.
        let k = c * (below * l - l) / arc_force(1.0, l, below * l);
        near(law(below).compression_n_per_m(k, l), c, 1e-12 * c);
        let change = 0.5 * c * (l - below * l).powi(2) - arc_energy(k, l, below * l);
        for i in 1..=120 {
            let d = l * f64::from(i) / 100.0;
            system.state_mut().0[1].x = d;
            let spring = c * (d - l);
            let (force, energy) = if d >= l {
                (0.0, 0.0)
            } else if d < below * l {
                (arc_force(k, l, d), arc_energy(k, l, d) + change)
            } else {
                (spring, 0.5 * spring * (d - l))
            };
            // Which of both acts is the larger of both, tension positive.
            assert!(d >= l || (force - arc_force(k, l, d).max(spring)).abs() < 1e-9);
            near(-force::reaction_n(&system, 0).x, force, 1e-9);
            near(energy::elastic_j(&system), energy, 1e-12);
        }
    }
}

/// However it is crumpled, and also where arcs are far stiffer than the springs before them.
#[test]
fn no_frequency_is_beyond_the_bound() {
    for (rigidity, below) in [(6e-3, 0.95), (6e-2, 0.6), (2.0, 0.6), (0.3, 0.9)] {
        let fabric = arcs(rigidity, below);
        let mut flat = crumpled(fabric, 0.0, 0);
        let measured = largest_frequency(flat.system());
        let bound = frequency_bound(flat.system_mut()).omega_rad_per_s;
        let mut most = 0.0_f64;
        for seed in 0..12 {
            let by = [0.02, 0.1, 0.3, 1.0][seed as usize % 4];
            let mut cloth = crumpled(fabric, by, seed);
            // Some ends meet.
            let meet = cloth.system().positions()[3];
            cloth.system_mut().state_mut().0[9] = meet;
            most = most.max(largest_frequency(cloth.system()));
        }
        assert!(most <= bound, "{most} {bound}");
        assert!(measured <= bound);
    }
}

/// Two particles and an arc: the limit is that of the arc at its stiffest, where both ends meet.
#[test]
fn the_limit_is_known_before_it_folds() {
    let (l, c, m) = (0.1, 5.0, 0.01);
    for below in [0.6, 0.7, 0.95] {
        let mut system = on_a_line([0.0, l], m);
        system.bend([0, 1], l, c).expect("a bend");
        let of_springs = frequency_bound(&mut system).omega_rad_per_s;
        near(of_springs, (2.0 * c / m).sqrt(), 1e-6);
        system.set_buckling(Some(law(below)));
        system.hold(0);
        let omega = frequency_bound(&mut system).omega_rad_per_s;
        // By a difference of the paper's force near the place where the ends meet.
        let k = c * (below * l - l) / arc_force(1.0, l, below * l);
        let h = 1e-7 * l;
        let slope = (arc_force(k, l, 3.0 * h) - arc_force(k, l, h)) / (2.0 * h);
        near(omega * omega * m / slope.max(c), 1.0, 1e-4);
    }
}

#[test]
fn methods_that_project_refuse_what_is_no_spring() {
    for (fabric, refused) in [
        (arcs(6e-3, 0.9), "21 bends buckle"),
        (Fabric::orthotropic(weave()), "18 triangles resist stretch"),
    ] {
        let mut cloth = crumpled(fabric, 0.05, 1);
        for solver in [&mut Pbd::default() as &mut dyn Solver, &mut Xpbd::default()] {
            let before = cloth.positions().to_vec();
            let error = cloth.step(solver, 1e-3).expect_err("springs alone");
            assert_eq!(cloth.positions(), before);
            let text = format!("the method supports springs only, and {refused}");
            assert_eq!(error.to_string(), text);
        }
        cloth.step(&mut Implicit::default(), 0.01).expect("a step");
    }
}

/// A strip that is clamped at one end and sags under its weight, on three meshes, against a thin plate
/// whose small sag is q L⁴ / (8 B): within 5 %, but where all diagonals go one way. Only the strips across
/// one direction of edges bend there, which are √5 / 2 times as long as with alternating diagonals, and the
/// resistance to the same curve falls with the fourth power of that, 1.56.
#[test]
fn a_clamped_strip_sags_as_a_plate_unless_diagonals_align() {
    let even = |i: u32, j: u32| (i + j).is_multiple_of(2);
    for (rising, jitter, multiple) in [
        (&even as &dyn Fn(u32, u32) -> bool, 0.0, 1.0),
        (&even, 0.3, 1.0),
        (&|_, _| true, 0.0, 1.73),
    ] {
        let ratio = sag_of_a_strip_m(rising, jitter) / SAG_OF_A_PLATE_M;
        near(ratio, multiple, 0.05 * multiple);
    }
}

/// Cells of a strip of one metre, of the same size as one.
const CELLS: u32 = 8;
/// Its rigidity, and the force of its weight on an area: it is nearly straight.
const RIGIDITY_N_M: f64 = 1e-5;
const WEIGHT_N_PER_M2: f64 = 0.8 * RIGIDITY_N_M;
/// An edge bends the cloth half a cell to either side of it, so the clamp ends half a cell before the last
/// vertices that it holds.
const SAG_OF_A_PLATE_M: f64 = {
    let length_m = 1.0 + 0.5 / CELLS as f64;
    WEIGHT_N_PER_M2 * (length_m * length_m * length_m * length_m) / (8.0 * RIGIDITY_N_M)
};

/// How far the end of a strip sags whose diagonals are those of `rising`, and whose inner vertices are up
/// to so many cells off the grid.
fn sag_of_a_strip_m(rising: &dyn Fn(u32, u32) -> bool, jitter: f64) -> f64 {
    let columns = CELLS + 1;
    let (mesh, square) = shapes::grid_with_diagonals(columns, 2, rising);
    let mut random = Random(5);
    let points = square.as_slice().iter().map(|p| {
        let [column, row] = [p.x * f64::from(columns), 2.0 * p.y];
        let is_inner = column > 1.5 && p.x < 0.999 && (0.5..1.5).contains(&row);
        let off = [0, 1].map(|_| jitter * (2.0 * random.next() - 1.0));
        let [x, y] = if is_inner { off } else { [0.0; 2] };
        Point::new(column + x - 1.0, row + y, 0.0) / f64::from(CELLS)
    });
    let positions = Positions::new(points).expect("a strip");
    let fabric = Fabric {
        stretch: Fabric::new(1000.0).stretch,
        ..arcs(RIGIDITY_N_M, 1.0 - 1e-5)
    };
    let mut cloth = cloth(&mesh, &positions, fabric);
    let rest = positions.as_slice();
    let system = cloth.system_mut();
    for v in (0..rest.len()).filter(|&v| rest[v].x < 1e-9) {
        system.hold(v);
    }
    let loads = pulled(Vector::z() * (-WEIGHT_N_PER_M2 / 0.2), 0.0);
    system.set_loads(loads).expect("loads");
    // Long steps, which damp.
    run(system, implicit_to(Method::BackwardEuler, 1e-6), 20.0, 200);
    let end = (0..rest.len()).filter(|&v| rest[v].x > 0.999);
    let sags = end.map(|v| -cloth.positions()[v].z);
    sags.fold(0.0, |sum, sag| sum + sag / 3.0)
}
