//! What is refused before a simulation, and what is warned of.

use std::path::{Path, PathBuf};

use tearmesh::{FaceId, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{Frame, Run, RunError, Scene, TimedCut};
use tearmesh_cloth::{
    ClothError, Method, SimulationError, Softness, TearingError, Threshold, frequency_bound,
};

use super::words::two_digits;
use crate::args::TearArgs;
use crate::cut::scissors::{no_plane, warn_of_skew};
use crate::exit::{Exit, Stop};
use crate::rays;
use crate::say::{Fault, count, short};
use crate::scene::Source;
use crate::session::Opened;
use crate::{files, output};

/// Refuses numbers out of range, streams that are wanted twice, and files that would replace what is
/// read or what else is written.
pub(super) fn usage(args: &TearArgs) -> Result<(), Stop> {
    let from = |least: f64| move |x: f64| x >= least && x.is_finite();
    let above = |least: f64| move |x: f64| x > least && x.is_finite();
    range(
        "--threshold",
        args.threshold,
        above(1.0),
        "a length as a multiple of the length at rest, above 1, as in --threshold 1.5",
    )?;
    range(
        "--toughness",
        args.toughness,
        above(0.0),
        "joules for each metre of tear, as in --toughness 2",
    )?;
    range(
        "--threshold-newton",
        args.threshold_newton,
        above(0.0),
        "the pull of an edge in newtons, as in --threshold-newton 10",
    )?;
    range("--seconds", args.seconds, from(0.0), "as in --seconds 2")?;
    range("--dt", args.dt, above(0.0), "as in --dt 0.001")?;
    range(
        "--cut-at",
        args.cut_at,
        from(0.0),
        "seconds of the simulation, as in --cut-at 1.5",
    )?;
    let dash = Path::new("-");
    let scene = args.scene == "-";
    let strength = args.strength.as_deref() == Some(dash);
    let streams = [args.files.input == dash, scene, strength];
    if streams.into_iter().filter(|&wanted| wanted).count() > 1 {
        let message = "two inputs both come from standard input".to_owned();
        return refuse(message, "name a file for one of them");
    }
    let scene = PathBuf::from(&args.scene);
    let mut taken = vec![&args.files.input, &scene];
    taken.extend(&args.strength);
    for (option, what, path) in [
        ("--forces", "the table of forces", &args.forces),
        ("--cache", "the point cache", &args.cache),
    ] {
        let Some(path) = path else { continue };
        if path == dash || taken.iter().any(|other| files::is_same(path, other)) {
            let message = format!("`{option}` takes the name of a file of its own");
            return refuse(message, &format!("write {what} to another file"));
        }
        files::keep(&args.files, Some(path), what)?;
        output::check(path).map_err(|error| files::unwritable(path, &error))?;
        taken.push(path);
    }
    Ok(())
}

fn range(
    option: &str,
    value: Option<f64>,
    is_in: impl Fn(f64) -> bool,
    help: &str,
) -> Result<(), Stop> {
    match value.filter(|&value| !is_in(value)) {
        Some(value) => refuse(format!("`{option} {value}` is out of range"), help),
        None => Ok(()),
    }
}

fn refuse(message: String, help: &str) -> Result<(), Stop> {
    let fault = Fault::error("E-USAGE", message).help(help);
    Err(Stop::new(Exit::Usage, fault))
}

/// The cuts that were typed.
pub(super) fn cuts(args: &TearArgs, faults: &mut Vec<Fault>) -> Result<Vec<TimedCut>, Stop> {
    let mut cuts = Vec::new();
    for text in &args.rays {
        let pair = rays::pair(text, "--rays", 1).map_err(|fault| Stop::new(Exit::Usage, fault))?;
        let scissor = Scissor::new(pair[0], pair[1]).map_err(|error| no_plane(&pair, error))?;
        warn_of_skew(&scissor, faults);
        cuts.push(TimedCut {
            at_s: args.cut_at.unwrap_or(0.0),
            rays: pair,
            through: false,
            method: tearmesh::CutMethod::Exact,
        });
    }
    Ok(cuts)
}

/// Refuses a table of forces where the method knows none.
pub(super) fn known_forces(args: &TearArgs, scene: &Scene) -> Result<(), Stop> {
    if args.forces.is_some() && matches!(scene.solver, Method::Provot(_)) {
        let message =
            "`--forces` has nothing to write: Provot's limiter moves vertices without a force";
        return refuse(message.to_owned(), "--solver verlet or implicit");
    }
    Ok(())
}

/// Refuses what would make no difference to how the scene tears.
pub(super) fn tearing(args: &TearArgs, scene: &Scene, source: &Source) -> Result<(), Stop> {
    let blame = |at, message: &str, help: &str| {
        let fault = source.blame(at, "E-SCENE-CLASH", message.to_owned());
        Err(Stop::new(Exit::Usage, fault.help(help)))
    };
    let Some(tearing) = &scene.tearing else {
        let help = "add --threshold, or a threshold in [tear] of a scene file";
        if args.strength.is_some() {
            let message = "`--strength` makes no difference: nothing tears in this scene";
            return refuse(message.to_owned(), help);
        }
        if source.has("strength", "") {
            let message = "nothing tears in this scene, however strong it is";
            return blame(("strength", 0, ""), message, help);
        }
        return Ok(());
    };
    let fabric = &scene.fabric;
    let has_springs = fabric.weave.is_none() || fabric.stretch_n_per_m > 0.0;
    if has_springs || !matches!(tearing.threshold, Threshold::Force(_)) {
        return Ok(());
    }
    let lack = "is the pull of springs, and this fabric is of triangles";
    if args.threshold_newton.is_some() {
        return refuse(format!("`--threshold-newton` {lack}"), "take --toughness");
    }
    let help = "take toughness_j_per_m or principal_stretch, or add stretch_n_per_m to [fabric]";
    blame(
        ("tear", 0, "threshold_n"),
        &format!("`threshold_n` {lack}"),
        help,
    )
}

/// Why a scene cannot be played with this mesh.
pub(super) fn refused(error: &RunError, opened: &Opened, source: &Source) -> Stop {
    let blame = |at, code, message, help: Option<&str>| {
        let mut fault = source.blame(at, code, message);
        fault.help = help.map(str::to_owned);
        Stop::new(Exit::Usage, fault)
    };
    match *error {
        _ if opened.mesh.face_count() == 0 => {}
        RunError::NoVertices { named_by, number } => {
            let help = "give it a larger region, or `near` with a place";
            return blame(
                (&named_by.to_string(), number, ""),
                "E-SCENE-EMPTY",
                error.to_string(),
                Some(help),
            );
        }
        RunError::NoVertex {
            named_by,
            number,
            vertex,
            ..
        } => {
            let message = format!(
                "{named_by} {} names the vertex {}, and the mesh has the vertices 1 to {}",
                number + 1,
                vertex.index() + 1,
                opened.document.vertex_statement_count()
            );
            let table = named_by.to_string();
            return blame((&table, number, "vertices"), "E-SCENE-RANGE", message, None);
        }
        RunError::Simulation(SimulationError::Tearing(TearingError::Axis { .. })) => {
            return blame(
                ("tear", 0, "warp"),
                "E-SCENE-RANGE",
                error.to_string(),
                None,
            );
        }
        RunError::Simulation(SimulationError::Cloth(ClothError::Face { face, warp })) => {
            return flat(face, warp, opened, source);
        }
        _ => {}
    }
    let (exit, code, help) = match error {
        _ if opened.mesh.face_count() == 0 => (
            Exit::Input,
            "E-SIM-MESH",
            Some("the mesh has no faces that a scene could be played with"),
        ),
        RunError::Simulation(SimulationError::Cloth(ClothError::Length { ends, .. })) => {
            let [a, b] = ends.map(|v| opened.document.number_of_vertex(v.index()));
            let message = format!("the vertices {a} and {b} of an edge are at one place");
            let help = "an edge without length has no strain: take the face out";
            let fault = Fault::error("E-SIM-MESH", message).help(help);
            return Stop::new(Exit::Input, fault);
        }
        RunError::Simulation(SimulationError::Cloth(ClothError::Mass(_))) => {
            (Exit::Input, "E-MASS", None)
        }
        RunError::Simulation(SimulationError::Cloth(_)) => (Exit::Input, "E-SIM-MESH", None),
        RunError::Times { .. } => (Exit::Usage, "E-USAGE", Some("take a longer --dt")),
        _ => (Exit::Usage, "E-SCENE-RANGE", None),
    };
    let mut fault = Fault::error(code, error.to_string());
    fault.help = help.map(str::to_owned);
    Stop::new(exit, fault)
}

/// A face without area is a fault of the mesh, and one across the warp a fault of the warp.
fn flat(face: FaceId, warp: Vector, opened: &Opened, source: &Source) -> Stop {
    let corners = opened.mesh.face_vertices(face);
    let [a, b, c] = corners.map(|v| opened.positions.as_slice()[v.index()]);
    let number = |v: VertexId| opened.document.number_of_vertex(v.index());
    let name = corners.map(|v| number(v).to_string()).join("-");
    if (b - a).cross(&(c - a)) == Vector::zeros() {
        let message = format!("the face {name} has no area at rest");
        let help = "a triangle without area has no strain: take the face out";
        let fault = Fault::error("E-SIM-MESH", message).help(help);
        return Stop::new(Exit::Input, fault);
    }
    let [x, y, z] = <[f64; 3]>::from(warp);
    let message = format!("the warp ({x}, {y}, {z}) has no direction in the face {name}");
    let help = "name a `warp` in [fabric] that lies in no face's normal";
    let fault = source.blame(("fabric", 0, "warp"), "E-SCENE-RANGE", message);
    Stop::new(Exit::Usage, fault.help(help))
}

/// What may tear, or not tear, for reasons that are none of the cloth's. `number` is that of a vertex in its
/// file.
pub(super) fn warnings(run: &Run, frame: &Frame, number: &dyn Fn(usize) -> usize) -> Vec<Fault> {
    let mut warnings = Vec::new();
    let size = frame.size_m();
    if !(0.01..=8.0).contains(&size) {
        let size = short(size);
        let message =
            format!("the mesh is {size} m across, and the fabric is one for garments and flags");
        let help = "units are metres: scale the mesh, or set [fabric] in a scene file";
        warnings.push(Fault::warning("W-SIM-SIZE", message).help(help));
    }
    warnings.extend(endless(run, number));
    warnings.extend(late(run));
    warnings.extend(soft(run));
    warnings.extend(coarse(run));
    warnings.extend(rigid(run));
    if run.scene().tearing.is_none() {
        return warnings;
    }
    for (number, hold) in run.scene().holds.iter().enumerate() {
        let pins = run.pins(number);
        if hold.moves.is_empty() && pins > 0 {
            let number = number + 1;
            let (what, they) = match pins {
                1 => ("a single vertex, whose".to_owned(), "it"),
                _ => (format!("{pins} single vertices, whose"), "they"),
            };
            let message = format!(
                "hold {number} pins {what} strain grows as the mesh gets finer: {they} may tear \
                 where a clamp would not"
            );
            let help = "give it a `radius`, such as 0.1";
            warnings.push(Fault::warning("W-SIM-PIN", message).help(help));
        }
    }
    warnings
}

/// An explicit method takes steps as short as the stiffest edge between the lightest vertices
/// asks for, and one face without area is enough for years of them.
fn endless(run: &Run, number: &dyn Fn(usize) -> usize) -> Option<Fault> {
    let is_explicit = matches!(run.scene().solver, Method::Verlet | Method::Provot(_));
    if !is_explicit || run.steps_planned() < STEPS_MANY {
        return None;
    }
    let frequency = frequency_bound(&mut run.cloth().system().clone());
    let at = frequency.ends.map(|[a, b]| {
        let omega = frequency.omega_rad_per_s;
        let [a, b] = [a, b].map(number);
        format!(
            ": the edge {a}-{b} may swing at {omega:.1e} rad/s, as it is stiff and its ends are light"
        )
    });
    let message = format!(
        "{:.1e} steps of {} s are planned{}",
        run.steps_planned() as f64,
        two_digits(run.step_s()),
        at.unwrap_or_default()
    );
    let help = "take a face without area out of the mesh, or use --solver implicit";
    Some(Fault::warning("W-SIM-ENDLESS", message).help(help))
}

/// Hours of a mesh of a few thousand vertices.
const STEPS_MANY: u64 = 10_000_000;

/// What is to happen when the scene is over. Where no step is taken at all, nothing has to be held.
fn late(run: &Run) -> Vec<Fault> {
    let scene = run.scene();
    let over = short(run.steps_planned() as f64 * run.step_s());
    let late = |what: String, at_s: f64| {
        let message = format!("{what}: the scene is over after {over} s");
        let help = format!("--seconds above {}, or an earlier time", short(at_s));
        Fault::warning("W-SCENE-LATE", message).help(help)
    };
    let cuts = scene.cuts.iter().filter(|cut| !run.reaches(cut.at_s));
    let cuts = cuts.map(|cut| {
        let at = short(cut.at_s);
        late(format!("the cut at {at} s is never made"), cut.at_s)
    });
    let holds = scene.holds.iter().enumerate();
    let holds = holds.filter(|(_, hold)| run.steps_planned() > 0 && !run.reaches(hold.from_s));
    let holds = holds.map(|(number, hold)| {
        let number = number + 1;
        late(format!("hold {number} is never taken"), hold.from_s)
    });
    cuts.chain(holds).collect()
}

/// XPBD leaves cloth softer than its fabric, and that is said with a number.
fn soft(run: &Run) -> Option<Fault> {
    let softness = run.softness()?;
    if softness.extra <= Softness::TOLERABLE {
        return None;
    }
    let percent = (softness.extra * 100.0).round();
    let message = format!(
        "xpbd with a step of {} s leaves the cloth too soft: what hangs is stretched {} % farther \
         than its fabric would be, and some edges far more",
        short(run.step_s()),
        short(percent),
    );
    let help = format!(
        "--dt {} for {} %, or --solver verlet, which is exact at rest",
        two_digits(softness.step_s),
        short(Softness::TOLERABLE * 100.0),
    );
    Some(Fault::warning("W-SIM-SOFT", message).help(help))
}

/// PBD has no stiffness: how far cloth stretches is what its sweeps leave, and shorter steps leave less.
fn rigid(run: &Run) -> Option<Fault> {
    if !matches!(run.scene().solver, Method::Pbd(_)) {
        return None;
    }
    let message = format!(
        "pbd treats edges as rigid: how far they stretch depends on the step and the number of sweeps, and \
         not on the {} N/m of the fabric",
        short(run.scene().fabric.stretch_n_per_m),
    );
    let help = "--solver verlet, or xpbd, whose edges are as stiff as the fabric's at short steps";
    Some(Fault::note("W-SIM-RIGID", message).help(help))
}

/// Few sweeps or large steps leave a cloth of PBD soft, and it tears of its own weight.
fn coarse(run: &Run) -> Option<Fault> {
    let Method::Pbd(pbd) = &run.scene().solver else {
        return None;
    };
    let wanted_s = run.step_wanted_s()?;
    if run.step_s() <= wanted_s {
        return None;
    }
    let times = run.step_s() / wanted_s;
    let message = format!(
        "a step of {} s with {} is {} times too long for a mesh so fine: what merely hangs is \
         stretched{}",
        short(run.step_s()),
        count(pbd.sweeps as usize, "sweep", "sweeps"),
        short((times * 10.0).round() / 10.0),
        if run.scene().tearing.is_some() {
            ", and may tear"
        } else {
            ""
        },
    );
    let help = format!("--dt {}, or --solver verlet", two_digits(wanted_s));
    Some(Fault::warning("W-SIM-COARSE", message).help(help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tearmesh::Positions;
    use tearmesh_cloth::scene::{Axis, Scene};
    use tearmesh_obj::Document;

    #[test]
    fn any_number_of_sweeps_is_judged() {
        use tearmesh_cloth::{Tearing, Xpbd};

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
        let fault = soft(&run).expect("a warning");
        let help = fault.help.expect("a step");
        assert!(help.starts_with("--dt "), "{help}");
        assert_eq!(coarse(&run).map(|fault| fault.message), None);
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
            let scene = Scene {
                solver,
                ..Scene::hang(&frame)
            };
            let run = Run::new(mesh.clone(), &positions, scene, &frame).expect("a scene");
            endless(&run, &|v| document.number_of_vertex(v)).map(|fault| fault.message)
        };
        let message = warned(Method::Verlet).expect("a warning");
        assert!(message.contains("the edge 4-3 may swing at "), "{message}");
        assert_eq!(warned(Method::Implicit(Default::default())), None);
    }
}
