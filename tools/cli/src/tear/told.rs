//! What tore when and where, and the forces at holds: for the report, in words, and as a table.

use std::io::{self, Write};

use tearmesh::Point;
use tearmesh_cloth::scene::{Run, TearEvent, TearLog};

use super::words::three_digits;
use crate::report;
use crate::say::short;

/// The line of the summary; none where nothing tore.
pub(super) fn first_tear(tear_log: &TearLog) -> Option<String> {
    let first = tear_log.first_tear()?;
    let [_, rest] = first.event.place.map(at).map(|at| at.map(three_digits));
    let forces = first.force_n.zip(tear_log.largest_force_n());
    let forces = forces.map_or(String::new(), |(then_n, most_n)| {
        format!(
            ", where a hold bears {} N; at most {} N",
            three_digits(then_n),
            three_digits(most_n)
        )
    });
    Some(format!(
        "first tear: after {} s at {} of the cloth at rest{forces}",
        short(first.event.time_s),
        rest.join(","),
    ))
}

/// The first tear, for the report.
pub(super) fn first(tear_log: &TearLog) -> Option<report::FirstTear> {
    tear_log.first_tear().map(|first| {
        let [place, place_at_rest] = first.event.place.map(at);
        report::FirstTear {
            time_s: first.event.time_s,
            place,
            place_at_rest,
            force_n: first.force_n,
        }
    })
}

/// All steps in which something tore.
pub(super) fn events(tear_log: &TearLog) -> Vec<report::TearEvent> {
    let told = |event: &TearEvent| {
        let [place, place_at_rest] = event.place.map(at);
        report::TearEvent {
            time_s: event.time_s,
            splits: event.splits,
            torn_m: event.torn_m,
            place,
            place_at_rest,
            load: event.load,
        }
    };
    tear_log.events().iter().map(told).collect()
}

/// The table of forces: a line a frame, three columns a hold of the scene, in its order.
pub(super) fn write_forces(run: &Run, tear_log: &TearLog, out: &mut dyn Write) -> io::Result<()> {
    write!(out, "end_s")?;
    for hold in 1..=run.scene().holds.len() {
        write!(out, ",hold_{hold}_x_n,hold_{hold}_y_n,hold_{hold}_z_n")?;
    }
    writeln!(out)?;
    for frame in tear_log.hold_forces() {
        write!(out, "{:.6}", frame.end_s)?;
        for force in &frame.forces_n {
            write!(out, ",{:.6e},{:.6e},{:.6e}", force.x, force.y, force.z)?;
        }
        writeln!(out)?;
    }
    Ok(())
}

fn at(p: Point) -> [f64; 3] {
    [p.x, p.y, p.z]
}
