//! Ids that are none of a mesh: every operation that takes one panics, names the invariant and
//! the id, also beside ids of the mesh, and leaves mesh, log and followers as they were.

use std::any::Any;
use std::cell::Cell;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use tearmesh::insert::{ChordEnd, Plan};
use tearmesh::mend::{self, Stitch};
use tearmesh::script::{Script, Step, World};
use tearmesh::{
    Edits, FaceId, HalfEdgeId, Mesh, PerVertex, Place, Plane, Point, Vector, VertexId, classify,
    shapes, slide, split, tear,
};

use crate::cases::cases;
use crate::lockstep::nothing_changed;
use crate::random::Random;

/// An operation, the foreign id that it is given, and its name.
struct Case<'c> {
    id: String,
    name: &'static str,
    run: Box<dyn Fn(&mut World) + 'c>,
}

/// A number from `count` on: the next one, one soon after, the last one or any.
fn beyond(random: &mut Random, count: usize, limit: usize) -> usize {
    let any = count + random.below(limit - count);
    let soon = count + random.below(20);
    [count, soon, any.min(limit - 1), limit - 1][random.below(4)]
}

/// Operations and queries.
#[derive(Default)]
struct Cases<'c>(Vec<Case<'c>>);

impl<'c> Cases<'c> {
    fn add<T>(&mut self, id: impl Display, name: &'static str, run: impl Fn(&mut World) -> T + 'c) {
        let run = Box::new(move |world: &mut World| {
            run(world);
        });
        let id = id.to_string();
        self.0.push(Case { id, name, run });
    }
}

/// Looks at no step.
fn quiet(_: &World, _: &Step<'_>) {}

/// Every operation and every query, with a foreign id.
fn operations<'c>(world: &World, random: &mut Random) -> Vec<Case<'c>> {
    let mesh = &world.mesh;
    let own = VertexId::new(random.below(mesh.vertex_count())).expect("a vertex");
    let corner = HalfEdgeId::new(random.below(mesh.half_edge_count())).expect("a half-edge");
    let v = VertexId::new(beyond(random, mesh.vertex_count(), VertexId::LIMIT)).expect("an id");
    let h = beyond(random, mesh.half_edge_count(), HalfEdgeId::LIMIT);
    let h = HalfEdgeId::new(h).expect("an id");
    let f = FaceId::new(beyond(random, mesh.face_count(), FaceId::LIMIT)).expect("an id");
    let plane = Plane::new(Point::origin(), Vector::new(1.0, 2.0, 3.0)).expect("a normal");
    let mut moving: Vec<FaceId> = mesh.faces_of(own).collect();
    moving.truncate(random.below(moving.len() + 1));
    moving.insert(random.below(moving.len() + 1), f);
    let weights = [[1.0; 2], [-1.0; 2]][random.below(2)];
    let t = [0.5, 0.0][random.below(2)];
    // A point on an edge of this mesh comes before what is foreign.
    let insert = move |world: &mut World, more: &dyn Fn(&mut Plan, ChordEnd)| {
        let mut plan = Plan::new();
        let point = plan.on_edge(corner, 0.5);
        more(&mut plan, ChordEnd::Point(point));
        world.insert(&plan, &mut quiet);
    };
    let slide = move |w: &mut World, v, toward| {
        slide::toward(&mut w.mesh, v, toward, t, &mut w.edits).is_ok()
    };

    let mut cases = Cases::default();
    let near = corner.face();
    cases.add(v, "split a vertex", move |w| {
        w.split(v, &[near], &mut quiet);
    });
    cases.add(v, "split into nothing", move |w| {
        w.split(v, &[], &mut quiet);
    });
    cases.add(f, "split off a face", move |w| {
        w.split(own, &moving, &mut quiet);
    });
    cases.add(v, "split by a plane", move |w| {
        split::by_plane(&mut w.mesh, v, &plane, &w.positions, &mut w.edits).is_some()
    });
    cases.add(v, "merge one", move |w| {
        w.merge(v, own, weights, &mut quiet);
    });
    cases.add(v, "merge other", move |w| {
        w.merge(own, v, weights, &mut quiet);
    });
    cases.add(v, "merge with itself", move |w| {
        w.merge(v, v, weights, &mut quiet);
    });
    cases.add(v, "sew", move |w| {
        let stitches = [Stitch::new(v, own).expect("they differ")];
        let (mesh, weight) = (&mut w.mesh, |_| weights[0]);
        mend::sew(mesh, &w.positions, &stitches, weight, 1.0, &mut w.edits)
    });
    cases.add(v, "slide", move |w| slide(w, v, own));
    cases.add(v, "slide toward", move |w| slide(w, own, v));
    cases.add(h, "tear", move |w| {
        tear::edge(&mut w.mesh, h, &w.positions, |_| Some(1.0), &mut w.edits).is_some()
    });
    cases.add(h, "candidate", move |w| {
        tear::candidate(&w.mesh, h, &w.positions, |_| None).is_some()
    });
    cases.add(h, "insert on an edge", move |w| {
        insert(w, &|plan, _| {
            plan.on_edge(h, t);
        });
    });
    cases.add(f, "insert in a face", move |w| {
        insert(w, &|plan, _| {
            plan.in_face(f, [1.0; 3]);
        });
    });
    cases.add(f, "a chord across a face", move |w| {
        insert(w, &|plan, point| {
            plan.chord(f, [point, ChordEnd::Corner(corner.prev())]);
        });
    });
    cases.add(h, "a chord to a corner", move |w| {
        insert(w, &|plan, point| {
            plan.chord(near, [point, ChordEnd::Corner(h)]);
        });
    });
    cases.add(f, "the side of a face", move |w| {
        classify::face(&w.mesh, f, &plane, &w.positions)
    });
    cases.add(h, "pair", move |w| w.mesh.pair(h));
    cases.add(h, "ghost pair", move |w| w.mesh.ghost_pair(h));
    cases.add(h, "either pair", move |w| w.mesh.pair_or_ghost(h));
    cases.add(h, "origin", move |w| w.mesh.origin(h));
    cases.add(h.next(), "target", move |w| w.mesh.target(h));
    cases.add(f, "face_vertices", move |w| w.mesh.face_vertices(f));
    cases.add(f, "neighbours", move |w| w.mesh.neighbours(f).count());
    cases.add(f, "component", move |w| w.mesh.components().of(f));
    cases.add(v, "half-edge of", move |w| w.mesh.half_edge_of(v));
    cases.add(v, "corners of", move |w| w.mesh.corners_of(v).count());
    cases.add(v, "faces of", move |w| w.mesh.faces_of(v).count());
    cases.add(v, "fans", move |w| w.mesh.fans(v).count());
    cases.add(v, "root", move |w| w.mesh.root(v));
    cases.add(h, "fan", move |w| w.mesh.fan(h).count());
    cases.add(h, "boundary loop", move |w| w.mesh.boundary_loop(h).count());
    cases.add(v, "position", move |w| w.positions.at(v));
    cases.add(v, "place", move |w| w.positions.as_slice().at(v));
    cases.add(v, "mass", move |w| w.area.at(v));
    cases.add(v, "half mass", move |w| {
        w.half.as_ref().unwrap_or(&w.area).at(v)
    });
    cases.add(h, "corner data", move |w| *w.corners.at(h));
    cases.add(v, "vertex data", move |w| {
        *PerVertex::new(vec![1.0; w.mesh.vertex_count()]).at(v)
    });
    cases.0
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// What something says as it panics, if it does. Nothing is printed: there are thousands.
pub(crate) fn panic_of<T>(run: impl FnOnce() -> T) -> Option<String> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let print = take_hook();
        set_hook(Box::new(move |info| {
            if !QUIET.get() {
                print(info);
            }
        }));
    });
    QUIET.set(true);
    let panic = catch_unwind(AssertUnwindSafe(run)).err();
    QUIET.set(false);
    let text = |panic: Box<dyn Any + Send>| match panic.downcast::<String>() {
        Ok(text) => *text,
        Err(panic) => String::from(*panic.downcast::<&str>().expect("a message")),
    };
    panic.map(text)
}

/// I2 is named, and I22 holds.
fn a_foreign_id_is_a_panic_that_changes_nothing(world: &World, case: &Case<'_>) {
    let Case { id, name, run } = case;
    let mut after = world.clone();
    let told = panic_of(|| run(&mut after)).unwrap_or_default();
    let is_named = told.starts_with(&format!("I2: {id} is not a "));
    assert!(is_named, "{name} of {id}: {told:?}");
    nothing_changed(world, &after);
    // Nor was anything left in the log for the next record.
    let again = |world: &World| {
        let mut world = world.clone();
        for v in world.mesh.vertices() {
            let face = world.mesh.faces_of(v).next();
            world.split(v, &Vec::from_iter(face), &mut quiet);
        }
        world
    };
    nothing_changed(&again(world), &again(&after));
}

#[test]
fn foreign_ids_are_named_and_change_nothing() {
    let mut tried = 0;
    for seed in 0..cases() / 5 {
        let mut random = Random(seed);
        let bytes = random.bytes(60);
        let world = Script::from_bytes(&bytes).run(|_, _| {});
        for case in operations(&world, &mut random) {
            println!("script {seed}: {} of {}", case.name, case.id);
            a_foreign_id_is_a_panic_that_changes_nothing(&world, &case);
            tried += 1;
        }
    }
    assert!(tried > 0);
}

/// The first face has moved by the time the second is looked at; and a foreign vertex is not merely
/// apart.
#[test]
fn regression_foreign_ids_beside_own_ones_change_nothing() {
    let (mut mesh, _) = shapes::fan(4, true);
    let before = mesh.clone();
    let [hub, foreign] = [0, 7].map(|v| VertexId::new(v).expect("an id"));
    let faces = [0, 9].map(|f| FaceId::new(f).expect("an id"));
    let mut edits = Edits::new();
    let split = panic_of(|| split::vertex(&mut mesh, hub, &faces, &mut edits).is_ok());
    let slide = panic_of(|| slide::toward(&mut mesh, hub, foreign, 0.5, &mut edits).is_ok());
    assert_eq!(mesh, before, "the mesh is as it was");
    let half_edge = panic_of(|| mesh.half_edge(12));
    for (panic, told) in [
        (
            half_edge,
            "I2: h12 is not a half-edge of this mesh, which has 12",
        ),
        (split, "I2: f9 is not a face of this mesh, which has 4"),
        (slide, "I2: v7 is not a vertex of this mesh, which has 5"),
    ] {
        assert_eq!(panic.as_deref(), Some(told));
    }
}

/// Three times the face was more than an id holds, and came out as a half-edge of the mesh.
#[test]
fn regression_every_face_id_has_half_edges() {
    let last = FaceId::new(FaceId::LIMIT - 1).expect("the last face id");
    for h in last.half_edges() {
        assert_eq!(h.face(), last);
    }
    assert_eq!(FaceId::new((1 << 32) / 3 + 1), None);
}

/// Where the vertices are, but for one.
struct Unknown<'p>(&'p [Point], VertexId);

impl Place for Unknown<'_> {
    fn at(&self, v: VertexId) -> Point {
        assert_ne!(v, self.1, "this vertex is unknown");
        self.0[v.index()]
    }
}

/// What was noted before the panic was found in the record of the next split.
#[test]
fn regression_a_place_that_panics_leaves_the_log_alone() {
    let (mesh, positions) = shapes::fan(6, true);
    let hub = VertexId::new(0).expect("an id");
    let plane = Plane::new(Point::origin(), Vector::new(1.0, 0.2, 0.0)).expect("a normal");
    let told = |mesh: &Mesh, mut edits: Edits| {
        let mut mesh = mesh.clone();
        let split = split::by_plane(&mut mesh, hub, &plane, &positions, &mut edits);
        assert!(split.is_some(), "faces on both sides");
        edits
    };
    let expected = told(&mesh, Edits::new());
    for v in mesh.vertices() {
        let (mut torn, mut edits) = (mesh.clone(), Edits::new());
        let place = Unknown(positions.as_slice(), v);
        let split = || split::by_plane(&mut torn, hub, &plane, &place, &mut edits).is_some();
        assert!(panic_of(split).is_some(), "{v} is asked for");
        assert_eq!(torn, mesh);
        assert!(told(&mesh, edits).iter().eq(expected.iter()), "without {v}");
    }
}
