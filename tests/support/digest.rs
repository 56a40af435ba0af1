//! One number that stands for many bytes (FNV-1a of 64 bits): no defence against anybody, and the same
//! everywhere.

/// The digest of no bytes.
pub(crate) const EMPTY: u64 = 0xcbf2_9ce4_8422_2325;

/// The digest of some bytes, of which that of all before `bytes` is `digest`.
pub(crate) fn after(digest: u64, bytes: impl IntoIterator<Item = u8>) -> u64 {
    let add = |digest: u64, byte| (digest ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.into_iter().fold(digest, add)
}
