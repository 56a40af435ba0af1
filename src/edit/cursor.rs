//! The place of a follower in a log.

/// A place in a log: the number of records before it, and a hash of their contents.
///
/// A follower starts at [`Cursor::START`], the beginning of every log, and
/// [`Edits::replay`](crate::Edits::replay) advances its cursor. The hash detects a follower of
/// another log, whose replay would silently skip edits.
///
/// The hash depends on the records alone, and is the same on every machine and in every run. So a
/// cursor may be saved ([`Cursor::to_bytes`]) together with the values that were replayed up to it,
/// and a new log can continue from it ([`Edits::starting_at`](crate::Edits::starting_at)).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Cursor {
    number: u64,
    hash: u64,
}

impl Cursor {
    /// The beginning of every log, before its first record.
    pub const START: Cursor = Cursor {
        number: 0,
        hash: 0x243f_6a88_85a3_08d3,
    };

    /// The place of a follower whose replay a panic interrupted.
    pub(super) const HALF_WAY: Cursor = Cursor {
        number: u64::MAX,
        hash: 0,
    };

    pub(super) const fn new(number: u64, hash: u64) -> Cursor {
        Cursor { number, hash }
    }

    /// Returns the number of records before this place. It is also the number of the next record,
    /// since records are numbered from 0.
    #[must_use]
    pub const fn number(self) -> u64 {
        self.number
    }

    /// Returns this cursor as sixteen bytes. [`Cursor::from_bytes`] restores it.
    #[must_use]
    pub fn to_bytes(self) -> [u8; 16] {
        let both = u128::from(self.number) << 64 | u128::from(self.hash);
        both.to_be_bytes()
    }

    /// Restores a cursor from the bytes that [`Cursor::to_bytes`] returned.
    #[must_use]
    pub fn from_bytes(bytes: [u8; 16]) -> Cursor {
        let both = u128::from_be_bytes(bytes);
        Cursor {
            number: (both >> 64) as u64,
            hash: both as u64,
        }
    }
}

/// Returns [`Cursor::START`].
impl Default for Cursor {
    fn default() -> Cursor {
        Cursor::START
    }
}

/// A running hash of the words of a record.
///
/// Each word is folded in by one multiplication of 64 by 64 bits, whose halves are added up: a few
/// cycles. It tells logs apart that differ by accident, and is no defence against anybody.
pub(super) struct RunningHash(u64);

impl RunningHash {
    /// Goes on from a cursor.
    pub(super) fn after(cursor: Cursor) -> RunningHash {
        RunningHash(cursor.hash)
    }

    /// Adds a word of up to 64 bits.
    #[inline]
    pub(super) fn add(&mut self, word: u64) {
        // A hash of zero would not change with a word of zero.
        let mixed = u128::from(self.0 ^ word ^ 0x9e37_79b9_7f4a_7c15)
            * u128::from(0xd6e8_feb8_6659_fd93_u64);
        self.0 = (mixed as u64) ^ (mixed >> 64) as u64 ^ word.rotate_left(32);
    }

    /// Adds two words of 32 bits.
    #[inline]
    pub(super) fn add_pair(&mut self, [high, low]: [u32; 2]) {
        self.add(u64::from(high) << 32 | u64::from(low));
    }

    pub(super) fn get(&self) -> u64 {
        self.0
    }
}
