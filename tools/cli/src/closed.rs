//! Standard output that was closed when the program began.
//!
//! Before `main`, Rust's runtime puts `/dev/null` in the place of a stream that is closed, and what is printed there
//! is lost without an error. So on Linux the loader calls a function of ours before that. (Later it is too late: other
//! programs open `/dev/null` for those that they start in the same way as the runtime does.)

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

static IS_CLOSED: AtomicBool = AtomicBool::new(false);

#[cfg(target_os = "linux")]
#[expect(
    unsafe_code,
    reason = "no compiler checks what the loader finds in this section; there is no unsafe block"
)]
#[used]
#[unsafe(link_section = ".init_array")]
static LOOK: extern "C" fn() = look;

#[cfg(target_os = "linux")]
extern "C" fn look() {
    let is_there = |path| std::fs::symlink_metadata(path).is_ok();
    let is_closed = is_there("/proc/self/fd") && !is_there("/proc/self/fd/1");
    IS_CLOSED.store(is_closed, Ordering::Relaxed);
}

/// Whether standard output was closed, as far as that is known.
pub(crate) fn is_output() -> bool {
    IS_CLOSED.load(Ordering::Relaxed)
}

/// Takes nothing.
pub(crate) struct Closed;

impl Write for Closed {
    fn write(&mut self, _: &[u8]) -> io::Result<usize> {
        Err(io::Error::other("it is closed"))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
