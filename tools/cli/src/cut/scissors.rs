//! From what was typed to scissors.

use tearmesh::{Scissor, ScissorError};

use crate::args::CutArgs;
use crate::exit::{Exit, Stop};
use crate::input::Input;
use crate::rays::{self, Pair};
use crate::say::{Fault, short};
use crate::streams::Streams;

/// The rays that were given, two for each cut.
pub(super) fn pairs(args: &CutArgs, streams: &mut Streams<'_>) -> Result<Vec<Pair>, Stop> {
    let refused = |fault: Fault| {
        let exit = if fault.code == "E-RAY-ZERO" {
            Exit::NoPlane
        } else {
            Exit::Usage
        };
        Stop::new(exit, fault)
    };
    let mut pairs = Vec::new();
    for text in &args.rays {
        pairs.push(rays::pair(text, "--rays", 1).map_err(refused)?);
    }
    if let Some(path) = &args.rays_file {
        let unreadable = |fault| Stop::new(Exit::Input, fault);
        let file = Input::find(path, streams.input).map_err(unreadable)?;
        let text = file.text().map_err(unreadable)?;
        pairs.extend(rays::file(&text, &file.name).map_err(refused)?);
    }
    if pairs.is_empty() {
        return Err(refused(Fault {
            code: "E-RAY-COUNT",
            message: "a cut takes two rays, and none was given".to_owned(),
            help: Some("add --rays A B, as in --rays 0,1,5:0,0,-1 0,-1,5:0,0,-1".to_owned()),
            ..Fault::default()
        }));
    }
    Ok(pairs)
}

/// Says that two rays span no plane, and what would.
pub(crate) fn no_plane(pair: &Pair, error: ScissorError) -> Stop {
    let [x, y, z] = <[f64; 3]>::from(pair[0].origin());
    let (left, right) = (x - 1.0, x + 1.0);
    let eye = format!("{x},{y},{z}");
    let help =
        format!("move one origin, or aim at two points: {eye}@{left},{y},0 {eye}@{right},{y},0");
    let fault = Fault {
        code: "E-RAY-ONE-LINE",
        message: error.to_string(),
        help: Some(help),
        ..Fault::default()
    };
    Stop::new(Exit::NoPlane, fault)
}

/// Says how far the second ray leaves the plane, if it does.
pub(crate) fn warn_of_skew(scissor: &Scissor, faults: &mut Vec<Fault>) {
    if scissor.skew() > 0.0 {
        let leaves = short(scissor.skew());
        let message = format!(
            "the rays are skew: the second leaves the cutting plane by {leaves} for each unit of \
             its length"
        );
        faults.push(Fault::warning("W-RAY-SKEW", message));
    }
}
