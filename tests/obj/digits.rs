//! Numbers, bit for bit: read as the standard library reads them, and written so that it reads the same.

use tearmesh_obj::Document;

use super::random::Random;
use super::{read, rewritten, text};

/// Bits without a pattern.
fn bits(random: &mut Random) -> u64 {
    let bytes = random.bytes(8).try_into();
    u64::from_le_bytes(bytes.expect("eight bytes"))
}

fn digits(random: &mut Random, count: usize) -> String {
    let digit = |_| char::from(b'0' + random.below(10) as u8);
    (0..count).map(digit).collect()
}

/// What lies in the middle between two numbers, cut to 19 digits, or beside it.
fn beside_a_half(random: &mut Random) -> String {
    let units = (1 << 53) | (bits(random) >> 11) | 1;
    let middle: u64 = [units, 1 << 53, (1 << 53) + 1, (1 << 54) - 1][random.below(4)];
    let places = random.below(19) as u32;
    let mut scaled = (u128::from(middle) * 10_u128.pow(places)) >> random.below(12);
    while scaled >= 10_u128.pow(19) {
        scaled >>= 1;
    }
    format!("{}e-{places}", scaled + random.below(5) as u128 - 2)
}

/// A number as somebody may write it.
fn number(random: &mut Random) -> String {
    match random.below(6) {
        0 => {
            let sign = ["", "-", "+"][random.below(3)];
            let [whole, fraction] = [12, 14].map(|most| random.below(most));
            let exponent = ["", "e", "E", "e+", "e-"][random.below(5)];
            let [whole, fraction] = [whole, fraction + 1].map(|count| digits(random, count));
            let power = random.below(50).to_string();
            let power = if exponent.is_empty() { "" } else { &power };
            format!("{sign}{whole}.{fraction}{exponent}{power}")
        }
        1 => {
            let mantissa = bits(random) >> random.below(64);
            format!("{mantissa}e{}", random.below(48) as i32 - 24)
        }
        // What models have: 17 digits below a thousand.
        2 => format!("{}.{}", random.below(1000), digits(random, 14)),
        3 => beside_a_half(random),
        4 => format!("{}", (random.next() - 0.5) * 1e-6),
        _ => {
            let number = f64::from_bits(bits(random));
            format!(
                "{:e}",
                if number.abs() < 1e75 {
                    number
                } else {
                    1e21 * random.next()
                }
            )
        }
    }
}

#[test]
fn numbers_are_read_and_written_as_the_library_reads_them() {
    let mut random = Random(7);
    let numbers: Vec<String> = (0..600_000).map(|_| number(&mut random)).collect();
    let lines = numbers
        .chunks(3)
        .map(|three| format!("v {}\n", three.join(" ")));
    let file = lines.collect::<String>() + "f 1 2 3\n";
    let points = read(file.as_bytes()).positions().to_vec();
    let found = points.iter().flat_map(|p| [p.x, p.y, p.z]);
    let written = text(&rewritten(file.as_bytes()));
    let words = written.split_whitespace().filter(|word| *word != "v");
    for ((number, found), word) in numbers.iter().zip(found).zip(words) {
        let [is, again] = [number, word].map(|text| text.parse::<f64>().expect("a number"));
        assert_eq!(found.to_bits(), is.to_bits(), "{number}");
        assert_eq!(
            again.to_bits(),
            is.to_bits(),
            "{number} is written as {word}"
        );
    }
}

/// The bytes that are nearest to digits are none, wherever among digits they stand.
#[test]
fn bytes_beside_digits_are_told_from_them() {
    let mut random = Random(3);
    let mut numbers = 0;
    for _ in 0..100_000 {
        let count = 1 + random.below(31);
        let byte = |_| match random.below(160) {
            odd @ 0..9 => b"/:.\0\xb0\xb9\xff\x8ap"[odd],
            digit => b'0' + (digit % 10) as u8,
        };
        let word: Vec<u8> = (0..count).map(byte).collect();
        // Far from the end of the file and near it, where a reader that looks ahead sees less.
        let rest = b"v 1 0 0\nv 0 1 0\nf 1 2 3\n# what is behind the word\n";
        let (is_last, of_word) = (random.below(2) == 1, [b"v ", &word[..], b" 0 0\n"].concat());
        let file = match is_last {
            true => [&rest[..], &of_word].concat(),
            false => [&of_word, &rest[..]].concat(),
        };
        let vertex = if is_last { 2 } else { 0 };
        let read = Document::read(&file[..]).ok();
        let found = read.map(|document| document.positions()[vertex].x.to_bits());
        let is = std::str::from_utf8(&word)
            .ok()
            .and_then(|word| word.parse::<f64>().ok());
        assert_eq!(found, is.map(f64::to_bits), "{}", text(&word));
        numbers += usize::from(is.is_some());
    }
    assert!((40_000..80_000).contains(&numbers), "{numbers}");
}
