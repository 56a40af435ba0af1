//! The rays and planes of cuts, from the arguments.

use tearmesh::{CutError, Plane, Point, Positions, Ray, Scissor, ScissorError};
use tearmesh_view::Camera;

use crate::args::{CameraArgs, CutArgs, numbers};
use crate::exit::Stop;
use crate::input::Input;
use crate::picture;
use crate::rays::{self, Pair};
use crate::say::{Fault, place, short};
use crate::streams::Streams;

/// What a cut goes along.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Along {
    Rays(Pair),
    Plane(Plane),
}

impl Along {
    pub(crate) fn rays(&self) -> Option<&[Ray; 2]> {
        match self {
            Along::Rays(pair) => Some(pair),
            Along::Plane(_) => None,
        }
    }
}

/// What was given for each cut.
pub(crate) fn cuts(args: &CutArgs, streams: &mut Streams<'_>) -> Result<Vec<Along>, Stop> {
    if !args.plane.is_empty() {
        let planes = args.plane.iter().map(|text| rays::plane(text, "--plane"));
        return planes.map(|plane| Ok(Along::Plane(plane?))).collect();
    }
    if let Some(look) = args.camera.camera {
        let pairs = seen(&args.camera, look)?;
        return Ok(pairs.into_iter().map(Along::Rays).collect());
    }
    let pairs = args.rays.iter().map(|text| rays::pair(text, "--rays", 1));
    let mut pairs: Vec<Pair> = pairs.collect::<Result<_, _>>()?;
    if let Some(path) = &args.rays_file {
        let file = Input::find(path, streams.input)?;
        let text = file.text()?;
        pairs.extend(rays::file(&text, &file.name)?);
    }
    if pairs.is_empty() {
        let message = "nothing to cut with: give --rays A B, --plane P:N or --camera";
        let help = "for example --plane 0,0,0:1,0,0, which parts a mesh at x = 0; `tearmesh view` writes a page on which \
                    two clicks give rays";
        return Err(Fault::error("E-RAY-COUNT", message).help(help).into());
    }
    Ok(pairs.into_iter().map(Along::Rays).collect())
}

/// The rays through points of a picture.
fn seen(args: &CameraArgs, look: [Point; 2]) -> Result<Vec<Pair>, Fault> {
    let refused = |message: &str, help: &str| Fault::error("E-CAMERA", message).help(help);
    let camera = Camera::new(look, args.up.coords, args.fov, args.viewport.as_f64());
    let camera = camera.map_err(picture::no_camera)?;
    let pairs = args.points.iter().map(|text| {
        let points = rays::split_pair(text).map(|span| numbers(&text[span], ','));
        let points: Vec<Vec<f64>> = points.collect();
        let [one, other] = &points[..] else {
            let message = format!("a cut takes two points, not `{text}`");
            return Err(refused(&message, POINTS_HELP));
        };
        let (&[a, b], &[c, d]) = (&one[..], &other[..]) else {
            let message = format!("cannot read the points `{text}`");
            return Err(refused(&message, POINTS_HELP));
        };
        if [a, b] == [c, d] {
            let message = format!("`{text}` is one point twice");
            return Err(refused(&message, "name two points"));
        }
        let ray = |point| {
            let help = "name points nearer to the picture";
            camera
                .ray(point)
                .map_err(|error| refused(&error.to_string(), help))
        };
        Ok([ray([a, b])?, ray([c, d])?])
    });
    pairs.collect()
}

const POINTS_HELP: &str = "write both in pixels from the top left, as in --points 200,300 600,250";

/// Says that two rays make no scissor, and what would.
pub(crate) fn no_plane(pair: &Pair, error: ScissorError) -> Fault {
    if error == ScissorError::NoLength {
        return Fault::error("E-RAY-SHORT", error.to_string()).help(SHORT_HELP);
    }
    let [x, y, z] = <[f64; 3]>::from(pair[0].origin());
    let aimed = [x - 1.0, x + 1.0].map(|to| format!("{x},{y},{z}@{to},{y},0"));
    let help = format!("move one origin, or aim at two points: {}", aimed.join(" "));
    Fault::error("E-RAY-ONE-LINE", error.to_string()).help(help)
}

const SHORT_HELP: &str = "leave out one of the points, or cut with a smaller --snap";

/// Says why a mesh is not cut; the number is that of the cut, where there are several.
pub(crate) fn refused(number: Option<usize>, error: CutError, positions: &Positions) -> Fault {
    let at = |p: Point| place(p.into());
    let (code, message, help) = match error {
        CutError::RaysCross { at: crossing } => {
            let crossing = at(crossing);
            let message = format!(
                "the rays cross at {crossing}, and the mesh is before and beyond that point"
            );
            let help = "move the rays, so that they cross in front of the mesh or behind it";
            ("E-RAY-CROSS", message, help)
        }
        CutError::TooShort { joint } => {
            let joint = at(positions.at(joint));
            let message =
                format!("the cut would end closer to {joint}, where it begins, than the snap");
            ("E-RAY-SHORT", message, SHORT_HELP)
        }
        _ => panic!("what follows every cut is in step: {error}"),
    };
    let of = number.map_or_else(String::new, |number| format!("cut {number}: "));
    Fault::error(code, of + &message).help(help)
}

/// The scissor of two rays, with a warning if the second leaves the plane.
pub(crate) fn of_rays(pair: &Pair, faults: &mut Vec<Fault>) -> Result<Scissor, Fault> {
    let scissor = Scissor::new(pair[0], pair[1]).map_err(|error| no_plane(pair, error))?;
    if scissor.skew() > 0.0 {
        let leaves = short(scissor.skew());
        let message = format!(
            "the rays are skew: the second leaves the plane of the first and both origins by {leaves} \
             for each unit of its length. The cut follows the first ray, and meets the second at the mesh"
        );
        faults.push(Fault::warning("W-RAY-SKEW", message));
    }
    Ok(scissor)
}
