//! Any bytes are two rays and a mesh: the scissor is refused, or is what it should be and cuts.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/rays.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod rays;
#[path = "../../tests/work.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod work;

fuzz_target!(|data: &[u8]| {
    rays::Case::from_bytes(data).check();
});
