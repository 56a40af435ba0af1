//! The warnings of a simulation, before its first step and at its end: those of the cloth in words of the command,
//! and those of times that steps do not make up.

use tearmesh_cloth::scene::{Frame, Run, Warning, Wording};

use super::frames::RATE_PER_S;
use crate::args::TearArgs;
use crate::say::{Fault, count, short, two_digits};
use crate::simulation::state_kept;

/// What is known before the first step. `number` is that of a vertex in its file.
pub(crate) fn before(run: &Run, frame: &Frame, number: &dyn Fn(usize) -> usize) -> Vec<Fault> {
    let warnings = Warning::before(run, frame, &wording(number)).into_iter();
    warnings.map(|warning| fault(&warning, run)).collect()
}

/// What showed in the steps that were taken.
pub(crate) fn after(run: &Run) -> Vec<Fault> {
    let warnings = Warning::after(run, &wording(&|v| v + 1)).into_iter();
    warnings.map(|warning| fault(&warning, run)).collect()
}

/// The options that set what a warning may ask for.
fn wording(number: &dyn Fn(usize) -> usize) -> Wording<'_> {
    Wording {
        vertex: number,
        duration: "--seconds",
        step: "--dt",
        solver: "--solver",
    }
}

/// A run that has exploded is over, and has failed.
fn fault(warning: &Warning, run: &Run) -> Fault {
    let (code, message) = (warning.code(), warning.to_string());
    let fault = if code == "W-SIM-ENERGY" && Warning::has_exploded(run) {
        let kept = state_kept(run);
        Fault::error("E-SIM-ENERGY", format!("{message}; {kept}"))
    } else if warning.is_note() {
        Fault::note(code, message)
    } else {
        Fault::warning(code, message)
    };
    fault.help(warning.help())
}

/// The part of the seconds that were asked for by which those simulated may differ unsaid: a step
/// that is chosen for its stability hardly ever divides them, and the summary says them.
const DIFFERENCE_MAX: f64 = 0.01;

/// Times that steps do not make up: the whole, and that between frames, each of which shows the end of a step.
pub(super) fn times(run: &Run, args: &TearArgs) -> Vec<Fault> {
    let mut faults = Vec::new();
    let (asked_s, step_s, steps) = (run.scene().duration_s, run.step_s(), run.steps_planned());
    let made_s = steps as f64 * step_s;
    let step = short(step_s);
    if (made_s - asked_s).abs() > DIFFERENCE_MAX * asked_s {
        let (asked, made) = (short(asked_s), short(made_s));
        let steps = count(steps as usize, "step", "steps");
        let message = format!(
            "{asked} s is not a whole number of steps of {step} s: {made} s are simulated, in {steps}"
        );
        let help = format!("--dt {}", short(asked_s / (asked_s / step_s).ceil()));
        faults.push(Fault::warning("W-SIM-SECONDS", message).help(help));
    }
    let has_frames = args.frames.is_some() || args.cache.is_some();
    if has_frames && !args.files.dry_run && step_s * RATE_PER_S > 1.0 {
        let rate = short(1.0 / step_s);
        let message = format!(
            "steps of {step} s make {rate} frames per second, not {RATE_PER_S}: they play too fast"
        );
        let help = format!("--dt {}", two_digits(1.0 / RATE_PER_S));
        faults.push(Fault::warning("W-FRAMES-FEW", message).help(help));
    }
    faults
}

#[cfg(test)]
mod tests {
    use tearmesh::Positions;
    use tearmesh_cloth::scene::{Axis, Scene};
    use tearmesh_cloth::{Fabric, Method, Tearing, Xpbd};
    use tearmesh_obj::Document;

    use super::*;

    #[test]
    fn any_number_of_sweeps_is_judged() {
        let (mesh, positions) = tearmesh::shapes::grid(2, 2);
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let scene = Scene {
            solver: Method::Xpbd(Xpbd::new(100_000, 1)),
            step_s: Some(1e12),
            duration_s: 1e12,
            tearing: Some(Tearing::default()),
            ..Scene::hang(&frame)
        };
        let run = Run::new(mesh, &positions, scene, &frame).expect("a scene");
        let faults = before(&run, &frame, &|v| v);
        assert!(faults.iter().all(|fault| fault.code != "W-SIM-COARSE"));
        let soft = faults.iter().find(|fault| fault.code == "W-SIM-SOFT");
        let help = soft.and_then(|fault| fault.help.clone()).expect("a step");
        assert!(help.starts_with("--dt "), "{help}");
    }

    #[test]
    fn steps_without_end_are_warned_of_with_the_edge() {
        // The second face has no area, and a vertex of its own.
        let file = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 -1 0\nf 1 2 3\nf 3 2 4\n";
        let document = Document::read(&file[..]).expect("a file");
        let mesh = document.mesh().expect("a strip");
        let positions = Positions::new(document.positions().iter().copied()).expect("numbers");
        let frame = Frame::new(&mesh, positions.as_slice(), Axis::Y);
        let warned = |solver| {
            // A membrane without area has next to no stiffness.
            let scene = Scene {
                solver,
                fabric: Fabric::of_edges(1000.0),
                ..Scene::hang(&frame)
            };
            let run = Run::new(mesh.clone(), &positions, scene, &frame).expect("a scene");
            let faults = before(&run, &frame, &|v| document.number_of_vertex(v));
            let endless = faults
                .into_iter()
                .find(|fault| fault.code == "W-SIM-ENDLESS");
            endless.map(|fault| fault.message.clone())
        };
        let message = warned(Method::Verlet).expect("a warning");
        assert!(message.contains("the edge 4-3 may swing at "), "{message}");
        assert_eq!(warned(Method::Implicit(Default::default())), None);
    }
}
