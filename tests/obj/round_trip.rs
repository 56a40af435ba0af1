//! Reading, writing and reading again; and whatever bytes there may be.

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use tearmesh_obj::{Document, ReadError};

use super::same_bytes;

/// A number in one of the forms that files have.
fn number() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<f64>()
            .prop_filter("finite", |x| x.abs() < 1e75)
            .prop_map(|x| format!("{x:?}")),
        (-1e3..1e3f64).prop_map(|x| format!("{x:.6}")),
        (-9i32..9).prop_map(|x| x.to_string()),
        Just("-0.0".to_owned()),
        (-9i32..9).prop_map(|x| format!("{x}.E+1")),
    ]
}

fn numbers(count: std::ops::RangeInclusive<usize>) -> impl Strategy<Value = String> {
    prop::collection::vec(number(), count).prop_map(|numbers| numbers.join(" "))
}

/// A statement that is carried through.
fn other() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        Just(b"".to_vec()),
        Just(b"  \t".to_vec()),
        Just(b"# caf\xe9\\".to_vec()),
        Just(b"g".to_vec()),
        Just(b"usemtl a#b \\\nc".to_vec()),
        Just(b"o x y".to_vec()),
        Just(b"nv 1 2 \\\n 3".to_vec()),
        Just(b"vv 0".to_vec()),
        Just(b" nl 1 # c".to_vec()),
        Just(b"l -1 1".to_vec()),
        Just(b"p -1\\".to_vec()),
        Just(b"\xef\xbb\xbfv 1 2 3".to_vec()),
        prop::collection::vec(any::<u8>(), 0..12),
    ]
}

/// Faces of a strip over six vertices, in the forms that corners have.
fn face() -> impl Strategy<Value = String> {
    let form = 0u8..5;
    let shape = prop_oneof![
        Just(vec![1, 2, 3]),
        Just(vec![3, 2, 4]),
        Just(vec![3, 4, 6, 5]),
        Just(vec![1, 2, 4, 6, 5, 3]),
    ];
    (shape, prop::collection::vec(form, 6), any::<bool>()).prop_map(|(shape, forms, relative)| {
        let mut text = "f".to_owned();
        for (v, form) in shape.into_iter().zip(forms) {
            let v = if relative { v - 7 } else { v };
            text += &match form {
                0 => format!(" {v}"),
                1 => format!(" {v}/1"),
                2 => format!(" {v}//1"),
                3 => format!(" {v}/2/2"),
                _ => format!(" {v}/"),
            };
        }
        text
    })
}

fn statement() -> impl Strategy<Value = Vec<u8>> {
    prop_oneof![
        4 => other(),
        2 => numbers(1..=3).prop_map(|n| format!("vt {n}").into_bytes()),
        2 => numbers(3..=3).prop_map(|n| format!("vn {n} # n").into_bytes()),
        2 => numbers(3..=8).prop_map(|n| format!("v {n}#").into_bytes()),
        2 => face().prop_map(String::into_bytes),
    ]
}

/// A file: statements anywhere, among them six vertices, two of each attribute, and faces.
fn file() -> impl Strategy<Value = Vec<u8>> {
    let lists = (
        prop::collection::vec(statement(), 0..8),
        prop::collection::vec(numbers(3..=6), 6),
        prop::collection::vec(statement(), 0..8),
        prop::collection::vec(numbers(3..=3), 2),
        prop::collection::vec(face(), 1..3),
    );
    let ends = prop_oneof![Just(&b"\n"[..]), Just(&b"\r\n"[..]), Just(&b"\r"[..])];
    (lists, ends, any::<bool>()).prop_map(
        |((before, points, between, normals, faces), end, late)| {
            let faces: Vec<Vec<u8>> = faces.into_iter().map(String::into_bytes).collect();
            let mut lines = before;
            if late {
                lines.extend(faces.clone());
            }
            lines.extend(points.into_iter().map(|p| format!("v {p}").into_bytes()));
            lines.extend(between);
            for normal in normals {
                lines.push(format!("vn {normal}").into_bytes());
                lines.push(b"vt 0 1".to_vec());
            }
            if !late {
                lines.extend(faces);
            }
            lines.join(end)
        },
    )
}

proptest! {
    #![proptest_config(super::properties())]

    #[test]
    fn written_files_are_fixed_points(bytes in file()) {
        same_bytes::check_file(&bytes, &[]);
    }

    #[test]
    fn bytes_of_any_kind_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        same_bytes::check_file(&bytes, &[]);
    }

    #[test]
    fn files_with_a_few_wrong_bytes_are_read_or_refused(
        mut bytes in file(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        same_bytes::check_file(&bytes, &[]);
    }

    /// Where it points, there is the text that it quotes.
    #[test]
    fn a_refusal_points_into_the_file(bytes in file(), at in any::<prop::sample::Index>()) {
        let cut = &bytes[..at.index(bytes.len())];
        if let Err(ReadError::Refused(diagnostic)) = Document::read(cut) {
            let place = diagnostic.location.expect("every refusal has a place");
            let ends = cut.iter().enumerate().filter(|&(i, &byte)| {
                byte == b'\n' && (i == 0 || cut[i - 1] != b'\r') || byte == b'\r'
            });
            prop_assert!(place.line <= ends.count() + 1);
        }
    }
}

#[test]
fn enough_random_files_are_meshes() {
    // Otherwise the properties above would hold of nothing.
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut meshes = 0;
    for _ in 0..300 {
        let tree = file()
            .new_tree(&mut runner)
            .expect("a strategy without filters");
        let bytes = tree.current();
        meshes +=
            usize::from(Document::read(&bytes[..]).is_ok_and(|document| document.mesh().is_ok()));
    }
    assert!(meshes > 30, "{meshes} of 300");
}
