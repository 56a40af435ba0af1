//! A [`Document`] from what the crate obj-rs has read; with the feature `obj-rs`.
//!
//! obj-rs has three roles in this project, and reads no product input in any of them, for the
//! reasons that the [crate](crate#why-not-obj-rs) gives: it panics on 22 keywords, refused 26
//! of 85 real files, and keeps `f32`, which changes 11,755 of the 11,898 coordinates of a real
//! gown.
//!
//! * **Interchange type.** A program that already holds a [`RawObj`] cuts it without a detour
//!   through bytes. That is this module.
//! * **Oracle.** What obj-rs reads without loss, our tests and fuzzing want us to read the same.
//! * **A reader to satisfy.** What obj-rs reads, it reads again after we have written it.
//!
//! # What is lost
//!
//! obj-rs has dropped it before we see it: all digits beyond an `f32`; all but the last `o`;
//! comments, blank lines and the order of statements; how many numbers a `v` or `vt` had; groups,
//! materials and smoothing groups that no element follows; the resolution of `mg`.
//!
//! # What is made of the rest
//!
//! The statements come in one order, whatever the order of a hash map: `mtllib`, `o`, `v`, `vt`,
//! `vn`, `vp`, points, lines, faces. Before an element stand the `g`, `usemtl`, `s` and `mg` that
//! change there; an element in several groups has them by name. (A face without a material after a
//! line that has one gets a bare `usemtl`, which is valid, but which obj-rs itself refuses.) A `v`
//! has a weight where that is not 1, and a `vt` a third number where that is not 0. Lines of the
//! file in diagnostics are those of this order, counted from 1.

use std::collections::{BTreeMap, HashMap};
use std::fmt;

use obj::raw::RawObj;
use obj::raw::object::{Group, Line, Polygon, Range};
use tearmesh::{Mesh, Point};

use crate::diagnostic::{Diagnostic, Level};
use crate::document::Document;
use crate::polygons::Corner;
use crate::read::ARITY_MAX;
use crate::store::{Column, Kind, extend, push};

impl TryFrom<&RawObj> for Document {
    type Error = RawObjError;

    /// Creates a document from a model that obj-rs has read. Linear, except for the sorting of groups.
    ///
    /// The model must satisfy the rules of [`Document::read`], which are stricter than those of obj-rs.
    ///
    /// # Errors
    ///
    /// [`RawObjError`] names the first invalid element by its index.
    ///
    /// ```
    /// use tearmesh_obj::Document;
    ///
    /// let bytes = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl silk\nf 1 2 3\n";
    /// let raw = obj::raw::parse_obj(&bytes[..])?;
    /// let document = Document::try_from(&raw)?;
    /// assert_eq!(document.mesh()?.face_count(), 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    fn try_from(raw: &RawObj) -> Result<Document, RawObjError> {
        Builder::default().build(raw)
    }
}

/// The reason why a [`RawObj`] cannot become a document. Indices count from 0, as in obj-rs.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RawObjError {
    /// The model has no faces.
    Empty,
    /// There are more elements of a kind than a document can have.
    TooMany {
        /// The kind of element.
        what: Item,
        /// The number of elements given.
        given: usize,
        /// The largest number of elements allowed.
        limit: usize,
    },
    /// A number is NaN or infinite.
    NotFinite {
        /// The kind of element that contains the number.
        what: Item,
        /// The index of that element.
        index: usize,
    },
    /// A face, line or point refers to an element that does not exist.
    OutOfRange {
        /// The kind of the element with the reference.
        from: Item,
        /// The index of that element.
        number: usize,
        /// The kind of the element that is referred to.
        to: Item,
        /// The index that does not exist.
        index: usize,
        /// The number of elements of the kind `to`, all of which have lower indices.
        count: usize,
    },
    /// A face has fewer than three corners, or a line fewer than two.
    TooFewCorners {
        /// The kind of element: a face or a line.
        what: Item,
        /// The index of that element.
        number: usize,
        /// The number of corners given.
        given: usize,
    },
    /// A face has more corners than a document allows.
    TooManyCorners {
        /// The index of the face.
        face: usize,
        /// The number of corners of the face.
        given: usize,
        /// The largest number of corners allowed.
        limit: usize,
    },
    /// A face refers to the same vertex twice.
    RepeatedVertex {
        /// The index of the face.
        face: usize,
        /// The index of the repeated vertex.
        vertex: usize,
    },
    /// The range of a group, a material or a smoothing or merging group holds elements that do not
    /// exist, or ends before it starts.
    GroupRange {
        /// The statement, such as `g`.
        keyword: &'static str,
        /// The name or number of the group.
        name: String,
        /// The index of the first element of the range, and the index after its last element.
        range: [usize; 2],
        /// The kind of element in the range.
        of: Item,
        /// The number of elements of the kind `of` in the model.
        count: usize,
    },
    /// An element has two materials, smoothing groups or merging groups.
    TwoGroups {
        /// The statement, such as `usemtl`.
        keyword: &'static str,
        /// The names or numbers of the two groups.
        names: [String; 2],
        /// The kind of element: a face, a line or a point.
        of: Item,
        /// The index of the element.
        number: usize,
    },
    /// A name cannot be written to a file unchanged: it is empty, contains a blank, a line end or a
    /// zero byte, or ends with `\`. (Names of objects may contain blanks.)
    Name {
        /// The statement, such as `g`.
        keyword: &'static str,
        /// The name that cannot be written.
        name: String,
    },
}

/// The kind of element that an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Item {
    /// A vertex (`v`).
    Vertex,
    /// A texture coordinate (`vt`).
    Texture,
    /// A normal (`vn`).
    Normal,
    /// A parameter-space vertex (`vp`).
    ParameterVertex,
    /// A point element (`p`).
    Point,
    /// A line element (`l`).
    Line,
    /// A face (`f`).
    Face,
    /// A triangle of a polygon.
    Triangle,
    /// A line of the text file.
    FileLine,
}

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Item::Vertex => "vertex",
            Item::Texture => "texture coordinate",
            Item::Normal => "normal",
            Item::ParameterVertex => "parameter vertex",
            Item::Point => "point",
            Item::Line => "line",
            Item::Face => "face",
            Item::Triangle => "triangle",
            Item::FileLine => "line of the file",
        })
    }
}

impl fmt::Display for RawObjError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RawObjError::Empty => write!(f, "there is no face"),
            RawObjError::TooMany { what, given, limit } => {
                write!(f, "{given} times a {what}, the limit is {limit}")
            }
            RawObjError::NotFinite { what, index } => {
                write!(f, "{what} {index} has a number that is not finite")
            }
            RawObjError::OutOfRange {
                from,
                number,
                to,
                index,
                count,
            } => write!(f, "{from} {number} refers to {to} {index} of {count}"),
            RawObjError::TooFewCorners {
                what,
                number,
                given,
            } => write!(f, "{what} {number} has too few corners: {given}"),
            RawObjError::TooManyCorners { face, given, limit } => {
                write!(f, "face {face} has {given} corners, the limit is {limit}")
            }
            RawObjError::RepeatedVertex { face, vertex } => {
                write!(f, "face {face} has vertex {vertex} twice")
            }
            RawObjError::GroupRange {
                keyword,
                name,
                range: [start, end],
                of,
                count,
            } => write!(
                f,
                "`{keyword}` {name:?} covers {of} {start} up to, but not including, {end}, of {count}"
            ),
            RawObjError::TwoGroups {
                keyword,
                names: [one, other],
                of,
                number,
            } => write!(
                f,
                "`{keyword}` of {of} {number} is both {one:?} and {other:?}"
            ),
            RawObjError::Name { keyword, name } => {
                write!(f, "a file cannot hold the name {name:?} after `{keyword}`")
            }
        }
    }
}

impl std::error::Error for RawObjError {}

/// A document in the making.
#[derive(Debug, Default)]
struct Builder {
    document: Document,
    lines: u32,
    /// The `g`, `usemtl`, `s` and `mg` that hold now.
    state: [String; 4],
}

impl Builder {
    fn build(mut self, raw: &RawObj) -> Result<Document, RawObjError> {
        if raw.polygons.is_empty() {
            return Err(RawObjError::Empty);
        }
        self.state = ["g default", "usemtl", "s off", "mg off"].map(str::to_owned);
        if !raw.material_libraries.is_empty() {
            for library in &raw.material_libraries {
                check_name("mtllib", library)?;
            }
            self.text(&format!("mtllib {}", raw.material_libraries.join(" ")))?;
        }
        if let Some(name) = &raw.name {
            check_name("o", &name.replace(' ', "_"))?;
            self.text(&format!("o {name}"))?;
        }
        self.numbers(raw)?;
        let points = self.changes(raw, Item::Point, raw.points.len(), |group| &group.points)?;
        self.points(raw, points)?;
        let lines = self.changes(raw, Item::Line, raw.lines.len(), |group| &group.lines)?;
        self.lines(raw, lines)?;
        let changes = self.changes(raw, Item::Face, raw.polygons.len(), |group| &group.polygons)?;
        self.faces(raw, changes)?;
        self.document.shrink();
        self.document.triangulate();
        for (keyword, count) in [
            ("vp", raw.param_vertices.len()),
            ("p", raw.points.len()),
            ("l", raw.lines.len()),
        ] {
            if count > 0 {
                self.document.diagnostics.push(kept(keyword, count));
            }
        }
        Ok(self.document)
    }

    fn numbers(&mut self, raw: &RawObj) -> Result<(), RawObjError> {
        limit(Item::Vertex, raw.positions.len(), Mesh::MAX_VERTICES)?;
        limit(Item::Texture, raw.tex_coords.len(), Column::LIMIT / 3)?;
        limit(Item::Normal, raw.normals.len(), Column::LIMIT)?;
        for (index, &(x, y, z, w)) in raw.positions.iter().enumerate() {
            let [x, y, z, w] = finite(Item::Vertex, index, [x, y, z, w])?;
            push(&mut self.document.positions, Point::new(x, y, z));
            if w != 1.0 {
                self.document.extras.set(index, &[w]);
            }
            self.statement(Kind::Vertex)?;
        }
        for (index, &(u, v, w)) in raw.tex_coords.iter().enumerate() {
            let numbers = finite(Item::Texture, index, [u, v, w])?;
            let count = if w.to_bits() == 0 { 2 } else { 3 };
            self.document.texture.set(index, &numbers[..count]);
            self.statement(Kind::Texture)?;
        }
        for (index, &(x, y, z)) in raw.normals.iter().enumerate() {
            let normal = finite(Item::Normal, index, [x, y, z])?;
            push(&mut self.document.normals, normal);
            self.statement(Kind::Normal)?;
        }
        for (index, &(u, v, w)) in raw.param_vertices.iter().enumerate() {
            finite(Item::ParameterVertex, index, [u, v, w])?;
            self.text(&format!("vp {u} {v} {w}"))?;
        }
        Ok(())
    }

    fn points(&mut self, raw: &RawObj, changes: Changes) -> Result<(), RawObjError> {
        let mut next = changes.into_iter().peekable();
        for (number, &vertex) in raw.points.iter().enumerate() {
            while let Some((_, text)) = next.next_if(|&(at, _)| at == number) {
                self.text(&text)?;
            }
            let vertex = reference(raw, (Item::Point, number), Item::Vertex, vertex)?;
            self.text(&format!("p {}", u64::from(vertex) + 1))?;
        }
        Ok(())
    }

    fn lines(&mut self, raw: &RawObj, changes: Changes) -> Result<(), RawObjError> {
        let mut next = changes.into_iter().peekable();
        for (number, line) in raw.lines.iter().enumerate() {
            while let Some((_, text)) = next.next_if(|&(at, _)| at == number) {
                self.text(&text)?;
            }
            let corners: Vec<(usize, Option<usize>)> = match line {
                Line::P(corners) => corners.iter().map(|&v| (v, None)).collect(),
                Line::PT(corners) => corners.iter().map(|&(v, t)| (v, Some(t))).collect(),
            };
            if corners.len() < 2 {
                return Err(RawObjError::TooFewCorners {
                    what: Item::Line,
                    number,
                    given: corners.len(),
                });
            }
            let mut text = "l".to_owned();
            for (vertex, texture) in corners {
                let vertex = reference(raw, (Item::Line, number), Item::Vertex, vertex)?;
                text += &format!(" {}", u64::from(vertex) + 1);
                if let Some(texture) = texture {
                    let texture = reference(raw, (Item::Line, number), Item::Texture, texture)?;
                    text += &format!("/{}", u64::from(texture) + 1);
                }
            }
            self.text(&text)?;
        }
        Ok(())
    }

    fn faces(&mut self, raw: &RawObj, changes: Changes) -> Result<(), RawObjError> {
        let mut next = changes.into_iter().peekable();
        let mut triangles = 0;
        for (number, polygon) in raw.polygons.iter().enumerate() {
            while let Some((_, text)) = next.next_if(|&(at, _)| at == number) {
                self.text(&text)?;
            }
            let corners = corners(raw, number, polygon)?;
            triangles += corners.len() - 2;
            limit(Item::Triangle, triangles, Mesh::MAX_FACES)?;
            self.document.polygons.add(corners.into_iter());
            self.statement(Kind::Polygon)?;
        }
        Ok(())
    }

    /// Which lines of text stand before which elements of a kind.
    fn changes(
        &mut self,
        raw: &RawObj,
        of: Item,
        count: usize,
        ranges: impl Fn(&Group) -> &[Range] + Copy,
    ) -> Result<Changes, RawObjError> {
        let groups = Members::of("g", &raw.groups, of, count, ranges)?;
        let materials = Members::of("usemtl", &raw.meshes, of, count, ranges)?;
        let smoothing = Members::of("s", &raw.smoothing_groups, of, count, ranges)?;
        let merging = Members::of("mg", &raw.merging_groups, of, count, ranges)?;
        for name in groups.names() {
            check_name("g", name)?;
        }
        for name in materials.names().filter(|name| !name.is_empty()) {
            check_name("usemtl", name)?; // The material before the first `usemtl` has none.
        }
        let mut changes = groups.changes(|names| match names {
            [] => "default".to_owned(),
            names => names.join(" "),
        });
        for members in [&materials, &smoothing, &merging] {
            members.check_single()?;
        }
        changes.extend(materials.changes(|names| names.concat()));
        for members in [smoothing, merging] {
            changes.extend(members.changes(|names| match names {
                [] => "off".to_owned(),
                names => names.concat(),
            }));
        }
        changes.sort_by_key(|&(at, which, _)| (at, which));
        let mut kept = Vec::new();
        for (at, which, text) in changes {
            if self.state[which] != text {
                self.state[which].clone_from(&text);
                kept.push((at, text));
            }
        }
        Ok(kept)
    }

    /// Adds a line for a statement that is not text.
    fn statement(&mut self, kind: Kind) -> Result<(), RawObjError> {
        let line = self.next_line()?;
        self.document.layout.push(kind, line);
        Ok(())
    }

    fn text(&mut self, text: &str) -> Result<(), RawObjError> {
        let line = self.next_line()?;
        extend(&mut self.document.text, text.as_bytes());
        push(&mut self.document.text, b'\n');
        self.document.layout.push_text(text.len() + 1, line);
        Ok(())
    }

    fn next_line(&mut self) -> Result<u32, RawObjError> {
        limit(Item::FileLine, self.lines as usize + 1, u32::MAX as usize)?;
        self.lines += 1;
        Ok(self.lines)
    }
}

/// Lines of text, each with the number of the element that it stands before.
type Changes = Vec<(usize, String)>;

/// The members of groups of one keyword, among the elements of one kind.
struct Members {
    keyword: &'static str,
    of: Item,
    /// From which element on which names hold; the first entry is for element 0.
    spans: Vec<(usize, Vec<String>)>,
}

impl Members {
    fn of<K: ToString + Ord>(
        keyword: &'static str,
        groups: &HashMap<K, Group>,
        of: Item,
        count: usize,
        ranges: impl Fn(&Group) -> &[Range],
    ) -> Result<Members, RawObjError> {
        // By name, so that the order of the hash map does not matter.
        let groups: BTreeMap<&K, &Group> = groups.iter().collect();
        let mut events = Vec::new();
        for (&name, group) in &groups {
            for &Range { start, end } in ranges(group) {
                if start > end || end > count {
                    return Err(RawObjError::GroupRange {
                        keyword,
                        name: name.to_string(),
                        range: [start, end],
                        of,
                        count,
                    });
                }
                if start < end {
                    events.extend([(start, name, 1), (end, name, -1)]);
                }
            }
        }
        events.sort();
        let mut spans = vec![(0, Vec::new())];
        let mut inside = BTreeMap::<&K, i64>::new();
        for at_once in events.chunk_by(|(a, ..), (b, ..)| a == b) {
            for &(_, name, step) in at_once {
                *inside.entry(name).or_default() += step;
            }
            inside.retain(|_, depth| *depth > 0);
            let names = inside.keys().map(|name| name.to_string()).collect();
            spans.push((at_once[0].0, names));
        }
        spans.retain(|&(at, _)| at < count);
        Ok(Members { keyword, of, spans })
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.spans
            .iter()
            .flat_map(|(_, names)| names)
            .map(String::as_str)
    }

    /// No element may have two of what it can have only one of.
    fn check_single(&self) -> Result<(), RawObjError> {
        match self.spans.iter().find(|(_, names)| names.len() > 1) {
            None => Ok(()),
            Some((number, names)) => Err(RawObjError::TwoGroups {
                keyword: self.keyword,
                names: [names[0].clone(), names[1].clone()],
                of: self.of,
                number: *number,
            }),
        }
    }

    /// The statement for each span, and which of the four states it sets.
    fn changes(&self, value: impl Fn(&[String]) -> String) -> Vec<(usize, usize, String)> {
        let which = match self.keyword {
            "g" => 0,
            "usemtl" => 1,
            "s" => 2,
            _ => 3,
        };
        let statement = |names| format!("{} {}", self.keyword, value(names));
        // Of several spans that begin at element 0 the last one holds.
        let mut changes: BTreeMap<usize, String> = BTreeMap::new();
        for (at, names) in &self.spans {
            changes.insert(*at, statement(names).trim_end().to_owned());
        }
        changes
            .into_iter()
            .map(|(at, text)| (at, which, text))
            .collect()
    }
}

/// The corners of a face, if it is a sound one.
fn corners(raw: &RawObj, face: usize, polygon: &Polygon) -> Result<Vec<Corner>, RawObjError> {
    let given: Vec<(usize, Option<usize>, Option<usize>)> = match polygon {
        Polygon::P(corners) => corners.iter().map(|&v| (v, None, None)).collect(),
        Polygon::PT(corners) => corners.iter().map(|&(v, t)| (v, Some(t), None)).collect(),
        Polygon::PN(corners) => corners.iter().map(|&(v, n)| (v, None, Some(n))).collect(),
        Polygon::PTN(corners) => {
            let corners = corners.iter();
            corners.map(|&(v, t, n)| (v, Some(t), Some(n))).collect()
        }
    };
    if given.len() < 3 {
        return Err(RawObjError::TooFewCorners {
            what: Item::Face,
            number: face,
            given: given.len(),
        });
    }
    if given.len() > ARITY_MAX {
        return Err(RawObjError::TooManyCorners {
            face,
            given: given.len(),
            limit: ARITY_MAX,
        });
    }
    let refer = |to, index| reference(raw, (Item::Face, face), to, index);
    let corners: Vec<Corner> = given
        .into_iter()
        .map(|(vertex, texture, normal)| {
            Ok(Corner {
                vertex: refer(Item::Vertex, vertex)?,
                texture: texture.map(|t| refer(Item::Texture, t)).transpose()?,
                normal: normal.map(|n| refer(Item::Normal, n)).transpose()?,
            })
        })
        .collect::<Result<_, _>>()?;
    let mut vertices: Vec<u32> = corners.iter().map(|corner| corner.vertex).collect();
    vertices.sort_unstable();
    match vertices.windows(2).find(|pair| pair[0] == pair[1]) {
        None => Ok(corners),
        Some(pair) => Err(RawObjError::RepeatedVertex {
            face,
            vertex: pair[0] as usize,
        }),
    }
}

/// An index, if what it refers to exists.
fn reference(
    raw: &RawObj,
    (from, number): (Item, usize),
    to: Item,
    index: usize,
) -> Result<u32, RawObjError> {
    let count = match to {
        Item::Texture => raw.tex_coords.len(),
        Item::Normal => raw.normals.len(),
        _ => raw.positions.len(),
    };
    match u32::try_from(index) {
        Ok(id) if index < count => Ok(id),
        _ => Err(RawObjError::OutOfRange {
            from,
            number,
            to,
            index,
            count,
        }),
    }
}

fn finite<const N: usize>(
    what: Item,
    index: usize,
    numbers: [f32; N],
) -> Result<[f64; N], RawObjError> {
    if numbers.iter().all(|number| number.is_finite()) {
        Ok(numbers.map(f64::from))
    } else {
        Err(RawObjError::NotFinite { what, index })
    }
}

fn limit(what: Item, given: usize, limit: usize) -> Result<(), RawObjError> {
    if given <= limit {
        Ok(())
    } else {
        Err(RawObjError::TooMany { what, given, limit })
    }
}

/// A name must be one word of one line.
fn check_name(keyword: &'static str, name: &str) -> Result<(), RawObjError> {
    let broken = |c: char| c == '\0' || c.is_whitespace();
    if name.is_empty() || name.contains(broken) || name.ends_with('\\') {
        let name = name.to_owned();
        return Err(RawObjError::Name { keyword, name });
    }
    Ok(())
}

fn kept(keyword: &str, count: usize) -> Diagnostic {
    let (code, what) = match keyword {
        "vp" => ("W-OBJ-FOREIGN", "is not interpreted, and is kept as it is"),
        _ => ("W-OBJ-ELEMENT", "elements are kept, but never cut"),
    };
    Diagnostic {
        level: Level::Warning,
        code,
        location: None,
        message: format!("`{keyword}` {what} ({count} of them)"),
        excerpt: None,
        help: None,
    }
}
