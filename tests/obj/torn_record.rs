//! Torn and divided meshes through a file and back: splits, insertions and merges at random.

use std::collections::BTreeMap;
use std::path::Path;

use tearmesh::insert::Plan;
use tearmesh::{
    CutMethod, Edit, Edits, FaceId, HalfEdgeId, Mesh, Point, Positions, Ray, Scissor, Vector,
    VertexId, mend, split,
};
use tearmesh_obj::{Document, ReadError, Simplified, TornDocument};

use super::random::Random;
use super::{positions, read, rewritten, text};

/// A number from 0 to `bound` - 1.
/// A document under the scissors.
pub(crate) struct Work<'d> {
    pub(crate) mesh: Mesh,
    pub(crate) positions: Positions,
    pub(crate) torn: TornDocument<'d>,
    pub(crate) edits: Edits,
}

impl<'d> Work<'d> {
    pub(crate) fn on(document: &'d Document) -> Work<'d> {
        Work {
            mesh: document.mesh().unwrap_or_else(|error| panic!("{error}")),
            positions: positions(document),
            torn: TornDocument::new(document),
            edits: Edits::new(),
        }
    }

    fn follow(&mut self) {
        self.edits
            .replay(&mut (&mut self.positions, &mut self.torn));
    }

    /// Edits the mesh, and has the document follow.
    pub(crate) fn edit<T>(
        &mut self,
        edit: impl FnOnce(&mut Mesh, &mut Positions, &mut Edits) -> T,
    ) -> T {
        let done = edit(&mut self.mesh, &mut self.positions, &mut self.edits);
        self.follow();
        done
    }

    pub(crate) fn written(&self) -> Vec<u8> {
        let mut out = Vec::new();
        let done = self.torn.write(&self.mesh, &self.positions, &mut out);
        done.expect("memory can be written");
        out
    }

    fn vertex(&self, random: &mut Random) -> VertexId {
        VertexId::new(random.below(self.mesh.vertex_count())).expect("a vertex")
    }

    /// Some points on edges and in faces.
    fn insert(&mut self, random: &mut Random) {
        let mut plan = Plan::new();
        for _ in 0..=random.below(5) {
            if random.below(3) == 0 {
                let f = FaceId::new(random.below(self.mesh.face_count())).expect("a face");
                plan.in_face(f, [(); 3].map(|()| 0.1 + random.next()));
            } else {
                let h = random.below(self.mesh.half_edge_count());
                let h = HalfEdgeId::new(h).expect("a half-edge");
                plan.on_edge(h, 0.1 + 0.8 * random.next());
            }
        }
        let _crowded = plan.apply(&mut self.mesh, &mut self.edits);
        self.follow();
    }

    pub(crate) fn split(&mut self, random: &mut Random) {
        let v = self.vertex(random);
        let mut faces: Vec<FaceId> = self.mesh.faces_of(v).collect();
        faces.retain(|_| random.below(2) == 0);
        let _refused = split::vertex(&mut self.mesh, v, &faces, &mut self.edits);
        self.follow();
    }

    fn merge(&mut self, random: &mut Random) {
        let root = self.mesh.root(self.vertex(random));
        let of_root = |&v: &VertexId| self.mesh.root(v) == root;
        let copies: Vec<VertexId> = self.mesh.vertices().filter(of_root).collect();
        if copies.len() > 1 {
            let one = random.below(copies.len() - 1);
            let other = one + 1 + random.below(copies.len() - one - 1);
            let [one, other] = [copies[one], copies[other]];
            let merged = mend::merge(&mut self.mesh, one, other, [1.0, 1.0], &mut self.edits);
            merged.expect("both have one root");
            self.follow();
        }
    }

    pub(crate) fn tear(&mut self, random: &mut Random, steps: usize, merges: bool) {
        for _ in 0..steps {
            match random.below(6) {
                0 => self.insert(random),
                1 if merges => self.merge(random),
                _ => self.split(random),
            }
        }
    }

    /// Splits something, or merges it again.
    pub(crate) fn tear_only(&mut self, random: &mut Random) {
        match random.below(4) {
            0 => self.merge(random),
            _ => self.split(random),
        }
    }

    pub(crate) fn sew(&mut self, stitches: &[mend::Stitch]) {
        let all = |_| 1.0;
        mend::sew(
            &mut self.mesh,
            &self.positions,
            stitches,
            all,
            1e-9,
            &mut self.edits,
        )
        .expect("nothing moved");
        self.follow();
    }

    pub(crate) fn sew_all(&mut self) {
        self.sew(&mend::stitches(&self.mesh, |_| true));
    }

    /// For each vertex of the mesh, the one that it is in the mesh that is read again.
    fn numbers(&self) -> Vec<u32> {
        let mut numbers = vec![u32::MAX; self.mesh.vertex_count()];
        for (v, number) in self.torn.vertices_in_order().into_iter().zip(0..) {
            numbers[v.index()] = number;
        }
        numbers
    }

    /// The faces in the order of the file, with its vertices.
    fn faces(&self) -> Vec<[u32; 3]> {
        let (order, numbers) = (self.torn.faces_in_order(), self.numbers());
        let corners = |f| self.mesh.face_vertices(f).map(|v| numbers[v.index()]);
        order.into_iter().map(corners).collect()
    }

    /// For each vertex of the file, the first of those that have one root with it.
    fn roots(&self) -> Vec<u32> {
        let roots = self.mesh.roots();
        let order = self.torn.vertices_in_order();
        let root = |v: &VertexId| roots[v.index()];
        let first = |v: &VertexId| order.iter().position(|other| root(other) == root(v));
        let all = order.iter().map(|v| first(v).expect("itself") as u32);
        all.collect()
    }

    /// For each vertex of the file, the first of those that become one with it when the last cut is
    /// undone.
    fn joined(&self) -> Vec<u32> {
        let numbers = self.numbers();
        let mut first: Vec<u32> = (0..numbers.len() as u32).collect();
        for stitch in self.torn.stitches_of_last(1) {
            let [one, other] = [stitch.kept(), stitch.gone()].map(|v| numbers[v.index()] as usize);
            let (low, high) = (first[one].min(first[other]), first[one].max(first[other]));
            for number in &mut first {
                *number = if *number == high { low } else { *number };
            }
        }
        first
    }
}

/// What is simplified where nothing was edited.
fn unedited(simplified: Result<Simplified, ReadError>) -> Option<Document> {
    let Simplified {
        document,
        edited,
        slid_edited,
        ..
    } = simplified.expect("what we wrote can be read");
    assert_eq!((edited, slid_edited), (0, 0), "nothing was edited");
    document
}

/// The files of `tests/data`, and one where everything comes late.
pub(crate) fn files() -> Vec<(String, Vec<u8>)> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/data");
    let mut files = vec![("late".to_owned(), LATE.to_vec())];
    for name in ["flag", "quilt", "sheet", "sleeve"] {
        let bytes = std::fs::read(data.join(name).with_extension("obj"));
        files.push((name.to_owned(), bytes.expect("a fixture")));
    }
    files
}

/// Two objects, the second behind the faces of the first: all kinds of corners, extra numbers
/// and foreign statements.
const LATE: &[u8] = b"mtllib a.mtl\no a\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nnv 1\nv 0 1 0 0 0 1\n\
v 1 1 0 1 1 1\nvt 0\nvt 1 0.5\nvt 0.5 0.25 1\nvn 0 0 1\nvn 0 0.6 0.8\ng one two\nusemtl m\ns 1\n\
f 1/1/1 2/2/2 3/3/1\nf 3/3/1 2/2/2 4//1\no b\nv 5 0 0\nv 6 0 0 0.25\n# kept\nv 5 1 0\nv 6 1 0\n\
nl 4\nvt 7 7\nvn 1 0 0\ns off\nf 5/4/3 6/4/3 8/1/3 7/2/1\n# end\n";

/// Faces, roots and tears of a mesh that was written are those of the mesh that is read, but for the
/// numbers of vertices and faces.
pub(crate) fn assert_is_read_again(work: &Work<'_>, again: &Document, name: &str) {
    assert_eq!(again.triangles(), work.faces(), "{name}");
    let same = again.mesh();
    let same = same.unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(same.roots(), work.roots(), "{name}");
    assert!(same.check().is_empty(), "{name}");
    let torn = |mesh: &Mesh, faces: &[FaceId]| -> Vec<Option<usize>> {
        let mut place = vec![0; 3 * faces.len()];
        let corners = faces
            .iter()
            .flat_map(|f| [0, 1, 2].map(|corner| 3 * f.index() + corner));
        let corners: Vec<usize> = corners.collect();
        for (i, &h) in corners.iter().enumerate() {
            place[h] = i;
        }
        let half_edges = corners.iter().filter_map(|&h| HalfEdgeId::new(h));
        let ghosts = half_edges.map(|h| mesh.ghost_pair(h).map(|ghost| place[ghost.index()]));
        ghosts.collect()
    };
    let faces: Vec<FaceId> = same.faces().collect();
    let [is, was] = [
        torn(&same, &faces),
        torn(&work.mesh, &work.torn.faces_in_order()),
    ];
    assert_eq!(is, was, "{name}");
}

/// What must hold of a mesh that is written, read and written again.
fn survives(work: &Work<'_>, name: &str) -> Vec<u8> {
    let written = work.written();
    let again = read(&written);
    assert_eq!(
        again.diagnostics().len(),
        work.torn.document().diagnostics().len() - quads(work),
        "{name}"
    );
    assert_is_read_again(work, &again, name);
    let in_order = work.torn.vertices_in_order().into_iter();
    let places: Vec<Point> = in_order.map(|v| work.positions.at(v)).collect();
    assert_eq!(again.positions(), places, "{name}");
    assert_eq!(text(&rewritten(&written)), text(&written), "{name}");
    let followed = Work::on(&again);
    assert_eq!(followed.torn.cuts(), work.torn.cuts(), "{name}");
    assert_eq!(followed.joined(), work.joined(), "{name}");
    assert_eq!(text(&followed.written()), text(&written), "{name}");
    written
}

/// The warning of quads, of which none is left when a document is written.
fn quads(work: &Work<'_>) -> usize {
    let diagnostics = work.torn.document().diagnostics().iter();
    diagnostics.filter(|one| one.code == "W-OBJ-QUAD").count()
}

#[test]
fn random_edits_survive_a_file_and_compose_with_those_before() {
    for (name, bytes) in files() {
        for seed in 0..if name == "late" { 60 } else { 6 } {
            let mut random = Random(seed);
            let mut bytes = bytes.clone();
            // Each file is cut again: its record is read, extended and written.
            for round in 0..3 {
                let name = format!("{name}, seed {seed}, round {round}");
                let document = read(&bytes);
                let mut work = Work::on(&document);
                for _ in 0..3 {
                    work.tear(&mut random, 12, true);
                    work.torn.next_cut();
                }
                assert!(work.mesh.check().is_empty(), "{name}");
                bytes = survives(&work, &name);
            }
        }
    }
}

#[test]
fn mending_cuts_gives_back_what_was_written_before_them() {
    for (name, bytes) in files() {
        for seed in 0..4 {
            let mut random = Random(100 + seed);
            let name = format!("{name}, seed {seed}");
            let document = read(&bytes);
            let mut work = Work::on(&document);
            let mut before = Vec::new();
            for _ in 0..3 {
                before.push(text(&work.written()));
                let vertices = work.mesh.vertex_count();
                while work.mesh.vertex_count()
                    < vertices + if name.starts_with("late") { 1 } else { 6 }
                {
                    work.split(&mut random);
                }
                work.torn.next_cut();
            }
            let file = work.written();
            let mut later = read(&file);
            for state in before.iter().rev() {
                work.sew(&work.torn.stitches_of_last(1));
                assert_eq!(&text(&work.written()), state, "{name}");
                // The same by way of the file.
                let file = {
                    let mut work = Work::on(&later);
                    work.sew(&work.torn.stitches_of_last(1));
                    work.written()
                };
                assert_eq!(&text(&file), state, "{name}, by way of a file");
                later = read(&file);
            }
            assert!(!text(&work.written()).contains("#tearmesh"), "{name}");
        }
    }
}

#[test]
fn mending_and_simplifying_gives_back_the_mesh_before_the_cut() {
    for (name, bytes) in files() {
        let uncut = text(&rewritten(&bytes));
        for seed in 0..if name == "late" { 100 } else { 6 } {
            let mut random = Random(200 + seed);
            let name = format!("{name}, seed {seed}");
            let document = read(&bytes);
            let mut work = Work::on(&document);
            for _ in 0..2 {
                work.tear(&mut random, 10, true);
                work.torn.next_cut();
            }
            let file = work.written();
            work.sew_all();
            let simple = work.torn.simplified(&work.mesh, &work.positions);
            let simple = unedited(simple);
            let bytes = simple.map_or_else(|| work.written(), |simple| Work::on(&simple).written());
            assert_eq!(text(&bytes), uncut, "{name}");

            let again = read(&file);
            let mut work = Work::on(&again);
            work.sew_all();
            let simple = work.torn.simplified(&work.mesh, &work.positions);
            let simple = unedited(simple);
            let bytes = simple.map_or_else(|| work.written(), |simple| Work::on(&simple).written());
            assert_eq!(text(&bytes), uncut, "{name}, by way of a file");
        }
    }
}

/// What is still open stays, and everything round it that is not may go.
#[test]
fn a_part_is_simplified_and_the_rest_still_can_be() {
    let mut parts = 0;
    for (name, bytes) in files() {
        let uncut = text(&rewritten(&bytes));
        for seed in 0..20 {
            let mut random = Random(300 + seed);
            let document = read(&bytes);
            let mut work = Work::on(&document);
            work.tear(&mut random, 30, false);
            let chosen: Vec<bool> = work.mesh.vertices().map(|_| random.below(3) > 0).collect();
            work.sew(&mend::stitches(&work.mesh, |v| chosen[v.index()]));
            let simple = work.torn.simplified(&work.mesh, &work.positions);
            let Some(simple) = unedited(simple) else {
                continue;
            };
            parts += 1;
            let mut rest = Work::on(&simple);
            assert!(rest.mesh.check().is_empty());
            survives(&rest, &name);
            let again = rest.torn.simplified(&rest.mesh, &rest.positions);
            assert!(unedited(again).is_none());
            assert_eq!(
                area(&rest.mesh, &rest.positions),
                area(&work.mesh, &work.positions)
            );
            rest.sew_all();
            let all = unedited(rest.torn.simplified(&rest.mesh, &rest.positions));
            let bytes = all.map_or_else(|| rest.written(), |all| Work::on(&all).written());
            assert_eq!(text(&bytes), uncut, "{name}, seed {seed}");
        }
    }
    assert!(parts > 20, "{parts}");
}

/// To nine digits.
fn area(mesh: &Mesh, positions: &Positions) -> String {
    let of = |f| {
        let [a, b, c]: [Point; 3] = mesh.face_vertices(f).map(|v| positions.at(v));
        (b - a).cross(&(c - a)).norm() / 2.0
    };
    format!("{:.9}", mesh.faces().map(of).sum::<f64>())
}

/// Corner by corner: an inserted index is that of both sides where both sides had the same two.
#[test]
fn both_sides_of_an_edge_share_an_index_where_they_did() {
    // Faces 1 and 2 have the same indices along 2-3; faces 2 and 3 have others along 3-4.
    let file =
        b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nvt 5 5\n\
vt 6 6\nvn 1 0 0\nvn 0 1 0\nf 1/1/1 2/2/1 3/3/2\nf 3/3/2 2/2/1 4/4/2\nf 3/5/2 4/6/2 5/4/2\n";
    for tear in [false, true] {
        let document = read(file);
        let mut work = Work::on(&document);
        if tear {
            for v in [1, 2] {
                let v = VertexId::new(v).expect("small");
                let f = FaceId::new(0).expect("small");
                split::vertex(&mut work.mesh, v, &[f], &mut work.edits).expect("a split");
            }
        }
        let mut plan = Plan::new();
        plan.on_edge(HalfEdgeId::new(1).expect("small"), 0.25); // 2-3
        plan.on_edge(HalfEdgeId::new(6).expect("small"), 0.5); // 3-4
        plan.apply(&mut work.mesh, &mut work.edits)
            .expect("two points");
        work.follow();
        let written = work.written();
        let again = read(&written);
        // One for 2-3, and for 3-4 one on each side; the normals of 3-4 are one.
        assert_eq!(again.texture_count(), 6 + 3, "{}", text(&written));
        let texture: Vec<&[f64]> = (6..9).map(|i| again.texture(i)).collect();
        assert_eq!(texture, [[0.75, 0.25], [0.5, 1.0], [5.5, 5.5]]);
        let [x, y, z] = again.normals()[2];
        assert_eq!(again.normals().len(), 3);
        assert!((x - 3.0 * y).abs() < 1e-15 && z == 0.0 && (x.hypot(y) - 1.0).abs() < 1e-15);
        let mut users = BTreeMap::new();
        for triangle in 0..again.triangles().len() {
            for corner in 0..3 {
                let texture = again
                    .corner(triangle, corner)
                    .texture
                    .expect("all have one");
                *users.entry(texture).or_insert(0) += 1;
            }
        }
        assert_eq!(users[&6], 5, "2 corners of one face and 3 of the other");
    }
}

/// Straight cuts through, into and across each other, on real sheets: undone one by one in another
/// session, and simplified.
#[test]
fn straight_cuts_are_undone_to_the_byte() {
    let ray = |x, y| Ray::new(Point::new(x, y, 50.0), Vector::new(0.0, 0.0, -1.0)).expect("a ray");
    let sheets = files().into_iter().filter(|(name, _)| name != "late");
    let sheets: Vec<(String, Vec<u8>)> = sheets.collect();
    let cuts = [false, true].map(|slides| sheets.iter().map(move |sheet| (sheet, slides)));
    for ((name, bytes), slides) in cuts.into_iter().flatten() {
        let document = read(bytes);
        let points = document.positions();
        let of = |axis: usize, part: f64| {
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for point in points {
                least = least.min(point[axis]);
                most = most.max(point[axis]);
            }
            least + part * (most - least)
        };
        let mut work = Work::on(&document);
        let mut inserted = 0;
        for ends in [[[0.31, 1.5], [0.37, 0.4]], [[0.1, 0.63], [0.8, 0.71]]] {
            let [a, b] = ends.map(|[x, y]| ray(of(0, x), of(1, y)));
            let scissor = Scissor::new(a, b).expect("a plane");
            let before = work.mesh.face_count();
            scissor
                .snap_move(slides)
                .cut(
                    CutMethod::Exact,
                    &mut work.mesh,
                    &mut work.positions,
                    &mut work.edits,
                )
                .expect("positions in step");
            work.follow();
            work.torn.next_cut();
            inserted += work.mesh.face_count() - before;
        }
        assert!(inserted > 20, "{name}: {inserted} faces");
        assert_eq!(work.torn.cuts(), [1, 2], "{name}");
        let file = survives(&work, name);
        let again = read(&file);
        let mut work = Work::on(&again);
        for left in [1, 0] {
            work.sew(&work.torn.stitches_of_last(1));
            assert_eq!(work.torn.cuts().len(), left, "{name}");
        }
        let simple = work.torn.simplified(&work.mesh, &work.positions);
        let simple = unedited(simple).expect("it was cut");
        let bytes = Work::on(&simple).written();
        assert_eq!(text(&bytes), text(&rewritten(&source(name))));
        assert_eq!(simple.triangles(), document.triangles(), "{name}");
        assert_eq!(simple.positions(), document.positions(), "{name}");
        assert_eq!(simple.texture_count(), document.texture_count(), "{name}");
    }
}

fn source(name: &str) -> Vec<u8> {
    let all = files().into_iter();
    let mut of_name = all.filter(|(other, _)| other == name);
    of_name.next().expect("a fixture").1
}

/// What is said of copies, as earlier versions wrote for them what `ARCSim` says of a vertex, goes with
/// them.
#[test]
fn what_is_said_of_copies_goes_with_them() {
    let mut file = String::new();
    for (i, [x, y]) in [[1, 0], [1, 1], [0, 1], [-1, 0], [-1, -1], [0, -1], [0, 0]]
        .iter()
        .enumerate()
    {
        file += &format!("v {x} {y} 0\nnv {i} 0 0\n");
    }
    file += "f 7 1 2\nf 7 2 3\nf 7 3 4\nf 7 4 5\nf 7 5 6\nf 7 6 1\n";
    let document = Document::read(file.as_bytes()).expect("a file");
    let mut mesh = document.mesh().expect("a mesh");
    let uncut = mesh.clone();
    let positions =
        |document: &Document| Positions::new(document.positions().iter().copied()).expect("finite");
    let mut at = positions(&document);
    let mut torn = TornDocument::new(&document);
    let mut edits = Edits::new();
    // Two opposite faces move: both halves are bow-ties.
    let faces = [0, 3].map(|f| FaceId::new(f).expect("small"));
    split::vertex(
        &mut mesh,
        VertexId::new(6).expect("small"),
        &faces,
        &mut edits,
    )
    .expect("a split");
    edits.replay(&mut (&mut at, &mut torn));
    let write = |torn: &TornDocument<'_>, mesh: &Mesh, at: &Positions| {
        let mut out = Vec::new();
        torn.write(mesh, at, &mut out).expect("memory");
        out
    };
    let ours = write(&torn, &mesh, &at);
    let text = String::from_utf8_lossy(&ours);
    assert_eq!(text.matches("nv 6 0 0").count(), 1, "{text}");
    // A `v` for each fan of both.
    let head = "v 0 0 0\nnv 6 0 0\n";
    assert_eq!(
        text.lines().filter(|line| *line == "v 0 0 0").count(),
        4,
        "{text}"
    );
    let written = text
        .replacen(head, "HEAD", 1)
        .replace("\nv 0 0 0\n", &format!("\n{head}"));
    let written = written.replace("\nv 0 0 0\n", &format!("\n{head}"));
    let written = written.replace("HEAD", head).into_bytes();

    let again = Document::read(&written[..]).expect("what we wrote");
    let mut mesh_again = again.mesh().expect("what we wrote");
    assert_eq!(mesh_again, mesh);
    let mut at = positions(&again);
    let mut torn = TornDocument::new(&again);

    let mut edits = Edits::new();
    let stitches = torn.stitches_of_last(1);
    mend::sew(&mut mesh_again, &at, &stitches, |_| 1.0, 0.0, &mut edits).expect("one place");
    edits.replay(&mut (&mut at, &mut torn));
    assert_eq!(mesh_again, uncut);
    assert_eq!(
        String::from_utf8_lossy(&write(&torn, &mesh_again, &at)),
        file
    );
}

/// A hundred meshes: cut straight or along edges, written, read, cut again across the first cut,
/// written, read, mended, simplified: the bytes of the mesh that was never cut.
#[test]
fn a_hundred_meshes_are_cut_twice_through_files_and_undone() {
    let shapes = [
        tearmesh::shapes::grid(8, 7),
        tearmesh::shapes::fan(9, true),
        tearmesh::shapes::tube(9, 6),
        tearmesh::shapes::torus(11, 8),
        tearmesh::shapes::octahedron(),
    ];
    let (mut compared, mut torn_twice, mut slid) = (0, 0, 0);
    for (mesh, at) in &shapes {
        let mut file = String::from("vt 0.25 0.5\nvt 1 0\nvt 0 1\n");
        for p in at.as_slice() {
            file += &format!("v {} {} {}\n", p.x, p.y, p.z);
        }
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_vertices(f).map(|v| v.index() + 1);
            file += &format!("f {a}/1 {b}/2 {c}/3\n");
        }
        let file = rewritten(file.as_bytes());
        for seed in 0..21 {
            let mut random = Random(seed);
            let mut bytes = file.clone();
            let mut cuts = 0;
            for i in 0..2 {
                let document = Document::read(&bytes[..]).expect("a file");
                let mut mesh = document.mesh().expect("a mesh");
                let mut at = positions(&document);
                let mut torn = TornDocument::new(&document);
                let mut edits = Edits::new();
                let mut near = || {
                    let [x, y, z] = [(); 3].map(|()| random.next() - 0.5);
                    let middle = at.as_slice()[random.below(at.len())];
                    middle + Vector::new(x, y, z) * 0.9
                };
                let [eye, p, q] = [near() + Vector::new(0.0, 0.0, 3.0), near(), near()];
                let rays = [p, q].map(|p| Ray::new(eye, p - eye).expect("a ray"));
                let scissor = Scissor::new(rays[0], rays[1]).expect("a plane");
                let method = if (seed + i) % 3 == 0 {
                    CutMethod::Partition
                } else {
                    CutMethod::Exact
                };
                let through = seed % 2 == 0;
                let slides = seed % 4 < 2 && method == CutMethod::Exact;
                let (_, report) = scissor
                    .through(through)
                    .snap(if slides { 0.3 } else { Scissor::SNAP })
                    .snap_move(slides)
                    .cut_measured(method, &mut mesh, &mut at, &mut edits)
                    .expect("positions are in step");
                edits.replay(&mut torn);
                slid += edits
                    .iter()
                    .filter(|edit| matches!(edit, Edit::Slide(_)))
                    .count();
                cuts += usize::from(report.splits > 0);
                bytes.clear();
                torn.write(&mesh, &at, &mut bytes).expect("memory");
            }
            let document = Document::read(&bytes[..]).expect("what we wrote");
            let mut mesh = document.mesh().expect("what we wrote");
            let mut at = positions(&document);
            let mut torn = TornDocument::new(&document);
            let mut edits = Edits::new();
            let stitches = mend::stitches(&mesh, |_| true);
            mend::sew(&mut mesh, &at, &stitches, |_| 1.0, 0.0, &mut edits).expect("one place");
            edits.replay(&mut (&mut at, &mut torn));
            let mut whole = Vec::new();
            match unedited(torn.simplified(&mesh, &at)) {
                Some(simple) => {
                    let mesh = simple.mesh().expect("a mesh");
                    simple
                        .write(&mesh, &positions(&simple), &mut whole)
                        .expect("memory");
                }
                None => torn
                    .write(&mesh, &at, &mut whole)
                    .map(|_| ())
                    .expect("memory"),
            }
            assert!(whole == file, "seed {seed}: {}", text(&whole));
            compared += 1;
            torn_twice += usize::from(cuts == 2);
        }
    }
    println!("{compared} meshes, {torn_twice} of them cut twice, and {slid} vertices that slid");
    assert!(
        compared >= 100 && torn_twice >= 60 && slid > 50,
        "{compared} {torn_twice} {slid}"
    );
}
