//! Any bytes are a script: run it in lock step with the oracle, and check every property.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tearmesh::script::Script;

#[path = "../../tests/lockstep/mod.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod lockstep;
#[path = "../../tests/oracle/mod.rs"]
#[allow(dead_code, unused_imports, reason = "shared with the tests")]
mod oracle;

fuzz_target!(|bytes: &[u8]| {
    lockstep::check(&Script::from_bytes(bytes));
});
