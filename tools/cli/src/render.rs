//! The verb `render`.

use std::path::Path;

use tearmesh::{Ray, Scissor};
use tearmesh_view::{Camera, RenderOptions};

use crate::args::RenderArgs;
use crate::cut::scissors::{no_plane, warn_of_skew};
use crate::exit::{Exit, Stop};
use crate::input::Input;
use crate::say::{Fault, count};
use crate::session::{self, Opened};
use crate::streams::Streams;
use crate::{files, output, picture, rays, report};

/// Draws a picture, and gives the exit status.
pub(crate) fn run(args: &RenderArgs, streams: &mut Streams<'_>) -> Exit {
    let mut faults = Vec::new();
    let mut worked = work(args, &mut faults, streams);
    if args.look.quiet || args.output == Path::new("-") {
        worked = worked.map(|_| String::new());
    }
    streams.conclude(worked, faults, args.look.color, args.look.verbose)
}

/// Gives the summary.
fn work(
    args: &RenderArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<String, Stop> {
    // What was typed is refused before a large file is read.
    let to_file = args.output != Path::new("-");
    files::check_picture(&args.output)?;
    if files::is_same(&args.input, &args.output) {
        return Err(files::replaced(&args.output, "the input"));
    }
    if to_file {
        output::check(&args.output).map_err(|error| files::unwritable(&args.output, &error))?;
    }
    let size = args.size.as_f64();
    let given = args
        .camera
        .map(|look| Camera::new(look, args.up.coords, args.fov, size));
    let given = given.transpose();
    let given = given.map_err(|error| Stop::new(Exit::Usage, picture::no_camera(error)))?;
    let options = options(args, faults)?;

    let input = Input::find(&args.input, streams.input);
    let input = input.map_err(|fault| Stop::new(Exit::Input, fault))?;
    let mut timing = report::Timing::default();
    let repair = session::repair(args.look.repair, args.look.separate_fans);
    let Opened {
        mesh, positions, ..
    } = session::open(&input, repair, faults, &mut timing)?;
    let camera = match given {
        Some(camera) => camera,
        None => picture::camera(&mesh, &positions, args.up.coords, args.fov, args.size)?,
    };
    let drawn = tearmesh_view::render(&mesh, &positions, &camera, args.size, &options);
    if to_file {
        picture::write(&args.output, &drawn)?;
    } else {
        let printed = output::print(streams.output, |out| drawn.write_png(out));
        printed.map_err(|fault| Stop::new(Exit::Output, fault))?;
    }
    Ok(format!(
        "render: {}, {}, {} · {}x{} pixels · wrote {}",
        count(mesh.vertex_count(), "vertex", "vertices"),
        count(mesh.face_count(), "face", "faces"),
        count(mesh.components().count(), "piece", "pieces"),
        args.size.width(),
        args.size.height(),
        args.output.display(),
    ))
}

/// What is drawn beside the mesh.
fn options(args: &RenderArgs, faults: &mut Vec<Fault>) -> Result<RenderOptions, Stop> {
    let mut options = RenderOptions {
        edges: args.edges,
        bounding_box: args.bounding_box,
        ..RenderOptions::default()
    };
    for text in &args.rays {
        let pair = rays::pair(text, "--rays", 1).map_err(rays::refused)?;
        let scissor = Scissor::new(pair[0], pair[1]).map_err(|error| no_plane(&pair, error))?;
        warn_of_skew(&scissor, faults);
        options.cuts.push(scissor);
        options.rays.extend::<[Ray; 2]>(pair);
    }
    for text in &args.plane {
        let plane = rays::plane(text, "--plane").map_err(rays::refused)?;
        options.cuts.push(Scissor::by_plane(plane));
    }
    Ok(options)
}
