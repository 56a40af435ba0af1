//! The keys of `[solver]`.

use tearmesh_cloth::Method;
use tearmesh_cloth::scene::Scene;

use super::kinds::set;
use super::read::SceneFile;
use crate::say::Fault;

impl SceneFile {
    /// The method: its keys are those of the file's or of the one that was typed in its place.
    pub(super) fn solver(
        &self,
        scene: &mut Scene,
        typed: Option<&Method>,
        faults: &mut Vec<Fault>,
    ) {
        let table = self.table("solver");
        let named = table.and_then(|table| table.get::<String>("method"));
        set(
            &mut scene.solver,
            named.and_then(|name| Method::named(&name)),
        );
        let method = scene.solver.name();
        set(&mut scene.solver, typed.cloned());
        let Some(table) = table else {
            return;
        };
        scene.step_s = table.get("dt_s").or(scene.step_s);
        for (key, readers) in OF_METHODS {
            let is_read = |reader: &&str| [method, scene.solver.name()].contains(reader);
            if table.has(key) && !readers.iter().any(is_read) {
                let readers = readers.join(" or ");
                let message = format!("`{key}` goes with {readers}, and the method is {method}");
                faults.push(self.fault(table, key, "E-SCENE-CLASH", message));
            }
        }
        match &mut scene.solver {
            Method::Provot(limiter) => {
                set(&mut limiter.stretch_ratio_max, table.get("limit_ratio"));
                set(&mut limiter.passes_max, table.get("limit_passes"));
            }
            Method::Pbd(pbd) => {
                set(&mut pbd.sweeps, table.get("sweeps"));
                set(&mut pbd.stiffness, table.get("stiffness"));
                set(&mut pbd.bend_stiffness, table.get("bend_stiffness"));
            }
            Method::Verlet => {}
            Method::Xpbd(xpbd) => {
                set(&mut xpbd.substeps, table.get("substeps"));
                set(&mut xpbd.sweeps, table.get("sweeps"));
            }
            Method::Implicit(settings) => {
                set(&mut settings.tolerance, table.get("tolerance"));
                set(&mut settings.method, table.word("order"));
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
