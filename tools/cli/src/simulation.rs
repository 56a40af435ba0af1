//! A simulation as verbs share it: how a scene begins, why it cannot, and why it failed.

use tearmesh::{FaceId, Point, Vector, VertexId};
use tearmesh_cloth::implicit;
use tearmesh_cloth::scene::{
    Frame, Run, RunError, Scene, TextureError, TimedCut, rest_from_texture,
};
use tearmesh_cloth::{
    BlowUpSite, ClothError, Method, SeamFault, SimulationError, StepError, StepLimit, Stretch,
    Tearing, TearingError, Threshold,
};

use crate::args::ChangeArgs;
use crate::cuts::scissors::of_rays;
use crate::exit::{Exit, Stop};
use crate::rays;
use crate::say::{Fault, short, two_digits};
use crate::scene::SceneSource;
use crate::session::Opened;

/// The cuts that were typed.
pub(crate) fn typed_cuts(
    args: &ChangeArgs,
    faults: &mut Vec<Fault>,
) -> Result<Vec<TimedCut>, Stop> {
    let mut cuts = Vec::new();
    for text in &args.rays {
        let pair = rays::pair(text, "--rays", 1).map_err(|fault| Stop::new(Exit::Usage, fault))?;
        of_rays(&pair, faults)?;
        cuts.push(TimedCut {
            at_s: args.cut_at.unwrap_or(0.0),
            rays: pair,
            through: false,
            method: tearmesh::CutMethod::Exact,
        });
    }
    Ok(cuts)
}

/// The scene of a file for a mesh with this frame, with what was typed in the place of what it says.
pub(crate) fn scene(
    args: &ChangeArgs,
    cuts: Vec<TimedCut>,
    source: &SceneSource,
    frame: &Frame,
) -> Result<Scene, Stop> {
    let mut scene = source.scene(frame, args.solver.as_ref())?;
    if let Some(seconds) = args.seconds {
        scene.duration_s = seconds;
    }
    scene.step_s = args.dt.or(scene.step_s);
    let stretch = args.threshold.map(Threshold::Stretch);
    let toughness = args.toughness.map(Threshold::Toughness);
    let force = args.threshold_newton.map(Threshold::Force);
    if let Some(threshold) = stretch.or(toughness).or(force) {
        let tearing = scene.tearing.get_or_insert(Tearing::new(threshold));
        tearing.threshold = threshold;
    }
    if !cuts.is_empty() {
        scene.cuts = cuts;
    }
    tearing(args.threshold_newton.is_some(), &scene, source)?;
    Ok(scene)
}

/// A scene that is about to begin, or why it cannot.
pub(crate) fn begin(
    mut scene: Scene,
    opened: &Opened,
    frame: &Frame,
    source: &SceneSource,
) -> Result<Run, Stop> {
    scene.rename_vertices(|named| vertex_of(opened, named));
    scene.rest = rest(opened, source)?;
    let run = Run::new(opened.mesh.clone(), &opened.positions, scene, frame);
    run.map_err(|error| refused(&error, opened, source))
}

/// Has the record of the file that is written say which vertices are copies of one that is sewn.
pub(crate) fn record_seams(
    run: &Run,
    opened: &mut Opened,
    source: &SceneSource,
) -> Result<(), Stop> {
    if run.scene().seams.is_empty() {
        return Ok(());
    }
    if opened.document.has_record() {
        let message = "a file that was torn has no panels to be sewn";
        let help = "sew the panels in the file from before it was torn";
        return Err(clash(source, ("seam", 0, ""), message, help));
    }
    let torn = opened.document.clone().torn_from(&run.mesh().roots());
    let torn = torn.map_err(|error| Fault::error("E-SCENE-SEAM", error.to_string()));
    opened.document = torn?.0;
    Ok(())
}

/// The id of a vertex that a scene names by its number in the file, among which copies for fans may be. A number
/// that no `v` has stays one that no vertex has.
pub(crate) fn vertex_of(opened: &Opened, named: VertexId) -> VertexId {
    let known = match &opened.welded {
        Some(welded) => welded.get(named.index()).copied(),
        None => {
            let known = opened.document.vertex_of_number(named.index() + 1);
            known.and_then(VertexId::new)
        }
    };
    known.unwrap_or(named)
}

/// Refuses what would make no difference to how the scene tears, where a force may have been typed.
pub(crate) fn tearing(is_typed: bool, scene: &Scene, source: &SceneSource) -> Result<(), Stop> {
    if scene.tearing.is_none() && source.has("strength") {
        let message = "nothing tears in this scene, however strong it is";
        let help = "add --threshold, or a threshold in [tear] of a scene file";
        return Err(clash(source, ("strength", 0, ""), message, help));
    }
    let threshold = scene.tearing.map(|tearing| tearing.threshold);
    let is_force = matches!(threshold, Some(Threshold::Force(_)));
    if scene.fabric.stretch != Stretch::Slack || !is_force {
        return Ok(());
    }
    let lack = "is the pull of springs, and this fabric is of triangles";
    if is_typed {
        let message = format!("`--threshold-newton` {lack}");
        return Err(Stop::usage(message, "take --toughness"));
    }
    let help = "take toughness_j_per_m or principal_stretch, or add modulus_n_per_m to [fabric]";
    let message = format!("`threshold_n` {lack}");
    Err(clash(source, ("tear", 0, "threshold_n"), &message, help))
}

/// The places at rest of corners, by their texture coordinates, if the scene has a unit of them.
fn rest(opened: &Opened, source: &SceneSource) -> Result<Vec<Point>, Stop> {
    let (Some(unit_m), document) = (source.vt_m(), &opened.document) else {
        return Ok(Vec::new());
    };
    let corner = |face, i| match document.texture(document.corner(face, i).texture? as usize) {
        &[u, v, ..] => Some([u, v]),
        _ => None,
    };
    let face = |face| [0, 1, 2].map(|i| corner(face, i));
    let faces = (0..document.triangles().len()).map(face);
    rest_from_texture(faces, unit_m).map_err(|TextureError { face, fault }| {
        let line = document.line_of_triangle(face);
        let message = format!("the face on line {line} {fault}");
        let fault = source.blame(("fabric", 0, "vt_m"), "E-SCENE-VT", message);
        fault.into()
    })
}

/// Why a scene cannot be played with this mesh.
fn refused(error: &RunError, opened: &Opened, source: &SceneSource) -> Stop {
    let said = error.to_string();
    let of_mesh = |message: String, help: &str| Fault::error("E-SIM-MESH", message).help(help);
    let fault = match *error {
        _ if opened.mesh.face_count() == 0 => of_mesh(
            said,
            "the mesh has no faces that a scene could be played with",
        ),
        RunError::NoVertices { named_by, number } => {
            let fault = source.blame((named_by, number, ""), "E-SCENE-EMPTY", said);
            fault.help("give it a larger region, or `near` with a place")
        }
        RunError::NoVertex {
            named_by,
            number,
            vertex,
            ..
        } => {
            let (one, vertex) = (number + 1, vertex.index() + 1);
            let last = opened.document.vertex_statement_count();
            let message = format!(
                "{named_by} {one} names the vertex {vertex}, and the mesh has the vertices 1 to {last}"
            );
            source.blame((named_by, number, "vertices"), "E-SCENE-RANGE", message)
        }
        RunError::Simulation(SimulationError::Seams(ref error)) => {
            let number = |v: VertexId| match v.index() {
                v if v < opened.mesh.vertex_count() => opened.document.number_of_vertex(v),
                v => v + 1,
            };
            let key = match error.fault {
                SeamFault::Counts(_) => "other",
                _ => "",
            };
            let text = error.text(|v| number(v).to_string());
            source.blame(("seam", error.seam, key), "E-SCENE-SEAM", text)
        }
        RunError::Simulation(SimulationError::Tearing(TearingError::Axis { .. })) => {
            source.blame(("tear", 0, "warp"), "E-SCENE-RANGE", said)
        }
        RunError::Simulation(SimulationError::Cloth(ref error)) => match *error {
            ClothError::Face { face, warp } => flat(face, warp, opened, source),
            ClothError::Length { ends, .. } => {
                let [a, b] = ends.map(|v| opened.document.number_of_vertex(v.index()));
                let message = format!("the vertices {a} and {b} of an edge are at one place");
                of_mesh(
                    message,
                    "an edge without length has no strain: take the face out",
                )
            }
            ClothError::Mass(_) => Fault::error("E-MASS", said),
            _ => Fault::error("E-SIM-MESH", said),
        },
        RunError::Times { .. } => Fault::error("E-USAGE", said).help("take a longer --dt"),
        _ => Fault::error("E-SCENE-RANGE", said),
    };
    fault.into()
}

/// A face without area is a fault of the mesh, and one across the warp a fault of the warp.
fn flat(face: FaceId, warp: Vector, opened: &Opened, source: &SceneSource) -> Fault {
    let corners = opened.mesh.face_vertices(face);
    let [a, b, c] = corners.map(|v| opened.positions.as_slice()[v.index()]);
    let number = |v: VertexId| opened.document.number_of_vertex(v.index());
    let name = corners.map(|v| number(v).to_string()).join("-");
    if (b - a).cross(&(c - a)) == Vector::zeros() {
        let message = format!("the face {name} has no area at rest");
        let help = "a triangle without area has no strain: take the face out";
        return Fault::error("E-SIM-MESH", message).help(help);
    }
    let [x, y, z] = <[f64; 3]>::from(warp);
    let message = format!("the warp ({x}, {y}, {z}) has no direction in the face {name}");
    let help = "name a `warp` in [fabric] that lies in no face's normal";
    let fault = source.blame(("fabric", 0, "warp"), "E-SCENE-RANGE", message);
    fault.help(help)
}

/// That something in a scene file cannot go with something else.
pub(crate) fn clash(
    source: &SceneSource,
    at: (&str, usize, &str),
    message: &str,
    help: &str,
) -> Stop {
    let fault = source.blame(at, "E-SCENE-CLASH", message.to_owned());
    fault.help(help).into()
}

/// What remains of a simulation that ended early.
pub(crate) fn state_kept(run: &Run) -> String {
    format!("the state after {} s is kept", short(run.elapsed_s()))
}

/// Why the simulation failed, with vertices counted as in OBJ, and what would help.
pub(crate) fn failure(error: &StepError, run: &Run) -> Fault {
    let edge = |[a, b]: [usize; 2]| format!(" at edge {}-{}", a + 1, b + 1);
    let half = two_digits(run.step_s() / 2.0);
    // What is torn later may need still shorter steps.
    let part = if run.elapsed_s() > 0.0 { 0.5 } else { 1.0 };
    let (message, help) = match *error {
        StepError::Unstable {
            given_s,
            limit_s,
            by,
        } => {
            let is_verlet = matches!(run.scene().solver, Method::Verlet);
            let (why, or) = match by {
                StepLimit::Springs(frequency) => {
                    let at = frequency.ends.map(edge).unwrap_or_default();
                    let omega = short(frequency.omega_rad_per_s.round());
                    let or = if is_verlet {
                        ""
                    } else {
                        ", or --solver verlet"
                    };
                    (format!("bound of frequencies {omega} rad/s{at}"), or)
                }
                StepLimit::Air {
                    rate_per_s,
                    particle,
                } => {
                    let (vertex, per_s) = (particle + 1, short(rate_per_s.round()));
                    let why = format!("the air slows vertex {vertex} at a rate of {per_s} /s");
                    (why, "")
                }
                _ => ("a limit of the method".to_owned(), ""),
            };
            let limit = two_digits(limit_s);
            (
                format!("dt {given_s} s exceeds the stability limit {limit} s ({why})"),
                format!("--dt {}{or}", two_digits(limit_s * part)),
            )
        }
        StepError::TooFar { particle, .. } => {
            let vertex = particle + 1;
            let message = format!("vertex {vertex} is so fast that it may pass through a collider");
            (message, shorter(run))
        }
        StepError::Pressed {
            particle,
            colliders,
            ..
        } => {
            let scene = &run.scene().colliders;
            let [one, other] = colliders.map(|i| scene[i].text(i + 1));
            let vertex = particle + 1;
            (
                format!("{one} and {other} leave no room for vertex {vertex} between them"),
                "`moves` that keep them farther apart".to_owned(),
            )
        }
        StepError::Implicit { error, .. } => {
            let (why, or) = unsolved(&error);
            let message = format!("an implicit step of {} s {why}", short(run.step_s()));
            (message, format!("--dt {half}, --solver verlet{or}"))
        }
        _ => {
            let message = match *error {
                StepError::BlowUp { at, .. } => format!("the simulation blew up{}", place(at)),
                ref other => other.to_string(),
            };
            (message, shorter(run))
        }
    };
    let after = match run.elapsed_s() {
        0.0 => String::new(),
        _ => format!("; {}", state_kept(run)),
    };
    Fault::error(error.code(), message + &after).help(help)
}

/// What helps where a step was too long for what happened in it.
fn shorter(run: &Run) -> String {
    let half = two_digits(run.step_s() / 2.0);
    match run.scene().step_s {
        Some(_) => format!("--dt {half}, or --solver implicit"),
        None => "--solver implicit".to_owned(),
    }
}

/// Where a simulation blew up.
fn place(at: BlowUpSite) -> String {
    let (place, ratio) = match at {
        BlowUpSite::Constraint([a, b], stretch_ratio) => {
            (format!("edge {}-{}", a + 1, b + 1), stretch_ratio)
        }
        BlowUpSite::Bend([a, b], stretch_ratio) => {
            let place = format!("the bend between the vertices {} and {}", a + 1, b + 1);
            (place, stretch_ratio)
        }
        BlowUpSite::Particle(particle) | BlowUpSite::Beyond(particle) => {
            return format!(": vertex {} has no finite position", particle + 1);
        }
        _ => return String::new(),
    };
    let ratio = short(ratio);
    format!(" at {place}, which is {ratio} times its rest length")
}

/// What an implicit step left undone, and which key of a scene file can help beside a shorter step.
fn unsolved(error: &implicit::StepError) -> (String, &'static str) {
    match error {
        implicit::StepError::NotConverged {
            residual,
            limit,
            solver_iterations,
        } => {
            let (error, limit) = (short(*residual), short(*limit));
            let why = format!(
                "leaves an error of {error} m/s after {solver_iterations} iterations of the linear solver, \
                 and the tolerance allows {limit} m/s"
            );
            (why, ", or a larger `tolerance` in [solver] of a scene file")
        }
        _ => (format!("failed: {error}"), ""),
    }
}
