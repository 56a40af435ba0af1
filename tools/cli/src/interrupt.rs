//! Ctrl-C during a simulation: it ends after the present step or frame, and its results are kept.

use std::sync::atomic::{AtomicU8, Ordering};

/// What an interruption would meet.
static STATE: AtomicU8 = AtomicU8::new(IDLE);

const IDLE: u8 = 0;
const RUNNING: u8 = 1;
const ENDING: u8 = 2;

/// Asks the current run to stop, save its results, and end. Returns false if no run can do so, or if the
/// run was already asked. The program should then [abandon its output](crate::abandon_output) and exit.
#[must_use]
pub fn interrupt() -> bool {
    let swap = STATE.compare_exchange(RUNNING, ENDING, Ordering::SeqCst, Ordering::SeqCst);
    swap.is_ok()
}

/// While this lives, an interruption is for whoever asks [`Guard::is_interrupted`].
pub(crate) struct Guard(());

impl Guard {
    pub(crate) fn new() -> Guard {
        STATE.store(RUNNING, Ordering::SeqCst);
        Guard(())
    }

    pub(crate) fn is_interrupted(&self) -> bool {
        STATE.load(Ordering::SeqCst) == ENDING
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        STATE.store(IDLE, Ordering::SeqCst);
    }
}
