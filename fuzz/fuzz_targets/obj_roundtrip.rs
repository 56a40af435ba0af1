//! An OBJ file, and behind a zero byte what is split in it: write, read, write gives the same
//! bytes, and every number is what it was.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/support/random.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod random;
#[path = "../../tests/obj/same_bytes.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod same_bytes;
#[path = "../../tests/obj/work.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod work;

fuzz_target!(|data: &[u8]| {
    same_bytes::check(data);
});
