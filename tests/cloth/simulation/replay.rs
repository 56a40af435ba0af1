//! A log of inputs, written, read and replayed, gives the same bytes; and whatever the inputs are,
//! what holds of a simulation holds.

use std::collections::BTreeSet;

use proptest::prelude::*;
use proptest::test_runner::Config;

use tearmesh::geometry::length;
use tearmesh::{Edit, Mix, Plane, Point, Scissor, Vector, VertexId, shapes};
use tearmesh_cloth::{
    CutId, Event, Fabric, HandId, InputLog, Method, ReplayError, Simulation, SimulationDef,
    Tearing, Threshold, Unstable, Wounds,
};

use super::{ALL, across, at, check, drag, hung, pass, sheet};
use crate::digest;
use crate::parts::scenes::methods;
use crate::parts::{ray, v};

/// Everything that a simulation computed, as words.
fn words(sim: &Simulation) -> Vec<u64> {
    let system = sim.cloth().system();
    let points = system.positions().iter().flat_map(|x| [x.x, x.y, x.z]);
    let velocities = system.velocities().iter().flat_map(|v| [v.x, v.y, v.z]);
    let numbers = points.chain(velocities).chain([sim.time_s()]);
    let indices = sim.mesh().indices().iter().map(|&index| u64::from(index));
    numbers.map(f64::to_bits).chain(indices).collect()
}

/// Writes, reads and replays the log of a simulation of a sheet, and compares.
fn replays(sim: &Simulation, n: u32, def: &SimulationDef) {
    let log = sim.log().expect("it is recorded");
    let read: InputLog = log.to_string().parse().expect("what was written");
    assert_eq!(&read, log);
    let (mesh, positions) = shapes::grid(n, n);
    let again = Simulation::replayed(mesh, &positions, def.clone(), &read, |_, _| {});
    let again = again.expect("replayed");
    assert!(words(&again) == words(sim), "the same bytes");
    assert_eq!(again.log(), Some(log));
    assert_eq!(again.open_pairs(), sim.open_pairs());
}

/// A sheet is held, torn by a hand, cut and healed.
fn played(n: u32, def: &SimulationDef) -> Simulation {
    let mut sim = hung(n, def.clone());
    pass(&mut sim, 0.1);
    let middle = sim.pick(&ray(0.5, 0.5)).expect("on the cloth").vertex;
    let hand = sim.grab(middle, Simulation::GRIP_RADIUS_M).expect("a hand");
    drag(&mut sim, hand, 30, |s| {
        Point::new(0.5, 0.5 - 2.0 * s, 2.0 * s)
    });
    let cut = sim.cut(&across(0.7)).expect("cut");
    pass(&mut sim, 0.05);
    sim.release(hand).expect("a hand");
    sim.heal(Wounds::Cut(cut)).expect("a cut");
    pass(&mut sim, 0.1);
    sim.heal(Wounds::All).expect("wounds");
    sim.free([v((n as usize + 2) * n as usize)]).expect("held");
    pass(&mut sim, 0.1);
    sim
}

#[test]
fn a_replay_gives_the_same_bytes_by_every_method() {
    for (_, method) in methods() {
        let def = SimulationDef {
            method,
            fabric: Fabric::new(200.0),
            is_recorded: true,
            ..SimulationDef::default()
        };
        let mut sim = played(10, &def);
        let tore = |event: Event| matches!(event, Event::Tore { .. });
        assert!(sim.events().filter(|&event| tore(event)).count() > 3);
        check(&mut sim);
        replays(&sim, 10, &def);
    }
}

/// The digits of a run that tears say nothing to anybody: a hash of them does, that they are the same
/// on every machine, and after every change that is to change nothing.
#[test]
fn a_run_of_verbs_has_the_bytes_that_it_had() {
    let def = SimulationDef {
        method: Method::xpbd(),
        step_s: Some(1.0 / 1200.0),
        is_recorded: true,
        ..SimulationDef::default()
    };
    let sim = played(12, &def);
    let bytes = words(&sim).into_iter().flat_map(u64::to_le_bytes);
    let digest = digest::after(digest::EMPTY, bytes);
    assert_eq!(format!("{digest:016x}"), "d7259a0ec5d2201a");
}

#[test]
fn steps_that_failed_are_replayed_as_well() {
    let def = SimulationDef {
        step_s: Some(1.0 / 60.0),
        when_unstable: Unstable::Refuse,
        method: Method::provot(),
        is_recorded: true,
        ..SimulationDef::default()
    };
    let mut sim = sheet(4, def.clone());
    sim.advance(0.1, ALL).expect_err("too long a step");
    sim.hold([v(3)]).expect("held");
    sim.advance(0.1, ALL).expect_err("too long a step");
    let log = sim.log().expect("recorded").to_string();
    assert!(log.ends_with("\n0 failed\n0 hold 3\n0 failed\n0 end\n"));
    replays(&sim, 4, &def);
}

#[test]
fn a_log_of_something_else_is_refused() {
    let def = SimulationDef {
        is_recorded: true,
        ..SimulationDef::default()
    };
    let mut sim = sheet(4, def.clone());
    sim.hold([v(3)]).expect("held");
    let log = sim.log().expect("recorded").clone();
    let replayed = |n: u32, def: &SimulationDef, log: &InputLog| {
        let (mesh, positions) = shapes::grid(n, n);
        Simulation::replayed(mesh, &positions, def.clone(), log, |_, _| {}).map(drop)
    };
    assert_eq!(replayed(4, &def, &log), Ok(()));
    let harder = SimulationDef {
        fabric: Fabric::new(1001.0),
        ..def.clone()
    };
    assert_eq!(replayed(5, &def, &log), Err(ReplayError::Digest));
    assert_eq!(replayed(4, &harder, &log), Err(ReplayError::Digest));
    let text = log.to_string();
    let taken = ["0 hold 3", "0 free 4", "0 heal"];
    let refused = "0 hold 19, 0 hold ffffffffffffffff, 0 free 19, 0 grab 3, 0 lead 0 0 0 0, 0 cut 1 2 3, \
                   0 heal 0, 0 heal 0 0, 0 failed";
    for line in taken.into_iter().chain(refused.split(", ")) {
        let log = text.replace("0 hold 3", line).parse().expect("a log");
        let named = match replayed(4, &def, &log) {
            Ok(()) => false,
            Err(ReplayError::Input(0, _) | ReplayError::Step(None)) => true,
            Err(error) => panic!("{line}: {error}"),
        };
        assert_eq!(named, !taken.contains(&line), "{line}");
    }
}

/// Rows of the table beside this file: what stands in the log, what stands there instead, and where what is expected.
#[test]
fn a_text_that_is_no_log_is_refused_by_line_and_column() {
    let good = "tearmesh inputs 1 digest 00ff\n3 hold 1 a\n3 end\n";
    assert!(good.parse::<InputLog>().is_ok());
    for row in include_str!("logs.txt").lines() {
        let plain = row.replace("{ALL}", good).replace("\\n", "\n");
        let [edit, place, expected] = plain.split(" | ").collect::<Vec<_>>()[..] else {
            panic!("{row}");
        };
        let (from, to) = edit.split_once(" -> ").expect("two texts");
        let text = good.replace(from, to);
        let error = text.parse::<InputLog>().expect_err(&text);
        let found = format!("{}:{}", error.line, error.column);
        assert_eq!((&*found, error.expected.trim_end()), (place, expected));
    }
}

/// A verb, to whom it is done, and three numbers from 0 to 1.
type Verb = (u8, u32, [f64; 3]);

fn verbs() -> impl Strategy<Value = Vec<Verb>> {
    let numbers = [0.0..1.0, 0.0..1.0, 0.0..1.0];
    prop::collection::vec((0_u8..12, 0_u32..40, numbers), 1..24)
}

/// The holds of a script as this test sees them: by the calls that were accepted, and by the log of edits.
#[derive(Default)]
struct Holds {
    /// Of each call, the vertices that it still holds.
    held: Vec<BTreeSet<VertexId>>,
    /// Of each call, those that were inserted between others of it by a cut that is not healed.
    inserted: Vec<BTreeSet<VertexId>>,
}

impl Holds {
    fn hold(&mut self, vertices: impl IntoIterator<Item = VertexId>) {
        self.held.push(vertices.into_iter().collect());
        self.inserted.push(BTreeSet::new());
    }

    fn free(&mut self, v: VertexId) {
        for set in self.held.iter_mut().chain(&mut self.inserted) {
            set.remove(&v);
        }
    }

    /// Follows the edits of a cut or of one step.
    fn follow(&mut self, sim: &Simulation) {
        let mut is_sewn = false;
        for edit in sim.edits() {
            let sets = self.held.iter_mut().zip(&mut self.inserted);
            for (held, inserted) in sets {
                match edit {
                    Edit::Split(split) => {
                        for set in [held, inserted] {
                            if set.contains(&split.old) {
                                set.insert(split.new);
                            }
                        }
                    }
                    Edit::Insert(insert) => {
                        for point in insert.points {
                            let ends = match point.at {
                                Mix::Copy(v) => vec![v],
                                Mix::Between { ends, .. } => ends.to_vec(),
                                Mix::Weighted { of, .. } => of.to_vec(),
                                _ => unreachable!("there is no other mix"),
                            };
                            if ends.iter().all(|v| held.contains(v)) {
                                held.insert(point.vertex);
                                inserted.insert(point.vertex);
                            }
                        }
                    }
                    Edit::Merge(merge) => {
                        is_sewn = true;
                        for set in [held, inserted] {
                            if set.remove(&merge.gone) {
                                set.insert(merge.kept);
                            }
                            let last = merge.renumbered.filter(|last| set.remove(&last.from));
                            set.extend(last.map(|last| last.to));
                        }
                    }
                    Edit::Slide(_) => {}
                    _ => unreachable!("there is no other edit"),
                }
            }
        }
        let mesh = sim.mesh();
        let is_torn = |v: VertexId| {
            let corners = mesh.corners_of(v);
            let mut around = corners.flat_map(|h| [h, h.prev()]);
            around.any(|h| mesh.ghost_pair(h).is_some())
        };
        for (held, inserted) in self.held.iter_mut().zip(&mut self.inserted) {
            let healed = inserted.iter().filter(|&&v| is_sewn && !is_torn(v));
            let healed: Vec<_> = healed.copied().collect();
            for v in healed {
                held.remove(&v);
                inserted.remove(&v);
            }
        }
    }

    /// What is held, and in no hand, is what calls hold.
    fn check(&self, sim: &Simulation, hands: &[HandId]) {
        let in_hands = hands.iter();
        let in_hands = in_hands.flat_map(|&hand| sim.in_hand(hand).expect("a hand"));
        let in_hands: BTreeSet<VertexId> = in_hands.copied().collect();
        let system = sim.cloth().system();
        let held = sim.mesh().vertices().filter(|v| system.is_held(v.index()));
        let held: BTreeSet<VertexId> = held.filter(|v| !in_hands.contains(v)).collect();
        let of_calls: BTreeSet<VertexId> = self.held.iter().flatten().copied().collect();
        assert_eq!(held, of_calls);
    }
}

/// Where the vertices are that are held and in no hand.
fn held_places(sim: &Simulation, hands: &[HandId]) -> BTreeSet<[u64; 3]> {
    let in_hands = hands
        .iter()
        .flat_map(|&hand| sim.in_hand(hand).expect("a hand"));
    let in_hands: BTreeSet<&VertexId> = in_hands.collect();
    let system = sim.cloth().system();
    let held = sim.mesh().vertices().filter(|v| system.is_held(v.index()));
    let held = held.filter(|v| !in_hands.contains(v));
    let bits = |v: VertexId| <[f64; 3]>::from(at(sim, v)).map(f64::to_bits);
    held.map(bits).collect()
}

/// What a script has made so far.
#[derive(Default)]
struct Made {
    holds: Holds,
    hands: Vec<HandId>,
    cuts: Vec<CutId>,
}

/// Does what a verb says, if it is not refused, and checks what must hold then.
fn perform(sim: &mut Simulation, made: &mut Made, verb: &Verb) {
    let &(verb, whom, [x, y, z]) = verb;
    let Made { holds, hands, cuts } = made;
    let index = whom as usize;
    let vertex = v(index);
    let hand = hands.get(index % 3).copied();
    let before = held_places(sim, hands);
    match verb {
        0 => {
            let row = 5 * (index % 5);
            let some = if z < 0.5 {
                vec![vertex, v(index / 2)]
            } else {
                (row..row + 5).map(v).collect()
            };
            if sim.hold(some.iter().copied()).is_ok() {
                holds.hold(some);
            }
        }
        1 => {
            if sim.free([vertex]).is_ok() {
                holds.free(vertex);
            }
        }
        2 | 3 => hands.extend(sim.grab(vertex, 0.4 * x)),
        4 | 5 => {
            let to = Point::new(2.0 * x - 0.5, 2.0 * y - 0.5, z);
            assert!(hand.is_none_or(|hand| sim.lead(hand, to).is_ok()));
        }
        6 => {
            if let Some(hand) = hand {
                sim.release(hand).expect("a hand");
                assert!(sim.release(hand).is_err(), "it is released");
                hands.retain(|other| *other != hand);
            }
        }
        7 => {
            let normal = Vector::new(x - 0.5, y - 0.5, 0.1 * z);
            if let Ok(plane) = Plane::new(Point::new(z, x, 0.0), normal) {
                cuts.push(sim.cut(&Scissor::by_plane(plane)).expect("cut"));
                holds.follow(sim);
            }
        }
        8 => {
            if let Ok(scissor) = Scissor::new(ray(x, y), ray(y, z)) {
                cuts.push(sim.cut(&scissor.with_snap(0.3 * z)).expect("cut"));
                holds.follow(sim);
            }
        }
        9 => {
            let cut = cuts.get(index % 4).copied();
            let opened = sim.heal(cut.map_or(Wounds::All, Wounds::Cut));
            opened.expect("a cut that was made");
        }
        _ => {
            let places = |sim: &Simulation, hands: &[HandId]| -> Vec<Point> {
                let of = |&hand| at(sim, sim.in_hand(hand).expect("a hand")[0]);
                hands.iter().map(of).collect()
            };
            let from = places(sim, hands);
            let began_s = sim.time_s();
            let step_s = sim.step_s();
            for _ in 0..((0.1 * x / step_s) as u64).min(400) {
                if sim.advance(step_s, 1).is_err() {
                    break;
                }
                holds.follow(sim);
            }
            let way_m = 3.0 * (sim.time_s() - began_s);
            for (from, to) in from.iter().zip(places(sim, hands)) {
                assert!(length(to - from) <= way_m + 1e-9);
            }
        }
    }
    holds.check(sim, hands);
    // What is held stays where it is.
    let after = held_places(sim, hands);
    match verb {
        0 | 1 => {}
        7 | 8 => assert!(before.is_subset(&after)),
        _ => assert!(after.is_subset(&before)),
    }
    let mut taken = BTreeSet::new();
    for &hand in hands.iter() {
        let vertices = sim.in_hand(hand).expect("a hand");
        assert!(!vertices.is_empty());
        // Copies of one vertex, which no edge joins: nothing is inserted between them.
        let mesh = sim.mesh();
        let is_in = |v| vertices.contains(&v);
        let joins = |h| is_in(mesh.origin(h)) && is_in(mesh.target(h));
        assert!(!mesh.half_edges().any(joins));
        for &v in vertices {
            assert_eq!(at(sim, v), at(sim, vertices[0]));
            assert!(sim.cloth().system().is_held(v.index()) && taken.insert(v));
        }
    }
    check(sim);
}

proptest! {
    #![proptest_config(Config { failure_persistence: None, ..Config::default() })]

    #[test]
    fn random_scripts_keep_what_holds_and_replay_exactly(
        verbs in verbs(),
        method in 0_usize..5,
        ratio in 1.05..1.5,
    ) {
        let def = SimulationDef {
            method: methods()[method].1.clone(),
            fabric: Fabric::new(50.0),
            tearing: Some(Tearing::new(Threshold::Stretch(ratio))),
            is_recorded: true,
            ..SimulationDef::default()
        };
        let mut sim = sheet(4, def.clone());
        let mut made = Made::default();
        for verb in &verbs {
            perform(&mut sim, &mut made, verb);
        }
        replays(&sim, 4, &def);
    }
}
