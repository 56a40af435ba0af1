//! Readers of answers and pages of the command.

use std::io::Read as _;

use base64::Engine as _;
use serde_json::Value;

/// The text of a page, and the bytes behind it.
pub(crate) fn content(html: &str) -> (Value, Vec<u8>) {
    let (_, data) = html.split_once("type=\"text/plain\">").expect("data");
    let (data, _) = data.split_once('<').expect("an end");
    let packed = base64::engine::general_purpose::STANDARD.decode(data);
    let packed = packed.expect("base64");
    let mut bytes = Vec::new();
    let mut inflated = flate2::read::ZlibDecoder::new(&packed[..]);
    inflated.read_to_end(&mut bytes).expect("zlib");
    let length = u32::from_le_bytes(bytes[..4].try_into().expect("four bytes")) as usize;
    let behind = bytes.split_off(4 + length);
    (serde_json::from_slice(&bytes[4..]).expect("JSON"), behind)
}

/// What the line about energy says: who took energy, and by how many joules its parts do not add up beyond their rounding to three
/// digits. None if there is no such line, or if it says that not all is known.
pub(crate) fn added_up(said: &str) -> Option<(Vec<&str>, f64)> {
    let line = said
        .lines()
        .find_map(|line| line.strip_prefix("energy: "))?;
    if line.contains("is not known") {
        return None;
    }
    let (mut takers, mut sum, mut rounding) = (Vec::new(), 0.0_f64, 0.0);
    for part in line.split(", ") {
        let (number, what) = part.split_once(" J ").expect("a number of joules");
        let joules: f64 = number.parse().expect("a number");
        let is_given = matches!(what, "put in" | "made by the method");
        sum += if is_given { joules } else { -joules };
        rounding += 0.005 * joules.abs();
        takers.push(what);
    }
    Some((takers, (sum.abs() - rounding).max(0.0)))
}
