//! One number that stands for many bytes (FNV-1a of 64 bits). It tells apart what differs by accident, on every
//! machine alike, and is no defence against anybody.

/// The digest of no bytes.
pub const EMPTY: u64 = 0xcbf2_9ce4_8422_2325;

/// Returns the digest of all bytes so far, of which that of those before `bytes` is `digest`. Each item may be
/// a larger word, which is then taken in as one byte is.
#[must_use]
pub fn after(digest: u64, bytes: impl IntoIterator<Item = impl Into<u64>>) -> u64 {
    let words = bytes.into_iter().map(Into::into);
    words.fold(digest, |digest, word: u64| {
        (digest ^ word).wrapping_mul(0x0100_0000_01b3)
    })
}
