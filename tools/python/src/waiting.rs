//! Work that takes long: other threads run, and Ctrl-C is heard.

use std::sync::mpsc;
use std::thread;
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// How often a signal is looked for.
const HEARS_EVERY: Duration = Duration::from_millis(50);

/// Does work in a thread of its own, and gives what comes of it; an exception if a signal comes first. The work then
/// goes on to its end, and is dropped.
pub(crate) fn heard<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = mpsc::channel();
    thread::spawn(move || sender.send(work()));
    // A short piece of work is not worth a change of threads of Python.
    if let Ok(done) = receiver.recv_timeout(Duration::from_micros(200)) {
        return Ok(done);
    }
    loop {
        let received;
        (received, receiver) = py.detach(|| (receiver.recv_timeout(HEARS_EVERY), receiver));
        match received {
            Ok(done) => return Ok(done),
            Err(mpsc::RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(mpsc::RecvTimeoutError::Disconnected) => panic!("the work panicked"),
        }
    }
}

/// A listener for signals while work is done step by step.
pub(crate) struct Listener {
    last: Instant,
    /// The exception of a signal.
    pub(crate) raised: Option<PyErr>,
}

impl Listener {
    pub(crate) fn new() -> Listener {
        Listener {
            last: Instant::now(),
            raised: None,
        }
    }

    /// Whether no signal came. Python is asked now and then.
    pub(crate) fn goes_on(&mut self) -> bool {
        if self.last.elapsed() >= HEARS_EVERY {
            self.raised = Python::attach(|py| py.check_signals()).err();
            self.last = Instant::now();
        }
        self.raised.is_none()
    }
}
