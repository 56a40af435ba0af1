//! What obj-rs reads without loss, we read the same.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/obj/differential.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod differential;

fuzz_target!(|data: &[u8]| {
    differential::check(data);
});
