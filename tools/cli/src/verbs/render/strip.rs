//! A strip of pictures of a simulation, from its first tear on.

use tearmesh_cloth::scene::{Frame, Run};
use tearmesh_view::{Camera, Picture, RenderOptions, fit_all, render};

use crate::args::RenderArgs;
use crate::exit::{Exit, Stop};
use crate::picture::{Texture, no_camera, with_bodies};
use crate::scene::SceneSource;
use crate::session::Opened;
use crate::simulation;
use crate::streams::Streams;

/// Plays a scene and draws so many moments of it, at equal times: from the step before the first tear, or the
/// beginning if nothing tears, to the end.
pub(super) fn draw(
    count: u32,
    opened: &Opened,
    given: Option<Camera>,
    options: &RenderOptions,
    args: &RenderArgs,
    streams: &mut Streams<'_>,
) -> Result<Picture, Stop> {
    let source = SceneSource::find(args.scene.as_deref().unwrap_or_default(), streams)?;
    let frame = Frame::new(&opened.mesh, opened.positions.as_slice(), source.up());
    let begin = || {
        let mut scene = source.scene(&frame, None)?;
        scene.duration_s = args.seconds.unwrap_or(scene.duration_s);
        simulation::begin(scene, opened, &frame, &source)
    };
    let mut run = begin()?;
    // It is played twice.
    let bar = streams.bar(2 * run.steps_planned(), BAR, !args.look.quiet);
    while !run.is_over() && run.tally().splits == 0 {
        step(&mut run)?;
        bar.set_position(run.tally().steps);
    }
    let has_torn = run.tally().splits > 0;
    let first = if has_torn { run.tally().steps - 1 } else { 0 };
    let last = run.steps_planned();

    let mut run = begin()?;
    let mut texture = Texture::of(&opened.document);
    let mut moments = Vec::new();
    for number in 0..u64::from(count) {
        let at = match count {
            1 => last,
            _ => first + (last - first) * number / u64::from(count - 1),
        };
        while run.tally().steps < at {
            step(&mut run)?;
            bar.set_position(last + run.tally().steps);
            texture.follow(run.edits());
        }
        let points = run.cloth().positions().to_vec();
        let shown = (run.mesh(), &points[..], &texture);
        moments.push(with_bodies(shown, &run.scene().colliders, run.elapsed_s()));
    }
    bar.finish_and_clear();
    let up = frame.up.vector();
    let seen = moments.iter().map(|(mesh, points, _)| (mesh, &**points));
    let camera = match given {
        Some(camera) => camera,
        None => fit_all(seen, up, args.fov, args.size.as_f64()).map_err(no_camera)?,
    };
    let pictures = moments.into_iter().map(|(mesh, points, texture)| {
        let options = RenderOptions {
            texture: texture.values,
            ground: Some(up),
            ..options.clone()
        };
        render(&mesh, &*points, &camera, args.size, &options)
    });
    Ok(Picture::beside(&pictures.collect::<Vec<_>>()))
}

/// The progress bar.
const BAR: &str = "{bar:40} {percent} %, {eta} left";

/// Takes a step that has to be good.
fn step(run: &mut Run) -> Result<(), Stop> {
    let stepped = run.step().map(|_| ());
    stepped.map_err(|error| Stop::new(Exit::Simulation, simulation::failure(&error, run)))
}
