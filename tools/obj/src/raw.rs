//! A [`Document`] from what the crate obj-rs has read; with the feature `obj-rs`.
//!
//! obj-rs has three roles in this project, and reads no product input in any of them, for the
//! reasons that the [crate](crate#why-not-obj-rs) gives.
//!
//! * **Interchange type.** A program that already holds a [`RawObj`] can cut it. The model is
//!   printed and read, so that the reader alone knows what a document may hold.
//! * **Oracle.** What obj-rs reads without loss, our tests and fuzzing want us to read the same.
//! * **A reader to satisfy.** What obj-rs reads, it reads again after we have written it.
//!
//! obj-rs has dropped before we see it: all digits beyond an `f32`; all but the last `o`;
//! comments, blank lines and the order of statements; how many numbers a `v` or `vt` had; groups,
//! materials and smoothing groups that no element follows; the resolution of `mg`.
//!
//! The rest is printed in one order, whatever that of a hash map: `mtllib`, `o`, `v`, `vt`,
//! `vn`, `vp`, points, lines, faces. Before an element stand the `g`, `usemtl`, `s` and `mg` that
//! change there; an element in several groups has them by name. A `v` has a weight where that is
//! not 1, and a `vt` a third number where that is not 0. Lines of the file in diagnostics are
//! those of this text.

use std::collections::{BTreeMap, HashMap};
use std::io::{Error, ErrorKind};

use obj::raw::RawObj;
use obj::raw::object::{Group, Line, Polygon, Range};

use crate::diagnostic::ReadError;
use crate::document::Document;

impl TryFrom<&RawObj> for Document {
    type Error = ReadError;

    /// Creates a document from a model that obj-rs has read, by way of a text. Linear, except for the
    /// sorting of groups.
    ///
    /// # Errors
    ///
    /// The errors of [`Document::read`], which is stricter than obj-rs; [`ReadError::Input`] if no text
    /// can hold a name or a range of a group.
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
    fn try_from(raw: &RawObj) -> Result<Document, ReadError> {
        let mut text = Text {
            text: String::new(),
            said: ["g default", "usemtl", "s off", "mg off"].map(str::to_owned),
        };
        text.print(raw)?;
        Document::read(text.text.as_bytes())
    }
}

struct Text {
    text: String,
    /// The `g`, `usemtl`, `s` and `mg` that hold now.
    said: [String; 4],
}

impl Text {
    fn print(&mut self, raw: &RawObj) -> Result<(), ReadError> {
        for library in &raw.material_libraries {
            word("mtllib", library)?;
        }
        if !raw.material_libraries.is_empty() {
            self.line("mtllib", raw.material_libraries.iter().cloned());
        }
        if let Some(name) = &raw.name {
            word("o", &name.replace(' ', "_"))?;
            self.line("o", [name.clone()].into_iter());
        }
        // An `f32` is an `f64`, whose digits read back as the same bits.
        let number = |x: &f32| f64::from(*x).to_string();
        for &(x, y, z, w) in &raw.positions {
            let count = if w == 1.0 { 3 } else { 4 };
            self.line("v", [x, y, z, w][..count].iter().map(number));
        }
        for &(u, v, w) in &raw.tex_coords {
            let count = if w.to_bits() == 0 { 2 } else { 3 };
            self.line("vt", [u, v, w][..count].iter().map(number));
        }
        for (keyword, all) in [("vn", &raw.normals), ("vp", &raw.param_vertices)] {
            for &(x, y, z) in all {
                self.line(keyword, [x, y, z].iter().map(number));
            }
        }
        let points = |&v: &usize| vec![corner(v, None, None)];
        self.elements("p", raw, &raw.points, |group| &group.points, points)?;
        let lines = |line: &Line| match line {
            Line::P(all) => all.iter().map(|&v| corner(v, None, None)).collect(),
            Line::PT(all) => all.iter().map(|&(v, t)| corner(v, Some(t), None)).collect(),
        };
        self.elements("l", raw, &raw.lines, |group| &group.lines, lines)?;
        let faces = |face: &Polygon| match face {
            Polygon::P(all) => all.iter().map(|&v| corner(v, None, None)).collect(),
            Polygon::PT(all) => all.iter().map(|&(v, t)| corner(v, Some(t), None)).collect(),
            Polygon::PN(all) => all.iter().map(|&(v, n)| corner(v, None, Some(n))).collect(),
            Polygon::PTN(all) => {
                let corners = all.iter().map(|&(v, t, n)| corner(v, Some(t), Some(n)));
                corners.collect()
            }
        };
        self.elements("f", raw, &raw.polygons, |group| &group.polygons, faces)
    }

    fn line(&mut self, keyword: &str, words: impl Iterator<Item = String>) {
        self.text += keyword;
        for word in words {
            self.text.push(' ');
            self.text += &word;
        }
        self.text.push('\n');
    }

    /// Prints all elements of a kind, each behind the statements that change there.
    fn elements<T>(
        &mut self,
        keyword: &str,
        raw: &RawObj,
        elements: &[T],
        ranges: fn(&Group) -> &[Range],
        corners: impl Fn(&T) -> Vec<String>,
    ) -> Result<(), ReadError> {
        let count = elements.len();
        let names = [
            statements("g", &raw.groups, count, ranges)?,
            statements("usemtl", &raw.meshes, count, ranges)?,
            statements("s", &raw.smoothing_groups, count, ranges)?,
            statements("mg", &raw.merging_groups, count, ranges)?,
        ];
        for (number, element) in elements.iter().enumerate() {
            for (said, names) in self.said.iter_mut().zip(&names) {
                let now = &names[number];
                if now != said {
                    said.clone_from(now);
                    self.text += now;
                    self.text.push('\n');
                }
            }
            self.line(keyword, corners(element).into_iter());
        }
        Ok(())
    }
}

/// The statement that holds at each element of a kind.
fn statements<K: ToString>(
    keyword: &str,
    groups: &HashMap<K, Group>,
    count: usize,
    ranges: fn(&Group) -> &[Range],
) -> Result<Vec<String>, ReadError> {
    // In the order of names, so that of several that cannot be printed the same one is told.
    let by_name: BTreeMap<String, &Group> = groups
        .iter()
        .map(|(name, group)| (name.to_string(), group))
        .collect();
    let mut names: Vec<Vec<&str>> = vec![Vec::new(); count];
    for (name, group) in &by_name {
        for &Range { start, end } in ranges(group) {
            let Some(covered) = names.get_mut(start..end) else {
                let range = format!("`{keyword}` {name:?} covers {start} up to {end}, of {count}");
                return Err(refused(range));
            };
            if !(name.is_empty() && keyword == "usemtl") {
                word(keyword, name)?; // The material before the first `usemtl` has no name.
            }
            covered.iter_mut().for_each(|names| names.push(name));
        }
    }
    let statement = |mut names: Vec<&str>| {
        names.dedup(); // Ranges of one group may overlap.
        let value = match (keyword, &names[..]) {
            ("g", []) => "default".to_owned(),
            ("s" | "mg", []) => "off".to_owned(),
            ("g", _) | (_, [] | [_]) => names.join(" "),
            _ => return Err(refused(format!("`{keyword}` of one element is {names:?}"))),
        };
        Ok(format!("{keyword} {value}").trim_end().to_owned())
    };
    names.into_iter().map(statement).collect()
}

/// `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1.
fn corner(vertex: usize, texture: Option<usize>, normal: Option<usize>) -> String {
    let number = |index: usize| (index as u128 + 1).to_string();
    let vertex = number(vertex);
    match (texture.map(number), normal.map(number)) {
        (None, None) => vertex,
        (Some(texture), None) => format!("{vertex}/{texture}"),
        (texture, Some(normal)) => format!("{vertex}/{}/{normal}", texture.unwrap_or_default()),
    }
}

/// A name must be one word of one line.
fn word(keyword: &str, name: &str) -> Result<(), ReadError> {
    let is_broken = |c: char| c == '\0' || c.is_whitespace();
    if name.is_empty() || name.contains(is_broken) || name.ends_with('\\') {
        return Err(refused(format!(
            "no file has the name {name:?} after `{keyword}`"
        )));
    }
    Ok(())
}

fn refused(message: String) -> ReadError {
    ReadError::Input(Error::new(ErrorKind::InvalidData, message))
}
