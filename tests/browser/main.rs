//! Pages in a real browser: Chromium, without a window and without a network, driven as by a mouse.
//!
//! These tests are not run unless asked for: `cargo test -p tearmesh-cli --test browser -- --ignored`. A
//! browser that is not to be had is a failure, unless `TEARMESH_SKIP` names `chromium`.

#![expect(clippy::print_stdout, reason = "tests say how much they did")]

mod border;
mod chrome;
mod clicks;
#[path = "../support/digest.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod digest;
mod eye;
#[path = "../cli/harness.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod harness;
#[path = "../cli/in_process.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod in_process;
mod play;
mod playing;
#[path = "../support/random.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod random;
#[path = "../cli/read_back.rs"]
#[allow(dead_code, reason = "shared with other tests")]
mod read_back;
mod screen;
#[path = "../support/vectors.rs"]
mod vectors;
