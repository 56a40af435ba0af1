//! How much is tried of what takes long.

/// Of long rows and cases every fourth is tried, and in CI, where `TEARMESH_CASES` is `ci`, every one.
pub(crate) fn stride() -> usize {
    match std::env::var("TEARMESH_CASES").as_deref() {
        Ok("ci") => 1,
        _ => 4,
    }
}
