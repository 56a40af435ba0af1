//! What several functions take: a mesh, torn or not, and what to cut it by.

use pyo3::prelude::*;
use tearmesh_core::{BuildError, CutLayers, Defect, Mesh, Plane, Positions, Ray, Scissor};

use crate::arrays::{ANY, Array, floats, ids, triangles, value_error};

/// The mesh of some triangles, torn where vertices have roots.
pub(crate) fn mesh_of(n: usize, faces: &Array<'_>, roots: Option<&Array<'_>>) -> PyResult<Mesh> {
    let faces = triangles(faces)?;
    let Some(roots) = roots else {
        return Mesh::build(n, faces).map_err(|error| no_manifold(&error));
    };
    let roots = ids("roots", roots, &[n])?;
    Mesh::build_torn(&faces, &roots).map_err(value_error)
}

/// What is wrong with triangles, and two ways out where vertices were parted for their texture coordinates.
fn no_manifold(error: &BuildError) -> PyErr {
    let is_bow_tie = |defect: &Defect| matches!(defect, Defect::BowTie { .. });
    let hint = match error.defects().iter().all(is_bow_tie) {
        true => {
            "\n  If vertices are parted for their texture coordinates, read the file with tearmesh.read_obj, or with \
             trimesh.load(..., process=False, maintain_order=True)"
        }
        false => "",
    };
    value_error(format!("{error}{hint}"))
}

/// The mesh and the positions of arrays.
pub(crate) fn parts_of(
    points: &Array<'_>,
    faces: &Array<'_>,
    roots: Option<&Array<'_>>,
) -> PyResult<(Mesh, Positions)> {
    let points = floats("points", points, &[ANY, 3])?;
    let points = points.as_chunks::<3>().0;
    let positions = Positions::new(points.iter().copied()).map_err(value_error)?;
    Ok((mesh_of(points.len(), faces, roots)?, positions))
}

/// Three numbers.
pub(crate) type Triple = [f64; 3];

/// The scissor of a plane or two rays.
pub(crate) fn scissor_of(
    plane: Option<[Triple; 2]>,
    rays: Option<[[Triple; 2]; 2]>,
    layers: &str,
    snap: f64,
) -> PyResult<Scissor> {
    let scissor = match (plane, rays) {
        (Some([point, normal]), None) => {
            let plane = Plane::new(point.into(), normal.into());
            Scissor::by_plane(plane.map_err(value_error)?)
        }
        (None, Some(rays)) => {
            let [a, b] = rays.map(|[from, way]| Ray::new(from.into(), way.into()));
            let scissor = Scissor::new(a.map_err(value_error)?, b.map_err(value_error)?);
            scissor.map_err(value_error)?
        }
        _ => return Err(value_error("give either a plane or rays")),
    };
    if !(0.0..=0.49).contains(&snap) {
        let why = format!("snap must be from 0 to 0.49, not {snap}");
        return Err(value_error(why));
    }
    let layers = match (layers, rays) {
        ("all", _) => CutLayers::All,
        ("first", Some(_)) => CutLayers::First,
        _ => return Err(value_error("layers is all, or with rays first")),
    };
    Ok(scissor.with_layers(layers).with_snap(snap))
}
