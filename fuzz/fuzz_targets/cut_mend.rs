//! Any bytes are a mesh, cuts of it and menders: everything holds, and mending all gives one surface.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/cut_mend.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod cut_mend;
#[path = "../../tests/work.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod work;

fuzz_target!(|data: &[u8]| {
    cut_mend::Case::from_bytes(data).check();
});
