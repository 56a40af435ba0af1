//! Arguments and an OBJ file: the command never panics, breaks no invariant, and what it says
//! agrees with its exit status.
//!
//! The command catches panics and writes a reproducer into the working folder. Here a panic ends
//! the process before that, in the hook, which first prints the input; and a command
//! built for fuzzing panics instead of writing a reproducer.
#![no_main]

use std::sync::Mutex;

use libfuzzer_sys::fuzz_target;

#[path = "../../tests/cli/in_process.rs"]
#[allow(dead_code, reason = "shared with the tests")]
mod in_process;

use in_process::Case;

/// What is being run.
static CASE: Mutex<Option<Case>> = Mutex::new(None);

fuzz_target!(
    init: {
        let abort = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            if let Ok(case) = CASE.try_lock() {
                eprintln!("{case:?}");
            }
            abort(panic);
        }));
    },
    |data: &[u8]| {
        let case = Case::from_bytes(data);
        *CASE.lock().expect("no panic is survived") = Some(case.clone());
        case.check();
    }
);
