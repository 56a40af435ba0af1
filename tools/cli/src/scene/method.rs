//! The keys of `[solver]`.

use tearmesh_cloth::Method;
use tearmesh_cloth::scene::Scene;

use super::kinds::{Count, Word, set};
use super::read::SceneFile;
use crate::choice::Solver;
use crate::say::Fault;

impl SceneFile {
    /// The method: its keys are those of the file's or of the one that was typed in its place.
    pub(super) fn solver(&self, scene: &mut Scene, typed: Option<Solver>, faults: &mut Vec<Fault>) {
        let named = self.solver.as_ref().and_then(|table| table.method);
        if let Some(Word(Solver(method))) = named {
            scene.solver = method();
        }
        let method = scene.solver.name();
        if let Some(Solver(typed)) = typed {
            scene.solver = typed();
        }
        let Some(table) = &self.solver else {
            return;
        };
        scene.step_s = table.dt_s.map(f64::from).or(scene.step_s);
        for (key, readers) in OF_METHODS {
            let is_read = |reader: &&str| [method, scene.solver.name()].contains(reader);
            if table.place.values.contains_key(key) && !readers.iter().any(is_read) {
                let readers = readers.join(" or ");
                let message = format!("`{key}` goes with {readers}, and the method is {method}");
                faults.push(*self.fault(&table.place, key, "E-SCENE-CLASH", message));
            }
        }
        let count = |count: Option<Count>| count.map(|count| count.0);
        match &mut scene.solver {
            Method::Provot(limiter) => {
                set(&mut limiter.stretch_ratio_max, table.limit_ratio);
                set(&mut limiter.passes_max, count(table.limit_passes));
            }
            Method::Pbd(pbd) => {
                set(&mut pbd.sweeps, count(table.sweeps));
                set(&mut pbd.stiffness, table.stiffness);
                set(&mut pbd.bend_stiffness, table.bend_stiffness);
            }
            Method::Verlet => {}
            Method::Xpbd(xpbd) => {
                set(&mut xpbd.substeps, count(table.substeps));
                set(&mut xpbd.sweeps, count(table.sweeps));
            }
            Method::Implicit(settings) => {
                set(&mut settings.tolerance, table.tolerance);
                set(&mut settings.method, table.order.map(|word| word.0));
            }
        }
    }
}

/// The keys of [solver] that not all methods read, and which do.
const OF_METHODS: [(&str, &[&str]); 8] = [
    ("substeps", &["xpbd"]),
    ("sweeps", &["xpbd", "pbd"]),
    ("stiffness", &["pbd"]),
    ("bend_stiffness", &["pbd"]),
    ("limit_ratio", &["provot"]),
    ("limit_passes", &["provot"]),
    ("order", &["implicit"]),
    ("tolerance", &["implicit"]),
];
