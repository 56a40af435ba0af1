//! A line means the same however it is spelt: what the reader's common case reads, and its cold arms.
//!
//! The reader looks at digits, single blanks and line feeds where it meets them, and sets everything
//! else apart. So each text is read as it is, and with tabs, continuations, signs, comments and other
//! line ends in place of the plain ones; numbers, faces and refusals must be the same.

use std::io::BufReader;

use proptest::prelude::*;
use tearmesh_obj::Document;

use super::properties;

const START: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nf 1 2 3\n";

/// A comment that is longer than what the reader looks ahead in a common line.
const PADDING: &str = "#                                                                \n";

/// What a text says, but for its lines.
fn meaning(text: &str) -> Result<String, &'static str> {
    let document = match Document::read(text.as_bytes()) {
        Ok(document) => document,
        Err(error) => return Err(error.diagnostic().expect("memory can be read").code),
    };
    let vertices = 0..document.positions().len();
    let extras: Vec<&[f64]> = vertices.map(|v| document.extra_numbers(v)).collect();
    let texture = 0..document.texture_count();
    let texture: Vec<&[f64]> = texture.map(|index| document.texture(index)).collect();
    let polygons = 0..document.polygon_count();
    let polygons: Vec<Vec<_>> = polygons.map(|p| document.polygon(p).collect()).collect();
    // Numbers are printed with the digits that tell them apart.
    Ok(format!(
        "{:?} {extras:?} {texture:?} {:?} {polygons:?}",
        document.positions(),
        document.normals()
    ))
}

/// Lines with other blanks between the words and other ends.
fn respelt(lines: &[Vec<String>], blank: &str, end: &str) -> String {
    let lines = lines.iter().map(|words| words.join(blank) + end);
    lines.collect()
}

/// A number, which may be hard to round, or none.
fn number() -> impl Strategy<Value = String> {
    let odd = prop::sample::select(vec![
        "nan", "1,5", "1.#INF", "é", "1e76", ".", "1e", "1e999",
    ]);
    prop_oneof![
        20 => "-?[0-9]{1,3}(\\.[0-9]{0,9})?",
        20 => "[-+]?[0-9]{0,2}\\.[0-9]{1,22}",
        20 => "[-+]?[0-9]{1,20}([eE][-+]?[0-9]{1,2})?",
        20 => "[-+]?[0-9]{1,3}\\.[0-9]{1,17}[eE][-+]?[0-9]{1,2}",
        1 => odd.prop_map(str::to_owned),
    ]
}

/// A corner of a face, which may count back, ahead or beyond.
fn corner() -> impl Strategy<Value = String> {
    prop_oneof![
        20 => "[1-5]",
        20 => "[1-4](/1/1|/1|//1)",
        5 => "-[1-4](/-1|/|//)",
        5 => "0{0,9}[1-4]",
        1 => "-?[0-9]{0,10}(/-?[0-9]{0,2}){0,3}",
    ]
}

/// The words of a line, which is mostly a statement that is accepted.
fn line() -> impl Strategy<Value = Vec<String>> {
    use prop::collection::vec;
    let line = prop_oneof![
        (Just("v"), vec(number(), 3..6)),
        (Just("vt"), vec(number(), 1..4)),
        (Just("vn"), vec(number(), 3)),
        (Just("f"), vec(corner(), 3..6)),
        (Just("f"), vec(corner(), 3)),
        (Just("fo"), vec(corner(), 4)),
    ];
    line.prop_map(|(keyword, mut words)| {
        words.retain(|word| !word.is_empty());
        words.insert(0, keyword.to_owned());
        words
    })
}

proptest! {
    #![proptest_config(properties())]

    #[test]
    fn blanks_line_ends_and_comments_change_no_meaning(
        start in any::<bool>(),
        lines in prop::collection::vec(line(), 1..4),
    ) {
        let start = if start { START } else { "" };
        let plain = format!("{start}{}", respelt(&lines, " ", "\n"));
        let meant = meaning(&plain);
        let spellings = [
            ("  ", " \n"), ("\t", "\n"), (" \\\n", "\n"), ("\\ \r\n ", "\r\n"), (" ", "\r"),
            (" ", "\r\n"), (" ", "# 1 2\n"), (" ", " #\n"), ("\x0b", "\x0c\\\n\n"),
        ];
        for (blank, end) in spellings {
            let text = format!("{start}{}", respelt(&lines, blank, end));
            prop_assert_eq!(&meaning(&text), &meant, "{:?} for {:?}", text, plain);
            let cut_off = text.trim_end();
            prop_assert_eq!(&meaning(cut_off), &meant, "{:?} for {:?}", cut_off, plain);
            let padded = text + PADDING;
            prop_assert_eq!(&meaning(&padded), &meant, "{:?} for {:?}", padded, plain);
        }
    }
}

#[test]
fn lines_that_blocks_divide_are_read_whole() {
    let lines: String = (0..20_000)
        .map(|i| format!("v {i}.25 0.{i} 1\nf {} {} {}\n", i + 1, i + 2, i + 3))
        .collect();
    let (plain, odd) = (lines.clone(), lines.replace(' ', "\t"));
    let both = [plain, odd].map(|lines| meaning(&format!("{START}{lines}")));
    assert!(both[0].is_ok() && both[0] == both[1]);
}

/// The reader expects the corners of a face to be like those of the face before.
#[test]
fn faces_mean_the_same_behind_faces_of_any_form() {
    let faces = [
        "1 2 3",
        "4 2 1 3",
        "1/1 2/1 3/1",
        "1/1 2/1 4/1 3/1",
        "1//1 2//1 3//1",
        "1/1/1 2/1/1 3/1/1",
        "1/1/1 2/1/1 4/1/1 3/1/1",
        "1/1/ 2/1/ 3/1/",
        "1/ 2/ 3/",
        "1 2/1 3//1",
        "1/1 2/1 3",
        "-1 2 3",
        "1 2 4 3 5",
        "1/1 2/1 4/1 3/1 5/1",
        "1 2",
        "1/1 2/1 1/1",
        "1 2 3 2",
        "1 2 9",
        "1/1 2/1 3/9",
    ];
    let lines = faces.map(|face| format!("f {face}\n"));
    let pairs = lines
        .iter()
        .flat_map(|one| lines.iter().map(move |other| [one, other]));
    for [one, other] in pairs {
        let text = format!("v 2 2 0\n{START}{one}{one}{other}{other}{PADDING}");
        let spelt_oddly = text.replace(' ', "\t");
        assert_eq!(meaning(&text), meaning(&spelt_oddly), "{text}");
    }
}

/// The reader takes lines where its input has them, and joins those that pieces of the input divide.
#[test]
fn inputs_mean_the_same_in_pieces_of_any_size() {
    let long = format!(
        "f 1 2 \\\n{}3\r\n# {}\n",
        " \\\r\n".repeat(300),
        "x".repeat(3000)
    );
    let rest = [
        "f 1 2 3\r\n",
        "\r\r\n\nvt 1\\\r\n 2\r\r",
        &long,
        "f 1 2 9",
        "f 2 3 4\\\n",
        "v 1 \\",
        "\r",
    ];
    let starts = ["", "\u{feff}", "\u{feff}\u{feff}"];
    for text in starts
        .iter()
        .flat_map(|start| rest.map(|rest| format!("{start}{START}{rest}")))
    {
        let whole = format!("{:?}", Document::read(text.as_bytes()));
        for size in [1, 2, 3, 5, 7, 64, 1000] {
            let pieces = BufReader::with_capacity(size, text.as_bytes());
            assert_eq!(
                format!("{:?}", Document::read(pieces)),
                whole,
                "{size} of {text:?}"
            );
        }
    }
}
