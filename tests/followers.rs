//! Followers by the normal form of edits keep, bit for bit, what a plain reading of the records
//! gives, through all four kinds of edit, seams of texture and torn edges; and a follower that is
//! not in step is told what is wrong with it.

mod values;

use std::panic::{AssertUnwindSafe, catch_unwind};

use tearmesh::insert::Plan;
use tearmesh::{
    Blend, Cursor, Edit, Edits, FaceId, Follower, HalfEdgeId, Masses, Mesh, Mix, PerCorner,
    PerFace, PerVertex, Positions, VertexId, mend, shapes, slide, split,
};

use crate::cases::cases;
use crate::random::Random;
use values::{Value, Values};

/// How many sequences of edits there are, unless `TEARMESH_CASES` says otherwise.
const CASES: u64 = 100_000;

/// A mesh that is split, divided, sewn and slid at random.
struct Work {
    mesh: Mesh,
    edits: Edits,
    random: Random,
    /// How many edits there were: splits, insertions, of these with a point on a torn edge, merges
    /// and slides.
    counts: [usize; 5],
}

impl Work {
    fn new(seed: u64) -> Work {
        let mut random = Random(seed);
        let size = 1 + random.below(3) as u32;
        let (mesh, _) = match seed % 5 {
            0 => shapes::fan(3 + size, seed.is_multiple_of(2)),
            1 => shapes::tube(3 + size, size),
            2 => shapes::octahedron(),
            _ => shapes::grid(size, 2),
        };
        Work {
            mesh,
            edits: Edits::new(),
            random,
            counts: [0; 5],
        }
    }

    fn half_edge(&mut self) -> HalfEdgeId {
        let torn = |&h: &HalfEdgeId| self.mesh.ghost_pair(h).is_some();
        let torn: Vec<HalfEdgeId> = self.mesh.half_edges().filter(torn).collect();
        if torn.is_empty() || self.random.next() < 0.5 {
            let h = self.random.below(self.mesh.half_edge_count());
            return HalfEdgeId::new(h).expect("I1: ids fit");
        }
        torn[self.random.below(torn.len())]
    }

    fn edit(&mut self) {
        match self.random.below(8) {
            0..=2 => self.split(),
            3 | 4 => self.insert(),
            5 => self.merge(),
            _ => self.slide(),
        }
    }

    fn split(&mut self) {
        let h = self.half_edge();
        let v = self.mesh.origin(h);
        let faces: Vec<FaceId> = self.mesh.faces_of(v).collect();
        let mask = self.random.below(1 << faces.len().min(10));
        let moving = (0..faces.len()).filter(|i| mask >> (i % 10) & 1 == 1);
        let moving: Vec<FaceId> = moving.map(|i| faces[i]).collect();
        let done = split::vertex(&mut self.mesh, v, &moving, &mut self.edits).is_ok();
        self.counts[0] += usize::from(done);
    }

    fn insert(&mut self) {
        if self.mesh.face_count() > 60 {
            return;
        }
        let mut plan = Plan::new();
        let mut on_torn = false;
        for _ in 0..=self.random.below(3) {
            let h = self.half_edge();
            if self.random.below(3) == 0 {
                let weights = [0; 3].map(|_| 0.1 + self.random.next());
                plan.in_face(h.face(), weights);
            } else {
                on_torn |= self.mesh.ghost_pair(h).is_some();
                plan.on_edge(h, 0.05 + 0.9 * self.random.next());
            }
        }
        if plan.apply(&mut self.mesh, &mut self.edits).is_ok() {
            self.counts[1] += 1;
            self.counts[2] += usize::from(on_torn);
        }
    }

    fn merge(&mut self) {
        let roots = self.mesh.roots();
        let v = self.random.below(roots.len());
        let copies = (0..roots.len()).filter(|&w| w != v && roots[w] == roots[v]);
        let copies: Vec<usize> = copies.collect();
        if let Some(&w) = copies.get(self.random.below(copies.len().max(1))) {
            let [v, w] = [v, w].map(vertex);
            let weights = [1.0 + self.random.next(), self.random.next()];
            let done = mend::merge(&mut self.mesh, v, w, weights, &mut self.edits).is_ok();
            self.counts[3] += usize::from(done);
        }
    }

    fn slide(&mut self) {
        let h = self.half_edge();
        let (v, w) = (self.mesh.origin(h), self.mesh.target(h));
        let t = 0.01 + 0.98 * self.random.next();
        slide::toward(&self.mesh, v, w, t, &mut self.edits).expect("an edge");
        self.counts[4] += 1;
    }

    /// A number that few others have, and corners of some vertices alike in all faces or on one
    /// side of a seam.
    fn values(&mut self) -> Values {
        let mut value = || [self.random.next(), self.random.next()];
        let vertices: Vec<Value> = self.mesh.vertices().map(|_| value()).collect();
        let sides: Vec<[Value; 2]> = vertices.iter().map(|&at| [at, value()]).collect();
        let side = |h: HalfEdgeId| {
            let v = self.mesh.origin(h).index();
            sides[v][(v + h.face().index()) % 3 / 2]
        };
        Values {
            corners: self.mesh.half_edges().map(side).collect(),
            faces: (0..self.mesh.face_count() as u16).collect(),
            indices: self.mesh.indices().to_vec(),
            vertices,
        }
    }
}

fn vertex(index: usize) -> VertexId {
    VertexId::new(index).expect("I1: ids fit")
}

/// A value of another crate, which knows nothing of this one: neither `Blend` nor `Clone`.
#[derive(Debug, PartialEq)]
struct Foreign(Value);

impl Foreign {
    fn mixed(mix: Mix<&Foreign>) -> Foreign {
        Foreign(match mix {
            Mix::Copy(one) => one.0,
            Mix::Between { ends: [a, b], t } => [0, 1].map(|i| a.0[i] - (a.0[i] - b.0[i]) * t),
            Mix::Weighted { of, weights } => [0, 1].map(|i| {
                of[0].0[i] * weights[0] + of[1].0[i] * weights[1] + of[2].0[i] * weights[2]
            }),
        })
    }
}

/// Lists of another crate, each with its own place in the log.
struct ForeignLists {
    vertices: (Cursor, Vec<Foreign>),
    corners: (Cursor, Vec<Foreign>),
    faces: (Cursor, Vec<String>),
    indices: (Cursor, Vec<u32>),
}

impl ForeignLists {
    fn of(values: &Values, seen: Cursor) -> ForeignLists {
        let foreign = |values: &[Value]| values.iter().map(|&value| Foreign(value)).collect();
        ForeignLists {
            vertices: (seen, foreign(&values.vertices)),
            corners: (seen, foreign(&values.corners)),
            faces: (seen, values.faces.iter().map(u16::to_string).collect()),
            indices: (seen, values.indices.clone()),
        }
    }

    fn replay(&mut self, edits: &Edits) {
        let (seen, values) = &mut self.vertices;
        edits.replay_vertices(seen, values, Foreign::mixed);
        let (seen, values) = &mut self.corners;
        edits.replay_corners(seen, values, Foreign::mixed);
        let (seen, values) = &mut self.faces;
        edits.replay_faces(seen, values);
        let (seen, indices) = &mut self.indices;
        edits.replay_indices(seen, indices);
    }

    fn assert_are(&self, values: &Values, seed: u64) {
        let same = |foreign: &[Foreign], own: &[Value]| {
            assert!(
                foreign.iter().map(|one| one.0).eq(own.iter().copied()),
                "seed {seed}"
            );
        };
        same(&self.vertices.1, &values.vertices);
        same(&self.corners.1, &values.corners);
        let faces = self.faces.1.iter().map(|face| face.parse().ok());
        assert!(
            faces.eq(values.faces.iter().copied().map(Some)),
            "seed {seed}: faces"
        );
        assert_eq!(self.indices.1, values.indices, "seed {seed}: indices");
    }
}

#[test]
fn followers_by_the_normal_form_keep_what_the_records_say() {
    let (mut counts, mut records) = ([0; 5], 0);
    let cases = cases(CASES);
    for seed in 0..cases {
        let mut work = Work::new(seed);
        let mut plain = work.values();
        let point = |v: &Value| [v[0], v[1], 0.0];
        let mut positions = Positions::new(plain.vertices.iter().map(point)).expect("finite");
        let mut vertices = PerVertex::new(plain.vertices.clone());
        let mut corners = PerCorner::new(plain.corners.clone());
        let mut faces = PerFace::new(plain.faces.clone());
        let (length, start) = (4 + work.random.below(28), work.random.below(28));
        let mut foreign = None;
        for step in 0..length {
            let before = work.edits.cursor();
            work.edit();
            for edit in work.edits.since(before) {
                plain.follow(&edit);
            }
            if work.random.below(4) == 0 || step + 1 == length {
                let ours = (&mut vertices, &mut corners, &mut faces);
                work.edits.replay(&mut (ours, &mut positions));
                assert_eq!(vertices.as_slice(), plain.vertices, "seed {seed}: vertices");
                assert_eq!(corners.as_slice(), plain.corners, "seed {seed}: corners");
                assert_eq!(faces.as_slice(), plain.faces, "seed {seed}: faces");
                let points = positions.as_slice().iter().map(|p| [p.x, p.y]);
                assert!(
                    points.eq(plain.vertices.iter().copied()),
                    "seed {seed}: positions"
                );
                if let Some(foreign) = &mut foreign {
                    ForeignLists::replay(foreign, &work.edits);
                    foreign.assert_are(&plain, seed);
                }
                if work.random.below(3) == 0 {
                    work.edits.clear();
                }
            }
            if step == start {
                foreign = Some(ForeignLists::of(&plain, work.edits.cursor()));
            }
        }
        assert_eq!(plain.indices, work.mesh.indices(), "seed {seed}");
        records += work.edits.cursor().number();
        for (sum, count) in counts.iter_mut().zip(work.counts) {
            *sum += count;
        }
    }
    println!(
        "{cases} sequences, {records} edits: {} splits, {} insertions, {} of them on torn edges, \
         {} merges, {} slides",
        counts[0], counts[1], counts[2], counts[3], counts[4]
    );
    assert!(
        counts.iter().all(|&count| count as u64 > cases / 4),
        "{counts:?}"
    );
}

/// Three splits of one vertex, and the values of a follower that has seen them.
fn three_splits() -> (Mesh, Edits, PerVertex<f64>) {
    let (mut mesh, _) = shapes::fan(5, true);
    let mut edits = Edits::new();
    let mut values = PerVertex::new(vec![1.0; mesh.vertex_count()]);
    for face in 0..3 {
        let face = FaceId::new(face).expect("small");
        split::vertex(&mut mesh, vertex(0), &[face], &mut edits).expect("others stay");
    }
    edits.replay(&mut values);
    (mesh, edits, values)
}

fn panic_of(act: impl FnOnce()) -> String {
    let panic = catch_unwind(AssertUnwindSafe(act)).expect_err("a panic");
    match panic.downcast::<String>() {
        Ok(words) => *words,
        Err(panic) => String::from(*panic.downcast::<&str>().expect("words")),
    }
}

#[test]
fn a_follower_that_is_not_in_step_is_told_why() {
    let (mut mesh, mut edits, seen) = three_splits();

    // One that comes to a log that was cleared before.
    let mut late = PerVertex::new(vec![1.0; mesh.vertex_count()]);
    edits.clear();
    let told = panic_of(|| edits.replay(&mut late));
    assert!(
        told.starts_with("late: this follower has seen 0 edits"),
        "{told}"
    );
    assert!(told.contains("starting_at(edits.cursor())"), "{told}");

    // One that has seen more than there is.
    let mut ahead = seen.clone();
    let told = panic_of(|| Edits::new().replay(&mut ahead));
    assert!(
        told.starts_with("ahead: this follower has seen 3 edits, and there are 0"),
        "{told}"
    );

    // One that has seen as many edits of another log, or more of them, or fewer: the same vertex was
    // split, and one other face went.
    let (mut other, mut others) = (shapes::fan(5, true).0, Edits::new());
    for face in [4, 1, 2] {
        let face = FaceId::new(face).expect("small");
        split::vertex(&mut other, vertex(0), &[face], &mut others).expect("others stay");
    }
    let mut foreign = seen.clone();
    let told = panic_of(|| others.replay(&mut foreign));
    assert!(
        told.starts_with("foreign: this follower has seen 3 edits, which are not"),
        "{told}"
    );
    let last = FaceId::new(3).expect("small");
    split::vertex(&mut other, vertex(0), &[last], &mut others).expect("one stays");
    let told = panic_of(|| others.replay(&mut foreign));
    assert!(told.starts_with("foreign: "), "{told}");
    assert_eq!(foreign, seen, "nothing was taken in");

    // One whose record is shown to it out of turn.
    split::vertex(&mut mesh, vertex(0), &[last], &mut edits).expect("one stays");
    let record = edits.iter().next().expect("a record");
    let (grid, places) = shapes::grid(1, 1);
    let mut masses = Masses::area(&grid, &places, 1.0).expect("an area");
    let told = panic_of(|| record.pass_on(&mut masses));
    assert!(told.contains("has seen 0 edits was shown edit 3"), "{told}");

    // And the one that is in step sees just what is new.
    let mut values = seen;
    edits.replay(&mut values);
    assert_eq!(
        (values.as_slice().len(), values.seen()),
        (mesh.vertex_count(), edits.cursor())
    );
}

#[test]
fn a_place_in_a_log_survives_saving_and_clearing_and_is_the_same_everywhere() {
    let (mut mesh, mut edits, values) = three_splits();
    let place = values.seen();
    assert_eq!(place.number(), 3);
    // Of this sequence of edits, on every machine.
    assert_eq!(
        format!("{:032x}", u128::from_be_bytes(place.to_bytes())),
        "0000000000000003e3b17fffd353e395"
    );
    assert_eq!(Cursor::from_bytes(place.to_bytes()), place);
    edits.clear();
    assert_eq!(edits.cursor(), place);

    // A session goes on where another one ended.
    let mut resumed = Edits::starting_at(Cursor::from_bytes(place.to_bytes()));
    let mut saved = PerVertex::new(values.as_slice().to_vec()).starting_at(place);
    let last = FaceId::new(3).expect("small");
    split::vertex(&mut mesh.clone(), vertex(0), &[last], &mut resumed).expect("one stays");
    split::vertex(&mut mesh, vertex(0), &[last], &mut edits).expect("one stays");
    assert_eq!(resumed.cursor(), edits.cursor());
    resumed.replay(&mut saved);
    assert_eq!(saved.as_slice().len(), mesh.vertex_count());
}

/// Every part of a record that says something makes another log of it.
#[test]
fn logs_that_differ_in_one_record_have_different_cursors() {
    type Make = fn(&mut Mesh, &mut Edits);
    fn on_edge(mesh: &mut Mesh, edits: &mut Edits, h: usize, t: f64) {
        let mut plan = Plan::new();
        plan.on_edge(HalfEdgeId::new(h).expect("small"), t);
        plan.apply(mesh, edits).expect("an edge");
    }
    fn split(mesh: &mut Mesh, edits: &mut Edits, nth: usize) {
        let is_shared = |h: &HalfEdgeId| mesh.faces_of(mesh.origin(*h)).count() > 1;
        let h = mesh
            .half_edges()
            .filter(is_shared)
            .nth(nth)
            .expect("a corner");
        split::vertex(mesh, mesh.origin(h), &[h.face()], edits).expect("others stay");
    }
    let logs: [Make; 10] = [
        |_, _| {},
        |mesh, edits| split(mesh, edits, 0),
        |mesh, edits| split(mesh, edits, 1),
        |mesh, edits| split(mesh, edits, 2),
        |mesh, edits| on_edge(mesh, edits, 0, 0.5),
        |mesh, edits| on_edge(mesh, edits, 0, 0.25),
        |mesh, edits| on_edge(mesh, edits, 1, 0.5),
        |mesh, edits| {
            slide::toward(mesh, vertex(0), vertex(1), 0.5, edits).expect("an edge");
        },
        |mesh, edits| {
            slide::toward(mesh, vertex(0), vertex(1), 0.25, edits).expect("an edge");
        },
        |mesh, edits| {
            slide::toward(mesh, vertex(1), vertex(0), 0.25, edits).expect("an edge");
        },
    ];
    let mut cursors: Vec<Cursor> = Vec::new();
    for make in logs {
        let (mut mesh, mut edits) = (shapes::grid(2, 2).0, Edits::new());
        make(&mut mesh, &mut edits);
        let same = cursors.iter().position(|&other| other == edits.cursor());
        assert_eq!(same, None, "log {}", cursors.len());
        cursors.push(edits.cursor());
    }
}

#[test]
fn every_value_goes_to_the_nearest_source_where_there_is_none_between() {
    let of = [7, 8, 9];
    let weighted = |weights| Mix::Weighted { of, weights }.nearest();
    assert_eq!(
        [0.0, 0.5].map(|t| Mix::Between { ends: [3, 4], t }.nearest()),
        [3, 3]
    );
    assert_eq!(
        Mix::Between {
            ends: [3, 4],
            t: 0.51
        }
        .nearest(),
        4
    );
    assert_eq!(
        [0.25, 0.5, 0.25].map(|_| weighted([0.25, 0.5, 0.25])),
        [8; 3]
    );
    assert_eq!(weighted([0.4, 0.4, 0.2]), 7);
    assert_eq!(weighted([0.2, 0.4, 0.4]), 8);
    assert_eq!(weighted([0.2, 0.2, 0.6]), 9);
    assert_eq!(
        f64::blend(Mix::Between {
            ends: [&2.0, &4.0],
            t: 0.25
        }),
        2.5
    );
}

/// The operations of an edit name what they are for.
#[test]
fn families_are_named_by_their_parent() {
    let mut work = Work::new(3);
    let mut plan = Plan::new();
    plan.on_edge(HalfEdgeId::new(2).expect("small"), 0.5);
    plan.apply(&mut work.mesh, &mut work.edits)
        .expect("an edge");
    let edit: Edit<'_> = work.edits.iter().next().expect("a record");
    for family in edit.families() {
        assert_eq!(family.children()[0].face, family.parent());
        assert!(family.children().len() > 1);
        for child in family.children() {
            let corners = child
                .corner_mixes()
                .map(|mix| mix.map(HalfEdgeId::face).nearest());
            assert_eq!(corners, [family.parent(); 3]);
        }
    }
    assert!(edit.families().count() > 0);
}

/// A log with one record for each kind of edit, the numbers of vertices and faces before that, and the
/// name of the kind.
fn one_edit_of_each_kind() -> Vec<(&'static str, Edits, [usize; 2])> {
    let mut logs = Vec::new();
    let face = FaceId::new(1).expect("small");
    let (mut mesh, _) = shapes::fan(5, true);
    let mut edits = Edits::new();
    let mut log = |name, mesh: &Mesh, act: &mut dyn FnMut(&mut Edits)| {
        let size = [mesh.vertex_count(), mesh.face_count()];
        edits.clear();
        act(&mut edits);
        assert_eq!(edits.len(), 1, "{name}");
        logs.push((name, edits.clone(), size));
    };
    let at = mesh.clone();
    log("slide", &at, &mut |edits| {
        slide::toward(&mesh, vertex(0), vertex(1), 0.25, edits).expect("an edge");
    });
    log("split", &at, &mut |edits| {
        split::vertex(&mut mesh, vertex(0), &[face], edits).expect("others stay");
    });
    let at = mesh.clone();
    log("merge", &at, &mut |edits| {
        mend::merge(&mut mesh, vertex(0), vertex(6), [1.0; 2], edits).expect("copies");
    });
    let at = mesh.clone();
    log("insertion", &at, &mut |edits| {
        let mut plan = Plan::new();
        plan.in_face(face, [1.0; 3]);
        plan.apply(&mut mesh, edits).expect("a point");
    });
    logs
}

#[test]
fn lists_of_the_wrong_length_are_refused_for_every_kind_of_edit() {
    for (name, edits, [vertices, faces]) in one_edit_of_each_kind() {
        let start = {
            let first = edits.iter().next().expect("one edit");
            first.before()
        };
        type Replay<'e> = &'e dyn Fn(&mut Cursor, &mut Vec<u32>);
        let replays: [(&str, usize, Replay<'_>); 4] = [
            ("vertices", vertices, &|seen, list| {
                edits.replay_vertices(seen, list, |mix| *mix.nearest());
            }),
            ("corners", 3 * faces, &|seen, list| {
                edits.replay_corners(seen, list, |mix| *mix.nearest());
            }),
            ("faces", faces, &|seen, list| edits.replay_faces(seen, list)),
            ("indices", 3 * faces, &|seen, list| {
                edits.replay_indices(seen, list);
            }),
        ];
        for (of, right, replay) in replays {
            for length in [right - 1, right + 1, right] {
                let (mut seen, mut list) = (start, vec![0; length]);
                let replayed = catch_unwind(AssertUnwindSafe(|| replay(&mut seen, &mut list)));
                assert_eq!(replayed.is_ok(), length == right, "{name}: {length} {of}");
                if length != right {
                    assert_eq!((seen, list.len()), (start, length), "{name}: {of} stay");
                }
            }
        }
    }
}

/// What panics half way may have changed some values and not others: that is told, not guessed.
#[test]
fn after_a_panic_half_way_the_next_replay_says_so() {
    let (_, edits, _) = three_splits();
    let (mut seen, mut list) = (Cursor::START, vec![1.0; 6]);
    let mut calls = 0;
    let mix = |mix: Mix<&f64>| {
        calls += 1;
        assert!(calls < 2, "{}", "a mix fails");
        *mix.nearest()
    };
    assert_eq!(
        panic_of(|| edits.replay_vertices(&mut seen, &mut list, mix)),
        "a mix fails"
    );
    let told = panic_of(|| edits.replay_vertices(&mut seen, &mut list, |mix| *mix.nearest()));
    assert!(told.starts_with("half way: "), "{told}");

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
    let mut fails = Fails(PerVertex::new(vec![1.0; 6]), 0);
    assert_eq!(panic_of(|| edits.replay(&mut fails)), "a follower fails");
    let told = panic_of(|| edits.replay(&mut fails));
    assert!(told.starts_with("half way: "), "{told}");
    let first = edits.iter().next().expect("three splits");
    let mut fails = Fails(PerVertex::new(vec![1.0; 6]), 1);
    assert_eq!(panic_of(|| first.pass_on(&mut fails)), "a follower fails");
    let told = panic_of(|| edits.replay(&mut fails.0));
    assert!(told.starts_with("half way: "), "{told}");
}
