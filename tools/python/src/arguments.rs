//! What several functions take: a mesh, torn or not, and what to cut it by.

use pyo3::prelude::*;
use tearmesh_core::{BuildError, CutLayers, Defect, Mesh, Plane, Positions, Ray, Scissor};

use crate::arrays::{ANY, Array, floats, ids, triangles};
use crate::errors::value_error;

/// The mesh of some triangles, torn where vertices have roots.
pub(crate) fn mesh_of(
    py: Python<'_>,
    n: usize,
    faces: Vec<[u32; 3]>,
    roots: Option<&Array<'_>>,
) -> PyResult<Mesh> {
    let Some(roots) = roots else {
        let built = py.detach(|| Mesh::build(n, faces));
        return built.map_err(|error| no_manifold(&error));
    };
    let roots = ids("roots", roots, &[n])?;
    let built = py.detach(|| Mesh::build_torn(&faces, &roots));
    built.map_err(value_error)
}

/// How many of `n` vertices a mesh of triangles needs: up to the last that one of them names. The others, which have no
/// faces, take no room; but so few faces may name so high a number that the room is not to be had.
pub(crate) fn vertices_named(n: usize, triangles: &[[u32; 3]]) -> PyResult<usize> {
    let last = triangles.iter().flatten().max().copied();
    let named = last.map_or(0, |last| last as usize + 1).min(n);
    match last {
        Some(last) if named > SPARSE_MAX + 100 * triangles.len() => Err(value_error(format!(
            "faces contains {last}, but only {} triangles: number the vertices without such gaps",
            triangles.len()
        ))),
        _ => Ok(named),
    }
}

/// The number of vertices, beyond a hundred for each face, up to which most may have no face: 200 MB.
const SPARSE_MAX: usize = 1 << 24;

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
    let py = faces.py();
    let positions = py.detach(|| Positions::new(points.iter().copied()));
    let positions = positions.map_err(value_error)?;
    let mesh = mesh_of(py, points.len(), triangles(faces)?, roots)?;
    Ok((mesh, positions))
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
        _ => return Err(value_error("layers must be 'all' or, with rays, 'first'")),
    };
    Ok(scissor.with_layers(layers).with_snap(snap))
}
