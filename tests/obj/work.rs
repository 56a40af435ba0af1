//! A document under the scissors, and what its tests do with it.

use std::collections::BTreeSet;
use std::path::Path;

use tearmesh::insert::Plan;
use tearmesh::{
    CutMethod, Edits, FaceId, HalfEdgeId, Mesh, Point, Positions, Ray, Scissor, Vector, VertexId,
    mend, slide, split,
};
use tearmesh_obj::{Document, TornDocument};

use crate::random::Random;

/// Reads a file that must be accepted.
pub(crate) fn read(bytes: &[u8]) -> Document {
    match Document::read(bytes) {
        Ok(document) => document,
        Err(error) => panic!("{error}\n{}", String::from_utf8_lossy(bytes)),
    }
}

/// The positions of a document, for writing it with its own mesh.
pub(crate) fn positions(document: &Document) -> Positions {
    Positions::new(document.positions().iter().copied()).expect("the reader checks coordinates")
}

/// Writes a document as a mesh.
pub(crate) fn write_as(document: &Document, mesh: &Mesh, positions: &Positions) -> Vec<u8> {
    let mut out = Vec::new();
    TornDocument::new(document)
        .write(mesh, positions, &mut out)
        .expect("memory can be written");
    out
}

/// Reads, builds and writes.
pub(crate) fn rewritten(bytes: &[u8]) -> Vec<u8> {
    let document = read(bytes);
    let mesh = document.mesh().unwrap_or_else(|error| panic!("{error}"));
    write_as(&document, &mesh, &positions(&document))
}

/// Bytes as text, for comparisons that a person can read.
pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A document under the scissors.
pub(crate) struct Work<'d> {
    pub(crate) mesh: Mesh,
    pub(crate) positions: Positions,
    pub(crate) torn: TornDocument<'d>,
    pub(crate) edits: Edits,
}

impl<'d> Work<'d> {
    pub(crate) fn on(document: &'d Document) -> Work<'d> {
        let mut work = Work {
            mesh: document.mesh().unwrap_or_else(|error| panic!("{error}")),
            positions: positions(document),
            torn: TornDocument::new(document),
            edits: Edits::new(),
        };
        work.follow();
        work
    }

    pub(crate) fn follow(&mut self) {
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
        self.mesh.vertex(random.below(self.mesh.vertex_count()))
    }

    /// Some points on edges and in faces.
    fn insert(&mut self, random: &mut Random) {
        let mut plan = Plan::new();
        for _ in 0..=random.below(5) {
            if random.below(3) == 0 {
                let f = self.mesh.face(random.below(self.mesh.face_count()));
                plan.in_face(f, [(); 3].map(|()| 0.1 + random.next()));
            } else {
                let h = random.below(self.mesh.half_edge_count());
                let h = self.mesh.half_edge(h);
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
        self.sew_apart(stitches, 1e-9);
    }

    /// Sews copies that may be as far apart as this.
    pub(crate) fn sew_apart(&mut self, stitches: &[mend::Stitch], most: f64) {
        self.edit(|mesh, positions, edits| {
            let sewn = mend::sew(mesh, positions, stitches, |_| 1.0, most, edits);
            sewn.expect("stitches of one root, and no further apart");
        });
    }

    pub(crate) fn all_stitches(&self) -> Vec<mend::Stitch> {
        mend::stitches(&self.mesh, |_| true)
    }

    pub(crate) fn sew_all(&mut self) {
        self.sew(&self.all_stitches());
    }

    /// The vertices in the order in which they are written first.
    pub(crate) fn in_order(&self) -> Vec<VertexId> {
        let mut seen = BTreeSet::new();
        let mut order = self.torn.statements_in_order(&self.mesh);
        order.retain(|v| seen.insert(*v));
        order
    }

    /// For each vertex of the mesh, the one that it is in the mesh that is read again.
    fn numbers(&self) -> Vec<u32> {
        let mut numbers = vec![u32::MAX; self.mesh.vertex_count()];
        for (v, number) in self.in_order().into_iter().zip(0..) {
            numbers[v.index()] = number;
        }
        numbers
    }

    /// The faces in the order of the file, with its vertices.
    pub(crate) fn faces(&self) -> Vec<[u32; 3]> {
        let (order, numbers) = (self.torn.faces_in_order(), self.numbers());
        let corners = |f| self.mesh.face_vertices(f).map(|v| numbers[v.index()]);
        order.into_iter().map(corners).collect()
    }

    /// For each vertex of the file, the first of those that have one root with it.
    pub(crate) fn roots(&self) -> Vec<u32> {
        let roots = self.mesh.roots();
        let order = self.in_order();
        let root = |v: &VertexId| roots[v.index()];
        let first = |v: &VertexId| order.iter().position(|other| root(other) == root(v));
        let all = order.iter().map(|v| first(v).expect("itself") as u32);
        all.collect()
    }

    /// For each vertex of the file, the first of those that become one with it when the last cut is
    /// undone.
    pub(crate) fn joined(&self) -> Vec<u32> {
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

    /// Cuts somewhere, and slides vertices that are near the plane onto it.
    pub(crate) fn cut_sliding(&mut self, random: &mut Random) {
        let points = self.positions.as_slice();
        let near = |random: &mut Random| {
            let middle = points[random.below(points.len())];
            middle + Vector::new(random.next() - 0.5, random.next() - 0.5, 0.0) * 0.2
        };
        let [p, q]: [Point; 2] = [near(random), near(random)];
        let down = Vector::new(0.0, 0.0, -1.0);
        let rays = [p, q].map(|p| Ray::new(p - down * 50.0, down).expect("a ray"));
        let Ok(scissor) = Scissor::new(rays[0], rays[1]) else {
            return;
        };
        let scissor = scissor.with_snap(0.2).with_snap_move(true);
        self.edit(|mesh, positions, edits| {
            let done = scissor.cut(CutMethod::Exact, mesh, positions, edits);
            done.expect("positions are in step");
        });
    }

    fn slide(&mut self, from: usize, toward: usize, t: f64) {
        self.edit(|mesh, _, edits| {
            slide::toward(mesh, vertex(from), vertex(toward), t, edits).expect("an edge");
        });
    }

    /// Does what a text says: `slide VERTEX TOWARD PART`, `insert HALF-EDGE`, `split VERTEX FACE…`, `next` cut.
    pub(crate) fn deeds(&mut self, deeds: &str) {
        for deed in deeds.split(", ") {
            let words: Vec<&str> = deed.split(' ').collect();
            let number = |i: usize| words[i].parse::<usize>().expect("a number");
            match words[0] {
                "slide" => {
                    let t = words[3].parse().expect("a part of the edge");
                    self.slide(number(1), number(2), t);
                }
                "insert" => self.edit(|mesh, _, edits| {
                    let mut plan = Plan::new();
                    plan.on_edge(mesh.half_edge(number(1)), 0.375);
                    plan.apply(mesh, edits).expect("a point");
                }),
                "split" => self.edit(|mesh, _, edits| {
                    let faces = (2..words.len()).map(|i| mesh.face(number(i)));
                    let faces: Vec<FaceId> = faces.collect();
                    split::vertex(mesh, vertex(number(1)), &faces, edits).expect("a split");
                }),
                _ => self.torn.next_cut(),
            }
        }
    }

    /// Slides any vertex whose copies are all where it is, along any edge; whether there was one.
    pub(crate) fn slide_anywhere(&mut self, random: &mut Random) -> bool {
        let h = random.below(self.mesh.half_edge_count());
        let h = self.mesh.half_edge(h);
        let ends = [self.mesh.origin(h), self.mesh.target(h)];
        let roots = self.mesh.roots();
        let copies = roots.iter().filter(|&&root| root == roots[ends[0].index()]);
        let is_alone = copies.count() == 1;
        if is_alone {
            let t = 0.05 + 0.9 * random.next();
            self.slide(ends[0].index(), ends[1].index(), t);
        }
        is_alone
    }

    /// What is written once all is taken out that can be; and how many vertices stay for edits since they
    /// were inserted or slid, and how many are slid back.
    pub(crate) fn simplest(&self) -> (Vec<u8>, [usize; 3]) {
        let simple = self.torn.simplified(&self.mesh, &self.positions);
        let simple = simple.expect("what we wrote can be read");
        let counts = [simple.edited, simple.slid_edited, simple.slid_back];
        let simple = simple.document.as_ref().map(Work::on);
        (simple.as_ref().unwrap_or(self).written(), counts)
    }

    /// The same as text.
    pub(crate) fn simplified(&self) -> (String, [usize; 3]) {
        let (written, counts) = self.simplest();
        (text(&written), counts)
    }

    /// What is written once all is sewn and simplified, where nothing was edited.
    pub(crate) fn undone(&mut self) -> String {
        self.sew_all();
        let (written, [edited, slid_edited, _]) = self.simplified();
        assert_eq!((edited, slid_edited), (0, 0), "nothing was edited");
        written
    }
}

/// What is written once every cut of a file is sewn and undone, by a session that reads it anew.
pub(crate) fn undone_later(file: &[u8]) -> String {
    let document = read(file);
    Work::on(&document).undone()
}

/// What is written of a file once it is sewn and simplified, by a session that reads it, and what [`Work::simplest`]
/// counts.
pub(crate) fn simplified_later(file: &[u8]) -> (String, [usize; 3]) {
    let document = read(file);
    let mut work = Work::on(&document);
    work.sew_all();
    work.simplified()
}

/// A file of a mesh, with texture coordinates.
pub(crate) fn file_of(mesh: &Mesh, at: &Positions) -> String {
    let mut file = String::from("vt 0.25 0.5\nvt 1 0\nvt 0 1\n");
    for p in at.as_slice() {
        file += &format!("v {} {} {}\n", p.x, p.y, p.z);
    }
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| v.index() + 1);
        file += &format!("f {a}/1 {b}/2 {c}/3\n");
    }
    file
}

pub(crate) fn vertex(v: usize) -> VertexId {
    VertexId::new(v).expect("small")
}

/// Everything that can be done with a file, whatever its record says.
pub(crate) fn exercise(bytes: &[u8]) -> bool {
    let Ok(document) = Document::read(bytes) else {
        return false;
    };
    let Ok(mesh) = document.mesh() else {
        return false;
    };
    assert!(mesh.check().is_empty());
    let written = rewritten(bytes);
    // What is left out is said to be.
    let marks = ["#tearmesh record", "#~ ", "#tearmesh end"];
    let is_of_record = |line: &str| marks.iter().any(|mark| line.starts_with(mark));
    let has_lines = |bytes: &[u8]| text(bytes).lines().any(is_of_record);
    if !document.has_record() && has_lines(bytes) && !has_lines(&written) {
        let helps = document.diagnostics().iter();
        let helps = helps.filter_map(|one| one.help.as_ref());
        let said = helps.filter(|help| help.contains("will not be written again"));
        assert_eq!(said.count(), 1, "{}", text(bytes));
    }
    assert_eq!(text(&rewritten(&written)), text(&written));
    let mut work = Work::on(&document);
    work.sew_apart(&work.torn.stitches_of_last(1), f64::INFINITY);
    let simplified = work.torn.simplified(&work.mesh, &work.positions);
    if let Some(simple) = simplified.ok().and_then(|one| one.document) {
        let _refused = simple.mesh().is_ok();
    }
    true
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
