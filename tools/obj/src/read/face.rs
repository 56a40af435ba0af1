//! Faces: `f 1 2 3`, `f 1/1 2/2 3/3`, `f 1//1 …`, `f 1/1/1 …`, mixed, relative.

use std::ops::Range;

use tearmesh::Mesh;

use super::fault::{Fault, Parsed};
use super::index::{Element, absolute};
use super::line::{Line, quoted};
use super::reader::{Reader, limit};
use super::scan::Scan;
use crate::store::{Kind, push};

/// The most corners of a polygon. The largest that are met in earnest are outlines of letters
/// and maps with one or two thousand; cutting one of this size takes a few hundredths of
/// a second at worst (the cost is its square), so that no file takes for ever.
const ARITY_MAX: usize = 4096;

impl Reader {
    /// Reads what follows the keyword `f` or `fo`.
    pub(super) fn face(&mut self, line: &Line<'_>, scan: &mut Scan<'_>) -> Parsed<()> {
        let keyword = *scan;
        let first = self.document.polygons.vertices.len();
        let mut corner = first;
        while scan.find_token() {
            let start = scan.at;
            if corner - first == ARITY_MAX {
                return Err(too_many_corners(start..start + scan.token().len()));
            }
            let vertex = self.reference(line, scan, start, Element::Vertex)?;
            push(&mut self.document.polygons.vertices, vertex);
            if scan.peek() == Some(b'/') {
                scan.at += 1;
                if scan.peek() != Some(b'/') && !scan.at_token_end() {
                    let texture = self.reference(line, scan, start, Element::Texture)?;
                    self.document.polygons.texture.set(corner, texture);
                }
                if scan.peek() == Some(b'/') {
                    scan.at += 1;
                    if !scan.at_token_end() {
                        let normal = self.reference(line, scan, start, Element::Normal)?;
                        self.document.polygons.normals.set(corner, normal);
                    }
                }
            }
            if !scan.at_token_end() {
                return Err(malformed(Scan { at: start, ..*scan }));
            }
            corner += 1;
        }
        let corners = &self.document.polygons.vertices[first..];
        if corners.len() < 3 {
            return Err(too_few_corners(keyword, corners.len()));
        }
        if let Some((earlier, later)) = repeated(corners) {
            return Err(repeated_vertex(keyword, corners, earlier, later));
        }
        let triangles_before = first - 2 * self.document.polygons.len();
        limit(
            triangles_before + corners.len() - 3,
            Mesh::MAX_FACES,
            "triangles",
        )?;
        push(&mut self.document.polygons.starts, first as u32);
        self.document.layout.push(Kind::Polygon, line.number);
        Ok(())
    }

    /// Reads an index, and counts it from 0.
    #[inline(always)]
    fn reference(
        &mut self,
        line: &Line<'_>,
        scan: &mut Scan<'_>,
        token: usize,
        element: Element,
    ) -> Parsed<u32> {
        let start = scan.at;
        let Some(given) = scan.integer() else {
            return Err(malformed(Scan { at: token, ..*scan }));
        };
        let count = self.count(element);
        if given > 0 && given as u64 <= count as u64 {
            return Ok((given - 1) as u32);
        }
        if !(scan.at_token_end() || scan.peek() == Some(b'/')) {
            return Err(malformed(Scan { at: token, ..*scan }));
        }
        self.unusual_reference(line, given, start..scan.at, element)
    }

    /// An index that counts back, or to an element that is not there yet.
    #[cold]
    fn unusual_reference(
        &mut self,
        line: &Line<'_>,
        given: i64,
        span: Range<usize>,
        element: Element,
    ) -> Parsed<u32> {
        let count = self.count(element);
        let absolute = absolute(given, count, element, &span)?;
        if absolute as usize > count {
            self.forward[element as usize].note(absolute, count, line, span);
        }
        Ok(absolute - 1)
    }
}

/// The first corner whose vertex an earlier corner has, after that one.
#[inline(always)]
pub(super) fn repeated(corners: &[u32]) -> Option<(usize, usize)> {
    match *corners {
        [a, b, c] if a != b && b != c && c != a => None,
        [a, b, c, d] if a != b && a != c && a != d && b != c && b != d && c != d => None,
        _ => repeated_in_many(corners),
    }
}

fn repeated_in_many(corners: &[u32]) -> Option<(usize, usize)> {
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_by_key(|&corner| corners[corner]);
    order
        .windows(2)
        .filter(|pair| corners[pair[0]] == corners[pair[1]])
        .map(|pair| (pair[0], pair[1]))
        .min_by_key(|&(_, later)| later)
}

/// What is wrong with the corner that starts here.
#[cold]
fn malformed(scan: Scan<'_>) -> Box<Fault> {
    let token = scan.token();
    let span = scan.at..scan.at + token.len();
    let text = quoted(token);
    let slashes = token.iter().filter(|&&byte| byte == b'/').count();
    let is_number = |part: &[u8]| {
        std::str::from_utf8(part).is_ok_and(|part| !part.is_empty() && part.parse::<f64>().is_ok())
    };
    let label = "expected `v`, `v/vt`, `v//vn` or `v/vt/vn`";
    let fault = |message: String| Fault::new("E-OBJ-INDEX", span.clone(), message, label);
    if token.starts_with(b"/") {
        return fault(format!("the corner {text} has no vertex"));
    }
    if token
        .split(|&byte| byte == b'/')
        .any(|part| is_number(part) && part.contains(&b'.'))
    {
        return fault(format!("an index is a whole number, not {text}"));
    }
    if slashes > 2 {
        return fault(format!(
            "the corner {text} has {} indices, not up to 3",
            slashes + 1
        ));
    }
    fault(format!("cannot read the corner {text}"))
}

#[cold]
fn too_many_corners(span: Range<usize>) -> Box<Fault> {
    let message = format!("this face has more than {ARITY_MAX} corners");
    Fault::new("E-OBJ-ARITY", span, message, "one too many")
        .help("triangulate this face in the program that made it")
}

#[cold]
fn too_few_corners(scan: Scan<'_>, count: usize) -> Box<Fault> {
    let end = scan.end_of_tokens();
    let message = match count {
        0 => "a face needs 3 corners, this one has none".to_owned(),
        _ => format!("a face needs 3 corners, this one has {count}"),
    };
    Fault::new(
        "E-OBJ-CORNERS",
        end..end,
        message,
        "expected another vertex",
    )
    .help("a line is written `l 1 2`, a point `p 1`")
}

#[cold]
fn repeated_vertex(
    mut scan: Scan<'_>,
    corners: &[u32],
    earlier: usize,
    later: usize,
) -> Box<Fault> {
    for _ in 0..later {
        scan.find_token();
        scan.at += scan.token().len();
    }
    scan.find_token();
    let span = scan.at..scan.at + scan.token().len();
    let message = format!(
        "this face has vertex {} twice",
        u64::from(corners[later]) + 1
    );
    let label = format!("already its corner {}", earlier + 1);
    let fault = Fault::new("E-OBJ-REPEAT", span, message, label);
    if earlier == 0 && later == corners.len() - 1 && later >= 3 {
        fault.help("a face closes by itself: leave out the last corner")
    } else if corners.len() > 4 {
        fault.help("if this is a face with a hole, triangulate it in the program that made it")
    } else {
        fault.help("a triangle with a repeated vertex has no area: remove it")
    }
}
