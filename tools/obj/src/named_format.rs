//! Formats that people take for OBJ, by the names of files.

use std::path::Path;

/// Returns the format that the ending of a file's name says, with its article, if it is not OBJ but is often taken
/// for it.
///
/// ```
/// use std::path::Path;
///
/// assert_eq!(tearmesh_obj::named_format(Path::new("a.STL")), Some("an STL"));
/// assert_eq!(tearmesh_obj::named_format(Path::new("a.obj")), None);
/// ```
#[must_use]
pub fn named_format(path: &Path) -> Option<&'static str> {
    let ending = path.extension()?.to_ascii_lowercase();
    match ending.to_str()? {
        "ply" => Some("a PLY"),
        "stl" => Some("an STL"),
        _ => None,
    }
}
