//! Single numbers from Python, refused by the name of their argument and as they were given.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyInt, PyList, PyTuple};
use tearmesh_core::{Mesh, VertexId};

use crate::errors::{no_integer, value_error};

/// Whatever Python gives.
type Given<'py> = Bound<'py, PyAny>;

/// A number of vertices.
pub(crate) fn vertex_count(n: &Given<'_>) -> PyResult<usize> {
    let most = Mesh::MAX_VERTICES as u64;
    Ok(up_to("n", "a number of vertices", n, most)? as usize)
}

/// A number of steps to take.
pub(crate) fn count(given: &Given<'_>) -> PyResult<u64> {
    up_to("count", "a number of steps", given, u32::MAX.into())
}

/// A limit for the number of steps.
pub(crate) fn steps_max(given: &Given<'_>) -> PyResult<u64> {
    up_to("steps_max", "a number of steps", given, u64::MAX)
}

/// The id of a vertex, which a mesh need not have.
pub(crate) fn vertex(given: &Given<'_>) -> PyResult<VertexId> {
    let most = Mesh::MAX_VERTICES as u64 - 1;
    let number = up_to("vertex", "the index of a vertex", given, most)?;
    Ok(VertexId::new(number as usize).expect("a mesh may have it"))
}

/// What was made under a number before, such as a hand or a cut.
pub(crate) fn numbered<T: Copy>(name: &str, given: &Given<'_>, made: &[T]) -> PyResult<T> {
    let number = whole(name, given)?;
    let found = number.extract().ok().and_then(|at: usize| made.get(at));
    let found = found.copied();
    found.ok_or_else(|| value_error(format!("no such {name}: {number}")))
}

/// A whole number from 0 to `most`.
fn up_to(name: &str, what: &str, given: &Given<'_>, most: u64) -> PyResult<u64> {
    let number = whole(name, given)?;
    let fits = number.extract().ok().filter(|fits| *fits <= most);
    fits.ok_or_else(|| value_error(format!("{name} must be {what}, not {number}")))
}

/// An integer of Python or numpy, however large. True would pass for 1, and is none.
pub(crate) fn whole<'py>(name: &str, given: &Given<'py>) -> PyResult<Given<'py>> {
    let number = match given.is_instance_of::<PyBool>() {
        true => None,
        false => given.call_method0("__index__").ok(),
    };
    number.ok_or_else(|| no_integer(name, given))
}

/// Refuses truth values in lists of so many dimensions: among numbers, numpy takes them for 0 and 1.
pub(crate) fn refuse_truth_values(
    name: &str,
    given: &Given<'_>,
    dimensions: usize,
) -> PyResult<()> {
    if given.is_exact_instance_of::<PyInt>() {
        return Ok(());
    }
    if given.get_type().name()?.to_str()?.starts_with("bool") {
        let why = format!("{name} contains {given}, which is not an integer");
        return Err(PyTypeError::new_err(why));
    }
    let is_list = given.is_instance_of::<PyList>() || given.is_instance_of::<PyTuple>();
    if dimensions > 0 && is_list {
        let mut items = given.try_iter()?;
        items.try_for_each(|item| refuse_truth_values(name, &item?, dimensions - 1))
    } else {
        Ok(())
    }
}

/// Refuses a number that is negative, infinite or none. `what` is its kind, such as "a length".
pub(crate) fn not_negative(name: &str, what: &str, number: f64) -> PyResult<()> {
    match number >= 0.0 && number.is_finite() {
        true => Ok(()),
        false => {
            let why = format!("{name} must be {what} of 0 or more, not {number}");
            Err(value_error(why))
        }
    }
}
