//! Arrays of numpy, in and out.

use std::fmt::Display;
use std::io;
use std::path::Path;

use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArrayDyn, PyUntypedArray};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use tearmesh_core::VertexId;

/// Whatever Python gives, and is given, for an array.
pub(crate) type Array<'py> = Bound<'py, PyAny>;

/// An array that was made, or why it was not.
pub(crate) type Made<'py> = PyResult<Array<'py>>;

/// In the shape of an array, any length.
pub(crate) const ANY: usize = usize::MAX;

/// The text of an error of the library, for Python.
pub(crate) fn value_error(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An error of a file, with its name.
pub(crate) fn os_error(error: &io::Error, path: &Path) -> PyErr {
    let text = error.to_string();
    let text = text
        .split(" (os error")
        .next()
        .unwrap_or_default()
        .to_owned();
    PyOSError::new_err((error.raw_os_error(), text, path.to_owned()))
}

/// Whatever numpy makes an array of.
pub(crate) fn any<'py>(given: &Array<'py>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let array = numpy::get_array_module(given.py())?.call_method1("asarray", (given,))?;
    Ok(array.cast_into()?)
}

/// The elements of an array, in the order of its shape.
fn elements<T: Element + Copy>(name: &str, array: &Array<'_>, shape: &[usize]) -> PyResult<Vec<T>> {
    let dtype = numpy::dtype::<T>(array.py());
    let numpy = numpy::get_array_module(array.py())?;
    let array = numpy.call_method1("ascontiguousarray", (array, dtype))?;
    let array = array.cast_into::<PyArrayDyn<T>>()?;
    let given = array.shape();
    let fits = |(is, wanted): (&usize, &usize)| *wanted == ANY || is == wanted;
    if given.len() != shape.len() || !given.iter().zip(shape).all(fits) {
        let wanted = format!("{shape:?}").replace(&ANY.to_string(), "n");
        let why = format!("{name} must be an array of shape {wanted}, not {given:?}");
        return Err(value_error(why));
    }
    Ok(array.try_readonly()?.as_slice()?.to_vec())
}

/// Numbers from an array of a shape.
pub(crate) fn floats(name: &str, given: &Array<'_>, shape: &[usize]) -> PyResult<Vec<f64>> {
    elements(name, given, shape)
}

/// Whole numbers that an id can have, from an array of integers.
pub(crate) fn ids(name: &str, given: &Array<'_>, shape: &[usize]) -> PyResult<Vec<u32>> {
    let array = any(given)?;
    let kind = array.dtype().kind();
    if !matches!(kind, b'i' | b'u') && !array.is_empty() {
        let kind = array.dtype();
        return Err(value_error(format!("{name} must be integers, not {kind}")));
    }
    let id = |number: i128| u32::try_from(number).map_err(|_| no_vertex(name, number));
    // As they are: the largest numbers of either kind are none of the other.
    if kind == b'u' {
        let numbers: Vec<u64> = elements(name, array.as_any(), shape)?;
        return numbers
            .into_iter()
            .map(|number| id(number.into()))
            .collect();
    }
    let numbers: Vec<i64> = elements(name, array.as_any(), shape)?;
    numbers
        .into_iter()
        .map(|number| id(number.into()))
        .collect()
}

/// Vertices from an array of one dimension.
pub(crate) fn vertices(name: &str, given: &Array<'_>) -> PyResult<Vec<VertexId>> {
    let ids = ids(name, given, &[ANY])?;
    ids.into_iter().map(|id| vertex(name, id)).collect()
}

/// The vertex of a number.
pub(crate) fn vertex(name: &str, number: u32) -> PyResult<VertexId> {
    VertexId::new(number as usize).ok_or_else(|| no_vertex(name, number))
}

fn no_vertex(name: &str, number: impl Display) -> PyErr {
    value_error(format!("{name} has {number}, which is no vertex"))
}

/// The triangles of an array of faces.
pub(crate) fn triangles(faces: &Array<'_>) -> PyResult<Vec<[u32; 3]>> {
    let ids = ids("faces", faces, &[ANY, 3])?;
    Ok(ids.as_chunks::<3>().0.to_vec())
}

/// An array of a shape, which takes over the elements.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    elements: Vec<T>,
    shape: &[usize],
) -> Made<'py> {
    Ok(PyArray1::from_vec(py, elements).reshape(shape)?.into_any())
}

/// An array of points, or of vectors, a row each.
pub(crate) fn rows<'py>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f64; 3]>,
) -> Made<'py> {
    let count = rows.len();
    array(py, rows.flatten().collect(), &[count, 3])
}

/// An array of ids, as numpy indexes by them.
pub(crate) fn indices<'py>(py: Python<'py>, ids: &[u32], shape: &[usize]) -> Made<'py> {
    array(py, ids.iter().map(|&id| i64::from(id)).collect(), shape)
}
