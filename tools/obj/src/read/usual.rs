//! The usual lines, read in one go.
//!
//! Nearly every line of a file is a `v`, `vt` or `vn` with up to three numbers, or a triangle
//! or a quad whose corners are all of one form; there are blanks between the words and a line end
//! behind them. Such lines are read here straight from the buffer: their end need not be found
//! first, and nothing about them needs to be remembered. That saves about a quarter of the time.
//!
//! Nothing is refused here. A line that is unusual in any way (a comment, an exponent, an index
//! that counts back, and everything wrong) is left as it is to [`Reader::statement`], which alone
//! knows what else there may be. It reads usual lines too, and to the same effect.

use tearmesh::{COORDINATE_MAX, Mesh, Point};

use super::decimal::{Expected, Widths, Word, digits, many_digits, nearest};
use super::face::repeated;
use super::reader::Reader;
use crate::store::{Column, Kind, NUMBERS_MAX, Rows, extend, push};

/// The most corners of a usual face.
const CORNERS_MAX: usize = 4;

impl Reader {
    /// Reads usual lines as long as they follow each other; how many there were, and of how many
    /// bytes. The first one has this number.
    pub(super) fn usual_lines(&mut self, bytes: &[u8], number: u32) -> (u32, usize) {
        let mut rest = bytes;
        let mut count = 0;
        while let Some(line) = number.checked_add(count).filter(|&line| line < u32::MAX)
            && let Some(behind) = self.usual_line(rest, line)
        {
            rest = behind;
            count += 1;
        }
        (count, bytes.len() - rest.len())
    }

    /// Reads a line, if it is a usual one, and gives what comes behind it. Otherwise nothing
    /// has changed.
    #[inline]
    fn usual_line<'b>(&mut self, bytes: &'b [u8], line: u32) -> Option<&'b [u8]> {
        let (kind, behind) = match bytes {
            [b'f', b' ', rest @ ..] => (Kind::Polygon, self.usual_face(rest)?),
            [b'v', b' ', rest @ ..] => (Kind::Vertex, self.usual_vertex(rest)?),
            [b'v', b't', b' ', rest @ ..] => (Kind::Texture, self.usual_texture(rest)?),
            [b'v', b'n', b' ', rest @ ..] => (Kind::Normal, self.usual_normal(rest)?),
            _ => return None,
        };
        self.document.layout.push(kind, line);
        Some(behind)
    }

    #[inline]
    fn usual_vertex<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let ([x, y, z], 3, behind) = numbers(bytes, &mut self.widths.places)? else {
            return None;
        };
        let positions = &mut self.document.positions;
        let too_large = [x, y, z].iter().any(|x| x.abs() > COORDINATE_MAX);
        if too_large || positions.len() >= Mesh::MAX_VERTICES {
            return None;
        }
        push(positions, Point::new(x, y, z));
        Some(behind)
    }

    #[inline]
    fn usual_texture<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (numbers, count, behind) = numbers(bytes, &mut self.widths.places)?;
        let texture = &mut self.document.texture;
        if texture.value_count() >= Rows::LIMIT - NUMBERS_MAX {
            return None;
        }
        texture.set(texture.len(), &numbers[..count]);
        Some(behind)
    }

    #[inline]
    fn usual_normal<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let (numbers, 3, behind) = numbers(bytes, &mut self.widths.places)? else {
            return None;
        };
        if self.document.normals.len() >= Column::LIMIT {
            return None;
        }
        push(&mut self.document.normals, numbers);
        Some(behind)
    }

    #[inline]
    fn usual_face<'b>(&mut self, bytes: &'b [u8]) -> Option<&'b [u8]> {
        let document = &self.document;
        let existing = [
            document.positions.len(),
            document.texture.len(),
            document.normals.len(),
        ];
        let bytes = after_blanks(bytes);
        let (vertex, behind) = index(bytes, existing[0], &mut self.widths.vertex)?;
        // What most faces have is read without a thought of the rest.
        if behind.first() == Some(&b'/') {
            self.corners::<true>(vertex, behind, existing)
        } else {
            self.corners::<false>(vertex, behind, existing)
        }
    }

    /// Reads a face of which the vertex of the first corner is read. Whether its corners have
    /// `MORE` than a vertex shows behind it.
    #[inline(always)]
    fn corners<'b, const MORE: bool>(
        &mut self,
        mut vertex: u32,
        mut behind: &'b [u8],
        existing: [usize; 3],
    ) -> Option<&'b [u8]> {
        let mut corners = Corners::default();
        for at in 0..CORNERS_MAX {
            corners.vertices[at] = vertex;
            if MORE {
                let (more, form);
                (more, form, behind) = more_of_corner(behind, existing, &mut self.widths)?;
                [corners.texture[at], corners.normals[at]] = more;
                if at == 0 {
                    corners.form = form;
                } else if form != corners.form {
                    return None;
                }
            }
            match next_word(behind)? {
                Next::Word(word) => {
                    (vertex, behind) = index(word, existing[0], &mut self.widths.vertex)?;
                }
                Next::Line(behind) => {
                    // A copy of a known length is a few instructions, of any other a call.
                    match at {
                        2 => self.append::<3, MORE>(&corners)?,
                        3 => self.append::<4, MORE>(&corners)?,
                        _ => return None,
                    }
                    return Some(behind);
                }
            }
        }
        None
    }

    /// Appends a face of the first `COUNT` corners, unless it is one too many or has a vertex
    /// twice.
    #[inline(always)]
    fn append<const COUNT: usize, const MORE: bool>(&mut self, corners: &Corners) -> Option<()> {
        let polygons = &mut self.document.polygons;
        let first = polygons.vertices.len();
        let triangles_before = first - 2 * polygons.len();
        let all = |indices: &[u32; CORNERS_MAX]| -> [u32; COUNT] {
            std::array::from_fn(|at| indices[at])
        };
        let vertices = all(&corners.vertices);
        if triangles_before + COUNT - 3 >= Mesh::MAX_FACES || repeated(&vertices).is_some() {
            return None;
        }
        extend(&mut polygons.vertices, &vertices);
        if MORE && corners.form.texture {
            polygons.texture.set_all(first, &all(&corners.texture));
        }
        if MORE && corners.form.normal {
            polygons.normals.set_all(first, &all(&corners.normals));
        }
        push(&mut polygons.starts, first as u32);
        Some(())
    }
}

/// The corners of a usual face, counted from 0.
#[derive(Default)]
struct Corners {
    form: Form,
    vertices: [u32; CORNERS_MAX],
    texture: [u32; CORNERS_MAX],
    normals: [u32; CORNERS_MAX],
}

/// What the corners of a face have beside a vertex.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct Form {
    texture: bool,
    normal: bool,
}

/// Reads what a corner has behind its vertex: nothing, `/2`, `//3` or `/2/3`.
#[inline(always)]
fn more_of_corner<'b>(
    bytes: &'b [u8],
    existing: [usize; 3],
    widths: &mut Widths,
) -> Option<([u32; 2], Form, &'b [u8])> {
    let [_, textures, normals] = existing;
    let mut form = Form::default();
    let (mut texture, mut normal) = (0, 0);
    let mut rest = bytes;
    if let [b'/', behind @ ..] = rest {
        rest = behind;
        if rest.first() != Some(&b'/') {
            (texture, rest) = index(rest, textures, &mut widths.texture)?;
            form.texture = true;
        }
        if let [b'/', behind @ ..] = rest {
            (normal, rest) = index(behind, normals, &mut widths.normal)?;
            form.normal = true;
        }
    }
    Some(([texture, normal], form, rest))
}

/// Reads an index of at most eight digits, where `existing` elements are there, and counts it from
/// 0.
#[inline(always)]
fn index<'b>(bytes: &'b [u8], existing: usize, expected: &mut Expected) -> Option<(u32, &'b [u8])> {
    let (given, count) = expected.digits(Word::new(*bytes.first_chunk()?));
    let index = given.checked_sub(1)?;
    (given <= existing as u64).then_some((index as u32, &bytes[count..]))
}

/// Reads one to three numbers and the end of the line: the numbers, how many they are, and what
/// comes behind.
#[inline(always)]
fn numbers<'b>(bytes: &'b [u8], expected: &mut Expected) -> Option<([f64; 3], usize, &'b [u8])> {
    let mut numbers = [0.0; 3];
    let mut rest = after_blanks(bytes);
    for at in 0..3 {
        (numbers[at], rest) = number(rest, expected)?;
        match next_word(rest)? {
            Next::Word(word) => rest = word,
            Next::Line(behind) => return Some((numbers, at + 1, behind)),
        }
    }
    None
}

/// Reads a number without an exponent.
#[inline(always)]
fn number<'b>(bytes: &'b [u8], expected: &mut Expected) -> Option<(f64, &'b [u8])> {
    let (negative, bytes) = match bytes {
        [b'-', rest @ ..] => (true, rest),
        _ => (false, bytes),
    };
    let mut mantissa = 0;
    let whole = digits(bytes, &mut mantissa);
    let significant = if mantissa == 0 { 0 } else { whole };
    let mut rest = &bytes[whole..];
    let mut places = 0;
    if let [b'.', behind @ ..] = rest {
        places = many_digits(behind, &mut mantissa, expected);
        rest = &behind[places..];
    }
    if whole + places == 0 || whole > 19 || significant + places > 19 {
        return None;
    }
    let value = nearest(mantissa, -(places as i32))?;
    Some((if negative { -value } else { value }, rest))
}

/// What comes behind a word.
enum Next<'b> {
    /// Another word, which starts here.
    Word(&'b [u8]),
    /// The end of the line, and this behind it.
    Line(&'b [u8]),
}

#[inline(always)]
fn next_word(bytes: &[u8]) -> Option<Next<'_>> {
    let rest = after_blanks(bytes);
    match rest {
        [b'\n', behind @ ..] | [b'\r', b'\n', behind @ ..] => Some(Next::Line(behind)),
        _ => (rest.len() < bytes.len()).then_some(Next::Word(rest)),
    }
}

#[inline(always)]
fn after_blanks(mut bytes: &[u8]) -> &[u8] {
    while let [b' ', rest @ ..] = bytes {
        bytes = rest;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use proptest::test_runner::Config;

    use super::super::lines::Lines;
    use super::super::textual;
    use super::*;
    use crate::{Document, ReadError};

    /// Reads as [`Document::read`] does, every line by [`Reader::statement`].
    fn read_carefully(bytes: &[u8]) -> Result<Document, ReadError> {
        let mut lines = Lines::new(bytes);
        let mut reader = Reader::default();
        reader.start(&mut lines)?;
        while let Some(line) = lines.next()? {
            reader
                .statement(&line)
                .map_err(|fault| textual(fault, &line).at(&line))?;
        }
        let last_line = lines.number().saturating_sub(1).max(1);
        reader.finish(last_line as usize)
    }

    #[track_caller]
    fn check(bytes: &[u8]) {
        // Numbers are printed with the digits that tell them apart.
        let both = [Document::read(bytes), read_carefully(bytes)].map(|read| format!("{read:?}"));
        assert_eq!(both[0], both[1], "{}", String::from_utf8_lossy(bytes));
    }

    const START: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\n";

    #[test]
    fn usual_lines_are_read_here() {
        let lines = "v 1 2 3\nv  0.5 -0.25 .125 \r\nv 1. -0 12345.678901234567\nvt 1\nvt 0.1 0.2\n\
                     vt 1 2 3\nvn 0 0 -1\nf 1 2 3\nf 1/2 2/1 3/3\nf 1//1 2//1 3//1 \n\
                     f 1/1/1 2/1/1 3/1/1\r\nf  1  2  3  4\nf 1/1/1 2/1/1 3/1/1 4/1/1\n";
        let text = format!("{START}{lines}f 1 2 -1\n");
        let mut reader = Reader::default();
        let usual = START.lines().chain(lines.lines()).count();
        assert_eq!(
            reader.usual_lines(text.as_bytes(), 1),
            (usual as u32, START.len() + lines.len())
        );
        check(text.as_bytes());
    }

    #[test]
    fn lines_that_the_buffer_divides_are_read_whole() {
        let lines: String = (0..20_000)
            .map(|i| format!("v {i}.25 0.{i} 1\nf {} {} {}\n", i + 1, i + 2, i + 3))
            .collect();
        check(format!("{START}{lines}").as_bytes());
    }

    /// A line of words that are usual, odd or wrong.
    fn line() -> impl Strategy<Value = String> {
        let one_of = |words| prop::sample::select::<&str>(words);
        let keyword = prop_oneof![
            9 => one_of(vec!["f", "f", "f", "f", "v", "v", "v", "vt", "vn"]),
            1 => one_of(vec!["o", "vp", "", "F", "fo", " f", "#", "l"]),
        ];
        let number = prop_oneof![
            6 => "-?[0-9]{0,2}(\\.[0-9]{0,3})?",
            2 => "-?[0-9]{0,20}(\\.[0-9]{0,22})?",
            2 => "[-+]?[0-9]{1,3}(\\.[0-9]{1,3})?([eE][-+]?[0-9]{0,3})?",
            1 => one_of(vec!["nan", "1,5", "1#", "#", "1.#INF", "\\", "é", "1e76"])
                .prop_map(str::to_owned),
        ];
        let corner = prop_oneof![
            8 => "[1-5]",
            8 => "[1-4](/1/1|/1|//1)",
            1 => "-?[0-9]{0,10}(/-?[0-9]{0,2}){0,3}",
        ];
        let word = prop_oneof![number, corner.clone()];
        let words = prop_oneof![
            prop::collection::vec(word, 0..6),
            prop::collection::vec(corner, 3..6)
        ];
        let blank = prop_oneof![20 => Just(" "), 1 => one_of(vec!["  ", "\t", "\\\n"])];
        let end = prop_oneof![
            4 => one_of(vec!["\n", "\n", "\n", "\r\n", " \n"]),
            1 => one_of(vec!["\r", "# x\n", "\\\n", "\0\n", "\n\n"]),
        ];
        (keyword, words, blank, end).prop_map(|(keyword, words, blank, end)| {
            format!("{keyword}{blank}{}{end}", words.join(blank))
        })
    }

    proptest! {
        #![proptest_config(Config { cases: 20_000, failure_persistence: None, ..Config::default() })]

        #[test]
        fn usual_lines_mean_what_a_careful_reader_takes_them_for(
            start in any::<bool>(),
            lines in prop::collection::vec(line(), 1..4),
        ) {
            let start = if start { START } else { "" };
            let text = format!("{start}{}", lines.concat());
            check(text.as_bytes());
            check(text.trim_end().as_bytes());
        }
    }
}
