//! Lists of numbers, of which mostly a few change: the faces of a mesh that tears.
//!
//! A list is written as what is other than in the list before: its length, and then runs: how many numbers
//! stay, how many are new, and each new one as the difference to the new one before it. Counts are written
//! seven bits a byte, the lowest first, the eighth bit set where more follow; differences are folded, so
//! that 0, −1, 1, −2 are 0, 1, 2, 3.

/// Writes a list that has followed another.
pub(super) fn write_change(before: &[u32], now: &[u32], out: &mut Vec<u8>) {
    write_count(now.len() as u64, out);
    let is_same = |i: usize| before.get(i) == Some(&now[i]);
    let (mut at, mut last) = (0, 0i64);
    while at < now.len() {
        let changed = (at..now.len()).find(|&i| !is_same(i)).unwrap_or(now.len());
        write_count((changed - at) as u64, out);
        // The run goes on over a number that stayed, if another has changed right behind it.
        let stays = |&i: &usize| is_same(i) && (i + 1 == now.len() || is_same(i + 1));
        at = (changed..now.len()).find(stays).unwrap_or(now.len());
        write_count((at - changed) as u64, out);
        for &number in &now[changed..at] {
            write_count(folded(i64::from(number) - last), out);
            last = i64::from(number);
        }
    }
}

/// The same for whole numbers without a sign, small for small ones.
pub(super) fn folded(number: i64) -> u64 {
    ((number << 1) ^ (number >> 63)) as u64
}

fn write_count(mut count: u64, out: &mut Vec<u8>) {
    while count >= 0x80 {
        out.push(count as u8 | 0x80);
        count >>= 7;
    }
    out.push(count as u8);
}
