//! Files as data: what becomes of each, to the letter, by the table beside this file.
//!
//! A line that begins at the margin is a file with its escapes, or what is done to one; the indented lines
//! below are what is said of it, and behind `=` what is written of it (nothing, if that is the file itself).
//! `TEARMESH_BLESS=1` writes the table anew; read the difference before you keep it.

use std::io::Read as _;
use std::path::Path;

use tearmesh_obj::{Document, ReadError, Repair};

use super::refuse::refusal;
use super::work::exercise;
use super::{digest, positions, read, rewritten, text, write_as};

/// Beginnings of files that stand in the table by their names.
const NAMES: [(&str, &str); 6] = [
    ("{TORN}", TORN),
    ("{APART}", APART),
    (
        "{SAID}",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nnv 1 2 3\n# kept\nv 0 1 0\nnl 4\nv 0.5 1 0\n\
         f 1 2 3\nf 7 6 5\nf 7 5 4\n",
    ),
    ("{LONELY}", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nf 1 2 3\n"),
    (
        "{SIX}",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nv 2 2 2\n",
    ),
    ("{THREE}", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
];

/// Two triangles torn apart at vertices 2 and 3, with a vertex on the edge 3-4 of the second.
pub(crate) const TORN: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0.5 1 0\n\
    f 1 2 3\nf 7 6 5\nf 7 5 4\n";

/// The same without that vertex; the lip of the second stands apart.
pub(crate) const APART: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 1.25 0.5 0\nv 0 1.5 0\n\
    f 1 2 3\nf 6 5 4\n";

/// A body of triangles without texture, and a record of it: the version and `counts` of `vt` and `vn`.
pub(crate) fn with_record(body: &str, version: &str, counts: &str, items: &str) -> String {
    let lines = |keyword: &'static str| body.lines().filter_map(move |l| l.strip_prefix(keyword));
    let (vertices, faces) = (lines("v ").count(), lines("f ").count());
    let corners = lines("f ").flat_map(|face| face.split(' '));
    let corners = corners.map(|corner| corner.parse::<u32>().expect("an index") - 1);
    let hash = digest::after(digest::EMPTY, (vertices as u64).to_le_bytes());
    let hash = digest::after(hash, corners.flat_map(u32::to_le_bytes));
    let sum = digest::after(digest::EMPTY, items.bytes());
    let count = items.lines().count();
    format!(
        "{body}#tearmesh record {version} v {vertices} f {faces} {counts} faces {hash:016x}\n{items}\
         #tearmesh end {count} {sum:016x}\n"
    )
}

/// A body with the record that fits it.
pub(crate) fn whole(body: &str) -> String {
    let (version, rest) = match body {
        TORN => ("1", "#~ edge 7 1 3 4 0.5\n#~ parent 2 3 3 2 4\n"),
        _ => (
            "3",
            "#~ apart 5 1 0 0 1.25 0.5 0\n#~ apart 6 0 1 0 0 1.5 0\n",
        ),
    };
    let items = format!("#~ split 5 2 1\n#~ split 6 3 1\n{rest}");
    with_record(body, version, "vt 0 0 vn 0 0", &items)
}

/// The bytes that [`u8::escape_ascii`] writes so.
fn unescaped(written: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = written.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'\\' => match rest.next().expect("an escape") {
                b'n' => b'\n',
                b'r' => b'\r',
                b't' => b'\t',
                b'x' => {
                    let digits = [(); 2].map(|()| rest.next().expect("two digits") as char);
                    u8::from_str_radix(&String::from_iter(digits), 16).expect("a byte")
                }
                itself => itself,
            },
            byte => byte,
        });
    }
    assert_eq!(bytes.escape_ascii().to_string(), written);
    bytes
}

/// The file of a row, and how it is repaired.
fn file(row: &str) -> (Vec<u8>, Option<Repair>) {
    let plain = |text: &str| {
        let named = NAMES
            .iter()
            .find_map(|(name, start)| Some((start, text.strip_prefix(name)?)));
        let (start, rest) = named.map_or(("", text), |(start, rest)| (*start, rest));
        [start.as_bytes(), &unescaped(rest)].concat()
    };
    let string = |text: &str| String::from_utf8(unescaped(text)).expect("a text");
    let edits = [("torn, but ", TORN), ("apart, but ", APART)];
    let mut edits = edits.into_iter();
    if let Some((edit, body)) = edits.find_map(|(but, body)| Some((row.strip_prefix(but)?, body))) {
        let (from, to) = edit.split_once(" -> ").expect("two texts");
        let [from, to] = [from, to].map(string);
        let file = whole(body);
        assert!(file.contains(&from), "{row}");
        return (file.replacen(&from, &to, 1).into_bytes(), None);
    }
    match row.split_once(": ") {
        Some(("fans", text)) => (plain(text), Some(Repair::SeparateFans)),
        Some(("all", text)) => (plain(text), Some(Repair::All)),
        Some((head, items)) if head.starts_with("record ") => {
            let words: Vec<&str> = head.split(' ').collect();
            let (version, counts) = (words[1], words[3..].join(" "));
            let body = NAMES.iter().find(|(name, _)| *name == words[2]);
            let (_, body) = body.expect("a name");
            let file = with_record(body, version, &counts, &string(items));
            (file.into_bytes(), None)
        }
        _ => (plain(row), None),
    }
}

/// What is said of a file, and what is written of it.
fn outcome(bytes: &[u8], repair: Option<Repair>) -> Vec<String> {
    // In two parts, so that no line and no escape has to come whole.
    let (one, other) = bytes.split_at(bytes.len() / 2);
    let document = match Document::read(one.chain(other)) {
        Ok(document) => document,
        Err(ReadError::Refused(_)) => return vec![refusal(bytes)],
        Err(error) => panic!("{error}"),
    };
    let document = match repair {
        Some(repair) => document.repaired(repair),
        None => document,
    };
    let said = document.diagnostics().iter();
    let mut lines: Vec<String> = said.map(|one| format!("{one}  [{}]", one.code)).collect();
    let mesh = match document.mesh() {
        Ok(mesh) => mesh,
        Err(error) => {
            assert!(error.shown().iter().all(|defect| defect.help.is_some()));
            lines.extend(error.to_string().lines().map(str::to_owned));
            return lines;
        }
    };
    assert!(repair.is_some() || exercise(bytes));
    let written = write_as(&document, &mesh, &positions(&document));
    assert_eq!(text(&rewritten(&written)), text(&written), "written again");
    if !text(&written).contains("#tearmesh record") {
        let again = read(&written);
        let of_record = again
            .diagnostics()
            .iter()
            .find(|one| one.code.contains("RECORD"));
        assert_eq!(of_record, None, "what is left out is not warned of again");
    }
    let same = if written == bytes {
        ""
    } else {
        &*written.escape_ascii().to_string()
    };
    let named = NAMES.iter().find_map(|(name, start)| {
        let rest = same.strip_prefix(&start.escape_default().to_string())?;
        Some(format!("{name}{rest}"))
    });
    lines.push(
        format!("= {}", named.unwrap_or(same.to_owned()))
            .trim_end()
            .to_owned(),
    );
    lines
}

#[test]
fn files_of_the_table_become_what_it_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/obj/files.txt");
    let pinned = std::fs::read_to_string(&path).expect("a table");
    let (mut table, mut rows) = (String::new(), 0);
    for line in pinned.lines().filter(|line| !line.starts_with("    ")) {
        table += &format!("{line}\n");
        if !line.is_empty() && !line.starts_with("## ") {
            let (bytes, repair) = file(line);
            for said in outcome(&bytes, repair) {
                table += &format!("    {said}\n");
            }
            rows += 1;
        }
    }
    if std::env::var_os("TEARMESH_BLESS").is_some() {
        std::fs::write(&path, &table).expect("a blessed table");
    }
    for (is, was) in table.lines().zip(pinned.lines()) {
        assert_eq!(is, was);
    }
    assert_eq!(table.len(), pinned.len());
    assert!(rows > 200, "{rows} files");
}
