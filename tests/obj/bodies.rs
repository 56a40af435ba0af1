//! Everything before the record of a file that was torn and divided, predicted to the byte from the
//! text of the input, the log and the mesh. The prediction knows lines, and nothing of the writer.

use std::collections::{BTreeSet, VecDeque};

use tearmesh::{Edit, Mesh, VertexId};

use super::random::Random;
use super::work::Work;
use super::{read, text};

/// A random file of several strips of triangles, an object each.
pub(crate) struct Sheets {
    pub(crate) file: String,
    /// Whether corners have texture coordinates and vertices have colours: then nothing is inserted.
    has_values: bool,
}

impl Sheets {
    pub(crate) fn random(random: &mut Random) -> Sheets {
        let has_values = random.below(2) == 0;
        let heads_first = random.below(4) == 0;
        let (mut heads, mut file) = (String::new(), String::new());
        let (mut vertices, mut textures) = (0, 0);
        for object in 0..1 + random.below(4) {
            let order = if heads_first { 0 } else { random.below(3) };
            let statements = Sheets::vertices(object, has_values, random);
            let (count, of_texture) = (statements.len(), if has_values { 4 } else { 0 });
            let vt = |i: usize| format!("vt 0.{} {object}\n", i + 1);
            let texture: String = (0..of_texture).map(vt).collect();
            let corner = |v: usize| {
                let vertex = vertices + v + 1;
                match has_values {
                    true => format!("{vertex}/{}", textures + v % of_texture + 1),
                    false => vertex.to_string(),
                }
            };
            let faces = (0..count - 2).map(|i| {
                let [a, b, c] = [i, i + 2 - i % 2, i + 1 + i % 2];
                format!("f {} {} {}\n", corner(a), corner(b), corner(c))
            });
            let faces: Vec<String> = faces.collect();
            let name = ["", "# between\n", "g part\nusemtl m\ns off\n"][random.below(3)];
            let title = format!("o object{object}\n");
            match order {
                // All vertices, or those of the object, before the faces.
                0 if heads_first => {
                    heads += &(title + &statements.concat() + &texture);
                    file += &(format!("g of{object}\n") + &faces.concat());
                }
                0 => file += &(title + &statements.concat() + &texture + name + &faces.concat()),
                // Each face as soon as its vertices are there.
                1 => {
                    file += &(title + &texture + &statements[..2].concat());
                    for (vertex, face) in statements[2..].iter().zip(&faces) {
                        file += &(vertex.clone() + face);
                    }
                    file += name;
                }
                // Faces before their vertices.
                _ => file += &(title + &faces.concat() + name + &statements.concat() + &texture),
            }
            vertices += count;
            textures += of_texture;
        }
        let file = heads + &file;
        Sheets { file, has_values }
    }

    /// What the `v` have behind z.
    fn colour(&self) -> &'static str {
        if self.has_values { " 0.5 0.25 1" } else { "" }
    }

    /// `v`, each with the lines that say something of it.
    fn vertices(object: usize, has_values: bool, random: &mut Random) -> Vec<String> {
        let statements = (0..4 + random.below(7)).map(|i| {
            let colour = if has_values { " 0.5 0.25 1" } else { "" };
            let mut lines = format!("v {} {} {object}{colour}\n", i / 2, i % 2);
            if random.below(4) == 0 {
                lines += &format!("nl {i}\n");
            }
            if random.below(6) == 0 {
                lines += &format!("# behind {i}\n");
            }
            lines
        });
        statements.collect()
    }
}

/// What the log says of the vertices and faces of a mesh.
struct Followed {
    /// When each vertex was made: those of the file first, by their order.
    ages: Vec<usize>,
    /// The vertex of the file in whose place each stands: its own, that of its root, or the last
    /// of those that it was put between.
    anchors: Vec<usize>,
    /// The face of the file in whose place each face stands.
    slots: Vec<usize>,
    born: usize,
}

impl Followed {
    fn new(mesh: &Mesh) -> Followed {
        let vertices: Vec<usize> = (0..mesh.vertex_count()).collect();
        Followed {
            born: vertices.len(),
            ages: vertices.clone(),
            anchors: vertices,
            slots: (0..mesh.face_count()).collect(),
        }
    }

    fn follow(&mut self, edit: &Edit<'_>) {
        let add = |followed: &mut Followed, anchor: usize| {
            followed.ages.push(followed.born);
            followed.anchors.push(anchor);
            followed.born += 1;
        };
        let root = |followed: &Followed, v: VertexId| followed.anchors[v.index()];
        match edit {
            Edit::Split(split) => add(self, root(self, split.old)),
            Edit::Insert(insert) => {
                for point in insert.points {
                    let sources = match point.at {
                        tearmesh::Mix::Copy(v) => vec![v],
                        tearmesh::Mix::Between { ends, .. } => ends.to_vec(),
                        tearmesh::Mix::Weighted { of, .. } => of.to_vec(),
                        _ => unreachable!("there is no other mix"),
                    };
                    let anchors = sources.into_iter().map(|v| root(self, v));
                    let last = anchors.max().expect("sources");
                    add(self, last);
                }
                for child in insert.children {
                    let (face, slot) = (child.face.index(), self.slots[child.parent.index()]);
                    if face >= self.slots.len() {
                        self.slots.resize(face + 1, slot);
                    }
                }
            }
            Edit::Merge(merge) => {
                let [kept, gone] = [merge.kept, merge.gone].map(VertexId::index);
                self.ages[kept] = self.ages[kept].min(self.ages[gone]);
                self.ages.swap_remove(gone);
                self.anchors.swap_remove(gone);
            }
            Edit::Slide(_) => {}
            _ => unreachable!("there is no other edit"),
        }
    }
}

/// A line of the input.
enum Line {
    /// A `v` or `vt`, counted by kind, with the lines that say something of it.
    Counted {
        kind: usize,
        lines: Vec<String>,
    },
    Face(Vec<String>),
    Other(String),
}

fn lines_of(file: &str) -> Vec<Line> {
    let mut lines: Vec<Line> = Vec::new();
    for line in file.lines() {
        let keyword = line.split(' ').next();
        let kind = ["v", "vt"].iter().position(|kind| keyword == Some(kind));
        match (kind, lines.last_mut()) {
            (Some(kind), _) => lines.push(Line::Counted {
                kind,
                lines: vec![line.to_owned()],
            }),
            (None, Some(Line::Counted { lines, .. })) if keyword == Some("nl") => {
                lines.push(line.to_owned());
            }
            _ if keyword == Some("f") => {
                let corners = line.split(' ').skip(1).map(str::to_owned);
                lines.push(Line::Face(corners.collect()));
            }
            _ => lines.push(Line::Other(line.to_owned())),
        }
    }
    lines
}

/// The input with the lines that a face needs moved up to before it.
fn moved_up(lines: Vec<Line>) -> Vec<Line> {
    let (mut left, mut moved, mut counts) = (VecDeque::from(lines), Vec::new(), [0, 0]);
    while let Some(line) = left.pop_front() {
        match &line {
            Line::Counted { kind, .. } => counts[*kind] += 1,
            Line::Face(corners) => {
                // Texture coordinates come first, as they do in what is written.
                for wanted in [1, 0] {
                    let is_next =
                        |line: &Line| matches!(line, Line::Counted { kind, .. } if *kind == wanted);
                    while counts[wanted] < needs(corners, wanted) {
                        let next = left.iter().position(is_next).expect("it exists");
                        moved.extend(left.remove(next));
                        counts[wanted] += 1;
                    }
                }
            }
            Line::Other(_) => {}
        }
        moved.push(line);
    }
    moved
}

/// How many statements of a kind a face needs.
fn needs(corners: &[String], kind: usize) -> usize {
    let of_kind = corners
        .iter()
        .filter_map(|corner| corner.split('/').nth(kind));
    let numbers = of_kind.map(|number| number.parse().expect("an index"));
    numbers.max().unwrap_or(0)
}

/// The vertex of each corner, counting those that are written for a second fan behind the mesh's
/// own; and the vertices that these are. Faces have this order.
fn fans(mesh: &Mesh, order: &[usize]) -> (Vec<[usize; 3]>, Vec<usize>) {
    let mut faces: Vec<[usize; 3]> = mesh
        .faces()
        .map(|f| mesh.face_vertices(f).map(VertexId::index))
        .collect();
    let mut copies = Vec::new();
    for v in 0..mesh.vertex_count() {
        let around = order.iter().copied().filter(|&f| faces[f].contains(&v));
        let around: Vec<usize> = around.collect();
        // Faces with a second vertex in common are in one fan, which is named by its first face.
        let mut fan: Vec<usize> = (0..around.len()).collect();
        for _ in &around {
            for (i, &f) in around.iter().enumerate() {
                for (j, &g) in around.iter().enumerate() {
                    if faces[f].iter().filter(|w| faces[g].contains(w)).count() >= 2 {
                        let first = fan[i].min(fan[j]);
                        (fan[i], fan[j]) = (first, first);
                    }
                }
            }
        }
        let firsts: BTreeSet<usize> = fan.iter().copied().collect();
        for first in firsts.into_iter().skip(1) {
            let copy = mesh.vertex_count() + copies.len();
            copies.push(v);
            for (&f, _) in around.iter().zip(&fan).filter(|(_, fan)| **fan == first) {
                faces[f] = faces[f].map(|w| if w == v { copy } else { w });
            }
        }
    }
    (faces, copies)
}

/// What is written of the vertices of a mesh and the copies of them for further fans.
struct Vertices<'w> {
    sheets: &'w Sheets,
    work: &'w Work<'w>,
    followed: &'w Followed,
    /// The vertices that are copied.
    copies: Vec<usize>,
    /// The `v` of the input, with what is said of each.
    known: Vec<&'w Vec<String>>,
    /// How many faces and objects begin before each of these.
    sections: Vec<usize>,
}

impl Vertices<'_> {
    fn count(&self) -> usize {
        self.work.mesh.vertex_count() + self.copies.len()
    }

    fn is_copy(&self, element: usize) -> bool {
        element >= self.work.mesh.vertex_count()
    }

    /// The vertex of the mesh.
    fn vertex(&self, element: usize) -> usize {
        let copy = element.checked_sub(self.work.mesh.vertex_count());
        copy.map_or(element, |copy| self.copies[copy])
    }

    /// The `v` of the input that a vertex is, by its age.
    fn own(&self, element: usize) -> Option<usize> {
        Some(self.followed.ages[self.vertex(element)]).filter(|&age| age < self.known.len())
    }

    /// The one of the input that is written here, if it still is a vertex.
    fn at(&self, statement: usize) -> Option<usize> {
        let mut own = 0..self.work.mesh.vertex_count();
        own.find(|&v| self.own(v) == Some(statement))
    }

    /// What stands behind the last `v` of a section, in order: the youngest last, then copies.
    fn added(&self, section: usize) -> Vec<usize> {
        let all = 0..self.count();
        let new = all.filter(|&element| self.is_copy(element) || self.own(element).is_none());
        let here = new.filter(|&element| {
            let anchor = self.followed.anchors[self.vertex(element)];
            self.sections[self.own(element).unwrap_or(anchor)] == section
        });
        let mut here: Vec<usize> = here.collect();
        here.sort_by_key(|&element| {
            let age = self.followed.ages[self.vertex(element)];
            (self.is_copy(element), age, element)
        });
        here
    }

    /// A `v`, with what is said of it if it is one of the input.
    fn statement(&self, element: usize) -> String {
        let v = self.vertex(element);
        let p = self.work.positions.as_slice()[v];
        let extras = self.sheets.colour();
        let mut lines = format!("v {} {} {}{extras}\n", p.x, p.y, p.z);
        let own = self.own(element).filter(|_| !self.is_copy(element));
        let said = own.map_or(&[][..], |own| &self.known[own][1..]);
        said.iter().for_each(|line| lines += &format!("{line}\n"));
        lines
    }
}

/// The body of the file that is written.
fn predicted(sheets: &Sheets, work: &Work<'_>, followed: &Followed) -> String {
    let lines = moved_up(lines_of(&sheets.file));
    let (mut section, mut known, mut sections) = (0, Vec::new(), Vec::new());
    for line in &lines {
        match line {
            Line::Counted { kind: 0, lines } => {
                known.push(lines);
                sections.push(section);
            }
            Line::Face(_) => section += 1,
            Line::Other(line) if line.starts_with("o ") => section += 1,
            _ => {}
        }
    }
    let mut order: Vec<usize> = (0..work.mesh.face_count()).collect();
    order.sort_by_key(|&f| (followed.slots[f], f));
    let (faces, copies) = fans(&work.mesh, &order);
    let vertices = Vertices {
        sheets,
        work,
        followed,
        copies,
        known,
        sections,
    };
    let mut numbers = vec![0; vertices.count()];
    let (mut count, mut statements, mut slot, mut body) = (0, 0, 0, String::new());
    let mut write = |element: usize, body: &mut String, numbers: &mut Vec<usize>| {
        count += 1;
        numbers[element] = count;
        *body += &vertices.statement(element);
    };
    for line in &lines {
        match line {
            Line::Counted { kind: 0, .. } => {
                if let Some(element) = vertices.at(statements) {
                    write(element, &mut body, &mut numbers);
                }
                let section = vertices.sections[statements];
                statements += 1;
                if vertices.sections.get(statements) != Some(&section) {
                    for element in vertices.added(section) {
                        write(element, &mut body, &mut numbers);
                    }
                }
            }
            Line::Counted { lines, .. } => {
                lines.iter().for_each(|line| body += &format!("{line}\n"));
            }
            Line::Other(line) => body += &format!("{line}\n"),
            Line::Face(corners) => {
                for &f in order.iter().filter(|&&f| followed.slots[f] == slot) {
                    body += "f";
                    for (vertex, corner) in faces[f].iter().zip(corners) {
                        let texture = corner.find('/').map_or("", |at| &corner[at..]);
                        body += &format!(" {}{texture}", numbers[*vertex]);
                    }
                    body += "\n";
                }
                slot += 1;
            }
        }
    }
    body
}

#[test]
fn torn_files_are_as_predicted_and_mended_to_the_input() {
    let mut torn = 0;
    for seed in 0..600 {
        let mut random = Random(31_000 + seed);
        let sheets = Sheets::random(&mut random);
        let document = read(sheets.file.as_bytes());
        let mut work = Work::on(&document);
        let uncut = text(&work.written());
        let mut followed = Followed::new(&work.mesh);
        assert_eq!(uncut, predicted(&sheets, &work, &followed), "seed {seed}");
        // Vertices change their ids where many are split and merged.
        for _ in 0..random.below(if seed % 3 == 0 { 40 } else { 8 }) {
            let seen = work.edits.cursor();
            if sheets.has_values {
                work.tear_only(&mut random);
            } else {
                work.tear(&mut random, 1, true);
            }
            work.edits
                .since(seen)
                .for_each(|edit| followed.follow(&edit));
            work.torn.next_cut();
        }
        let written = text(&work.written());
        let body = written.split("#tearmesh").next().expect("a body");
        let expected = predicted(&sheets, &work, &followed);
        assert_eq!(body, expected, "seed {seed}:\n{}", sheets.file);
        torn += usize::from(body != uncut);

        // Frames number vertices by their ids.
        let mut frame = Vec::new();
        let done = work
            .torn
            .write_unseparated(&work.mesh, &work.positions, &mut frame);
        assert_eq!(done.expect("memory").vertices, work.mesh.vertex_count());
        let frame = read(&frame);
        assert_eq!(frame.positions(), work.positions.as_slice(), "seed {seed}");
        let faces = work.torn.faces_in_order().into_iter();
        let corners = faces.map(|f| work.mesh.face_vertices(f).map(u32::from));
        assert!(corners.eq(frame.triangles().iter().copied()), "seed {seed}");

        let again = read(written.as_bytes());
        let mut later = Work::on(&again);
        assert_eq!(
            text(&later.written()),
            written,
            "seed {seed}, written again"
        );
        assert_eq!(later.undone(), uncut, "seed {seed}, undone");
    }
    assert!(torn > 400, "{torn}");
}
