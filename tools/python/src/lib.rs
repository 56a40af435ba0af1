//! The Python module `tearmesh`: triangle meshes in numpy arrays are cut, torn, mended and simulated.
//!
//! What Python shows by `help(tearmesh)` is documented here; `tearmesh.pyi` has the types. What is refused raises
//! `ValueError` with the text of the library.

#![forbid(unsafe_code)]

mod arguments;
mod arrays;
mod errors;
mod numbers;
mod obj;
mod scene;
mod simulation;
mod torn;
mod waiting;

use pyo3::prelude::*;
use tearmesh_core::gap::gapped;
use tearmesh_core::unsewn::UnsewnSeams;
use tearmesh_core::{Cursor, Cut, CutError, CutMethod, Edits, Mesh, Scissor, mend as sewing};

use arguments::{Triple, mesh_of, parts_of, scissor_of, vertices_named};
use arrays::{Array, Made, triangles};
use errors::value_error;
use numbers::{not_negative, vertex_count};
use torn::Log;
use waiting::heard;

/// The distance that is given for `weld`: True is 0, and False none.
fn distance_of(weld: &Array<'_>) -> PyResult<Option<f64>> {
    match weld.extract::<bool>() {
        Ok(is_welded) => Ok(is_welded.then_some(0.0)),
        Err(_) => weld.extract().map(Some),
    }
}

// Defaults that Python shows have to be literals.
const _: () = assert!(Scissor::SNAP == 0.05 && tearmesh_cloth::Simulation::GRIP_RADIUS_M == 0.12);

/// Cuts, tears, mends and simulates triangle meshes that are held in numpy arrays.
///
/// `points` has the shape (n, 3), and `faces` the shape (m, 3): indices of points, from 0, counter-clockwise seen from
/// outside. Faces must form an oriented manifold: `check` lists what is wrong. `roots` has the shape (n,), and is
/// what makes a torn mesh more than its triangles: the lowest of the vertices that each was one with before it was
/// torn. Pass it on with the points and the faces of a result.
///
/// Both sides of a cut lie at the same place. Programs that merge equal points close it, as `trimesh.Trimesh` does
/// unless it is given `process=False`. Or have the sides moved apart: `cut(..., gap=0.001)`.
///
/// Whatever is refused raises ValueError, with the numbers of the vertices (v7) and faces (f3) concerned, or TypeError if
/// it is of the wrong type, as 1.5 or True is for the number of a vertex. Nothing is changed then.
#[pymodule]
mod tearmesh {
    use super::*;

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "its name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    #[pymodule_export]
    use super::obj::{read_obj, write_obj};
    #[pymodule_export]
    use super::simulation::Simulation;
    #[pymodule_export]
    use super::torn::TornMesh;

    /// Lists what is wrong with triangles, a text each; nothing if they form an oriented manifold.
    ///
    /// faces: (m, 3) integers. n: the number of vertices. At most a thousand defects of a kind are listed. A torn mesh
    /// need not be a manifold.
    #[pyfunction]
    fn check(faces: &Array<'_>, n: &Array<'_>) -> PyResult<Vec<String>> {
        let (triangles, n) = (triangles(faces)?, vertex_count(n)?);
        heard(faces.py(), move || {
            let defects = Mesh::build(vertices_named(n, &triangles)?, triangles).err();
            let defects = defects.iter().flat_map(|error| error.defects());
            Ok(defects.map(ToString::to_string).collect())
        })?
    }

    /// Returns the piece of each face, as (m,) integers. Pieces are numbered from 0 in the order of their first faces.
    ///
    /// Faces are of one piece if they are joined by shared edges.
    ///
    /// faces: (m, 3) integers. n: the number of vertices. roots: (n,) integers, for a torn mesh.
    #[pyfunction]
    #[pyo3(signature = (faces, n, *, roots=None))]
    fn pieces<'py>(faces: &Array<'py>, n: &Array<'py>, roots: Option<&Array<'py>>) -> Made<'py> {
        let (py, triangles, n) = (faces.py(), triangles(faces)?, vertex_count(n)?);
        let vertices = match roots {
            Some(_) => n,
            None => py.detach(|| vertices_named(n, &triangles))?,
        };
        let mesh = mesh_of(py, vertices, triangles, roots)?;
        torn::pieces_of(py, &mesh)
    }

    /// Cuts a mesh along a plane, or between two rays, and returns a TornMesh. The arrays that are given stay as they are.
    ///
    /// points: (n, 3) floats. faces: (m, 3) integers.
    /// plane: (point, normal). rays: ((origin, direction), (origin, direction)); what lies between them is cut.
    /// uv: an array that follows the cut, per vertex (n, k), or per corner (m, 3, k): see TornMesh.uv.
    /// layers: "all", or with rays "first", which cuts only the surface that the rays hit first.
    /// gap: how far to move the two sides apart, in the unit of the points: for good, so use it on the last cut.
    /// snap: how near the end of an edge a crossing is moved to that end, as a fraction of the edge: 0 to 0.49.
    /// roots: (n,) integers, if the mesh is torn already.
    /// weld: a distance. Seams whose sides are at most that far apart are sewn first: boundary edges that lie on each
    /// other, such as those of a mesh with a vertex for each texture coordinate. True is 0. To keep the texture coordinates of
    /// both sides, give uv per corner. Without weld, the cut crosses such seams, and they stay as they are.
    ///
    /// Raises ValueError if the faces form no oriented manifold, a coordinate is not finite or exceeds 1.8e75, the
    /// plane has no normal, both rays lie on one line, or they cross within the mesh. A cut that misses the mesh
    /// changes nothing.
    #[pyfunction]
    #[pyo3(signature = (points, faces, plane=None, rays=None, *, uv=None, layers="all", gap=0.0, snap=0.05, roots=None, weld=None))]
    #[expect(clippy::too_many_arguments, reason = "in Python they have names")]
    fn cut<'py>(
        py: Python<'py>,
        points: &Array<'py>,
        faces: &Array<'py>,
        plane: Option<[Triple; 2]>,
        rays: Option<[[Triple; 2]; 2]>,
        uv: Option<&Array<'py>>,
        layers: &str,
        gap: f64,
        snap: f64,
        roots: Option<&Array<'py>>,
        weld: Option<&Array<'py>>,
    ) -> PyResult<TornMesh> {
        let weld = weld.map(distance_of).transpose()?.flatten();
        not_negative("weld", "a distance", weld.unwrap_or(0.0))?;
        not_negative("gap", "a length", gap)?;
        let scissor = scissor_of(plane, rays, layers, snap)?;
        let (mut mesh, mut positions) = parts_of(points, faces, roots)?;
        let (log, mut edits) = (Log::new(&mesh, Cursor::START), Edits::new());
        let made = py.detach(|| {
            let seams = UnsewnSeams::within(&mesh, &positions, weld.unwrap_or(0.0));
            let mut closed = seams.close(&mut mesh);
            if weld.is_some() {
                let stitches = seams.stitches(&mesh);
                let far = f64::INFINITY;
                let sewn = sewing::sew(&mut mesh, &positions, &stitches, |_| 1.0, far, &mut edits);
                sewn.expect("the sides of a seam have one root");
                edits.replay(&mut positions);
            }
            let cut = scissor.cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)?;
            edits.replay(&mut closed);
            closed.reopen(&mut mesh);
            let points = match gap > 0.0 {
                true => gapped(&mesh, &positions, gap).1,
                false => positions.as_slice().to_vec(),
            };
            Ok((cut, points))
        });
        let (cut, points) = made.map_err(|error: CutError| value_error(error))?;
        let uv = log.follow(&edits, uv)?;
        TornMesh::new(py, &mesh, &points, uv, &cut, (log, edits))
    }

    /// Sews all vertices that were split from the same one, and returns a TornMesh. Each lies in the middle of those
    /// that it was.
    ///
    /// points: (n, 3) floats. faces: (m, 3) integers. roots: (n,) integers, as a TornMesh or a Simulation has them.
    /// uv: as for `cut`. max_distance: how far apart vertices may be that are sewn.
    ///
    /// Vertices that a cut inserted stay. Raises ValueError if two vertices are farther apart, or for the reasons of `cut`.
    #[pyfunction]
    #[pyo3(signature = (points, faces, roots, *, uv=None, max_distance=None))]
    fn mend<'py>(
        py: Python<'py>,
        points: &Array<'py>,
        faces: &Array<'py>,
        roots: &Array<'py>,
        uv: Option<&Array<'py>>,
        max_distance: Option<f64>,
    ) -> PyResult<TornMesh> {
        let max_distance = max_distance.filter(|&distance| distance != f64::INFINITY);
        not_negative("max_distance", "a distance", max_distance.unwrap_or(0.0))?;
        let (mut mesh, mut positions) = parts_of(points, faces, Some(roots))?;
        let (log, mut edits) = (Log::new(&mesh, Cursor::START), Edits::new());
        let sewn = py.detach(|| {
            let stitches = sewing::stitches(&mesh, |_| true);
            let (far, even) = (max_distance.unwrap_or(f64::INFINITY), |_| 1.0);
            let sewn = sewing::sew(&mut mesh, &positions, &stitches, even, far, &mut edits);
            edits.replay(&mut positions);
            sewn
        });
        sewn.map_err(value_error)?;
        let uv = log.follow(&edits, uv)?;
        let (points, none) = (positions.as_slice(), Cut::default());
        TornMesh::new(py, &mesh, points, uv, &none, (log, edits))
    }
}
