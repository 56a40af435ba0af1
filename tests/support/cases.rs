//! How many random cases a test tries. No other place says so.

/// What finds every seeded bug.
const CASES: u64 = 1_500;

/// The number of random cases: [`CASES`], ten times that in CI, where `TEARMESH_CASES` is `ci`, or what that
/// variable says.
pub(crate) fn cases() -> u64 {
    match std::env::var("TEARMESH_CASES").as_deref() {
        Err(_) => CASES,
        Ok("ci") => 10 * CASES,
        Ok(number) => number.parse().expect("TEARMESH_CASES is `ci` or a number"),
    }
}

/// Of long rows and cases every fourth is tried, and in CI every one.
pub(crate) fn stride() -> usize {
    if cases() > CASES { 1 } else { 4 }
}
