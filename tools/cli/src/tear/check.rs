//! Checks before a simulation.

use std::path::Path;

use tearmesh::{FaceId, HalfEdgeId, Point, Vector, VertexId};
use tearmesh_cloth::scene::{Preset, Run, RunError, Scene, TimedCut};
use tearmesh_cloth::{
    ClothError, Method, SeamFault, SimulationError, Stretch, TearingError, Threshold,
};

use crate::args::{TearArgs, Topology};
use crate::choice::Choice as _;
use crate::cut::scissors::of_rays;
use crate::exit::{Exit, Stop};
use crate::files::Names;
use crate::rays;
use crate::say::Fault;
use crate::scene::SceneFile;
use crate::session::Opened;

/// The files of a simulation, but for its frames.
pub(super) fn names(args: &TearArgs) -> Names<'_> {
    let is_file = Preset::of(&args.scene).is_none();
    let read = [(is_file.then_some(Path::new(&args.scene)), "the scene")];
    let written = [
        ("--forces", &args.forces, "the table of forces"),
        ("--cache", &args.cache, "the point cache"),
    ];
    Names::new(&args.files, &read, &written)
}

/// The cuts that were typed.
pub(super) fn cuts(args: &TearArgs, faults: &mut Vec<Fault>) -> Result<Vec<TimedCut>, Stop> {
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

/// A warning if the mesh has moved since it was torn: no other shape is known than the one that it has.
pub(super) fn moved(opened: &Opened) -> Option<Fault> {
    let (mesh, at) = (&opened.mesh, |v| opened.positions.at(v));
    let is_apart = |h: HalfEdgeId| {
        let across = mesh.ghost_pair(h);
        across.is_some_and(|across| at(mesh.origin(h)) != at(mesh.target(across)))
    };
    let message = "the file was torn before, and its sides have moved apart: the shape that it has now is taken as the \
                   shape at rest";
    let help =
        "play the file from before with a scene file of all holds and cuts, each at its time";
    let fault = Fault::warning("W-SIM-REST", message).help(help);
    mesh.half_edges().any(is_apart).then_some(fault)
}

/// Refuses frames with the faces of the last one, which has fewer vertices than the first where seams were sewn.
pub(super) fn points_stay(args: &TearArgs, run: &Run, source: &SceneFile) -> Result<(), Stop> {
    let is_last = args.cache.is_some() || args.frames_topology == Topology::Final;
    if run.scene().seams.is_empty() || !is_last {
        return Ok(());
    }
    let message = "vertices that are sewn are in no point cache, and not in frames with the faces of the last one";
    let help = "--frames DIR, in which each frame has its own faces";
    Err(clash(source, ("seam", 0, ""), message, help))
}

/// That something in a scene file cannot go with something else.
pub(super) fn clash(
    source: &SceneFile,
    at: (&str, usize, &str),
    message: &str,
    help: &str,
) -> Stop {
    let fault = source.blame(at, "E-SCENE-CLASH", message.to_owned());
    fault.help(help).into()
}

/// Refuses a table of forces where the method knows none.
pub(super) fn known_forces(args: &TearArgs, scene: &Scene) -> Result<(), Stop> {
    if args.forces.is_some() && matches!(scene.solver, Method::Provot(_)) {
        let message =
            "`--forces` has nothing to write: Provot's limiter moves vertices without a force";
        return Err(Stop::usage(message, "--solver verlet or implicit"));
    }
    Ok(())
}

/// Refuses what would make no difference to how the scene tears, where a force may have been typed.
pub(crate) fn tearing(is_typed: bool, scene: &Scene, source: &SceneFile) -> Result<(), Stop> {
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
pub(crate) fn rest(opened: &Opened, source: &SceneFile) -> Result<Vec<Point>, Stop> {
    let (mut rest, document) = (Vec::new(), &opened.document);
    let Some(unit_m) = source.vt_m() else {
        return Ok(rest);
    };
    for face in 0..document.triangles().len() {
        let corner = |i| match document.texture(document.corner(face, i).texture? as usize) {
            &[u, v, ..] => Some(Point::new(u * unit_m, v * unit_m, 0.0)),
            _ => None,
        };
        let wrong = match [0, 1, 2].map(corner) {
            [Some(a), Some(b), Some(c)] => {
                rest.extend([a, b, c]);
                match (b - a).cross(&(c - a)).z {
                    twice if twice > 0.0 => continue,
                    0.0 => "has no area",
                    _ => "is flipped",
                }
            }
            _ => "has no place",
        };
        let line = document.line_of_triangle(face);
        let message = format!("the face on line {line} {wrong} in texture coordinates");
        return Err(source
            .blame(("fabric", 0, "vt_m"), "E-SCENE-VT", message)
            .into());
    }
    Ok(rest)
}

/// Why a scene cannot be played with this mesh.
pub(super) fn refused(error: &RunError, opened: &Opened, source: &SceneFile) -> Stop {
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
fn flat(face: FaceId, warp: Vector, opened: &Opened, source: &SceneFile) -> Fault {
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
