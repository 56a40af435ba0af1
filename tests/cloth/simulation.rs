//! A simulation does what its verbs say: grips hold, rips run, cuts and sewing keep everything in
//! step, and what is refused changes nothing.

mod buffers;
mod replay;

use tearmesh::geometry::length;
use tearmesh::{CutMethod, Edits, FaceId, Mesh, Point, Scissor, Vector, VertexId, shapes};
use tearmesh_cloth::{
    CutId, Event, Fabric, HandId, InputError, Method, Quality, Simulation, SimulationDef, Solver,
    StepError, Tearing, Unstable, Verlet, Wounds,
};

use crate::follow;
use crate::parts::{cloths, gravity_along_y, near, plane, ray, v};

/// More steps than any test takes at once.
const ALL: u64 = 1_000_000;

/// A sheet of n × n cells of a metre in all.
fn sheet(n: u32, def: SimulationDef) -> Simulation {
    let (mesh, positions) = shapes::grid(n, n);
    Simulation::new(mesh, &positions, def).expect("a simulation")
}

/// A sheet that hangs by its upper edge.
fn hung(n: u32, def: SimulationDef) -> Simulation {
    let mut sim = sheet(n, def);
    let row = n as usize + 1;
    sim.hold((row * (row - 1)..row * row).map(v)).expect("held");
    sim
}

/// A definition by the length of its steps.
fn stepping(step_s: f64) -> SimulationDef {
    SimulationDef {
        step_s: Some(step_s),
        ..SimulationDef::default()
    }
}

fn hanging(n: u32, stretch_n_per_m: f64, drag_per_s: f64, method: Method) -> Simulation {
    let def = SimulationDef {
        fabric: Fabric::new(stretch_n_per_m),
        loads: gravity_along_y(drag_per_s),
        method,
        ..SimulationDef::default()
    };
    hung(n, def)
}

/// A scissor along the plane y = `height`.
fn across(height: f64) -> Scissor {
    Scissor::by_plane(plane([0.0, height, 0.0], Vector::y()))
}

/// A scissor along the plane x = `along`.
fn down(along: f64) -> Scissor {
    Scissor::by_plane(plane([along, 0.0, 0.0], Vector::x()))
}

/// Where a vertex is.
fn at(sim: &Simulation, vertex: VertexId) -> Point {
    sim.cloth().positions()[vertex.index()]
}

/// How many vertices are held, in a hand or not.
fn held(sim: &Simulation) -> usize {
    let is_held = |v: &VertexId| sim.cloth().system().is_held(v.index());
    sim.mesh().vertices().filter(is_held).count()
}

/// The vertex in a hand that holds one.
fn held_by(sim: &Simulation, hand: HandId) -> VertexId {
    let &[held] = sim.in_hand(hand).expect("a hand") else {
        panic!("one vertex is in the hand")
    };
    held
}

/// Leads a hand for a number of frames, by the seconds that passed.
fn drag(sim: &mut Simulation, hand: HandId, frames: u32, to: impl Fn(f64) -> Point) {
    for frame in 0..frames {
        sim.lead(hand, to(f64::from(frame) / 60.0)).expect("led");
        pass(sim, 1.0 / 60.0);
    }
}

fn pass(sim: &mut Simulation, seconds: f64) {
    sim.advance(seconds, ALL).expect("stable steps");
}

/// How many pieces there are.
fn pieces(sim: &Simulation) -> usize {
    sim.mesh().components().count()
}

/// How many faces hang together with this one.
fn together(mesh: &Mesh, face: FaceId) -> usize {
    let components = mesh.components();
    let is_same = |other: &FaceId| components.of(*other) == components.of(face);
    mesh.faces().filter(is_same).count()
}

/// What holds of a simulation at all times.
pub(crate) fn check(sim: &mut Simulation) {
    let mesh = sim.mesh();
    assert_eq!(mesh.check(), []);
    follow::check(mesh, sim.cloth(), false);
    let (faces, corners) = (mesh.face_count(), mesh.half_edge_count());
    let buffers = sim.draw_buffers();
    assert_eq!(buffers.indices().len(), corners);
    assert_eq!(buffers.pieces().len(), faces);
}

/// Drags a vertex near the middle of a hanging sheet down and forward by a metre and a half; the
/// number of faces that hang together with it then.
fn faces_pulled_out(n: u32, grip_radius_m: f64) -> usize {
    let mut sim = hanging(n, 100.0, 0.5, Method::Verlet);
    pass(&mut sim, 0.2);
    let picked = sim.pick(&ray(0.5, 0.5)).expect("on the cloth");
    let from = at(&sim, picked.vertex);
    let hand = sim.grab(picked.vertex, grip_radius_m).expect("a hand");
    // What another hand gripped, and released, is as it was.
    let other = sim.grab(v(picked.vertex.index() + 1), 0.5);
    sim.release(other.expect("a hand")).expect("a hand");
    drag(&mut sim, hand, 90, |s| from + Vector::new(0.0, -s, s));
    check(&mut sim);
    let mut faces = sim.mesh().faces_of(held_by(&sim, hand));
    together(sim.mesh(), faces.next().expect("a face"))
}

#[test]
fn a_grip_holds_more_than_a_crumb() {
    let [without, with] = [0.0, Simulation::GRIP_RADIUS_M].map(|r| faces_pulled_out(16, r));
    assert!(
        5 * without <= with && with >= 100,
        "{without} and {with} faces"
    );
}

/// Grabbed near the middle of its right edge, and drawn to the left.
#[test]
fn a_hand_rips_a_sheet_from_edge_to_edge() {
    let tearing = Tearing {
        weakening: Some(0.5),
        ..Tearing::default()
    };
    let def = SimulationDef {
        loads: gravity_along_y(5.0),
        method: Method::xpbd(),
        tearing: Some(tearing),
        ..SimulationDef::default()
    };
    for n in [11, 12, 16] {
        let mut sim = hung(n, def.clone());
        pass(&mut sim, 0.5);
        let picked = sim.pick(&ray(0.97, 0.5)).expect("on the cloth").vertex;
        let from = at(&sim, picked);
        let hand = sim.grab(picked, Simulation::GRIP_RADIUS_M).expect("a hand");
        drag(&mut sim, hand, 120, |s| {
            from + Vector::new(-1.5 * s, -0.3 * s, 0.3)
        });
        sim.release(hand).expect("a hand");
        check(&mut sim);
        assert_eq!(pieces(&sim), 2);
        let faces = sim.mesh().face_count();
        let of_one = together(sim.mesh(), sim.mesh().faces().next().expect("a face"));
        let (least, most) = (faces / 12, faces - faces / 12);
        let is_across = (least + 1..most).contains(&of_one);
        assert!(is_across, "{n}: {of_one} of {faces} faces");
        // A weakened edge bears a quarter of its length. The weakest is a diagonal with one face, which
        // is √2 times as long as a cell, and a quarter as stiff as its edge.
        let least_n = 1000.0 / 4.0 * 0.25 * 2.0_f64.sqrt() / f64::from(n) * (1.0 - 1e-9);
        let events: Vec<Event> = sim.events().collect();
        for &event in &events {
            assert!(
                matches!(event, Event::Tore { time_s, force_n: Some(newtons), .. }
                if (0.5..2.6).contains(&time_s) && newtons >= least_n)
            );
        }
        let before = (n as usize + 1).pow(2);
        assert!(events.len() >= n as usize);
        assert_eq!(sim.mesh().vertex_count(), before + events.len());
    }
}

#[test]
fn a_hand_follows_at_most_at_its_largest_speed() {
    let mut sim = sheet(4, stepping(1.0 / 1200.0));
    let hand = sim.grab(v(12), 0.1).expect("a hand");
    let mut before = at(&sim, v(12));
    let step_s = sim.step_s();
    sim.lead(hand, before + Vector::z() * 30.0).expect("led");
    for _ in 0..50 {
        pass(&mut sim, step_s);
        let way = length(at(&sim, v(12)) - before);
        near(way, 3.0 * step_s, 1e-12);
        before = at(&sim, v(12));
    }
    let near_by = before + Vector::y() * 0.006;
    sim.lead(hand, near_by).expect("led");
    for (seconds, left_m) in [(1.0 / 120.0, 0.003), (1.0 / 120.0, 0.0), (0.1, 0.0)] {
        pass(&mut sim, seconds);
        near(length(at(&sim, v(12)) - near_by), left_m, 1e-12);
    }
}

#[test]
fn time_passes_in_whole_steps_within_a_budget() {
    // Half a step is taken early, and not once more. What is beyond a budget is dropped.
    let whole: &[_] = &[(1.4, ALL, 1), (1.4, ALL, 2), (0.2, ALL, 0), (100.0, 7, 7)];
    let halves: &[_] = &[(125.0, ALL, 1), (0.0, ALL, 0), (125.0, 9, 0), (250.0, 9, 1)];
    for (step_s, calls) in [(0.001, whole), (0.25, halves)] {
        let mut sim = sheet(4, stepping(step_s));
        for &(dt_ms, most, steps) in calls {
            let reached = sim.advance(dt_ms / 1000.0, most).expect("stable");
            assert_eq!(reached.steps, steps);
            let dropped_s = [0.0, 0.093][usize::from(most == 7)];
            near(reached.dropped_s, dropped_s, 1e-12);
        }
        let steps: u64 = calls.iter().map(|call| call.2).sum();
        near(sim.time_s(), steps as f64 * step_s, 1e-15);
        for given_s in [-0.1, f64::NAN, f64::INFINITY] {
            let refused = sim.advance(given_s, ALL);
            assert!(matches!(refused, Err(StepError::Step { .. })));
        }
        assert_eq!(sim.steps(), steps);
    }
    // A time of more steps than an f64 counts does not stop time for good.
    for endless_s in [1e30, 1e308] {
        let mut sim = sheet(4, stepping(0.001));
        for (dt_s, steps) in [(endless_s, 3), (0.001, 1), (0.001, 1)] {
            assert_eq!(sim.advance(dt_s, 3).map(|reached| reached.steps), Ok(steps));
        }
    }
    // One that is too long is divided or refused.
    for (when_unstable, steps) in [(Unstable::Substep, 6), (Unstable::Refuse, 0)] {
        let def = SimulationDef {
            when_unstable,
            ..stepping(1.0 / 60.0)
        };
        let mut sim = sheet(4, def);
        assert_eq!(sim.advance(0.1, ALL).is_ok(), steps > 0);
        assert_eq!(sim.steps(), steps);
    }
}

#[test]
fn a_cut_while_it_moves_leaves_everything_in_step() {
    let mut sim = hanging(12, 1000.0, 0.5, Method::Verlet);
    pass(&mut sim, 0.3);
    let held_before = held(&sim);
    let hand = sim.grab(v(84), Simulation::GRIP_RADIUS_M).expect("a hand");
    let momentum = |sim: &Simulation| cloths::momentum(sim.cloth()).map(|sum| sum.to_f64());
    let before = momentum(&sim);
    // Down through the held edge, and through the vertex in the hand.
    let x = at(&sim, v(84)).x;
    sim.cut(&down(x)).expect("cut");
    for (now, before) in momentum(&sim).into_iter().zip(before) {
        near(now, before, 1e-12);
    }
    check(&mut sim);
    assert_eq!(pieces(&sim), 2);
    let in_hand = sim.in_hand(hand).expect("a hand").to_vec();
    assert_eq!(in_hand.len(), 2);
    assert_eq!(held(&sim), held_before + 1 + 2);
    let event = sim.events().next().expect("an event");
    assert!(matches!(event, Event::Cut { splits: 13.., .. }));
    let to = Point::new(x, 0.5, 0.2);
    sim.lead(hand, to).expect("led");
    pass(&mut sim, 0.2);
    assert!(in_hand.iter().all(|&v| length(at(&sim, v) - to) < 1e-12));
    sim.release(hand).expect("a hand");
    assert_eq!(held(&sim), held_before + 1);
}

/// How many links are torn.
fn torn(sim: &Simulation) -> usize {
    let mesh = sim.mesh();
    let torn = mesh.half_edges().filter(|&h| mesh.ghost_pair(h).is_some());
    torn.count() / 2
}

/// Heals, and returns what was sewn and left; nothing tears meanwhile.
fn heal(sim: &mut Simulation, wounds: Wounds) -> (usize, usize) {
    sim.events().for_each(drop);
    assert!(sim.heal(wounds).expect("wounds") > 0);
    for _ in 0..1000 {
        pass(sim, 1.0 / 60.0);
        let event = sim.events().next();
        if let Some(event) = event {
            let Event::Healed { sewn, left, .. } = event else {
                panic!("{event:?} while it heals")
            };
            assert_eq!(sim.open_pairs(), 0);
            return (sewn, left);
        }
    }
    panic!("healing ends")
}

/// Before they are weighed again.
#[test]
fn the_quality_of_a_step_is_known_where_what_was_carried_became_one() {
    let mut sim = hung(10, SimulationDef::default());
    pass(&mut sim, 0.01);
    let cut = sim.cut(&across(0.503).with_snap(0.0)).expect("cut");
    let step_s = sim.step_s();
    sim.advance(step_s, 1).expect("a step");
    let before = sim.mesh().vertex_count();
    sim.heal(Wounds::Cut(cut)).expect("a cut");
    while sim.mesh().vertex_count() == before {
        sim.advance(step_s, 1).expect("a step");
    }
    let quality = Verlet.quality(sim.cloth().system());
    let Quality::Carried {
        carried,
        mass_ratio_max,
        ..
    } = quality
    else {
        panic!("{quality:?}")
    };
    assert!(carried > 0 && mass_ratio_max > 1.0, "{quality:?}");
}

#[test]
fn a_cut_that_fell_apart_heals_by_every_method() {
    for (method, modulus_n_per_m, height) in [
        (Method::Verlet, 1000.0, 0.43),
        (Method::xpbd(), 100.0, 0.43),
        (Method::pbd(), 100.0, 0.43),
        // Pairs wait where edges are shaken, and its limiter makes energy: it leaves two of eight such cuts.
        (Method::provot(), 1000.0, 0.443),
        (Method::implicit(), 100.0, 0.43),
    ] {
        // In their plane: where folds tear that pbd and provot stretch is chance.
        let def = SimulationDef {
            fabric: Fabric::new(modulus_n_per_m),
            method: method.clone(),
            ripple_m: Some(0.0),
            ..SimulationDef::default()
        };
        let mut sim = hung(12, def);
        pass(&mut sim, 0.2);
        let cut = sim.cut(&across(height)).expect("cut");
        let inserted_and_split = sim.mesh().vertex_count();
        pass(&mut sim, 0.3);
        assert_eq!(pieces(&sim), 2);
        let (sewn, left) = heal(&mut sim, Wounds::Cut(cut));
        check(&mut sim);
        assert_eq!((left, pieces(&sim)), (0, 1), "{method:?}");
        // What was inserted stays, and what was split is whole.
        assert_eq!(
            sim.mesh().vertex_count(),
            inserted_and_split - sewn,
            "{method:?}"
        );
        assert_eq!(torn(&sim), 0);
        if !matches!(method, Method::Pbd(_)) {
            // That stretches by itself until it tears.
            pass(&mut sim, 0.5);
            assert_eq!(sim.events().count(), 0);
        }
    }
}

/// The halves of what a cut inserts in the held edge are held where they are, and once they are one again, no
/// longer; unless somebody holds them for their own sake.
#[test]
fn what_a_cut_inserts_within_a_hold_is_held_until_it_heals() {
    for is_held_anew in [false, true] {
        let mut sim = hanging(12, 1000.0, 1.0, Method::Verlet);
        pass(&mut sim, 0.1);
        let cut = sim.cut(&down(0.53)).expect("cut");
        assert_eq!(held(&sim), 13 + 2);
        let system = sim.cloth().system();
        let halves: Vec<usize> = (169..)
            .take_while(|&v| v < sim.mesh().vertex_count())
            .collect();
        let halves = halves.into_iter().filter(|&v| system.is_held(v)).map(v);
        let halves: Vec<VertexId> = halves.collect();
        let places = [at(&sim, halves[0]), at(&sim, halves[1])];
        pass(&mut sim, 0.3);
        assert_eq!(places, [at(&sim, halves[0]), at(&sim, halves[1])]);
        if is_held_anew {
            sim.hold([halves[1]]).expect("held");
        }
        let before = sim.mesh().vertex_count();
        let (sewn, left) = heal(&mut sim, Wounds::Cut(cut));
        assert_eq!((left, sim.mesh().vertex_count()), (0, before - sewn));
        assert_eq!(held(&sim), 13 + usize::from(is_held_anew));
        assert_eq!(
            sim.cloth().system().is_held(halves[0].index()),
            is_held_anew
        );
        check(&mut sim);
    }
}

/// Of two calls each holds for itself, and a vertex that was let go holds nothing.
#[test]
fn what_a_cut_inserts_between_two_holds_is_free() {
    for (holds, freed, inserted) in [
        (&[[20, 22], [23, 24]][..], None, 0),
        (&[[20, 24]], None, 2),
        (&[[20, 22], [22, 24]], None, 2),
        (&[[20, 24]], Some(22), 0),
        (&[[20, 22], [23, 24], [20, 24]], None, 2),
    ] {
        let mut sim = sheet(4, SimulationDef::default());
        for &[first, last] in holds {
            sim.hold((first..=last).map(v)).expect("held");
        }
        sim.free(freed.map(v)).expect("a vertex");
        let before = held(&sim);
        sim.cut(&down(0.6)).expect("cut");
        assert_eq!(held(&sim), before + inserted, "{holds:?}");
    }
}

#[test]
fn only_the_cut_that_is_meant_heals_where_two_cross() {
    let mut sim = hanging(8, 1000.0, 1.0, Method::Verlet);
    let first = sim.cut(&Scissor::new(ray(0.2, 0.5), ray(0.8, 0.5)).expect("rays"));
    let second = sim.cut(&Scissor::new(ray(0.53, 0.3), ray(0.53, 0.7)).expect("rays"));
    let (first, second) = (first.expect("cut"), second.expect("cut"));
    let both = torn(&sim);
    let (_, left) = heal(&mut sim, Wounds::Cut(first));
    let one = torn(&sim);
    assert!(left == 0 && 0 < one && one < both);
    check(&mut sim);
    assert_eq!(sim.heal(Wounds::Cut(first)), Ok(0));
    assert_eq!(heal(&mut sim, Wounds::Cut(second)).1, 0);
    assert_eq!(torn(&sim), 0);
}

#[test]
fn what_holds_keep_apart_is_left_and_stays_held() {
    let mut sim = hanging(6, 1000.0, 2.0, Method::Verlet);
    pass(&mut sim, 0.1);
    let cut = sim.cut(&across(0.47)).expect("cut");
    // Seven hands draw the lower edge down, and hold it there.
    let hands = [0, 1, 2, 3, 4, 5, 6].map(|i| {
        let hand = sim.grab(v(i), 0.0).expect("a hand");
        let to = Point::new(i as f64 / 6.0, -1.0, 0.0);
        sim.lead(hand, to).expect("led");
        hand
    });
    pass(&mut sim, 0.5);
    let vertices = sim.mesh().vertex_count();
    let before_s = sim.time_s();
    let (sewn, left) = heal(&mut sim, Wounds::Cut(cut));
    let took_s = sim.time_s() - before_s;
    assert_eq!((sewn, vertices), (0, sim.mesh().vertex_count()));
    assert!(left >= 7 && (5.0..6.5).contains(&took_s));
    check(&mut sim);
    for (i, hand) in hands.into_iter().enumerate() {
        assert_eq!(sim.in_hand(hand).expect("a hand"), [v(i)]);
    }
}

#[test]
fn what_is_held_is_not_sewn_to_what_is_in_a_hand() {
    let mut sim = hanging(4, 1000.0, 1.0, Method::Verlet);
    let cut = sim.cut(&down(0.5)).expect("cut");
    // Both halves of the middle of the upper edge are held; one goes from hand to hand.
    sim.free([v(22)]).expect("held");
    let hand = sim.grab(v(22), 0.0).expect("a hand");
    let vertices = sim.mesh().vertex_count();
    assert_eq!(heal(&mut sim, Wounds::Cut(cut)), (4, 1));
    assert_eq!(sim.mesh().vertex_count(), vertices - 4);
    assert_eq!(sim.in_hand(hand), Ok(&[v(22)][..]));
    sim.release(hand).expect("a hand");
    // It falls, and is drawn up again by the half that is held, which stays where it is.
    let pinned = at(&sim, v(22));
    pass(&mut sim, 0.1);
    assert_ne!(at(&sim, v(22)), pinned);
    assert_eq!(heal(&mut sim, Wounds::All), (1, 0));
    assert!(sim.cloth().system().is_held(22));
    assert_eq!(at(&sim, v(22)), pinned);
    check(&mut sim);
}

#[test]
fn holds_and_hands_are_kept_through_merges_and_renumbering() {
    let mut sim = hanging(6, 1000.0, 1.0, Method::Verlet);
    // Both cuts go through the held edge; the ids of the copies of the first are the lower ones.
    let first = sim.cut(&down(1.0 / 3.0)).expect("cut");
    let second = sim.cut(&down(2.0 / 3.0)).expect("cut");
    assert_eq!(held(&sim), 9);
    // The last vertex is a copy of the second cut, and gets another id when the first is sewn.
    let last = v(sim.mesh().vertex_count() - 1);
    let free = sim.mesh().vertices().rev();
    let mut free = free.filter(|v| !sim.cloth().system().is_held(v.index()));
    let grabbed = free.next().expect("free copies");
    assert!(grabbed.index() + 3 >= last.index());
    let hand = sim.grab(grabbed, 0.1).expect("a hand");
    let place = at(&sim, grabbed);
    assert_eq!(heal(&mut sim, Wounds::Cut(first)).1, 0);
    check(&mut sim);
    let now = held_by(&sim, hand);
    assert_ne!(now, grabbed);
    assert!(sim.cloth().system().is_held(now.index()));
    assert_eq!(at(&sim, now), place);
    assert_eq!(held(&sim), 8 + 1);
    // Sewn to the copy that was left free, it is still in the hand.
    assert_eq!(heal(&mut sim, Wounds::Cut(second)).1, 0);
    assert_eq!(at(&sim, held_by(&sim, hand)), place);
    assert_eq!(held(&sim), 7 + 1);
    assert_eq!(sim.mesh().vertex_count(), 49);
    sim.release(hand).expect("a hand");
    assert_eq!(held(&sim), 7);
}

#[test]
fn what_is_refused_changes_nothing() {
    let mut sim = hanging(4, 1000.0, 1.0, Method::Verlet);
    let hand = sim.grab(v(7), 0.1).expect("a hand");
    let gone = sim.grab(v(8), 0.1).expect("a hand");
    sim.release(gone).expect("a hand");
    let positions = sim.cloth().positions().to_vec();
    // A cut of another simulation, and a scissor that continues one.
    let cut: CutId = hanging(4, 1000.0, 1.0, Method::Verlet)
        .cut(&across(0.4))
        .expect("cut");
    let (mut mesh, mut at) = shapes::grid(4, 4);
    let scissor = Scissor::new(ray(0.2, 0.5), ray(0.6, 0.5)).expect("rays");
    let made = scissor.cut(CutMethod::Exact, &mut mesh, &mut at, &mut Edits::new());
    let ends = made.expect("cut");
    let [_, end] = ends.ends().expect("rays");
    let continued = Scissor::continued(end, ray(0.8, 0.8), &at).expect("rays");
    let far = Point::new(0.0, f64::INFINITY, 0.0);
    let (held, no_vertex) = (InputError::Held(v(24)), InputError::NoVertex(v(25)));
    let (no_hand, in_hand) = (InputError::NoHand(gone), InputError::InHand(v(7), hand));
    let [radius, to] =
        [("radius_m", -0.5), ("to", far.y)].map(|(name, x)| InputError::Number(name, x));
    for (refused, named) in [
        (sim.hold([v(3), v(25)]).err(), &no_vertex),
        (sim.free([v(24), v(25)]).err(), &no_vertex),
        (sim.grab(v(25), 0.1).err(), &no_vertex),
        (sim.hold([v(3), v(7)]).err(), &in_hand),
        (sim.free([v(24), v(7)]).err(), &in_hand),
        (sim.grab(v(7), 0.1).err(), &in_hand),
        (sim.grab(v(24), 0.1).err(), &held),
        (sim.grab(v(3), -0.5).err(), &radius),
        (sim.lead(hand, far).err(), &to),
        (sim.lead(gone, positions[0]).err(), &no_hand),
        (sim.release(gone).err(), &no_hand),
        (sim.in_hand(gone).err(), &no_hand),
        (sim.heal(Wounds::Cut(cut)).err(), &InputError::NoCut(cut)),
        (sim.cut(&continued).err(), &InputError::Continued),
    ] {
        assert_eq!(refused.as_ref(), Some(named));
    }
    assert!(sim.grab(v(3), f64::NAN).is_err());
    assert!(!sim.cloth().system().is_held(3) && sim.cloth().system().is_held(24));
    assert_eq!(sim.cloth().positions(), positions);
    assert_eq!((sim.mesh().vertex_count(), sim.events().count()), (25, 0));
}

#[test]
fn definitions_that_make_no_simulation_are_refused() {
    type Change = fn(&mut SimulationDef);
    let changes: [(Change, &str); 5] = [
        (|def| def.density_kg_per_m2 = -1.0, "the density -1"),
        (
            |def| def.fabric = Fabric::new(-1.0),
            "modulus_n_per_m is -1, and has to be finite and above 0",
        ),
        (|def| def.loads.drag_per_s = Some(-1.0), "drag_per_s is -1"),
        (|def| def.strengths = vec![1.0; 8], "there are 8 strengths"),
        (|def| def.step_s = Some(0.0), "a step of 0 s"),
    ];
    for (change, named) in changes {
        let (mesh, positions) = shapes::grid(2, 2);
        let mut def = SimulationDef::default();
        change(&mut def);
        let error = Simulation::new(mesh, &positions, def).expect_err(named);
        assert!(error.to_string().contains(named), "{error}");
    }
}

#[test]
fn edited_positions_go_on_from_their_place_in_the_log() {
    let (mut mesh, mut positions) = shapes::grid(4, 4);
    let mut edits = Edits::new();
    let scissor = across(0.55);
    scissor
        .cut(CutMethod::Exact, &mut mesh, &mut positions, &mut edits)
        .expect("cut");
    let vertices = mesh.vertex_count();
    let def = SimulationDef::default();
    let mut sim = Simulation::new(mesh, &positions, def).expect("a simulation");
    assert_eq!(sim.edits().cursor(), edits.cursor());
    // Wounds that it was born with heal as well.
    let (sewn, left) = heal(&mut sim, Wounds::All);
    assert_eq!((left, sim.mesh().vertex_count()), (0, vertices - sewn));
    assert_eq!(pieces(&sim), 1);
}
