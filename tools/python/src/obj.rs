//! OBJ files, with the record of what is torn.

use std::collections::HashMap;
use std::ffi::{CString, OsString};
use std::fmt::Display;
use std::fs::File;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::{fs, process};

use numpy::prelude::*;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use tearmesh_core::{Cursor, Cut, Edits, Mesh, Positions};
use tearmesh_obj::{Document, TornDocument, named_format};

use crate::arguments::parts_of;
use crate::arrays::{Array, any, array, floats};
use crate::errors::{os_error, value_error};
use crate::torn::{Log, TornMesh};
use crate::waiting::heard;

/// Reads an OBJ file, and returns a TornMesh. If tearmesh wrote the file, what was torn is torn again.
///
/// Polygons become triangles. uv is (m, 3, 2), or None unless every corner has a texture coordinate. Texts of the file
/// that deserve a look are raised as UserWarning. Raises OSError, or ValueError with line and column of what is wrong.
#[pyfunction]
pub(crate) fn read_obj(py: Python<'_>, path: PathBuf) -> PyResult<TornMesh> {
    let refused = |why: &dyn Display| value_error(format!("{}: {why}", path.display()));
    let from = path.clone();
    let document = heard(py, || {
        fs::read(from).map(|bytes| Document::read(&bytes[..]))
    })?;
    let document = document.map_err(|error| os_error(&error, &path))?;
    let document = document.map_err(|error| match named_format(&path) {
        Some(format) => refused(&format!("this is {format} file, not OBJ; convert it first")),
        None => refused(&error),
    })?;
    let mesh = py.detach(|| document.mesh());
    let mesh = mesh.map_err(|error| refused(&error))?;
    for diagnostic in document.diagnostics() {
        let text = CString::new(format!("{}: {diagnostic}", path.display()))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &text, 1)?;
    }
    let faces = mesh.face_count();
    let numbers = |h: usize| {
        let numbers = document.texture(document.corner(h / 3, h % 3).texture? as usize);
        Some([0, 1].map(|axis| numbers.get(axis).copied().unwrap_or(0.0)))
    };
    let uv: Option<Vec<[f64; 2]>> = py.detach(|| (0..3 * faces).map(numbers).collect());
    let uv = uv.map(|uv| array(py, uv.into_flattened(), &[faces, 3, 2]));
    let log = (Log::new(&mesh, Cursor::START), Edits::new());
    let (points, uv) = (document.positions(), uv.transpose()?);
    TornMesh::new(py, &mesh, points, uv, &Cut::default(), log)
}

/// Writes an OBJ file, with a record of what is torn, so that `read_obj` and the command `tearmesh mend` know it.
///
/// points: (n, 3) floats. faces: (m, 3) integers. roots: (n,) integers, for a torn mesh. uv: floats, (n, 2) per
/// vertex or (m, 3, 2) per corner, as a TornMesh has them.
/// Raises OSError, and then the old file is still there, or ValueError for the reasons of `cut`.
#[pyfunction]
#[pyo3(signature = (path, points, faces, *, roots=None, uv=None))]
pub(crate) fn write_obj(
    path: PathBuf,
    points: &Array<'_>,
    faces: &Array<'_>,
    roots: Option<&Array<'_>>,
    uv: Option<&Array<'_>>,
) -> PyResult<()> {
    let py = points.py();
    let (mesh, positions) = parts_of(points, faces, roots)?;
    let uv = uv.map(|uv| per_corner(uv, &mesh)).transpose()?;
    let bytes = py.detach(|| bytes_of(&mesh, &positions, uv.as_deref()))?;
    let to = path.clone();
    let written = heard(py, move || replace(&to, &bytes))?;
    written.map_err(|error| os_error(&error, &path))
}

/// The text of a mesh as an OBJ file, with the record of what is torn.
fn bytes_of(mesh: &Mesh, positions: &Positions, uv: Option<&[f64]>) -> PyResult<Vec<u8>> {
    if let Some(number) = uv.into_iter().flatten().find(|number| !number.is_finite()) {
        let why = format!("uv contains {number}, which no file can have");
        return Err(value_error(why));
    }
    let mut text = String::new();
    let mut line = |line: String| text.extend([&line, "\n"]);
    for p in positions.as_slice() {
        line(format!("v {:?} {:?} {:?}", p.x, p.y, p.z));
    }
    let mut numbers = HashMap::new();
    let mut texture = Vec::new();
    for pair in uv.iter().flat_map(|uv| uv.as_chunks::<2>().0) {
        let next = numbers.len() + 1;
        let number = *numbers.entry(pair.map(f64::to_bits)).or_insert(next);
        texture.push(format!("/{number}"));
        if number == next {
            line(format!("vt {:?} {:?}", pair[0], pair[1]));
        }
    }
    for (f, face) in mesh.indices().as_chunks::<3>().0.iter().enumerate() {
        let texture = |c: usize| texture.get(3 * f + c).map_or("", String::as_str);
        let corner = |c: usize| format!(" {}{}", face[c] + 1, texture(c));
        line(format!("f{}", [0, 1, 2].map(corner).concat()));
    }
    let document = Document::read(text.as_bytes()).map_err(value_error)?;
    let (document, mesh) = document.torn_from(&mesh.roots()).map_err(value_error)?;
    let mut bytes = Vec::new();
    TornDocument::new(&document).write(&mesh, positions, &mut bytes)?;
    Ok(bytes)
}

/// Texture coordinates by corner, from those of vertices or of corners.
fn per_corner(uv: &Array<'_>, mesh: &Mesh) -> PyResult<Vec<f64>> {
    if any(uv)?.ndim() == 3 {
        return floats("uv", uv, &[mesh.face_count(), 3, 2]);
    }
    let of_vertices = floats("uv", uv, &[mesh.vertex_count(), 2])?;
    let pairs = of_vertices.as_chunks::<2>().0;
    Ok(mesh
        .indices()
        .iter()
        .flat_map(|&v| pairs[v as usize])
        .collect())
}

/// Writes the file that a path leads to: the old one stays, or the new one is whole, with the mode of the old one. What
/// is no file, such as a pipe, is written to.
fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // A link leads elsewhere, and stays; one that leads nowhere is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let existing = fs::metadata(&path).ok();
    if existing.as_ref().is_some_and(|found| !found.is_file()) {
        return File::options().write(true).open(&path)?.write_all(bytes);
    }
    let mut beside = OsString::from(&path);
    beside.push(format!(".{}.new", process::id()));
    let filled = fs::write(&beside, bytes).and_then(|()| match existing {
        Some(existing) => fs::set_permissions(&beside, existing.permissions()),
        None => Ok(()),
    });
    let written = filled.and_then(|()| fs::rename(&beside, &path));
    written.inspect_err(|_| drop(fs::remove_file(&beside)))
}
