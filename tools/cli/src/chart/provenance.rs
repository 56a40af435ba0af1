//! What charts say of where they come from.

use tearmesh_lab::Provenance;

/// That of a chart by such a command; with the processor where it took times.
pub(super) fn of(command: String, is_timed: bool) -> Provenance {
    Provenance {
        command,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("TEARMESH_COMMIT").to_owned(),
        compiler: env!("TEARMESH_COMPILER").to_owned(),
        processor: is_timed.then(processor),
    }
}

/// What the processor calls itself, where the system says so, or else its architecture.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let mut lines = text.lines().filter(|line| line.starts_with("model name"));
    let named = lines.next().and_then(|line| line.split_once(':'));
    named.map_or(std::env::consts::ARCH.to_owned(), |(_, name)| {
        name.trim().to_owned()
    })
}
