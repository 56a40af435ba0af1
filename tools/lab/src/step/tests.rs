//! The time step of small scenes, from the runs to the words.

use std::num::NonZero;

use tearmesh::shapes;
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::{Axis, Frame, Scene};

use super::*;
use crate::experiment::{Chart as _, Draw as _, Provenance, conduct};

/// The rows of a scene on a square, at this step.
fn played(method: &str, step_s: f64, scene: fn(&Frame) -> Scene) -> Vec<Row> {
    let (mesh, positions) = shapes::grid(8, 8);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    let scene = Scene {
        solver: Method::named(method).expect("a method"),
        step_s: Some(step_s),
        duration_s: 1.0,
        ..scene(&frame)
    };
    let subject = Some(Subject {
        mesh: &mesh,
        positions: &positions,
        frame: &frame,
        scene: &scene,
    });
    let experiment = Step {
        subject,
        step_s,
        seeds: 4,
    };
    let bounds = Bounds {
        clock: None,
        stop: &|| false,
    };
    let (rows, done) = conduct(&experiment, NonZero::<usize>::MIN, &bounds, |_| {});
    assert_eq!((rows.len(), done), (8, 8));
    rows
}

const DRAWN: Step<'_> = Step {
    subject: None,
    step_s: 0.0,
    seeds: 0,
};

/// What does not tear has no first tear at either step, and one piece.
#[test]
fn a_sheet_that_hangs_is_the_same_at_half_the_step() {
    let rows = played("xpbd", 0.004, Scene::hang);
    let words = DRAWN.summary(&rows);
    for line in [
        "4 runs at 0.004 s and 4 runs at 0.002 s",
        "  first tear     none                           none                           same",
        "  pieces         1 (1 to 1)                     1 (1 to 1)                     same",
    ] {
        assert!(words.contains(line), "{words}");
    }
    assert!(!words.contains("differ"), "{words}");
}

/// The longer a step of PBD, the softer its cloth: it tears long before what is dragged is drawn tight.
#[test]
fn a_rip_by_pbd_depends_on_its_step() {
    let rows = played("pbd", 0.033, Scene::rip);
    let words = DRAWN.summary(&rows);
    assert!(
        words.starts_with("The result depends on the time step: "),
        "{words}"
    );
    assert!(words.contains("largest force"), "{words}");
}

#[test]
fn failed_runs_allow_no_verdict_and_are_counted() {
    let mut rows = played("xpbd", 0.004, Scene::hang);
    let why = "the simulation blew up".to_owned();
    rows[0] = Row {
        status: Status::Failed,
        why,
        ..rows[0].clone()
    };
    let words = DRAWN.summary(&rows);
    assert!(
        words.contains("1 of 8 runs failed: the simulation blew up"),
        "{words}"
    );
    assert!(words.contains("they cannot tell: "), "{words}");
    rows.iter_mut().for_each(|row| row.status = Status::Failed);
    let words = DRAWN.summary(&rows);
    assert!(
        words.starts_with("No run reached its end at both steps; 8 of 8 "),
        "{words}"
    );
}

/// A table that is read draws the figure of the runs that wrote it.
#[test]
fn a_table_draws_the_same_figure() {
    let rows = played("xpbd", 0.004, Scene::rip);
    let table = crate::experiment::table(&rows);
    let drawing = DRAWN
        .draw(&table, &Provenance::default())
        .expect("its own table");
    assert_eq!(drawing.table, table);
    assert_eq!(drawing.summary, DRAWN.summary(&rows));
    assert!(drawing.svg.contains("work of holds"));
}
