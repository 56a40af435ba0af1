//! The exceptions of the module: why something is refused.

use std::fmt::Display;
use std::io;
use std::path::Path;

use pyo3::exceptions::{PyOSError, PyTypeError, PyValueError};
use pyo3::prelude::*;

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

/// What stands where the number of a vertex belongs.
pub(crate) fn no_vertex(name: &str, number: impl Display) -> PyErr {
    value_error(format!(
        "{name} contains {number}, which is not a vertex index"
    ))
}

/// What stands where a whole number belongs.
pub(crate) fn no_integer(name: &str, given: &Bound<'_, PyAny>) -> PyErr {
    // Python refuses to show an integer of more than 4300 digits, but that is an integer.
    let shown = given.repr().map(|text| text.to_string());
    let shown = shown.unwrap_or_else(|_| "this".to_owned());
    PyTypeError::new_err(format!("{name} must be an integer, not {shown}"))
}

/// A setting of tearing that would be ignored.
pub(crate) fn nothing_tears(name: &str) -> PyErr {
    let why = "makes no difference where nothing tears: give stretch or toughness";
    value_error(format!("{name} {why}"))
}
