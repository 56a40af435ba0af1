//! The axes that can be typed, as an option and in a scene file.

use tearmesh_cloth::scene::Axis;

/// The axes, as they are typed.
pub(super) const AXES: [&str; 6] = ["x", "y", "z", "-x", "-y", "-z"];

/// Reads an axis.
pub(crate) fn axis(text: &str) -> Result<Axis, String> {
    let axis = match text.trim_start_matches('-') {
        "x" => Axis::X,
        "y" => Axis::Y,
        "z" => Axis::Z,
        _ => return Err(format!("expected one of {}", AXES.join(", "))),
    };
    Ok(match text.len() {
        1 => axis,
        2 => axis.opposite(),
        _ => return Err(format!("expected one of {}", AXES.join(", "))),
    })
}
