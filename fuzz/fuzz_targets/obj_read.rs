//! Any bytes may be an OBJ file: what can be read and is a mesh can be written, and what was
//! written reads as the same triangles and writes as the same bytes.
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
    same_bytes::check_file(data, &[]);
});
