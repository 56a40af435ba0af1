//! Checks before a simulation.

use std::path::Path;

use tearmesh::HalfEdgeId;
use tearmesh_cloth::Method;
use tearmesh_cloth::scene::{Preset, Run, Scene};

use crate::args::{TearArgs, Topology};
use crate::choice::Choice as _;
use crate::exit::Stop;
use crate::files::Names;
use crate::say::Fault;
use crate::scene::SceneSource;
use crate::session::Opened;
use crate::simulation::clash;

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
pub(super) fn points_stay(args: &TearArgs, run: &Run, source: &SceneSource) -> Result<(), Stop> {
    let is_last = args.cache.is_some() || args.frames_topology == Topology::Final;
    if run.scene().seams.is_empty() || !is_last {
        return Ok(());
    }
    let message = "vertices that are sewn are in no point cache, and not in frames with the faces of the last one";
    let help = "--frames DIR, in which each frame has its own faces";
    Err(clash(source, ("seam", 0, ""), message, help))
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
