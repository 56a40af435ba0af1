//! Ids that are none of a mesh: every operation that takes one panics, names the invariant and
//! the id, and leaves mesh, log and followers as they were.

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

use tearmesh::insert::{ChordEnd, Plan};
use tearmesh::mend::{self, Stitch};
use tearmesh::script::{Script, World};
use tearmesh::{
    Edits, FaceId, HalfEdgeId, Mesh, PerVertex, Place, Plane, Point, Vector, VertexId, classify,
    shapes, slide, split, tear,
};

use crate::cases::cases_of;
use crate::lockstep::nothing_changed;
use crate::random::Random;

/// How many scripts the property gets, unless `TEARMESH_CASES` asks for fewer.
const CASES: u64 = 300;

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

/// Every operation and every query, with a foreign id.
fn cases<'c>(world: &World, random: &mut Random) -> Vec<Case<'c>> {
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

    let mut cases = Vec::new();
    let mut add = |id: &dyn ToString, name, run: Box<dyn Fn(&mut World)>| {
        let id = id.to_string();
        cases.push(Case { id, name, run });
    };
    macro_rules! with {
        ($id:expr, $name:literal, |$world:ident| $run:expr) => {
            add(
                &$id,
                $name,
                Box::new(move |$world: &mut World| {
                    let _ = $run;
                }),
            );
        };
    }

    with!(v, "split a vertex", |w| split::vertex(
        &mut w.mesh,
        v,
        &[corner.face()],
        &mut w.edits
    ));
    with!(v, "split into nothing", |w| split::vertex(
        &mut w.mesh,
        v,
        &[],
        &mut w.edits
    ));
    with!(f, "split off a face", |w| split::vertex(
        &mut w.mesh,
        own,
        &moving,
        &mut w.edits
    ));
    with!(v, "split by a plane", |w| split::by_plane(
        &mut w.mesh,
        v,
        &plane,
        &w.positions,
        &mut w.edits
    ));
    with!(v, "merge one", |w| mend::merge(
        &mut w.mesh,
        v,
        own,
        weights,
        &mut w.edits
    ));
    with!(v, "merge other", |w| mend::merge(
        &mut w.mesh,
        own,
        v,
        weights,
        &mut w.edits
    ));
    with!(v, "merge with itself", |w| mend::merge(
        &mut w.mesh,
        v,
        v,
        weights,
        &mut w.edits
    ));
    with!(v, "sew", |w| mend::sew(
        &mut w.mesh,
        &w.positions,
        &[Stitch::new(v, own).expect("they differ")],
        |_| weights[0],
        1.0,
        &mut w.edits
    ));
    with!(v, "slide", |w| slide::toward(
        &w.mesh,
        v,
        own,
        t,
        &mut w.edits
    )
    .map(|slide| slide.t));
    with!(v, "slide toward", |w| slide::toward(
        &w.mesh,
        own,
        v,
        t,
        &mut w.edits
    )
    .map(|slide| slide.t));
    with!(h, "tear", |w| tear::edge(
        &mut w.mesh,
        h,
        &w.positions,
        |_| Some(1.0),
        &mut w.edits
    ));
    with!(h, "candidate", |w| tear::candidate(
        &w.mesh,
        h,
        &w.positions,
        |_| None
    ));
    with!(h, "insert on an edge", |w| {
        let mut plan = Plan::new();
        plan.on_edge(corner, 0.5);
        plan.on_edge(h, t);
        plan.apply(&mut w.mesh, &mut w.edits)
            .map(|insert| insert.before)
    });
    with!(f, "insert in a face", |w| {
        let mut plan = Plan::new();
        plan.in_face(corner.face(), [0.0; 3]);
        plan.in_face(f, [1.0; 3]);
        plan.apply(&mut w.mesh, &mut w.edits)
            .map(|insert| insert.before)
    });
    with!(f, "a chord across a face", |w| {
        let mut plan = Plan::new();
        let point = plan.on_edge(corner, 0.5);
        let end = ChordEnd::Corner(corner.prev());
        plan.chord(f, [ChordEnd::Point(point), end]);
        plan.apply(&mut w.mesh, &mut w.edits)
            .map(|insert| insert.before)
    });
    with!(h, "a chord to a corner", |w| {
        let mut plan = Plan::new();
        let point = plan.on_edge(corner, 0.5);
        plan.chord(corner.face(), [ChordEnd::Point(point), ChordEnd::Corner(h)]);
        plan.apply(&mut w.mesh, &mut w.edits)
            .map(|insert| insert.before)
    });
    with!(f, "the side of a face", |w| classify::face(
        &w.mesh,
        f,
        &plane,
        &w.positions
    ));
    with!(v, "the sides of faces", |w| classify::faces_of(
        &w.mesh,
        v,
        &plane,
        &w.positions
    )
    .count());
    with!(h, "pair", |w| w.mesh.pair(h));
    with!(h, "ghost pair", |w| w.mesh.ghost_pair(h));
    with!(h, "either pair", |w| w.mesh.pair_or_ghost(h));
    with!(h, "origin", |w| w.mesh.origin(h));
    with!(h.next(), "target", |w| w.mesh.target(h));
    with!(f, "face_vertices", |w| w.mesh.face_vertices(f));
    with!(f, "neighbours", |w| w.mesh.neighbours(f).count());
    with!(f, "component", |w| w.mesh.components().of(f));
    with!(v, "half-edge of", |w| w.mesh.half_edge_of(v));
    with!(v, "corners of", |w| w.mesh.corners_of(v).count());
    with!(v, "faces of", |w| w.mesh.faces_of(v).count());
    with!(v, "fans", |w| w.mesh.fans(v).count());
    with!(v, "root", |w| w.mesh.root(v));
    with!(h, "fan", |w| w.mesh.fan(h).count());
    with!(h, "boundary loop", |w| w.mesh.boundary_loop(h).count());
    with!(v, "position", |w| w.positions.at(v));
    with!(v, "place", |w| w.positions.as_slice().at(v));
    with!(v, "mass", |w| w.area.at(v));
    with!(v, "half mass", |w| match &w.half {
        Some(half) => half.at(v),
        None => w.area.at(v),
    });
    with!(h, "corner data", |w| *w.corners.at(h));
    with!(v, "vertex data", |w| {
        let values = vec![1.0; w.mesh.vertex_count()];
        *PerVertex::new(values).at(v)
    });
    cases
}

thread_local! {
    static QUIET: Cell<bool> = const { Cell::new(false) };
}

/// The panic of what is to panic, which is not printed: there are thousands.
fn panic_of<T>(run: impl FnOnce() -> T) -> Option<Box<dyn Any + Send>> {
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
    panic
}

fn message(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref().copied())
        .expect("a panic has a message")
}

/// I2 is named, and I22 holds.
fn a_foreign_id_is_a_panic_that_changes_nothing(world: &World, case: &Case<'_>) {
    let Case { id, name, run } = case;
    let mut after = world.clone();
    let Some(panic) = panic_of(|| run(&mut after)) else {
        panic!("{name}: {id} was taken for an id of this mesh");
    };
    let message = message(&*panic);
    assert!(
        message.starts_with(&format!("I2: {id} is not a ")),
        "{name} of {id}: {message}"
    );
    nothing_changed(world, &after);
    // Nor was anything left in the log for the next record.
    let again = |world: &World| {
        let mut world = world.clone();
        for v in world.mesh.vertices() {
            let face = world.mesh.faces_of(v).next();
            world.split(v, &Vec::from_iter(face), |_, _| {});
        }
        world
    };
    nothing_changed(&again(world), &again(&after));
}

#[test]
fn foreign_ids_are_named_and_change_nothing() {
    let mut tried = 0;
    for seed in 0..cases_of(CASES) {
        let mut random = Random(seed);
        let bytes = random.bytes(60);
        let world = Script::from_bytes(&bytes).run(|_, _| {});
        for case in cases(&world, &mut random) {
            println!("script {seed}: {} of {}", case.name, case.id);
            a_foreign_id_is_a_panic_that_changes_nothing(&world, &case);
            tried += 1;
        }
    }
    println!("{tried} calls");
}

/// The first face has moved by the time the second is looked at.
#[test]
fn regression_a_foreign_face_among_those_that_move() {
    let (mut mesh, _) = shapes::fan(4, true);
    let before = mesh.clone();
    let hub = VertexId::new(0).expect("an id");
    let faces = [0, 9].map(|f| FaceId::new(f).expect("an id"));
    let mut edits = Edits::new();
    let panic =
        panic_of(|| split::vertex(&mut mesh, hub, &faces, &mut edits).map(|split| split.new));
    let panic = panic.expect("f9 is foreign");
    assert_eq!(mesh, before, "the mesh is as it was");
    assert_eq!(
        message(&*panic),
        "I2: f9 is not a face of this mesh, which has 4"
    );
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

#[test]
fn regression_a_foreign_vertex_is_not_merely_apart() {
    let (mesh, _) = shapes::triangle();
    let [v, foreign] = [0, 3].map(|v| VertexId::new(v).expect("an id"));
    let mut edits = Edits::new();
    let panic = panic_of(|| slide::toward(&mesh, v, foreign, 0.5, &mut edits).map(|slide| slide.t));
    let panic = panic.expect("v3 is foreign");
    assert_eq!(
        message(&*panic),
        "I2: v3 is not a vertex of this mesh, which has 3"
    );
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
fn regression_a_place_that_panics_leaves_nothing_in_the_log() {
    let (mesh, positions) = shapes::fan(6, true);
    let hub = VertexId::new(0).expect("an id");
    let plane = Plane::new(Point::origin(), Vector::new(1.0, 0.2, 0.0)).expect("a normal");
    let told = |mesh: &Mesh, mut edits: Edits| {
        let mut mesh = mesh.clone();
        let split = split::by_plane(&mut mesh, hub, &plane, &positions, &mut edits);
        let split = split.expect("faces on both sides");
        (split.corners.to_vec(), split.torn.to_vec())
    };
    let expected = told(&mesh, Edits::new());
    for v in mesh.vertices() {
        let (mut torn, mut edits) = (mesh.clone(), Edits::new());
        let place = Unknown(positions.as_slice(), v);
        let panic =
            panic_of(|| split::by_plane(&mut torn, hub, &plane, &place, &mut edits).is_some());
        assert!(panic.is_some(), "{v} is asked for");
        assert_eq!(torn, mesh);
        assert_eq!(told(&mesh, edits), expected, "without {v}");
    }
}
