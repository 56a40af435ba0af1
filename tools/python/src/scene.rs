//! Simulations that begin as a scene file says.

use std::error::Error;
use std::fmt::Display;
use std::fs;
use std::path::Path;

use pyo3::prelude::*;
use tearmesh_cloth::scene::file::{BodyMesh, SceneFile};
use tearmesh_cloth::scene::{Frame, Opening, rest_from_texture};
use tearmesh_core::{Mesh, Positions};
use tearmesh_obj::Document;

use crate::errors::{os_error, value_error};

/// How the scene of a file begins on a mesh. `uv` has the texture coordinates of corners.
pub(crate) fn opening(
    path: &Path,
    mesh: &Mesh,
    positions: &Positions,
    uv: Option<&[f64]>,
) -> PyResult<Opening> {
    let refused = |why: &dyn Display| value_error(format!("{}: {why}", path.display()));
    let bytes = fs::read(path).map_err(|error| os_error(&error, path))?;
    let text = String::from_utf8(bytes).map_err(|error| refused(&error))?;
    let file: SceneFile = toml::from_str(&text).map_err(|error| refused(&error))?;
    let frame = Frame::new(mesh, positions.as_slice(), file.up());
    let scene = file.on(&frame, None, &mut |_, name| {
        body(&path.with_file_name(name)).map_err(|why| format!("{name}: {why}"))
    });
    let mut scene = scene.map_err(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        refused(&faults.join("; "))
    })?;
    let vt_m = file
        .fabric
        .as_ref()
        .and_then(|fabric| fabric.vt_m.as_deref());
    if let Some(vt_m) = vt_m {
        let uv = uv.ok_or_else(|| refused(&"[fabric] has vt_m, which needs uv"))?;
        let faces = uv.as_chunks::<2>().0.as_chunks::<3>().0.iter();
        let rest = rest_from_texture(faces.map(|uv| uv.map(finite)), *vt_m);
        scene.rest = rest.map_err(|error| refused(&error))?;
    }
    let opening = scene.opening(mesh, positions.as_slice(), &frame);
    opening.map_err(|error| refused(&error))
}

/// The texture coordinates of a corner, unless they are no numbers, which no file can have.
fn finite(uv: [f64; 2]) -> Option<[f64; 2]> {
    Some(uv).filter(|uv| uv.iter().all(|number| number.is_finite()))
}

/// The points and the triangles of an OBJ file.
fn body(path: &Path) -> Result<BodyMesh, Box<dyn Error>> {
    let document = Document::read(&fs::read(path)?[..])?;
    Ok((document.positions().to_vec(), document.triangles().to_vec()))
}
