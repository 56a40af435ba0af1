//! How many random cases a test tries, and random scripts.

use tearmesh::script::Script;

use crate::random::Random;

/// The number of cases that `TEARMESH_CASES` gives, or else `usual`.
pub(crate) fn cases(usual: u64) -> u64 {
    std::env::var("TEARMESH_CASES").map_or(usual, |cases| {
        cases.parse().expect("TEARMESH_CASES is a number")
    })
}

/// The number of cases that `TEARMESH_CASES` gives, but at most `all`, which is also the default.
pub(crate) fn cases_of(all: u64) -> u64 {
    cases(all).min(all)
}

/// `usual` random scripts, or as many as `TEARMESH_CASES` gives. They are the same on every
/// machine.
pub(crate) fn scripts(usual: u64) -> impl Iterator<Item = Script> {
    (0..cases(usual)).map(script)
}

/// The random script of this seed.
pub(crate) fn script(seed: u64) -> Script {
    let mut random = Random(seed);
    let length = 20 + random.below(400);
    Script::from_bytes(&random.bytes(length))
}
