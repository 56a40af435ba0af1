//! Those who read OBJ: other crates, and a plain loop.
//!
//! All are given the same bytes in memory, and give what they keep, whole and in memory. Each
//! is asked for as little as it offers: no welding, no triangulation where it can be left out.

/// Vertices and triangles alone, in twenty lines: what reading costs that checks nothing,
/// keeps nothing else, and knows no line numbers.
#[derive(Debug, Default)]
pub(crate) struct Plain {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Plain {
    pub(crate) fn read(bytes: &[u8]) -> Option<Plain> {
        let mut plain = Plain::default();
        for line in std::str::from_utf8(bytes).ok()?.lines() {
            let mut words = line.split_ascii_whitespace();
            match words.next() {
                Some("v") => plain.positions.push(three(words)?),
                Some("f") => plain
                    .triangles
                    .push(three::<u32>(words)?.map(|index| index - 1)),
                _ => {}
            }
        }
        Some(plain)
    }
}

fn three<T: std::str::FromStr>(mut words: std::str::SplitAsciiWhitespace<'_>) -> Option<[T; 3]> {
    let mut number = || words.next()?.parse().ok();
    Some([number()?, number()?, number()?])
}

pub(crate) fn obj_rs(bytes: &[u8]) -> obj_rs::raw::RawObj {
    obj_rs::raw::parse_obj(bytes).expect("it reads all dialects")
}

pub(crate) fn tobj(mut bytes: &[u8]) -> Vec<tobj::Model> {
    let options = tobj::LoadOptions::default();
    let no_materials = |_: &std::path::Path| unreachable!("no file names a library");
    let (models, _) =
        tobj::load_obj_buf(&mut bytes, &options, no_materials).expect("it reads all dialects");
    models
}

pub(crate) fn wavefront_obj(bytes: &[u8]) -> wavefront_obj::obj::ObjSet {
    let text = std::str::from_utf8(bytes).expect("digits and blanks");
    wavefront_obj::obj::parse(text).expect("it reads all dialects")
}

pub(crate) fn obj(bytes: &[u8]) -> obj::ObjData {
    obj::ObjData::load_buf(bytes).expect("it reads all dialects")
}

pub(crate) fn wobj(bytes: &[u8]) -> wobj::Obj {
    wobj::Obj::parse(bytes).expect("it reads all dialects")
}
