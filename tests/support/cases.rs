//! The number of random cases that a test tries. No other place says so.

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

/// Whether `tests/seeded/run` has planted a bug, of which the first case that fails is enough; none where tests are run
/// by others.
pub(crate) fn planted() -> Option<bool> {
    let number = std::env::var("TEARMESH_SEEDED").ok();
    number.map(|number| number != "0")
}

/// Of long rows and cases every fourth is tried, and in CI every one.
pub(crate) fn stride() -> usize {
    if cases() > CASES { 1 } else { 4 }
}
