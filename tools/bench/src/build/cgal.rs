//! CGAL's `Surface_mesh`, in a process of its own: `rivals/cgal.cpp`.

use std::fmt::Write as _;
use std::process::Command;

use super::triangles::Triangles;
use crate::process::{Process, Program};

/// Compiles the program against the headers that are installed; or why that cannot be.
pub(super) fn compile() -> Result<Program, String> {
    Program::compile("cgal", &["-DNDEBUG", "-march=native", "-lgmp"])
}

/// A mesh of some triangles.
pub(super) struct Cgal(Process);

impl Cgal {
    pub(super) fn start(program: &Program, triangles: &Triangles) -> Option<Cgal> {
        let mut told = format!("{} {}\n", triangles.vertices, triangles.corners.len());
        for [a, b, c] in &triangles.corners {
            writeln!(told, "{a} {b} {c}").expect("a string takes all");
        }
        Process::start(&mut Command::new(program.path()), &told).map(Cgal)
    }

    pub(super) fn version(&self) -> &str {
        &self.0.version
    }

    /// How many seconds it takes to `build`, or to `walk` round all vertices, and how many faces are met.
    pub(super) fn ask(&self, what: &str) -> (f64, usize) {
        let answer = self.0.ask(what);
        let mut words = answer.split(' ');
        let mut word = || words.next().expect("three numbers");
        let seconds = word().parse().expect("a number of seconds");
        (seconds, word().parse().expect("a number of faces"))
    }
}
