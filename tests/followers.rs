//! Followers by the normal form of edits keep, bit for bit, what a plain reading of the records
//! gives, through all four kinds of edit, seams of texture and torn edges; and a follower that is
//! not in step is told what is wrong with it.

mod values;

use tearmesh::engine::DrawBuffers;
use tearmesh::script::{Script, Step, World};
use tearmesh::{
    Blend, Cursor, Edit, Edits, Follower, HalfEdgeId, Masses, Mesh, Mix, PerCorner, PerVertex,
    Positions, shapes, slide, split,
};

use crate::foreign::panic_of;
use crate::random::Random;
use crate::scripts::scripts;
use values::{Value, Values, between, weighted};

/// A number that few others have, and corners of some vertices alike in all faces or on one side of a
/// seam.
fn any_values(mesh: &Mesh, random: &mut Random) -> Values {
    let mut value = || [random.next(), random.next()];
    let vertices: Vec<Value> = mesh.vertices().map(|_| value()).collect();
    let sides: Vec<[Value; 2]> = vertices.iter().map(|&at| [at, value()]).collect();
    let side = |h: HalfEdgeId| {
        let v = mesh.origin(h).index();
        sides[v][(v + h.face().index()) % 3 / 2]
    };
    Values {
        corners: mesh.half_edges().map(side).collect(),
        faces: (0..mesh.face_count() as u16).collect(),
        indices: mesh.indices().to_vec(),
        vertices,
    }
}

fn mixed(mix: Mix<&Value>) -> Value {
    match mix {
        Mix::Copy(one) => *one,
        Mix::Between { ends: [a, b], t } => between(*a, *b, t),
        Mix::Weighted { of, weights } => weighted(of.map(|one| *one), weights),
        _ => unreachable!("there is no other mix"),
    }
}

/// Values by a plain reading of the records, followers, and lists of somebody else, each with its own place
/// in the log.
struct Beside {
    plain: Values,
    lists: (PerVertex<Value>, PerCorner<Value>),
    positions: Positions,
    own: Option<([Cursor; 3], Values)>,
    /// As it was before it was cleared.
    log: Edits,
}

impl Beside {
    fn new(mesh: &Mesh, random: &mut Random) -> Beside {
        let plain = any_values(mesh, random);
        let point = |v: &Value| [v[0], v[1], 0.0];
        let mut beside = Beside {
            lists: (
                PerVertex::new(plain.vertices.clone()),
                PerCorner::new(plain.corners.clone()),
            ),
            positions: Positions::new(plain.vertices.iter().map(point)).expect("finite"),
            plain,
            own: None,
            log: Edits::new(),
        };
        beside.replay();
        beside
    }

    fn replay(&mut self) {
        let log = &self.log;
        let (vertices, corners) = &mut self.lists;
        log.replay(&mut ((vertices, corners), &mut self.positions));
        let (vertices, corners) = &self.lists;
        assert_eq!(vertices.as_slice(), self.plain.vertices, "vertices");
        assert_eq!(corners.as_slice(), self.plain.corners, "corners");
        let points = self.positions.as_slice().iter().map(|p| [p.x, p.y]);
        assert!(points.eq(self.plain.vertices.iter().copied()), "positions");
        if let Some(([vertices, corners, faces], own)) = &mut self.own {
            log.since(*vertices)
                .for_each(|edit| edit.apply_to_indices(&mut own.indices));
            log.replay_vertices(vertices, &mut own.vertices, mixed);
            log.replay_corners(corners, &mut own.corners, mixed);
            log.replay_faces(faces, &mut own.faces);
            assert_eq!(*own, self.plain, "lists of somebody else");
        }
    }
}

/// Splits, insertions, of these on torn edges, merges and slides of a log.
fn kinds<'e>(mesh: &Mesh, edits: impl Iterator<Item = Edit<'e>>) -> [usize; 5] {
    let mut kinds = [0; 5];
    for edit in edits {
        match edit {
            Edit::Split(_) => kinds[0] += 1,
            Edit::Insert(insert) => {
                kinds[1] += 1;
                let on_edge = insert.points.iter().filter(|point| {
                    let is_copy = mesh.root(point.vertex) != point.vertex;
                    is_copy && matches!(point.at, Mix::Between { .. })
                });
                kinds[2] += on_edge.count().min(1);
            }
            Edit::Merge(_) => kinds[3] += 1,
            Edit::Slide(_) => kinds[4] += 1,
            _ => unreachable!("there is no other edit"),
        }
    }
    kinds
}

#[test]
fn followers_keep_what_the_records_say_bit_for_bit() {
    let (mut counts, mut cases) = ([0; 5], 0);
    for script in scripts() {
        cases += 1;
        let mut random = Random(cases);
        let mut beside = None;
        let world = script.run(|world: &World, step: &Step<'_>| {
            let beside = beside.get_or_insert_with(|| Beside::new(&world.mesh, &mut random));
            if *step == Step::Cleared {
                beside.replay();
            }
            let seen = beside.log.cursor();
            world
                .edits
                .since(seen)
                .for_each(|edit| beside.plain.follow(&edit));
            let new = kinds(&world.mesh, world.edits.since(seen));
            counts = std::array::from_fn(|i| counts[i] + new[i]);
            beside.log = world.edits.clone();
            if random.below(4) == 0 {
                beside.replay();
            }
            if random.below(16) == 0 {
                beside.own = Some(([world.edits.cursor(); 3], beside.plain.clone()));
            }
        });
        let mut beside = beside.expect("the mesh is built first");
        beside.replay();
        assert_eq!(beside.plain.indices, world.mesh.indices());
    }
    let least = cases as usize / 4;
    assert!(counts.iter().all(|&count| count > least), "{counts:?}");
}

/// The hub of a fan is split by a face.
fn split_off(mesh: &mut Mesh, face: usize, edits: &mut Edits) {
    let hub = mesh.vertex(0);
    let face = mesh.face(face);
    split::vertex(mesh, hub, &[face], edits).expect("others stay");
}

/// A fan whose hub is split by these faces, one after the other.
fn splits_of(faces: &[usize]) -> (Mesh, Edits) {
    let (mut mesh, mut edits) = (shapes::fan(5, true).0, Edits::new());
    for &face in faces {
        split_off(&mut mesh, face, &mut edits);
    }
    (mesh, edits)
}

/// Values of the fan before any split.
fn ones() -> PerVertex<f64> {
    PerVertex::new(vec![1.0; 6])
}

#[test]
fn a_follower_that_is_not_in_step_is_told_why() {
    let (_, edits) = splits_of(&[0, 1, 2]);
    let mut seen = ones();
    edits.replay(&mut seen);
    let mut cleared = edits.clone();
    cleared.clear();
    let (_, others) = splits_of(&[4, 1, 2]);
    let (_, more_of_others) = splits_of(&[4, 1, 2, 3]);
    let late = "late: this follower has seen 0 edits";
    let ahead = "ahead: this follower has seen 3 edits, and there are 0";
    let foreign = "foreign: this follower has seen 3 edits, which are not";
    for (why, log, values) in [
        (late, &cleared, &ones()),
        (ahead, &Edits::new(), &seen),
        (foreign, &others, &seen),
        ("foreign: ", &more_of_others, &seen),
    ] {
        let mut follower = values.clone();
        let told = panic_of(|| log.replay(&mut follower)).expect("a panic");
        assert!(told.starts_with(why), "{told}");
        assert!(why != late || told.contains("starting_at(edits.cursor())"));
        assert_eq!(follower, *values, "nothing was taken in");
    }
    // A record is shown out of turn.
    let (mesh, edits) = splits_of(&[0, 1, 2, 3]);
    let record = edits.iter().next_back().expect("a record");
    let (grid, places) = shapes::grid(1, 1);
    let mut masses = Masses::area(&grid, &places, 1.0).expect("an area");
    let told = panic_of(|| record.pass_on(&mut masses)).expect("a panic");
    assert!(told.contains("has seen 0 edits was shown edit 3"), "{told}");
    // Who is in step is shown one after another, or sees just what is new.
    let mut shown = ones();
    edits.iter().for_each(|record| record.pass_on(&mut shown));
    assert_eq!(*shown.cursor(), edits.cursor());
    edits.replay(&mut seen);
    let counts = (seen.as_slice().len(), *seen.cursor());
    assert_eq!(counts, (mesh.vertex_count(), edits.cursor()));
}

#[test]
fn a_place_in_a_log_survives_clearing() {
    let (mut mesh, mut edits) = splits_of(&[0, 1, 2]);
    let place = edits.cursor();
    assert_eq!(place.number(), 3);
    // Of this sequence of edits, on every machine.
    let hash = 0xe3b1_7fff_d353_e395_u64;
    assert_eq!(
        format!("{place:?}"),
        format!("Cursor {{ number: 3, hash: {hash} }}")
    );
    let mut values = ones();
    edits.replay(&mut values);
    edits.clear();
    assert_eq!(edits.cursor(), place);
    // A session goes on where another one ended.
    let mut resumed = Edits::starting_at(place);
    let mut values = PerVertex::new(values.as_slice().to_vec()).starting_at(place);
    let mut again = mesh.clone();
    for (mesh, edits) in [(&mut mesh, &mut edits), (&mut again, &mut resumed)] {
        split_off(mesh, 3, edits);
    }
    assert_eq!(resumed.cursor(), edits.cursor());
    resumed.replay(&mut values);
    assert_eq!(values.as_slice().len(), mesh.vertex_count());
}

/// Every part of a record that says something makes another log of it.
#[test]
fn logs_that_differ_in_one_record_have_different_cursors() {
    let mut cursors: Vec<Cursor> = Vec::new();
    for operation in [
        "",
        "split 4 0b1",
        "split 4 0b10",
        "split 1 0b1",
        "insert 0 edge 0 32",
        "insert 0 edge 0 16",
        "insert 1 edge 0 32",
        "insert 3 face 0 1 2 1",
        "insert 3 face 0 1 1 2",
        "insert 3 face 0 3 4 1",
        "insert 0 edge 0 32 edge 1 32 edge 2 32 chord 3 4",
        "insert 0 edge 0 32 edge 1 32 edge 2 32 chord 4 5",
        "slide any 0 1 32",
        "slide any 0 1 16",
        "slide any 1 0 16",
    ] {
        let script: Script = format!("grid 2 2 0\n{operation}")
            .parse()
            .expect("a script");
        let edits = script.run(|_, _| {}).edits;
        assert_eq!(edits.is_empty(), operation.is_empty());
        let cursor = edits.cursor();
        assert!(!cursors.contains(&cursor), "{operation}");
        cursors.push(cursor);
    }
}

#[test]
fn a_value_that_is_not_mixed_comes_from_the_nearest_source() {
    let of = [7, 8, 9];
    let between = |t| Mix::Between { ends: [3, 4], t }.nearest();
    assert_eq!([0.0, 0.5, 0.51].map(between), [3, 3, 4]);
    for (weights, nearest) in [
        ([0.25, 0.5, 0.25], 8),
        ([0.4, 0.4, 0.2], 7),
        ([0.2, 0.4, 0.4], 8),
        ([0.2, 0.2, 0.6], 9),
    ] {
        assert_eq!(Mix::Weighted { of, weights }.nearest(), nearest);
    }
    let (ends, t) = ([&2.0, &4.0], 0.25);
    assert_eq!(f64::blend(Mix::Between { ends, t }), 2.5);
}

#[test]
fn lists_of_the_wrong_length_are_refused_by_every_edit() {
    let script = "fan 5\nslide any 0 1 16\nsplit 0 0b10\nmerge any 0 6 1 1\ninsert 3 face 0 1 1 1";
    let script: Script = script.parse().expect("a script");
    let mut before: Option<World> = None;
    script.run(|world, step| {
        let Some(before) = before.replace(world.clone()) else {
            return;
        };
        let (edits, start) = (&world.edits, before.edits.cursor());
        assert_eq!(edits.since(start).count(), 1, "{step:?}");
        let [vertices, faces] = [before.mesh.vertex_count(), before.mesh.face_count()];
        type Replay<'e> = &'e dyn Fn(&mut Cursor, &mut Vec<u32>);
        let replays: [(usize, Replay<'_>); 3] = [
            (vertices, &|seen, list| {
                edits.replay_vertices(seen, list, |mix| *mix.nearest());
            }),
            (3 * faces, &|seen, list| {
                edits.replay_corners(seen, list, |mix| *mix.nearest());
            }),
            (faces, &|seen, list| edits.replay_faces(seen, list)),
        ];
        for (right, replay) in replays {
            for length in [right - 1, right + 1, right] {
                let (mut seen, mut list) = (start, vec![0; length]);
                let refused = panic_of(|| replay(&mut seen, &mut list)).is_some();
                assert_eq!(refused, length != right, "{step:?}: {length}");
                let stays = (seen, list.len()) == (start, length);
                assert!(stays || length == right, "{step:?}");
            }
        }
    });
}

/// The first vertex of a row of squares slides a quarter of the way to the second.
fn slide_once(mesh: &mut Mesh, edits: &mut Edits) {
    let [first, second] = [0, 1].map(|v| mesh.vertex(v));
    slide::toward(mesh, first, second, 0.25, edits).expect("an edge");
}

/// Two squares after that, and its log.
fn slid() -> (Mesh, Edits) {
    let (mut mesh, mut edits) = (shapes::grid(2, 1).0, Edits::new());
    slide_once(&mut mesh, &mut edits);
    (mesh, edits)
}

/// Of a slide their number does not tell when they were made.
#[test]
fn values_made_after_a_slide_do_not_slide_again() {
    let (mesh, edits) = slid();
    let points = vec![[0.0; 3]; mesh.vertex_count()];
    let corners = vec![0.0; mesh.half_edge_count()];
    let mut positions = Positions::new(points).expect("finite");
    let mut vertices = PerVertex::new(vec![0.0; mesh.vertex_count()]);
    let mut of_corners = PerCorner::new(corners.clone());
    let mut buffers = DrawBuffers::new(&mesh, corners);
    for told in [
        panic_of(|| edits.replay(&mut positions)),
        panic_of(|| edits.replay(&mut vertices)),
        panic_of(|| edits.replay(&mut of_corners)),
        panic_of(|| edits.replay(&mut buffers)),
    ] {
        let told = told.expect("a new follower of a log with a slide is refused");
        assert!(told.starts_with("new: this follower"), "{told}");
    }
    let mut now = vertices.clone().starting_at(edits.cursor());
    edits.replay(&mut now);
    assert_eq!(now.as_slice(), vertices.as_slice());
    // Who was there before says so, or has replayed the log when it was empty.
    let mut said = PerVertex::new(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).starting_at(Cursor::START);
    let mut there = PerVertex::new(said.as_slice().to_vec());
    Edits::new().replay(&mut there);
    edits.replay(&mut (&mut said, &mut there));
    for before in [said, there] {
        assert_eq!(before.as_slice()[..2], [0.25, 1.0]);
    }
}

/// Of a mesh that was slid before: its log begins anew, its followers do not.
#[test]
fn a_slide_in_a_new_log_is_not_taken_for_an_equal_one() {
    let (mut mesh, edits) = slid();
    let mut values = PerVertex::new(vec![0.0, 1.0, 2.0, 3.0, 4.0, 5.0]).starting_at(Cursor::START);
    edits.replay(&mut values);
    let mut others = Edits::new();
    slide_once(&mut mesh, &mut others);
    let told = panic_of(|| others.replay(&mut values)).expect("a panic");
    assert!(told.starts_with("foreign: "), "{told}");
    // A log that goes on does.
    let mut more = Edits::starting_at(edits.cursor());
    slide_once(&mut mesh, &mut more);
    more.replay(&mut values);
    assert_eq!(values.as_slice()[0], 0.25 + 0.75 * 0.25);
}

/// Panics at a call, and follows else.
struct Fails(PerVertex<f64>, usize);

impl Follower for Fails {
    fn cursor(&mut self) -> &mut Cursor {
        self.0.cursor()
    }
    fn follow(&mut self, edit: &Edit<'_>) {
        self.1 += 1;
        assert!(self.1 != 2, "{}", "a follower fails");
        self.0.follow(edit);
    }
}

/// A value of another crate, which knows nothing of this one: neither `Blend` nor `Clone`.
struct Foreign(f64);

/// What panics half way may have changed some values and not others: that is told, not guessed.
#[test]
fn after_a_panic_half_way_the_next_replay_says_so() {
    let (_, edits) = splits_of(&[0, 1, 2]);
    let mut seen = Cursor::START;
    let mut list: Vec<Foreign> = [1.0; 6].map(Foreign).into();
    let nearest = |mix: Mix<&Foreign>| Foreign(mix.nearest().0);
    let mut calls = 0;
    let mix = |mix: Mix<&Foreign>| {
        calls += 1;
        assert!(calls < 2, "{}", "a mix fails");
        nearest(mix)
    };
    let mut told = vec![
        panic_of(|| edits.replay_vertices(&mut seen, &mut list, mix)),
        panic_of(|| edits.replay_vertices(&mut seen, &mut list, nearest)),
    ];
    let first = edits.iter().next().expect("three splits");
    for of_record in [false, true] {
        let mut fails = Fails(ones(), usize::from(of_record));
        told.push(panic_of(|| match of_record {
            true => first.pass_on(&mut fails),
            false => edits.replay(&mut fails),
        }));
        told.push(panic_of(|| edits.replay(&mut fails.0)));
    }
    let told: Vec<String> = told
        .into_iter()
        .map(|told| told.expect("a panic"))
        .collect();
    for (panic, again) in ["a mix fails", "a follower fails", "a follower fails"]
        .iter()
        .zip(told.chunks(2))
    {
        assert_eq!(again[0], *panic);
        assert!(again[1].starts_with("half way: "), "{}", again[1]);
    }
}
