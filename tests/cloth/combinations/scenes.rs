//! The scene of a case, run: with an energy balance, beside a simulation by the same verbs, at rest,
//! and by what it costs.

use std::collections::BTreeMap;

use tearmesh::nalgebra::Rotation3;
use tearmesh::{Edit, Scissor, Vector, VertexId};
use tearmesh_cloth::scene::{Frame, Run, Scene};
use tearmesh_cloth::{Simulation, SimulationDef, Unstable, Wind, Wounds};

use super::factors::Case;
use super::formulas::air;
use super::judge::{Fault, Judge, fault};
use super::script::{definition, words, words_of};
use super::shapes::Shape;
use super::text::{COEFFICIENT, CUT, FRAMES, HEALED, Text, at_s};
use super::wind;
use crate::parts::scenes::energy_warning;

/// How a run ended: nothing, or why it was refused; and how often it was judged.
#[derive(Debug, Default)]
pub(super) struct Ended {
    pub(super) refused: Option<String>,
    pub(super) soft: Vec<Fault>,
    pub(super) followed: usize,
    pub(super) balanced: usize,
    pub(super) touched: usize,
    pub(super) led: usize,
    pub(super) pushed: usize,
}

/// The frames from one comparison of what the wind does to the next.
const BLOWN_EVERY: u64 = 3;

/// Runs the scene of a case to its end, and judges every step.
pub(super) fn run(case: &Case, shape: &Shape) -> Result<Ended, Fault> {
    let (scene, frame) = read(case, shape)?;
    let run = Run::new(shape.mesh.clone(), &shape.positions, scene, &frame);
    let mut run = run.map_err(|error| fault("refused", format!("no run: {error}")))?;
    let mut judge = Judge::new(case, run.mesh(), run.cloth());
    let (steps, step_s) = ((at_s(1) / run.step_s()).round() as u64, run.step_s());
    let is_sewn = case.is("seams", "sewn");
    let mut ended = Ended::default();
    let mut taken = BTreeMap::new();
    while !run.is_over() {
        if let Err(error) = run.step() {
            if !error.code().starts_with("E-") {
                return Err(fault("finite", format!("{error} has no code")));
            }
            ended.refused = Some(error.to_string());
            break;
        }
        judge.step(run.mesh(), run.cloth(), step_s);
        if run.tally().steps.is_multiple_of(steps) {
            judge.frame(run.mesh(), run.cloth(), is_sewn)?;
            crate::follow::check(run.mesh(), run.cloth(), false);
            if run.tally().steps.is_multiple_of(BLOWN_EVERY * steps) {
                // The wind of a step is that of its beginning.
                let time_s = run.elapsed_s() - step_s;
                let method = &run.scene().solver;
                ended.pushed += wind::pushes(case, run.cloth(), method, time_s)?;
            }
            let limited = run.quality().has_limited();
            if !limited {
                judge.energy(
                    run.cloth(),
                    (&run.energy_balance(), run.ripple_m()),
                    energy_warning(&run).is_some(),
                )?;
            }
        }
        if run
            .edits()
            .iter()
            .any(|edit| matches!(edit, Edit::Merge(_)))
        {
            // Others have their numbers now.
            taken.clear();
        }
        ended.led += led(&run, &mut taken)?;
    }
    ended.soft = judge.soft;
    (ended.followed, ended.balanced, ended.touched) =
        (judge.followed, judge.balanced, judge.touched);
    Ok(ended)
}

/// What a hold holds is where its way says, from where it was taken. (The vertices that a cut inserts lie between.)
fn led(run: &Run, taken: &mut BTreeMap<(usize, VertexId), Vector>) -> Result<usize, Fault> {
    let (system, now_s) = (run.cloth().system(), run.elapsed_s());
    let mut looked = 0;
    for (number, hold) in run.scene().holds.iter().enumerate() {
        let is_last = |v: &VertexId| {
            !(number + 1..run.scene().holds.len()).any(|other| run.held(other).contains(v))
        };
        for &v in run.held(number).iter().filter(|v| is_last(v)) {
            let at = system.positions()[v.index()].coords;
            let turn = Rotation3::from_scaled_axis(offset(&hold.turns, now_s));
            let middle = hold.about.coords + offset(&hold.moves, now_s);
            let turned = taken.entry((number, v));
            let began = *turned.or_insert_with(|| turn.inverse() * (at - middle));
            let off = (at - middle - turn * began).norm();
            if off > 1e-9 || !system.is_held(v.index()) {
                let text = format!("after {now_s} s {v} of hold {number} is {off} m from its way");
                return Err(fault("holds", text));
            }
            looked += 1;
        }
    }
    Ok(looked)
}

/// The offset of a hold at a time: linear between its rows, still before and after them.
fn offset(moves: &[(f64, Vector)], time_s: f64) -> Vector {
    let mut last = None;
    for &(at_s, by) in moves {
        match last {
            Some((before_s, before)) if time_s < at_s => {
                return before + (by - before) * ((time_s - before_s) / (at_s - before_s));
            }
            None if time_s < at_s => return by,
            _ => last = Some((at_s, by)),
        }
    }
    last.map_or_else(Vector::zeros, |(_, by)| by)
}

pub(super) fn read(case: &Case, shape: &Shape) -> Result<(Scene, Frame), Fault> {
    let read = Text::of(case, shape).scene(shape);
    read.map_err(|error| fault("refused", error))
}

/// The part of a case that scenes and verbs have in common; none where there is no such part.
pub(super) fn common(case: &Case) -> Option<Case> {
    let both = case.without("hand").without("heal");
    let both = if case.is("cut", "snap0") {
        both.with("cut", "default")
    } else {
        both
    };
    let both = if case.is("cut", "partition") {
        both.without("cut")
    } else {
        both
    };
    case.is("hold", "none still released").then_some(both)
}

/// The scene of a case by a run and by the verbs of a simulation: the same bits after every frame, or both fail.
pub(super) fn run_is_simulation(case: &Case, shape: &Shape) -> Result<(), Fault> {
    let (scene, frame) = read(case, shape)?;
    let run = Run::new(shape.mesh.clone(), &shape.positions, scene.clone(), &frame);
    let mut run = run.map_err(|error| fault("refused", format!("no run: {error}")))?;
    let def = SimulationDef {
        when_unstable: match case.get("step") {
            "default" => Unstable::Substep,
            _ => Unstable::Refuse,
        },
        ..definition(&scene, &frame, shape)
    };
    let sim = Simulation::new(shape.mesh.clone(), &shape.positions, def);
    let mut sim = sim.map_err(|error| fault("refused", format!("no simulation: {error}")))?;
    let step_s = run.step_s();
    let due = |time_s: f64, step: u64| (time_s / step_s).round() as u64 == step;
    let hold = scene.holds.first();
    let (mesh, points) = (&shape.mesh, shape.positions.as_slice());
    let held = hold.map_or_else(Vec::new, |hold| hold.region.vertices(mesh, points, &frame));
    while !run.is_over() {
        let step = run.tally().steps;
        let refused = |error| {
            fault(
                "twins",
                format!("a verb is refused at step {step}: {error}"),
            )
        };
        if step == 0 {
            sim.hold(held.iter().copied()).map_err(refused)?;
        }
        if hold
            .and_then(|hold| hold.until_s)
            .is_some_and(|until_s| due(until_s, step))
        {
            // Sewing gave some of them other numbers.
            let is_held = |v: &VertexId| sim.cloth().system().is_held(v.index());
            let held: Vec<VertexId> = sim.mesh().vertices().filter(is_held).collect();
            sim.free(held).map_err(refused)?;
        }
        for (_, name) in scene.unpicks.iter().filter(|(at_s, _)| due(*at_s, step)) {
            sim.unpick(name).map_err(refused)?;
        }
        for cut in scene.cuts.iter().filter(|cut| due(cut.at_s, step)) {
            let scissor = Scissor::new(cut.rays[0], cut.rays[1]).expect("a plane");
            sim.cut(&scissor.with_through(cut.through))
                .map_err(refused)?;
        }
        if case.is("wind", "swaying later") {
            let velocity = air(case, step as f64 * step_s);
            let wind = velocity.map(|velocity_m_per_s| Wind {
                velocity_m_per_s,
                coefficient: COEFFICIENT,
            });
            sim.set_wind(wind).map_err(refused)?;
        }
        let (one, other) = (run.step(), sim.advance(step_s, 1));
        if one.is_err() != other.is_err() {
            let text = format!("at step {step} the run says {one:?}, and the simulation {other:?}");
            return Err(fault("twins", text));
        }
        let system = run.cloth().system();
        let of_run = words(run.mesh(), system.positions(), system.velocities());
        if step.is_multiple_of(8) && of_run != words_of(&sim) {
            return Err(fault(
                "twins",
                format!("the cloths differ after step {step}"),
            ));
        }
        if one.is_err() {
            break;
        }
    }
    Ok(())
}

/// The case without anything that moves cloth.
fn at_rest(case: &Case) -> Case {
    let still = case
        .without("hand")
        .without("wind")
        .without("unpick")
        .without("seams");
    let still = still.with("gravity", "none").with("hold", "still");
    let still = still.with("ripple", "none");
    match case.get("collider") {
        "moving" => still.with("collider", "body"),
        _ => still,
    }
}

/// A cloth at rest is still there after it is held, cut and healed.
pub(super) fn nothing_at_rest_moves(case: &Case, shape: &Shape) -> Result<(), Fault> {
    let case = &at_rest(case);
    let (scene, frame) = read(case, shape)?;
    let def = definition(&scene, &frame, shape);
    let sim = Simulation::new(shape.mesh.clone(), &shape.positions, def);
    let mut sim = sim.map_err(|error| fault("refused", format!("no simulation: {error}")))?;
    let held = scene.holds[0]
        .region
        .vertices(&shape.mesh, shape.positions.as_slice(), &frame);
    sim.hold(held)
        .map_err(|error| fault("refused", error.to_string()))?;
    let mut cut = None;
    for number in 0..HEALED + 3 {
        if number == CUT && !case.is("cut", "none") {
            let [a, b] = shape.slit.map(|[x, y]| crate::parts::ray(x, y));
            let scissor = Scissor::new(a, b).expect("a plane");
            let scissor = scissor.with_through(case.is("cut", "through"));
            let snapped = if case.is("cut", "snap0") {
                scissor.with_snap(0.0)
            } else {
                scissor
            };
            cut = sim.cut(&snapped).ok();
        }
        if number == HEALED && !case.is("heal", "none") {
            let wounds = if case.is("heal", "cut") {
                cut.map(Wounds::Cut)
            } else {
                Some(Wounds::All)
            };
            let wounds = wounds.ok_or_else(|| fault("rest", "there is no cut"))?;
            sim.heal(wounds)
                .map_err(|error| fault("rest", error.to_string()))?;
        }
        let taken = sim.advance(at_s(1), u64::MAX);
        taken.map_err(|error| fault("rest", format!("in frame {number}: {error}")))?;
    }
    let (mesh, cloth) = (sim.mesh(), sim.cloth());
    let corners = mesh
        .half_edges()
        .map(|h| (mesh.origin(h).index(), cloth.rest_corners()[h.index()]));
    let off = corners
        .map(|(v, rest)| (cloth.positions()[v] - rest).norm())
        .fold(0.0, f64::max);
    let speeds = cloth.system().velocities().iter().map(|v| v.norm());
    let speed = speeds.fold(0.0, f64::max);
    if off > 1e-9 || speed > 1e-7 {
        return Err(fault(
            "rest",
            format!("a corner is {off} m off, and a vertex goes at {speed} m/s"),
        ));
    }
    Ok(())
}

/// The factors that a step's cost is a product of, over the plain case with the same method, mesh and step.
const COSTLY: &[&str] = &[
    "fabric",
    "bending",
    "damping",
    "gravity",
    "drag",
    "threshold",
    "strength",
    "collider",
    "friction",
    "wind",
    "hold",
    "seams",
    "unpick",
    "cut",
];

/// The costs that were measured, by case; none of one that fails.
pub(super) type Costs = BTreeMap<Case, Option<f64>>;

/// A step costs at most twice the product of what each option costs alone. What is counted is visits of elements,
/// which are the same on every machine. Gives how many options there were.
pub(super) fn costs_multiply(case: &Case, costs: &mut Costs) -> Result<usize, Fault> {
    let case = &case.without("hand").without("heal");
    let used: Vec<&str> = COSTLY
        .iter()
        .copied()
        .filter(|name| case.get(name) != Case::plain().get(name))
        .collect();
    let plain = used
        .iter()
        .fold(case.clone(), |case, name| case.without(name));
    let Some(all) = cost(case, costs) else {
        return Ok(0);
    };
    let Some(base) = cost(&plain, costs) else {
        return Ok(0);
    };
    let mut product = base;
    let mut parts = String::new();
    for name in &used {
        // What does not go alone goes with what it needs.
        let mut alone = plain.with(name, case.get(name));
        for needed in [
            ("seams", "sewn"),
            ("collider", case.get("collider")),
            ("threshold", case.get("threshold")),
        ] {
            if !alone.is_allowed() {
                alone = alone.with(needed.0, needed.1);
            }
        }
        let Some(one) = cost(&alone, costs) else {
            return Ok(0);
        };
        product *= (one / base).max(1.0);
        parts += &format!(" {name} × {:.2}", one / base);
    }
    if all > 2.0 * product {
        let text =
            format!("{all} visits a second, where {base} plain ones and{parts} are {product:.0}");
        return Err(fault("cost", text));
    }
    Ok(used.len())
}

/// The visits of elements in a second of cloth, over the first half of a sequence. By Provot's method they are those
/// of a substep: a cut leaves slivers, and how thin they are depends on how the cloth hangs.
fn cost(case: &Case, costs: &mut Costs) -> Option<f64> {
    if let Some(cost) = costs.get(case) {
        return *cost;
    }
    let measured = measure(case);
    costs.insert(case.clone(), measured);
    measured
}

fn measure(case: &Case) -> Option<f64> {
    let shape = Shape::of(case.get("mesh"));
    let (scene, frame) = read(case, &shape).ok()?;
    let mut run = Run::new(shape.mesh.clone(), &shape.positions, scene, &frame).ok()?;
    while run.elapsed_s() < at_s(FRAMES / 2) {
        run.step().ok()?;
    }
    let counters = run.cloth().system().counters();
    let visits = counters.visits;
    // How often a limiter passes over edges depends on how far they are stretched.
    let projected = if case.is("method", "provot") {
        0
    } else {
        visits.project
    };
    let constraints = projected + visits.force + visits.detect;
    let others = counters.features.wind + counters.features.collider;
    let whole = match case.is("method", "provot") {
        true => counters.substeps as f64,
        false => run.elapsed_s(),
    };
    Some((constraints + others) as f64 / whole)
}
