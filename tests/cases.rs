//! How many random cases a test tries.

/// What `TEARMESH_CASES` says, or else so many.
pub(crate) fn cases(usual: u64) -> u64 {
    std::env::var("TEARMESH_CASES").map_or(usual, |cases| {
        cases.parse().expect("TEARMESH_CASES is a number")
    })
}

/// The same where there are no more than these.
pub(crate) fn cases_of(all: u64) -> u64 {
    cases(all).min(all)
}
