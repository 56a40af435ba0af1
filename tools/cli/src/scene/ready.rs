//! The scenes that stand ready, by their names.

use tearmesh_cloth::scene::{Frame, Scene};

/// The scenes that stand ready; a scene file can start from each.
pub(super) const NAMES: [&str; 5] = ["hang", "flag", "rip", "trouser", "fall"];

/// The scene of this name, one of [`NAMES`], for a mesh with this frame.
pub(super) fn base(name: &str, frame: &Frame) -> Scene {
    match name {
        "hang" => Scene::hang(frame),
        "flag" => Scene::flag(frame),
        "rip" => Scene::rip(frame),
        "trouser" => Scene::trouser(frame),
        _ => Scene::fall(frame.up),
    }
}
