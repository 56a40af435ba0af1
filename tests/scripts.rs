//! Random scripts.

use tearmesh::script::Script;

use crate::cases::cases;
use crate::random::Random;

/// A random script for each case, the same on every machine.
pub(crate) fn scripts() -> impl Iterator<Item = Script> {
    (0..cases()).map(script)
}

/// The random script of this seed.
pub(crate) fn script(seed: u64) -> Script {
    let mut random = Random(seed);
    let length = 20 + random.below(400);
    Script::from_bytes(&random.bytes(length))
}
