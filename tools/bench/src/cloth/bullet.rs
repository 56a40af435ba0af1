//! Bullet's soft body, in a process of its own: `rivals/bullet.cpp`.

use std::fmt::Write as _;
use std::io;
use std::process::Command;

use tearmesh::Point;
use tearmesh_cloth::System;

use super::sheet::{GRAVITY_M_PER_S2, Run, STEP_S};
use crate::process::{Process, Program, said};

/// Compiles the program against the library that is installed; or why that cannot be.
pub(super) fn compile() -> Result<Program, String> {
    let flags = said(Command::new("pkg-config").args(["--cflags", "--libs", "bullet"]));
    let Some(flags) = flags.filter(|output| output.status.success()) else {
        return Err("not installed (libbullet-dev, pkg-config)".to_owned());
    };
    let flags = String::from_utf8_lossy(&flags.stdout).into_owned();
    Program::compile(
        "bullet",
        &flags.split_ascii_whitespace().collect::<Vec<_>>(),
    )
}

/// The order in which Bullet has its links.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// That of the mesh.
    Mesh,
    /// That of the mesh, after Bullet's own `ReoptimizeLinkOrder`.
    Reoptimised,
    /// That of our colours.
    Colours,
}

/// A body that is ready to be stepped.
pub(super) struct Bullet {
    process: Process,
    links: usize,
}

impl Bullet {
    pub(super) fn start(program: &Program, system: &System, order: Order) -> io::Result<Bullet> {
        let constraints = system.stretches();
        let mut ids: Vec<_> = constraints.iter().collect();
        if order != Order::Colours {
            ids.sort_unstable();
        }
        let mut sheet = format!(
            "particles {} links {} gravity {GRAVITY_M_PER_S2}\n",
            system.positions().len(),
            ids.len()
        );
        for (particle, p) in system.positions().iter().enumerate() {
            let held = system.is_held(particle);
            let mass = if held { 0.0 } else { system.masses()[particle] };
            writeln!(sheet, "{} {} {} {mass:e}", p.x, p.y, p.z).expect("a string takes all");
        }
        for &id in &ids {
            let [a, b] = constraints.get(id).ends;
            writeln!(sheet, "{a} {b}").expect("a string takes all");
        }
        let mut command = Command::new(program.path());
        if order == Order::Reoptimised {
            command.arg("reoptimised");
        }
        let process = Process::start(&mut command, &sheet);
        let process = process.ok_or_else(|| io::Error::other("it does not start"))?;
        let links = ids.len();
        Ok(Bullet { process, links })
    }

    pub(super) fn version(&self) -> &str {
        &self.process.version
    }

    /// Steps the body from rest.
    pub(super) fn run(&self, iterations: u32, steps: u32) -> Run {
        let answer = self
            .process
            .ask(&format!("run {iterations} {steps} {STEP_S}"));
        let words = answer.split_ascii_whitespace();
        let mut numbers = words.map(|word| word.parse().expect("a rival answers with numbers"));
        let seconds = numbers.next().expect("a number of seconds");
        let coordinates: Vec<f64> = numbers.collect();
        let (points, []) = coordinates.as_chunks::<3>() else {
            panic!("a point has three coordinates");
        };
        Run {
            seconds,
            projections: self.links as u64 * u64::from(iterations) * u64::from(steps),
            positions: points
                .iter()
                .map(|&[x, y, z]| Point::new(x, y, z))
                .collect(),
        }
    }
}
