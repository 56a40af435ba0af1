//! A mesh after edits, and what they make of arrays that belong to the mesh before.

use numpy::PyUntypedArray;
use numpy::prelude::*;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tearmesh_core::{Blend as _, Components, Cursor, Cut, Edits, Mesh, Mix, Point, SeamLine, Side};

use crate::arrays::{Array, Made, any, array, floats, indices, rows};
use crate::errors::value_error;

/// Where edits begin, and the size of the mesh before them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Log {
    since: Cursor,
    vertices: usize,
    faces: usize,
}

impl Log {
    /// What is done to this mesh from now on. `since` is the end of its edits so far.
    pub(crate) fn new(mesh: &Mesh, since: Cursor) -> Log {
        Log {
            since,
            vertices: mesh.vertex_count(),
            faces: mesh.face_count(),
        }
    }

    /// What the edits make of an array that belongs to the mesh before. Of what is mixed, a new row lies between
    /// others; of anything else it is a copy of the nearest. Unless it is said how, floats are mixed.
    pub(crate) fn map<'py>(
        &self,
        edits: &Edits,
        values: &Array<'py>,
        per: &str,
        how: Option<&str>,
    ) -> Made<'py> {
        let (py, mut values) = (values.py(), any(values)?);
        let is_float = values.dtype().kind() == b'f';
        let mixes = match how {
            None => is_float,
            Some("mix") => true,
            Some("source") => false,
            Some(_) => return Err(value_error("how must be 'mix' or 'source'")),
        };
        if mixes && !is_float {
            values = as_floats(&values)?;
        }
        let shape = values.shape().to_vec();
        let corners = [self.faces, 3];
        let head = match per {
            "vertex" => &[self.vertices][..],
            "corner" => &corners[..],
            "face" => &corners[..1],
            _ => return Err(value_error("per must be 'vertex', 'corner' or 'face'")),
        };
        let Some(tail) = shape.strip_prefix(head) else {
            let why = format!("values per {per} begin with the shape {head:?}, not {shape:?}");
            return Err(value_error(why));
        };
        let reshaped = |array: &Array<'py>, rows: usize, inner: &[usize]| {
            let shape = PyTuple::new(py, [&[rows], inner].concat())?;
            array.call_method1("reshape", (shape,))
        };
        let count = head.iter().product();
        // Of no numbers there is nothing to mix, but rows to count.
        let mixes = mixes && !tail.contains(&0);
        let width = if mixes { tail.iter().product() } else { 1 };
        let given = match mixes {
            true => floats(
                "values",
                &reshaped(&values, count, &[width])?,
                &[count, width],
            )?,
            false => (0..count).map(|row| row as f64).collect(),
        };
        let cells = py.detach(|| self.replayed(edits, per, &given, width, mixes));
        let rows = cells.len() / width;
        let mapped = array(py, cells, &[rows, width])?;
        let mapped = match mixes {
            true => mapped.call_method1("astype", (values.dtype(),))?,
            false => {
                let sources = mapped.call_method1("astype", ("int64",))?;
                reshaped(&values, count, tail)?.call_method1("take", (sources, 0))?
            }
        };
        let inner = [&head[1..], tail].concat();
        reshaped(&mapped, rows / head[1..].iter().product::<usize>(), &inner)
    }

    /// What the edits make of rows of so many numbers, which are mixed or come from the nearest.
    fn replayed(
        &self,
        edits: &Edits,
        per: &str,
        given: &[f64],
        width: usize,
        mixes: bool,
    ) -> Vec<f64> {
        let mix = |mix: Mix<&f64>| match mixes {
            true => f64::blend(mix),
            false => *mix.nearest(),
        };
        let column = |at: usize| {
            let mut column: Vec<f64> = given.iter().skip(at).step_by(width).copied().collect();
            let seen = &mut self.since.clone();
            match per {
                "vertex" => edits.replay_vertices(seen, &mut column, mix),
                "corner" => edits.replay_corners(seen, &mut column, mix),
                _ => edits.replay_faces(seen, &mut column),
            }
            column
        };
        let columns: Vec<Vec<f64>> = (0..width).map(column).collect();
        let rows = 0..columns[0].len();
        rows.flat_map(|row| columns.iter().map(move |column| column[row]))
            .collect()
    }

    /// What the edits make of texture coordinates, which have three dimensions if they are per corner.
    pub(crate) fn follow<'py>(
        &self,
        edits: &Edits,
        uv: Option<&Array<'py>>,
    ) -> PyResult<Option<Array<'py>>> {
        let per = |dimensions| if dimensions == 3 { "corner" } else { "vertex" };
        let map = |uv| {
            let uv = any(uv)?;
            self.map(edits, uv.as_any(), per(uv.ndim()), Some("mix"))
        };
        uv.map(map).transpose()
    }
}

/// The array with its numbers as floats.
fn as_floats<'py>(array: &Bound<'py, PyUntypedArray>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let is_number = matches!(array.dtype().kind(), b'i' | b'u' | b'b');
    if !is_number {
        let kind = array.dtype();
        return Err(value_error(format!(
            "only numbers can be mixed, not {kind}"
        )));
    }
    let floats = array.call_method1("astype", ("float64",))?;
    Ok(floats.cast_into()?)
}

/// The piece of each face.
pub(crate) fn pieces_of<'py>(py: Python<'py>, mesh: &Mesh) -> Made<'py> {
    let pieces = py.detach(|| numbers_of(mesh, &mesh.components()));
    array(py, pieces, &[mesh.face_count()])
}

fn numbers_of(mesh: &Mesh, pieces: &Components) -> Vec<i64> {
    mesh.faces().map(|f| pieces.of(f) as i64).collect()
}

/// A mesh that may be torn: what a cut made, what was mended, or what a file has.
///
/// points: (n, 3) floats. faces: (m, 3) integers. roots: (n,) integers, the lowest of the vertices that each was one
/// with before it was torn. pieces: (m,) integers, the piece of each face. uv: texture coordinates, or None.
///
/// sides: (m,) int8, of a cut: 1 for a face on the side to which the normal of the plane points, -1 for one on the
/// other, and 0 for one on neither, such as away from a slit. seam: of a cut, a list of lines, each (k, 2) integers:
/// the vertices along the line, on side 1 and on side -1. Both are the same where a slit ends inside the mesh. missed:
/// whether nothing was changed, as by a cut that misses the mesh.
///
/// It never changes, so copies are itself. One that was pickled has all arrays, and no longer `map`.
#[pyclass(module = "tearmesh", frozen)]
pub(crate) struct TornMesh {
    #[pyo3(get)]
    points: Py<PyAny>,
    #[pyo3(get)]
    faces: Py<PyAny>,
    #[pyo3(get)]
    roots: Py<PyAny>,
    #[pyo3(get)]
    pieces: Py<PyAny>,
    #[pyo3(get)]
    uv: Option<Py<PyAny>>,
    #[pyo3(get)]
    sides: Py<PyAny>,
    #[pyo3(get)]
    seam: Vec<Py<PyAny>>,
    /// Whether the cut met nothing.
    #[pyo3(get)]
    missed: bool,
    /// None of one that was unpickled.
    log: Option<(Log, Edits)>,
}

impl TornMesh {
    /// What a cut made of a mesh; one that did nothing, of a mesh that was not cut.
    pub(crate) fn new(
        py: Python<'_>,
        mesh: &Mesh,
        points: &[Point],
        uv: Option<Array<'_>>,
        cut: &Cut,
        log: (Log, Edits),
    ) -> PyResult<TornMesh> {
        let faces = mesh.face_count();
        let (pieces, sides, seam, roots) = py.detach(|| {
            let pieces = cut.pieces(mesh);
            let side = |f| match cut.side(f).or(pieces.sides[pieces.components.of(f)]) {
                Some(Side::Front) => 1,
                Some(Side::Back) => -1,
                None => 0_i8,
            };
            let sides: Vec<i8> = mesh.faces().map(side).collect();
            let seam: Vec<Vec<u32>> = cut.seam().map(|line| ends_of(mesh, line)).collect();
            (
                numbers_of(mesh, &pieces.components),
                sides,
                seam,
                mesh.roots(),
            )
        });
        let line = |ids: &Vec<u32>| Ok(indices(py, ids, &[ids.len() / 2, 2])?.unbind());
        Ok(TornMesh {
            points: rows(py, points.iter().map(|&p| p.into()))?.unbind(),
            faces: indices(py, mesh.indices(), &[faces, 3])?.unbind(),
            roots: indices(py, &roots, &[roots.len()])?.unbind(),
            pieces: array(py, pieces, &[faces])?.unbind(),
            uv: uv.map(Bound::unbind),
            sides: array(py, sides, &[faces])?.unbind(),
            seam: seam.iter().map(line).collect::<PyResult<_>>()?,
            missed: log.1.is_empty(),
            log: Some(log),
        })
    }
}

/// The vertices along a line of a seam, on the front and on the back.
fn ends_of(mesh: &Mesh, line: &SeamLine) -> Vec<u32> {
    let lips = line.lips.iter();
    let starts = lips.map(|&[front, back]| [mesh.origin(front), mesh.target(back)]);
    let end = line.lips.last();
    let end = end.map(|&[front, back]| [mesh.target(front), mesh.origin(back)]);
    starts.chain(end).flatten().map(u32::from).collect()
}

#[pymethods]
impl TornMesh {
    /// Carries an array over from the mesh before the edits: what it is for the mesh now.
    ///
    /// values: (n, ...) per vertex, (m, 3, ...) per corner, or (m, ...) per face, of any dtype, for the n vertices and
    /// m faces of before. per: "vertex", "corner" or "face".
    ///
    /// how: "mix" interpolates, and averages where vertices are sewn: the result is floats. "source" copies from the
    /// nearest, as is right for the number of a bone or a material. By default floats are mixed, and anything else is
    /// copied. Raises ValueError if the shape does not fit, or for "mix" of what are no numbers.
    #[pyo3(signature = (values, per="vertex", how=None))]
    fn map<'py>(&self, values: &Array<'py>, per: &str, how: Option<&str>) -> Made<'py> {
        let log = self.log.as_ref();
        let (before, edits) =
            log.ok_or_else(|| value_error("it was unpickled, and no longer knows the edits"))?;
        before.map(edits, values, per, how)
    }

    fn __copy__(this: Py<Self>) -> Py<Self> {
        this
    }

    fn __deepcopy__(this: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        this
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let of = py.get_type::<TornMesh>().getattr("_of")?;
        let arrays = [
            &self.points,
            &self.faces,
            &self.roots,
            &self.pieces,
            &self.sides,
        ];
        let arrays = PyTuple::new(py, arrays)?;
        let uv = self.uv.as_ref().map(|uv| uv.bind(py));
        let seam: Vec<_> = self.seam.iter().map(|line| line.bind(py)).collect();
        Ok((of, (arrays, uv, seam, self.missed).into_pyobject(py)?))
    }

    /// The mesh of what was pickled.
    #[staticmethod]
    fn _of(
        arrays: [Py<PyAny>; 5],
        uv: Option<Py<PyAny>>,
        seam: Vec<Py<PyAny>>,
        missed: bool,
    ) -> TornMesh {
        let [points, faces, roots, pieces, sides] = arrays;
        TornMesh {
            points,
            faces,
            roots,
            pieces,
            uv,
            sides,
            seam,
            missed,
            log: None,
        }
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let [points, faces] = [&self.points, &self.faces].map(|array| array.bind(py).len());
        let pieces = self.pieces.bind(py).call_method0("max");
        let pieces = pieces.and_then(|last| last.extract::<usize>());
        let pieces = pieces.map_or(0, |last| last + 1);
        let (points, faces) = (points?, faces?);
        Ok(format!(
            "<tearmesh.TornMesh: {points} points, {faces} faces, pieces: {pieces}>"
        ))
    }
}
