//! Followers by the normal form of edits keep, bit for bit, what a plain reading of the records
//! gives, through all four kinds of edit, seams of texture and torn edges; and a follower that is
//! not in step is told what is wrong with it.

mod values;

use std::panic::{AssertUnwindSafe, catch_unwind};

use tearmesh::insert::Plan;
use tearmesh::{
    Blend, Cursor, DrawBuffers, Edit, Edits, FaceId, Follower, HalfEdgeId, Masses, Mesh, Mix,
    PerCorner, PerFace, PerVertex, Positions, VertexId, mend, shapes, slide, split,
};

use crate::cases::cases;
use crate::random::Random;
use values::{Value, Values};

/// How many sequences of edits there are, unless `TEARMESH_CASES` says otherwise.
const CASES: u64 = 100_000;

fn vertex(index: usize) -> VertexId {
    VertexId::new(index).expect("I1: ids fit")
}

fn face(index: usize) -> FaceId {
    FaceId::new(index).expect("I1: ids fit")
}

fn half_edge(index: usize) -> HalfEdgeId {
    HalfEdgeId::new(index).expect("I1: ids fit")
}

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
            return half_edge(self.random.below(self.mesh.half_edge_count()));
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
        let mut faces: Vec<FaceId> = self.mesh.faces_of(v).collect();
        let mask = self.random.below(1 << faces.len().min(10));
        let mut bit = 0..;
        faces.retain(|_| bit.next().is_some_and(|i: usize| mask >> (i % 10) & 1 == 1));
        let done = split::vertex(&mut self.mesh, v, &faces, &mut self.edits).is_ok();
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
        slide::toward(&mut self.mesh, v, w, t, &mut self.edits).expect("an edge");
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

/// A value of another crate, which knows nothing of this one: neither `Blend` nor `Clone`.
#[derive(Debug, PartialEq)]
struct Foreign(Value);

impl Foreign {
    fn all(values: &[Value]) -> Vec<Foreign> {
        values.iter().map(|&value| Foreign(value)).collect()
    }

    fn mixed(mix: Mix<&Foreign>) -> Foreign {
        Foreign(match mix {
            Mix::Copy(one) => one.0,
            Mix::Between { ends: [a, b], t } => values::between(a.0, b.0, t),
            Mix::Weighted { of, weights } => values::weighted(of.map(|one| one.0), weights),
        })
    }
}

/// Lists of another crate, each with its own place in the log.
struct ForeignLists {
    vertices: (Cursor, Vec<Foreign>),
    corners: (Cursor, Vec<Foreign>),
    faces: (Cursor, Vec<u16>),
    indices: (Cursor, Vec<u32>),
}

impl ForeignLists {
    fn of(values: &Values, seen: Cursor) -> ForeignLists {
        ForeignLists {
            vertices: (seen, Foreign::all(&values.vertices)),
            corners: (seen, Foreign::all(&values.corners)),
            faces: (seen, values.faces.clone()),
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
        assert_eq!(self.vertices.1, Foreign::all(&values.vertices), "{seed}");
        assert_eq!(self.corners.1, Foreign::all(&values.corners), "{seed}");
        assert_eq!(self.faces.1, values.faces, "seed {seed}: faces");
        assert_eq!(self.indices.1, values.indices, "seed {seed}: indices");
    }
}

#[test]
fn followers_by_the_normal_form_keep_what_the_records_say() {
    let mut counts = [0; 5];
    let cases = cases(CASES);
    for seed in 0..cases {
        let mut work = Work::new(seed);
        let mut plain = work.values();
        let point = |v: &Value| [v[0], v[1], 0.0];
        let mut positions = Positions::new(plain.vertices.iter().map(point)).expect("finite");
        let mut vertices = PerVertex::new(plain.vertices.clone());
        let mut corners = PerCorner::new(plain.corners.clone());
        let mut faces = PerFace::new(plain.faces.clone());
        let ours = (&mut vertices, &mut corners, &mut faces);
        work.edits.replay(&mut (ours, &mut positions));
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
                let mut points = positions.as_slice().iter().zip(&plain.vertices);
                let is_same = points.all(|(p, v)| [p.x, p.y] == *v);
                assert!(is_same, "seed {seed}: positions");
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
        counts = std::array::from_fn(|i| counts[i] + work.counts[i]);
    }
    let is_enough = counts.iter().all(|&count| count as u64 > cases / 4);
    assert!(
        is_enough,
        "splits, insertions, torn, merges, slides: {counts:?}"
    );
}

/// The hub of a fan is split by these faces, one after the other.
fn splits_of(faces: &[usize]) -> (Mesh, Edits) {
    let (mut mesh, mut edits) = (shapes::fan(5, true).0, Edits::new());
    for &f in faces {
        split::vertex(&mut mesh, vertex(0), &[face(f)], &mut edits).expect("others stay");
    }
    (mesh, edits)
}

/// Values of the fan before any split.
fn ones() -> PerVertex<f64> {
    PerVertex::new(vec![1.0; 6])
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
        let told = panic_of(|| log.replay(&mut follower));
        assert!(told.starts_with(why), "{told}");
        assert!(why != late || told.contains("starting_at(edits.cursor())"));
        assert_eq!(follower, *values, "nothing was taken in");
    }
    // A record is shown out of turn.
    let (mesh, edits) = splits_of(&[0, 1, 2, 3]);
    let record = edits.iter().next_back().expect("a record");
    let (grid, places) = shapes::grid(1, 1);
    let mut masses = Masses::area(&grid, &places, 1.0).expect("an area");
    let told = panic_of(|| record.pass_on(&mut masses));
    assert!(told.contains("has seen 0 edits was shown edit 3"), "{told}");
    // Who is in step sees just what is new.
    edits.replay(&mut seen);
    let counts = (seen.as_slice().len(), seen.seen());
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
        split::vertex(mesh, vertex(0), &[face(3)], edits).expect("one stays");
    }
    assert_eq!(resumed.cursor(), edits.cursor());
    resumed.replay(&mut values);
    assert_eq!(values.as_slice().len(), mesh.vertex_count());
}

/// Every part of a record that says something makes another log of it.
#[test]
fn logs_that_differ_in_one_record_have_different_cursors() {
    let on_edge = |mesh: &mut Mesh, edits: &mut Edits, h: usize, t: f64| {
        let mut plan = Plan::new();
        plan.on_edge(half_edge(h), t);
        plan.apply(mesh, edits).expect("an edge");
    };
    let split = |mesh: &mut Mesh, edits: &mut Edits, nth: usize| {
        let is_shared = |h: &HalfEdgeId| mesh.faces_of(mesh.origin(*h)).count() > 1;
        let h = mesh.half_edges().filter(is_shared).nth(nth);
        let h = h.expect("a corner");
        split::vertex(mesh, mesh.origin(h), &[h.face()], edits).expect("others stay");
    };
    let slide = |mesh: &mut Mesh, edits: &mut Edits, [v, w]: [usize; 2], t: f64| {
        slide::toward(mesh, vertex(v), vertex(w), t, edits).expect("an edge");
    };
    type Make<'m> = &'m dyn Fn(&mut Mesh, &mut Edits);
    let logs: [Make<'_>; 10] = [
        &|_, _| {},
        &|mesh, edits| split(mesh, edits, 0),
        &|mesh, edits| split(mesh, edits, 1),
        &|mesh, edits| split(mesh, edits, 2),
        &|mesh, edits| on_edge(mesh, edits, 0, 0.5),
        &|mesh, edits| on_edge(mesh, edits, 0, 0.25),
        &|mesh, edits| on_edge(mesh, edits, 1, 0.5),
        &|mesh, edits| slide(mesh, edits, [0, 1], 0.5),
        &|mesh, edits| slide(mesh, edits, [0, 1], 0.25),
        &|mesh, edits| slide(mesh, edits, [1, 0], 0.25),
    ];
    let mut cursors: Vec<Cursor> = Vec::new();
    for make in logs {
        let (mut mesh, mut edits) = (shapes::grid(2, 2).0, Edits::new());
        make(&mut mesh, &mut edits);
        assert!(!cursors.contains(&edits.cursor()), "log {}", cursors.len());
        cursors.push(edits.cursor());
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
fn families_of_faces_are_named_by_their_parent() {
    let mut work = Work::new(3);
    let mut plan = Plan::new();
    plan.on_edge(half_edge(2), 0.5);
    plan.apply(&mut work.mesh, &mut work.edits)
        .expect("an edge");
    let edit: Edit<'_> = work.edits.iter().next().expect("a record");
    assert!(edit.families().count() > 0);
    for family in edit.families() {
        assert_eq!(family.children()[0].face, family.parent());
        assert!(family.children().len() > 1);
        for child in family.children() {
            let sources = child.sources;
            let faces = sources.map(|mix| mix.map(HalfEdgeId::face).nearest());
            assert_eq!(faces, [family.parent(); 3]);
        }
    }
}

/// A log with one record for each kind of edit, and the numbers of vertices and faces before that.
fn one_edit_of_each_kind() -> Vec<(Edits, [usize; 2])> {
    let mut mesh = shapes::fan(5, true).0;
    let mut edits = Edits::new();
    type Act<'a> = &'a dyn Fn(&mut Mesh, &mut Edits);
    let acts: [Act<'_>; 4] = [
        &|mesh, edits| {
            slide::toward(mesh, vertex(0), vertex(1), 0.25, edits).expect("an edge");
        },
        &|mesh, edits| {
            split::vertex(mesh, vertex(0), &[face(1)], edits).expect("others stay");
        },
        &|mesh, edits| {
            mend::merge(mesh, vertex(0), vertex(6), [1.0; 2], edits).expect("copies");
        },
        &|mesh, edits| {
            let mut plan = Plan::new();
            plan.in_face(face(1), [1.0; 3]);
            plan.apply(mesh, edits).expect("a point");
        },
    ];
    let log = |act: Act<'_>| {
        let size = [mesh.vertex_count(), mesh.face_count()];
        edits.clear();
        act(&mut mesh, &mut edits);
        assert_eq!(edits.len(), 1);
        (edits.clone(), size)
    };
    acts.map(log).to_vec()
}

#[test]
fn lists_of_the_wrong_length_are_refused_by_every_edit() {
    for (edits, [vertices, faces]) in one_edit_of_each_kind() {
        let edit = edits.iter().next().expect("one edit");
        let start = edit.before();
        type Replay<'e> = &'e dyn Fn(&mut Cursor, &mut Vec<u32>);
        let replays: [(usize, Replay<'_>); 4] = [
            (vertices, &|seen, list| {
                edits.replay_vertices(seen, list, |mix| *mix.nearest());
            }),
            (3 * faces, &|seen, list| {
                edits.replay_corners(seen, list, |mix| *mix.nearest());
            }),
            (faces, &|seen, list| edits.replay_faces(seen, list)),
            (3 * faces, &|seen, list| edits.replay_indices(seen, list)),
        ];
        for (right, replay) in replays {
            for length in [right - 1, right + 1, right] {
                let (mut seen, mut list) = (start, vec![0; length]);
                let replayed = catch_unwind(AssertUnwindSafe(|| replay(&mut seen, &mut list)));
                assert_eq!(replayed.is_ok(), length == right, "{edit:?}: {length}");
                let stays = (seen, list.len()) == (start, length);
                assert!(length == right || stays, "{edit:?}");
            }
        }
    }
}

/// A row of two squares whose first vertex slides toward the second, and its log.
fn slid() -> (Mesh, Edits) {
    let (mut mesh, mut edits) = (shapes::grid(2, 1).0, Edits::new());
    slide::toward(&mut mesh, vertex(0), vertex(1), 0.25, &mut edits).expect("an edge");
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
    slide::toward(&mut mesh, vertex(0), vertex(1), 0.25, &mut others).expect("an edge");
    let told = panic_of(|| others.replay(&mut values));
    assert!(told.starts_with("foreign: "), "{told}");
    // A log that goes on does.
    let mut more = Edits::starting_at(edits.cursor());
    slide::toward(&mut mesh, vertex(0), vertex(1), 0.25, &mut more).expect("an edge");
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

/// What panics half way may have changed some values and not others: that is told, not guessed.
#[test]
fn after_a_panic_half_way_the_next_replay_says_so() {
    let (_, edits) = splits_of(&[0, 1, 2]);
    let (mut seen, mut list) = (Cursor::START, vec![1.0; 6]);
    let mut calls = 0;
    let mix = |mix: Mix<&f64>| {
        calls += 1;
        assert!(calls < 2, "{}", "a mix fails");
        *mix.nearest()
    };
    let told = panic_of(|| edits.replay_vertices(&mut seen, &mut list, mix));
    assert_eq!(told, "a mix fails");
    let again = panic_of(|| edits.replay_vertices(&mut seen, &mut list, |mix| *mix.nearest()));

    let mut fails = Fails(ones(), 0);
    let told = panic_of(|| edits.replay(&mut fails));
    assert_eq!(told, "a follower fails");
    let of_follower = panic_of(|| edits.replay(&mut fails));

    let first = edits.iter().next().expect("three splits");
    let mut fails = Fails(ones(), 1);
    let told = panic_of(|| first.pass_on(&mut fails));
    assert_eq!(told, "a follower fails");
    let of_record = panic_of(|| edits.replay(&mut fails.0));
    for told in [again, of_follower, of_record] {
        assert!(told.starts_with("half way: "), "{told}");
    }
}
