//! The verb `render`.

mod strip;

use std::path::Path;

use tearmesh::{Ray, Scissor};
use tearmesh_view::{Camera, RenderOptions, fit, write_drawn};

use crate::args::RenderArgs;
use crate::cuts::scissors::of_rays;
use crate::exit::Stop;
use crate::picture::Texture;
use crate::say::{Fault, count, shown};
use crate::session;
use crate::streams::Streams;
use crate::{files, output, picture, rays};

/// Makes what is shown, and gives the summary.
pub(crate) fn run(
    args: &RenderArgs,
    faults: &mut Vec<Fault>,
    streams: &mut Streams<'_>,
) -> Result<String, Stop> {
    // What was typed is refused before a large file is read.
    files::check_picture(&args.output)?;
    let inputs = std::slice::from_ref(&args.input);
    files::check_shown(&args.output, inputs, "the input")?;
    if let Some(obj) = &args.obj {
        files::check_mesh(obj)?;
        files::check_shown(
            obj,
            &[args.input.clone(), args.output.clone()],
            "named already",
        )?;
    }
    let size = args.size.as_f64();
    let camera = |look| Camera::new(look, args.up.coords, args.fov, size);
    let given = args.camera.map(camera).transpose();
    let given = given.map_err(picture::no_camera)?;
    let mut options = options(args, faults)?;

    let (_, opened) = session::look(&args.input, &args.look, faults, streams)?;
    let (document, mesh, positions) = (&opened.document, &opened.mesh, &opened.positions);
    options.texture = Texture::of(document).values;
    options.crease_deg = match args.flat {
        true => Some(0.0),
        false => args.crease.or_else(|| picture::crease(document)),
    };
    let drawn = match args.strip {
        Some(count) => strip::draw(count, &opened, given, &options, args, streams)?,
        None => {
            let fitted = || fit(mesh, positions, args.up.coords, args.fov, size);
            let camera = given.map_or_else(fitted, Ok).map_err(picture::no_camera)?;
            tearmesh_view::render(mesh, positions, &camera, args.size, &options)
        }
    };
    output::write_or_print(&args.output, streams.output, |out| drawn.write_png(out))?;
    let obj = args.obj.as_ref().map(|path| {
        output::write(path, |out| write_drawn(mesh, positions, &options, out))?;
        Ok::<_, Fault>(format!(", {}", shown(path)))
    });
    let obj = obj.transpose()?.unwrap_or_default();
    if args.output == Path::new("-") {
        return Ok(String::new());
    }
    Ok(format!(
        "render: {}, {}, {} · {}x{} pixels · wrote {}{obj}",
        count(mesh.vertex_count(), "vertex", "vertices"),
        count(mesh.face_count(), "face", "faces"),
        count(mesh.components().count(), "piece", "pieces"),
        drawn.width(),
        drawn.height(),
        shown(&args.output),
    ))
}

/// What is drawn beside the mesh.
fn options(args: &RenderArgs, faults: &mut Vec<Fault>) -> Result<RenderOptions, Stop> {
    let mut options = RenderOptions {
        edges: args.edges,
        bounding_box: args.bounding_box,
        finer: args.finer,
        fringe: args.fringe,
        ground: Some(args.up.coords),
        ..RenderOptions::default()
    };
    for text in &args.rays {
        let pair = rays::pair(text, "--rays", 1)?;
        options.cuts.push(of_rays(&pair, faults)?);
        options.rays.extend::<[Ray; 2]>(pair);
    }
    for text in &args.plane {
        let plane = rays::plane(text, "--plane")?;
        options.cuts.push(Scissor::by_plane(plane));
    }
    Ok(options)
}
