//! Arrays of numpy, in and out.

use std::fmt::Display;

use numpy::prelude::*;
use numpy::{Element, PyArray1, PyArrayDyn, PyUntypedArray};
use pyo3::prelude::*;
use pyo3::types::IntoPyDict;
use tearmesh_core::VertexId;

use crate::errors::{no_vertex, value_error};
use crate::numbers::{refuse_truth_values, whole};

/// Whatever Python gives, and is given, for an array.
pub(crate) type Array<'py> = Bound<'py, PyAny>;

/// An array that was made, or why it was not.
pub(crate) type Made<'py> = PyResult<Array<'py>>;

/// In the shape of an array, any length.
pub(crate) const ANY: usize = usize::MAX;

/// Whatever numpy makes an array of.
pub(crate) fn any<'py>(given: &Array<'py>) -> PyResult<Bound<'py, PyUntypedArray>> {
    let array = numpy::get_array_module(given.py())?.call_method1("asarray", (given,))?;
    Ok(array.cast_into()?)
}

/// A copy of an array, in the order of its shape, made of its elements by a function. Other threads run meanwhile, also
/// while numpy copies: nobody else has the copy that is read, so nobody writes it.
fn elements<T: Element + Copy + Sync, E: Send>(
    name: &str,
    array: &Array<'_>,
    shape: &[usize],
    made: impl FnOnce(&[T]) -> E + Send,
) -> PyResult<E> {
    let py = array.py();
    let order = [("order", "C")].into_py_dict(py)?;
    let array = numpy::get_array_module(py)?.call_method(
        "array",
        (array, numpy::dtype::<T>(py)),
        Some(&order),
    )?;
    let array = array.cast_into::<PyArrayDyn<T>>()?;
    let given = array.shape();
    let fits = |(is, wanted): (&usize, &usize)| *wanted == ANY || is == wanted;
    if given.len() != shape.len() || !given.iter().zip(shape).all(fits) {
        let wanted = format!("{shape:?}").replace(&ANY.to_string(), "n");
        let why = format!("{name} must be an array of shape {wanted}, not {given:?}");
        return Err(value_error(why));
    }
    let copy = array.try_readonly()?;
    let numbers = copy.as_slice()?;
    Ok(py.detach(|| made(numbers)))
}

/// Numbers from an array of a shape. Those of Python that numpy keeps as objects may be numbers as well.
pub(crate) fn floats(name: &str, given: &Array<'_>, shape: &[usize]) -> PyResult<Vec<f64>> {
    let array = any(given)?;
    if !matches!(array.dtype().kind(), b'f' | b'i' | b'u' | b'O') {
        let kind = array.dtype();
        return Err(value_error(format!("{name} must be numbers, not {kind}")));
    }
    elements(name, array.as_any(), shape, <[f64]>::to_vec)
}

/// Whole numbers that an id can have, from an array of integers.
pub(crate) fn ids(name: &str, given: &Array<'_>, shape: &[usize]) -> PyResult<Vec<u32>> {
    refuse_truth_values(name, given, shape.len())?;
    let array = any(given)?;
    // As they are: the largest numbers of either kind are none of the other.
    match array.dtype().kind() {
        b'u' => elements(name, array.as_any(), shape, |numbers: &[u64]| {
            all_ids(name, numbers)
        })?,
        kind if kind == b'i' || array.is_empty() => {
            elements(name, array.as_any(), shape, |numbers: &[i64]| {
                all_ids(name, numbers)
            })?
        }
        _ => Err(no_integers(name, given, &array)),
    }
}

fn all_ids<N: Copy + Display + TryInto<u32>>(name: &str, numbers: &[N]) -> PyResult<Vec<u32>> {
    let id = |&number: &N| number.try_into().map_err(|_| no_vertex(name, number));
    numbers.iter().map(id).collect()
}

/// Why an array has no integers: of integers that numpy has no type for, the first that is no id.
fn no_integers(name: &str, given: &Array<'_>, array: &Bound<'_, PyUntypedArray>) -> PyErr {
    let too_large = || {
        let numpy = numpy::get_array_module(given.py())?;
        let objects = numpy.call_method1("array", (given, "O"))?;
        for item in objects.call_method0("ravel")?.try_iter()? {
            let number = whole(name, &item?)?;
            if number.extract::<u32>().is_err() {
                return Ok(Some(no_vertex(name, number)));
            }
        }
        PyResult::Ok(None)
    };
    let kind = array.dtype();
    let wrong_kind = || value_error(format!("{name} must be integers, not {kind}"));
    too_large().ok().flatten().unwrap_or_else(wrong_kind)
}

/// Vertices from an array of one dimension.
pub(crate) fn vertices(name: &str, given: &Array<'_>) -> PyResult<Vec<VertexId>> {
    let ids = ids(name, given, &[ANY])?;
    let vertex = |id: u32| VertexId::new(id as usize).ok_or_else(|| no_vertex(name, id));
    ids.into_iter().map(vertex).collect()
}

/// The triangles of an array of faces.
pub(crate) fn triangles(faces: &Array<'_>) -> PyResult<Vec<[u32; 3]>> {
    let ids = ids("faces", faces, &[ANY, 3])?;
    Ok(faces.py().detach(|| ids.as_chunks::<3>().0.to_vec()))
}

/// An array of a shape, which takes over the elements.
pub(crate) fn array<'py, T: Element>(
    py: Python<'py>,
    elements: Vec<T>,
    shape: &[usize],
) -> Made<'py> {
    Ok(PyArray1::from_vec(py, elements).reshape(shape)?.into_any())
}

/// An array of points, or of vectors, a row each. Other threads run while they are calculated.
pub(crate) fn rows<'py>(
    py: Python<'py>,
    rows: impl ExactSizeIterator<Item = [f64; 3]> + Send,
) -> Made<'py> {
    let count = rows.len();
    array(py, py.detach(|| rows.flatten().collect()), &[count, 3])
}

/// An array of ids, as numpy indexes by them.
pub(crate) fn indices<'py>(py: Python<'py>, ids: &[u32], shape: &[usize]) -> Made<'py> {
    let numbers = py.detach(|| ids.iter().map(|&id| i64::from(id)).collect());
    array(py, numbers, shape)
}
