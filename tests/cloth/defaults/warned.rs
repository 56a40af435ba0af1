//! The errors that are printed of methods, and those that they have beside Verlet's method at a quarter of its step.

use std::f64::consts::TAU;

use tearmesh::{Mesh, Positions, Vector};
use tearmesh_cloth::scene::{Axis, Frame, HeldVertices, Run, Scene, Warning, Wording};
use tearmesh_cloth::{FRAME_S, Method};

use super::sheets;
use crate::parts::scenes::top;

/// A sheet that is held at its upper edge, and swings out of its plane from where it is let go, a little more than once.
#[derive(Clone, Copy)]
struct Sheet {
    size_m: f64,
    gravity_m_per_s2: Vector,
}

impl Sheet {
    /// A run by a method, about to begin, and the note about what it takes of a swing.
    fn run(&self, solver: Method, step_s: Option<f64>) -> (Run, Option<String>) {
        let (mesh, positions) = self.mesh();
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let scene = Scene {
            solver,
            step_s,
            duration_s: 1.25 * self.period_s(),
            drag_per_s: 0.0,
            gravity_m_per_s2: self.gravity_m_per_s2,
            holds: vec![HeldVertices::still(top())],
            tearing: None,
            ..Scene::fall(Axis::Y)
        };
        let run = Run::new(mesh, &positions, scene, &frame).expect("a scene");
        let warnings = Warning::before(&run, &frame, &Wording::default());
        let mut notes = warnings.iter().filter(|one| one.code() == "W-SIM-FADE");
        let note = notes.next().map(ToString::to_string);
        (run, note)
    }

    fn mesh(&self) -> (Mesh, Positions) {
        let (mesh, positions) = sheets::grid(12, 0.0);
        let scaled = positions.as_slice().iter().map(|p| *p * self.size_m);
        (mesh, Positions::new(scaled).expect("points"))
    }

    /// The period of a chain of this length.
    fn period_s(&self) -> f64 {
        let g_m_per_s2 = self.gravity_m_per_s2.norm().max(1.0);
        TAU / 1.2024 * (self.size_m / g_m_per_s2).sqrt()
    }

    /// Verlet's method at a quarter of its step.
    fn reference(&self) -> Run {
        let step_s = self.run(Method::Verlet, None).0.step_s();
        self.run(Method::Verlet, Some(step_s / 4.0)).0
    }

    /// How far the sheet as a whole is from its place at rest, across gravity, when it has swung forth and back.
    fn swing(&self, mut run: Run) -> f64 {
        let across = Vector::x().cross(&self.gravity_m_per_s2).normalize();
        let hook = Vector::y() * self.size_m;
        let mut most = f64::NEG_INFINITY;
        while !run.is_over() {
            run.step().expect("a step");
            if run.elapsed_s() > 0.75 * self.period_s() {
                let positions = run.cloth().positions().iter();
                let out = positions.map(|p| across.dot(&(p.coords - hook))).sum();
                most = f64::max(most, out);
            }
        }
        most
    }
}

/// The number in front of a text.
fn number_before(text: &str, after: &str) -> f64 {
    let before = text.split(after).next().unwrap_or_default();
    let number = before.rsplit(' ').next().unwrap_or_default();
    number.parse().expect("a number")
}

#[test]
fn a_swing_fades_by_implicit_steps_as_is_said() {
    let usual = Sheet {
        size_m: 1.0,
        gravity_m_per_s2: Vector::new(0.0, -9.8, 1.0),
    };
    let small = Sheet {
        size_m: 0.3,
        ..usual
    };
    let large = Sheet {
        size_m: 4.0,
        ..usual
    };
    let on_the_moon = Sheet {
        gravity_m_per_s2: Vector::new(0.0, -1.6, 0.3),
        ..usual
    };
    let implicit = || Method::named("implicit").expect("a method");
    let frame_s = Some(FRAME_S);
    for (sheet, step_s) in [
        (usual, None),
        (usual, frame_s),
        (small, None),
        (large, frame_s),
        (on_the_moon, frame_s),
    ] {
        let (run, note) = sheet.run(implicit(), step_s);
        let said = number_before(&note.expect("a note"), " % of its swing") / 100.0;
        let exact = sheet.swing(sheet.reference());
        let lost = 1.0 - sheet.swing(run) / exact;
        assert!((0.5..2.0).contains(&(said / lost)), "{said} {lost}");
        assert_eq!(sheet.run(Method::Verlet, step_s).1, None);
    }
    let weightless = Sheet {
        gravity_m_per_s2: Vector::zeros(),
        ..usual
    };
    assert_eq!(weightless.run(implicit(), frame_s).1, None);
}
