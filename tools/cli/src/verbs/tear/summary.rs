//! The summary of a simulation: what tore, where the energy went, and at what cost.

use std::io::{self, Write};

use tearmesh::Point;
use tearmesh_cloth::scene::{Run, TearLog};
use tearmesh_cloth::{Body, Collider, ColliderShape, EnergyBalance, Pose};

use crate::report;
use crate::say::{count, pieces, short, three_digits};

/// The line of the summary.
pub(super) fn simulation(tear: &report::Tear, has_cuts: bool) -> String {
    let came_apart = if has_cuts { "torn or cut" } else { "torn" };
    let cap = match tear.steps_at_cap {
        0 => String::new(),
        steps => format!(" (cap hit in {})", count(steps as usize, "step", "steps")),
    };
    let ended = match tear.status {
        "done" => String::new(),
        status => format!(", {status} before {} s", short(tear.time_planned_s)),
    };
    format!(
        "tear: {} s in {} ({}){ended}, {} split{cap}, {} m {came_apart} (at rest), {} -> {}, stretched up to {}",
        short(tear.time_simulated_s),
        count(tear.steps as usize, "step", "steps"),
        tear.solver,
        count(tear.splits as usize, "vertex", "vertices"),
        short(tear.tear_length_m),
        pieces(tear.pieces_before, tear.crumbs_before),
        pieces(tear.pieces, tear.crumbs),
        short(tear.max_stretch),
    )
}

/// The line of the summary that says where the energy went. What neither loads nor hands took is the
/// method's.
pub(super) fn balance(run: &Run) -> String {
    let balance = run.energy_balance();
    let stored = three_digits(balance.kinetic_j + balance.elastic_j);
    if run.quality().has_limited() {
        return format!(
            "energy: {stored} J stored; what was put in and lost is not known, because the limiter's work grows without bound as steps get shorter"
        );
    }
    let made_j = balance.made_j();
    let made = match made_j > 0.0 {
        true => format!("{} J made by the method", three_digits(made_j)),
        false => format!("{} J of numerical dissipation", three_digits(-made_j)),
    };
    let put_in = three_digits(balance.put_in_j());
    let lost = lost(&balance);
    format!("energy: {put_in} J put in, {stored} J stored, {lost}, {made}")
}

/// What was taken out of a cloth, by what took it.
fn lost(balance: &EnergyBalance) -> String {
    let takers = [
        ("damping", balance.damping_j),
        ("gravity", balance.gravity_j),
        ("hands", balance.held_j),
        ("wind", balance.wind_j),
        ("colliders", balance.colliders_j),
        ("edits", balance.edits_j),
    ];
    let drag = format!("{} J lost to drag", three_digits(-balance.drag_j));
    let took = takers.map(|(taker, work_j)| (taker, three_digits((-work_j).max(0.0))));
    let shown = took
        .into_iter()
        .filter(|(taker, joules)| *taker == "damping" || joules != "0");
    shown.fold(drag, |all, (taker, joules)| {
        format!("{all}, {joules} J to {taker}")
    })
}

pub(super) fn energy(run: &Run) -> report::Energy {
    let balance = run.energy_balance();
    let said = |joules: f64| Some(joules).filter(|_| !run.quality().has_limited());
    report::Energy {
        torn_edges: run.tally().edge_energy_j,
        began: balance.began_j,
        kinetic: balance.kinetic_j,
        elastic: balance.elastic_j,
        gravity: balance.gravity_j,
        held: said(balance.held_j),
        wind: balance.wind_j,
        drag: balance.drag_j,
        damping: balance.damping_j,
        colliders: balance.colliders_j,
        edits: balance.edits_j,
        numerical_dissipation: said(-balance.made_j()),
    }
}

/// What became of the seams.
pub(super) fn pairs(run: &Run) -> report::Seams {
    let pairs = run.pairs();
    report::Seams {
        pairs: pairs.opened,
        sewn: pairs.sewn,
        left: pairs.left,
        unpicked: pairs.unpicked,
        open: pairs.open,
    }
}

/// The line of the summary about the seams.
pub(super) fn seams(seams: &report::Seams) -> String {
    let open = match seams.open {
        0 => String::new(),
        open => format!(", {open} still open"),
    };
    format!(
        "seams: {} of {} sewn, {} left, {} unpicked{open}",
        seams.sewn,
        count(seams.pairs, "pair", "pairs"),
        seams.left,
        seams.unpicked
    )
}

/// How closely each body of the scene is met.
pub(super) fn bodies(run: &Run) -> Vec<report::BodyGrid> {
    let grid = |collider: &Collider| match &collider.shape {
        ColliderShape::Body {
            body, thickness_m, ..
        } => {
            let pose = collider.pose(run.elapsed_s());
            let [nearest_vertex_m, nearest_middle_m] = clearances_m(run, body, &pose);
            Some(report::BodyGrid {
                thickness_m: *thickness_m,
                cell_m: body.cell_m(),
                error_rms_m: body.error_rms_m(),
                error_worst_m: body.error_worst_m(),
                nearest_vertex_m,
                nearest_middle_m,
            })
        }
        _ => None,
    };
    run.scene().colliders.iter().filter_map(grid).collect()
}

/// How far the nearest vertex, and the nearest middle of an edge, are from a body. Between its ends, which are kept
/// away, an edge is a chord of what it lies on.
fn clearances_m(run: &Run, body: &Body, pose: &Pose) -> [f64; 2] {
    let (mesh, positions) = (run.mesh(), run.cloth().positions());
    let distance_m = |x: Point| body.distance_m(pose.to_body(x));
    let vertices = positions.iter().map(|&x| distance_m(x));
    let edges = mesh.edges();
    let middles = edges.map(|h| {
        let [from, to] = [mesh.origin(h), mesh.target(h)].map(|end| positions[end.index()]);
        distance_m(from + (to - from) / 2.0)
    });
    [
        vertices.fold(f64::INFINITY, f64::min),
        middles.fold(f64::INFINITY, f64::min),
    ]
}

/// The line of the summary about a body.
pub(super) fn body(body: &report::BodyGrid) -> String {
    let [thickness, middle, cell, rms, worst] = [
        body.thickness_m,
        body.nearest_middle_m.abs(),
        body.cell_m,
        body.error_rms_m,
        body.error_worst_m,
    ]
    .map(three_digits);
    let ended = match body.nearest_middle_m < 0.0 {
        true => format!("middles of edges ended up to {middle} m inside"),
        false => format!("middles of edges ended at least {middle} m away"),
    };
    format!(
        "body: vertices stay {thickness} m away, {ended}; a grid with cells of {cell} m, off by {rms} m (rms) and at most {worst} m"
    )
}

/// The line of the summary about the ripple of a flat cloth; none of one that was given its shape.
pub(super) fn ripple(run: &Run) -> Option<String> {
    let ripple_m = Some(run.ripple_m()).filter(|ripple_m| *ripple_m > 0.0)?;
    let up_to = three_digits(ripple_m);
    let words = "so that it can buckle (ripple_m = 0 in a scene file: not)";
    Some(format!(
        "ripple: the flat cloth began up to {up_to} m out of its plane, {words}"
    ))
}

/// The features that a scene uses, and which part of the work each is.
pub(super) fn features(run: &Run) -> Vec<report::FeatureCost> {
    let (system, scene) = (run.cloth().system(), run.scene());
    let counters = system.counters();
    let cost = counters.features;
    let features = [
        ("springs", true, cost.stretch),
        ("bending", !system.bends().is_empty(), cost.bend),
        ("triangles", cost.triangle > 0, cost.triangle),
        ("wind", scene.wind.is_some(), cost.wind),
        ("colliders", !scene.colliders.is_empty(), cost.collider),
        ("tearing", scene.tearing.is_some(), counters.visits.detect),
    ];
    let all: u64 = features.iter().map(|&(_, _, visits)| visits).sum();
    let used = features.into_iter().filter(|&(_, is_used, _)| is_used);
    let costs = used.map(|(name, _, visits)| report::FeatureCost {
        name,
        visits,
        share: visits as f64 / all.max(1) as f64,
    });
    costs.collect()
}

/// The line of `--verbose` that says what the work was for.
pub(super) fn cost(features: &[report::FeatureCost]) -> String {
    let share = |one: &report::FeatureCost| format!("{} {:.0} %", one.name, 100.0 * one.share);
    let shares = features.iter().map(share);
    let visits: u64 = features.iter().map(|feature| feature.visits).sum();
    let visits = match visits {
        0..1_000_000 => visits.to_string(),
        _ => format!("{:.1} million", visits as f64 / 1e6),
    };
    let shares = shares.collect::<Vec<_>>().join(", ");
    format!("cost: {visits} element visits: {shares}")
}

/// The line of the summary; none where nothing tore.
pub(super) fn first_tear(tear_log: &TearLog) -> Option<String> {
    let first = tear_log.events().first()?;
    let rest: [f64; 3] = first.place_at_rest.into();
    let forces = [
        tear_log.first_force_n(),
        tear_log.largest_force_n(),
        tear_log.peak_force_n(),
    ];
    let forces = match forces.map(|force| force.map(three_digits)) {
        [Some(then), Some(most), Some(peak)] => {
            format!(
                ", where a hold bears {then} N; at most {most} N, and {peak} N in a single step"
            )
        }
        _ => String::new(),
    };
    let (time, place) = (short(first.time_s), rest.map(three_digits).join(","));
    let words = format!("first tear: after {time} s at {place} of the cloth at rest{forces}");
    Some(words)
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
