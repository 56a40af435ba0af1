//! Scenes that play on a square metre.

use tearmesh::{Mesh, Positions, shapes};
use tearmesh_cloth::Method;
use tearmesh_cloth::implicit::Settings;
use tearmesh_cloth::scene::{Axis, Frame, Run, Scene};
use tearmesh_cloth::{Limiter, Pbd, Xpbd};

/// A square of one metre with `cells` cells per side and alternating diagonals.
pub(crate) fn square(cells: u32) -> (Mesh, Positions) {
    shapes::grid_with_diagonals(cells, cells, |i, j| (i + j) % 2 == 0)
}

/// A scene on a [`square`], about to begin.
pub(crate) fn staged(cells: u32, scene: impl Fn(&Frame) -> Scene) -> Run {
    let (mesh, positions) = square(cells);
    let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
    Run::new(mesh, &positions, scene(&frame), &frame).expect("a scene")
}

/// Plays a run to its end.
///
/// # Panics
///
/// If a step fails.
pub(crate) fn play(mut run: Run) -> Run {
    while !run.is_over() {
        run.step().expect("a step");
    }
    run
}

/// Every method that a scene can name, by its name.
pub(crate) fn methods() -> [(&'static str, Method); 5] {
    [
        ("xpbd", Method::Xpbd(Xpbd::new(1, 1))),
        ("pbd", Method::Pbd(Pbd::default())),
        ("verlet", Method::Verlet),
        ("provot", Method::Provot(Limiter::default())),
        ("implicit", Method::Implicit(Settings::default())),
    ]
}
