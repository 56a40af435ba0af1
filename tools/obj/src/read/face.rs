//! Faces: `f 1 2 3`, `f 1/1 2/2 3/3`, `f 1//1 …`, `f 1/1/1 …`, mixed, relative.

use tearmesh::Mesh;

use super::decimal::{Expected, Word};
use super::fault::{Fault, Parsed, quoted};
use super::reader::{Reader, absolute, limit};
use super::scan::Scan;
use crate::store::{Kind, push};

/// The most corners of a polygon. The largest that are met in earnest are outlines of letters
/// and maps with one or two thousand; cutting one of this size takes a few hundredths of
/// a second at worst (the cost is its square), so that no file takes for ever.
const ARITY_MAX: usize = 4096;

impl Reader {
    /// Reads what follows the keyword `f` or `fo`.
    #[inline(always)]
    pub(super) fn face(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        match self.usual_face(scan.rest, scan.line.number) {
            Some(rest) => scan.rest = rest,
            None => *scan = self.any_face(*scan)?,
        }
        Ok(())
    }

    /// Reads a face as most lines have it, and gives the line end: three or four corners, one blank
    /// between them, all with the kinds of indices that the face before had. `None`, and nothing is
    /// changed, if it is another or a wrong one.
    #[inline(never)]
    fn usual_face<'l>(&mut self, mut rest: &'l [u8], number: u32) -> Option<&'l [u8]> {
        let counts = self.document.counts();
        let [texture, normals] = self.corner_kinds;
        let (mut corners, mut count) = ([[0; 4]; 3], 0);
        loop {
            for (kind, is_there) in [true, texture, normals].into_iter().enumerate() {
                if kind > 0 && (is_there || kind == 1 && normals) {
                    rest = rest.strip_prefix(b"/")?;
                }
                if is_there {
                    let expected = &mut self.widths.index[kind];
                    (corners[kind][count], rest) = usual_index(rest, counts[kind], expected)?;
                }
            }
            count += 1;
            match *rest {
                [b' ', ref behind @ ..] if count < 4 => rest = behind,
                [b'\n' | b'\r', ..] if count > 2 => break,
                _ => return None,
            }
        }
        let polygons = &mut self.document.polygons;
        let triangles_before = polygons.vertices.len() - 2 * polygons.len();
        let is_usual = repeated(&corners[0][..count]).is_none()
            && triangles_before + count - 3 < Mesh::MAX_FACES;
        if !is_usual {
            return None;
        }
        polygons.append(&corners, [true, texture, normals], count);
        self.document.layout.push(Kind::Polygon, number);
        Some(rest)
    }

    /// Reads any face.
    #[inline(never)]
    fn any_face<'l>(&mut self, mut scan: Scan<'l>) -> Parsed<Scan<'l>> {
        let first = self.document.polygons.vertices.len();
        let mut count = 0;
        while scan.find_token() {
            if count == ARITY_MAX {
                return Err(too_many_corners(scan));
            }
            let corner = scan.at();
            let vertex = self.reference(&mut scan, corner, Kind::Vertex)?;
            push(&mut self.document.polygons.vertices, vertex);
            self.corner_kinds = [false; 2];
            if scan.peek() == Some(b'/') {
                scan.skip(1);
                if scan.peek() != Some(b'/') && !scan.at_token_end() {
                    let texture = self.reference(&mut scan, corner, Kind::Texture)?;
                    self.document.polygons.texture.set(first + count, texture);
                    self.corner_kinds[0] = true;
                }
                if scan.peek() == Some(b'/') {
                    scan.skip(1);
                    if !scan.at_token_end() {
                        let normal = self.reference(&mut scan, corner, Kind::Normal)?;
                        self.document.polygons.normals.set(first + count, normal);
                        self.corner_kinds[1] = true;
                        if scan.peek() == Some(b'/') {
                            return Err(malformed(scan.moved_to(corner)));
                        }
                    }
                }
            }
            count += 1;
        }
        let corners = &self.document.polygons.vertices[first..];
        if corners.len() < 3 {
            return Err(too_few_corners(scan, corners.len()));
        }
        if let Some((earlier, later)) = repeated(corners) {
            return Err(repeated_vertex(scan, corners, earlier, later));
        }
        let triangles = first - 2 * self.document.polygons.len() + count - 3;
        limit(triangles, Mesh::MAX_FACES, "triangles")?;
        push(&mut self.document.polygons.starts, first as u32);
        self.document.layout.push(Kind::Polygon, scan.line.number);
        Ok(scan)
    }

    /// Reads an index of a corner, and counts it from 0; the corner ends behind it, or a `/` comes.
    fn reference(&mut self, scan: &mut Scan<'_>, corner: usize, kind: Kind) -> Parsed<u32> {
        let expected = &mut self.widths.index[kind as usize];
        let usual = usual_index(scan.rest, self.document.counts()[kind as usize], expected);
        if let Some((index, rest @ [b' ' | b'/' | b'\n' | b'\r', ..])) = usual {
            scan.rest = rest;
            return Ok(index);
        }
        let (index, behind) = self.any_reference(*scan, corner, kind)?;
        scan.go_to(behind);
        Ok(index)
    }

    /// An index that counts back, or to an element that is not there yet; or none.
    #[cold]
    #[inline(never)]
    fn any_reference(
        &mut self,
        mut scan: Scan<'_>,
        corner: usize,
        kind: Kind,
    ) -> Parsed<(u32, usize)> {
        let start = scan.at();
        let given = scan.integer();
        let is_whole = scan.at_token_end() || scan.peek() == Some(b'/');
        let Some(given) = given.filter(|_| is_whole) else {
            return Err(malformed(scan.moved_to(corner)));
        };
        let (count, span) = (self.count(kind), start..scan.at());
        let absolute = absolute(given, count, kind, &span)?;
        if absolute as usize > count {
            self.forward[kind as usize].note(absolute, count, &scan.line, span);
        }
        Ok((absolute - 1, scan.at()))
    }
}

/// Reads an index of one of `count` elements, counts it from 0, and gives what comes behind.
#[inline(always)]
fn usual_index<'l>(
    bytes: &'l [u8],
    count: usize,
    expected: &mut Expected,
) -> Option<(u32, &'l [u8])> {
    let (given, length) = expected.digits(Word::new(*bytes.first_chunk()?));
    let index = given.wrapping_sub(1);
    (index < count as u64).then(|| (index as u32, &bytes[length..]))
}

/// The first corner whose vertex an earlier corner has, after that one.
#[inline(always)]
fn repeated(corners: &[u32]) -> Option<(usize, usize)> {
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
    let span = scan.at()..scan.at() + token.len();
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
fn too_many_corners(scan: Scan<'_>) -> Box<Fault> {
    let span = scan.at()..scan.at() + scan.token().len();
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
fn repeated_vertex(scan: Scan<'_>, corners: &[u32], earlier: usize, later: usize) -> Box<Fault> {
    let span = scan.argument(later);
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
