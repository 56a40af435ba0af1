//! The table of the warnings of a simulation: before its first step, and at its end. [`Warning`] documents the
//! subject of each warning, and when it is due.

use tearmesh_cloth::scene::{EnergyGain, Frame, Run, Warning};
use tearmesh_cloth::{Method, Softness};

use super::frames::RATE_PER_S;
use super::summary::has_limited;
use crate::args::TearArgs;
use crate::say::{Fault, count, short, three_digits, two_digits};
use crate::simulation::state_kept;

/// What is known before the first step. `number` is that of a vertex in its file.
pub(crate) fn before(run: &Run, frame: &Frame, number: &dyn Fn(usize) -> usize) -> Vec<Fault> {
    let warnings = Warning::before(run, frame).into_iter();
    let faults = warnings.map(|warning| fault(warning, run, number));
    faults.collect()
}

/// What showed in the steps that were taken.
pub(crate) fn after(run: &Run) -> Vec<Fault> {
    let warnings = Warning::after(run).into_iter();
    let faults = warnings.map(|warning| fault(warning, run, &|v| v + 1));
    faults.collect()
}

/// A warning in words, and what would help.
fn fault(warning: Warning, run: &Run, number: &dyn Fn(usize) -> usize) -> Fault {
    let scene = run.scene();
    let step = short(run.step_s());
    let half = two_digits(run.step_s() / 2.0);
    let has_failed = matches!(warning, Warning::Energy(_)) && has_exploded(run);
    let (message, help): (String, String) = match warning {
        Warning::Size(size_m) => {
            let size = short(size_m);
            let message =
                format!("the mesh is {size} m across, and the fabric suits garments and flags");
            let help = "units are metres: scale the mesh, or set [fabric] in a scene file";
            (message, help.into())
        }
        Warning::Endless(frequency) => {
            let at = frequency.ends.map(|ends| {
                let [a, b] = ends.map(number);
                let omega = frequency.omega_rad_per_s;
                format!(": the edge {a}-{b} may swing at {omega:.1e} rad/s, because it is stiff and its ends are light")
            });
            let (steps, at) = (run.steps_planned() as f64, at.unwrap_or_default());
            let step = two_digits(run.step_s());
            let help = "take a face without area out of the mesh, or use --solver implicit";
            let message = format!("{steps:.1e} steps of {step} s are planned{at}");
            (message, help.into())
        }
        Warning::LateCut(time_s)
        | Warning::LateUnpick(time_s)
        | Warning::LateHold { from_s: time_s, .. } => {
            let time = short(time_s);
            let what = match warning {
                Warning::LateHold { hold, .. } => format!("hold {} is never taken", hold + 1),
                Warning::LateUnpick(_) => format!("no seam is unpicked at {time} s"),
                _ => format!("the cut at {time} s is never made"),
            };
            let over = short(run.steps_planned() as f64 * run.step_s());
            let help = format!("--seconds above {time}, or an earlier time");
            (format!("{what}: the scene is over after {over} s"), help)
        }
        Warning::Soft(softness) => {
            let extra = short((softness.extra * 100.0).round());
            let (dt, most) = (
                two_digits(softness.step_s),
                short(Softness::TOLERABLE * 100.0),
            );
            let message = format!(
                "xpbd with a step of {step} s leaves the cloth too soft: hanging cloth stretches {extra} % \
                 too far, and some edges far more"
            );
            let verlet = "--solver verlet, which is exact at rest";
            (message, format!("--dt {dt} for {most} %, or {verlet}"))
        }
        Warning::Coarse(wanted_s) => {
            let sweeps = match &scene.solver {
                Method::Pbd(pbd) => pbd.sweeps as usize,
                _ => 1,
            };
            let sweeps = count(sweeps, "sweep", "sweeps");
            let times = short((run.step_s() / wanted_s * 10.0).round() / 10.0);
            let (dt, and) = (
                two_digits(wanted_s),
                scene.tearing.map_or("", |_| ", and may tear"),
            );
            let message = format!(
                "a step of {step} s with {sweeps} is {times} times too long for so fine a mesh: hanging \
                 cloth stretches too far{and}"
            );
            (message, format!("--dt {dt}, or --solver verlet"))
        }
        Warning::Rigid => {
            let stiffness = short(scene.fabric.stretch_n_per_m());
            let message = format!(
                "pbd treats edges as rigid: their stretch depends on the step and the number of sweeps, not \
                 on the {stiffness} N/m of the fabric"
            );
            let xpbd = "xpbd, whose edges are as stiff as the fabric's at short steps";
            (message, format!("--solver verlet, or {xpbd}"))
        }
        Warning::Pinned { hold, pins } => {
            let (what, they) = match pins {
                1 => ("a single vertex, whose".to_owned(), "it"),
                _ => (format!("{pins} single vertices, whose"), "they"),
            };
            let number = hold + 1;
            let message = format!(
                "hold {number} pins {what} strain grows as the mesh gets finer: {they} may tear where a \
                 clamp would not"
            );
            (message, "give it a `radius`, such as 0.1".into())
        }
        Warning::SmallBall {
            collider,
            radius_m,
            longest_m,
        } => {
            let (number, across) = (collider + 1, short(2.0 * radius_m));
            let long = two_digits(longest_m);
            let message = format!(
                "collider {number} is a ball {across} m across, and edges are up to {long} m long: only \
                 vertices collide, so the ball may pass between them"
            );
            (message, "a finer mesh, or a larger ball".into())
        }
        Warning::InsideBody {
            collider,
            vertices,
            first,
        } => {
            let (number, first) = (collider + 1, number(first));
            let vertices = count(vertices, "vertex begins", "vertices begin");
            let message = format!(
                "{vertices} inside of the body of collider {number}, such as {first}: from deep inside \
                 there is no way out"
            );
            (message, "move the mesh or the body in its file".into())
        }
        Warning::Strong(least) => {
            let vertices = count(run.mesh().vertex_count(), "vertex", "vertices");
            let least = short(least);
            let message = format!(
                "all {vertices} are stronger than the cloth: nothing tears below {least} times the threshold"
            );
            (
                message,
                "a finer mesh, or smaller regions of strength".into(),
            )
        }
        Warning::Limiter(stats) => {
            let limit = match &scene.solver {
                Method::Provot(limiter) => limiter.stretch_ratio_max,
                _ => 1.0,
            };
            let (some, all) = (stats.steps_infeasible, of_steps(run));
            let most = short(limit + stats.excess_max);
            let message = format!(
                "in {some} of {all}, the holds were too far apart for the limiter: edges stayed up to {most} \
                 times their rest length, above its limit of {limit}"
            );
            let help = "a larger limit_ratio in [solver] of a scene file, or --solver verlet";
            (message, help.into())
        }
        Warning::PassedBall {
            collider,
            radius_m,
            farthest_m,
        } => {
            let (far, number, radius) = (two_digits(farthest_m), collider + 1, short(radius_m));
            let message = format!(
                "a vertex moved {far} m in a step, and collider {number} is a ball of radius {radius} m: the \
                 vertex may have passed through it"
            );
            let dt_s = run.step_s() * radius_m / farthest_m / 2.0;
            (message, format!("--dt {}", two_digits(dt_s)))
        }
        Warning::Energy(gain) => {
            let since = short(gain.since_s);
            let so = match has_failed {
                true => "; ".to_owned() + &state_kept(run),
                false => ": what tore since then tore partly because of it".to_owned(),
            };
            let much = if has_limited(run) {
                format!("energy out of nothing, from {since} s on")
            } else {
                let [made, put_in] = [gain.made_j, gain.put_in_j].map(three_digits);
                format!("{made} J out of nothing, from {since} s on, where {put_in} J were put in")
            };
            let others = match scene.solver {
                Method::Verlet => "--solver implicit",
                Method::Implicit(_) => "--solver verlet",
                _ => "--solver verlet or implicit",
            };
            let help = format!("{others}, --dt {half}, or a larger drag_per_s in a scene file");
            (format!("the method made {much}{so}"), help)
        }
        Warning::Damped { lost_j, moving_j } => {
            let or = match scene.solver {
                Method::Verlet => "",
                Method::Implicit(_) => {
                    ", `order = \"2\"` in [solver] of a scene file, or --solver verlet"
                }
                _ => ", or --solver verlet",
            };
            let (method, lost) = (scene.solver.name(), three_digits(lost_j));
            let moving = three_digits(moving_j);
            let message = format!(
                "{method} lost {lost} J of the {moving} J that went into motion, which fades too soon"
            );
            (message, format!("--dt {half}{or}"))
        }
    };
    let (code, say): (_, fn(&'static str, String) -> Fault) = match warning {
        _ if has_failed => ("E-SIM-ENERGY", Fault::error),
        Warning::Rigid | Warning::Strong { .. } | Warning::Damped { .. } => {
            (warning.code(), Fault::note)
        }
        _ => (warning.code(), Fault::warning),
    };
    say(code, message).help(help)
}

/// Whether the method has made so much energy that the run shows nothing of the cloth: more than three times what
/// was put in, and more than a millijoule. Where the limiter has worked, its energy is not known.
pub(super) fn has_exploded(run: &Run) -> bool {
    let is_absurd = |gain: EnergyGain| gain.made_j > f64::max(3.0 * gain.put_in_j, 1e-3);
    run.energy_gain().is_some_and(is_absurd) && !has_limited(run)
}

/// How many steps were taken; where they were divided, and the method had each part, how many parts.
fn of_steps(run: &Run) -> String {
    let substeps = run.cloth().system().counters().substeps;
    match substeps == run.tally().steps {
        true => count(substeps as usize, "step", "steps"),
        false => count(substeps as usize, "substep", "substeps"),
    }
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
    use tearmesh_cloth::{Fabric, Tearing, Xpbd};
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
