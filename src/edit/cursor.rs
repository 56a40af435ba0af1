//! The place of a follower in a log.

/// A place in a log: the number of records before it, and a hash of their contents.
///
/// A follower starts at [`Cursor::START`], the beginning of every log, and
/// [`Edits::replay`](crate::Edits::replay) advances its cursor. The hash detects a follower of
/// another log, whose replay would silently skip edits. It depends on the records alone, and is the
/// same on every machine and in every run.
#[derive(Clone, Copy, Debug, Eq)]
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

    /// [`Cursor::START`] as long as nobody has said so: the place of values that are new. They may be
    /// those of a mesh that has been edited since, and where their number does not show that,
    /// nothing does. The first replay makes a place of it, even one of an empty log.
    pub(crate) const ASSUMED: Cursor = Cursor {
        hash: 0,
        ..Cursor::START
    };

    /// The place of a follower whose replay a panic interrupted.
    pub(super) const HALF_WAY: Cursor = Cursor {
        number: u64::MAX,
        hash: 0,
    };

    /// Returns the number of records before this place. It is also the number of the next record,
    /// since records are numbered from 0.
    #[must_use]
    pub const fn number(self) -> u64 {
        self.number
    }

    pub(super) fn is_assumed(self) -> bool {
        (self.number, self.hash) == (Cursor::ASSUMED.number, Cursor::ASSUMED.hash)
    }

    /// This place, known to be one.
    pub(crate) fn known(self) -> Cursor {
        if self.is_assumed() {
            Cursor::START
        } else {
            self
        }
    }

    /// The place after one record more, once the words of that have been added.
    pub(super) fn advanced(self) -> Cursor {
        Cursor {
            number: self.number + 1,
            ..self
        }
    }

    /// Adds a word of up to 64 bits of a record to the hash: by one multiplication of 64 by 64 bits, whose
    /// halves are added up, which takes a few cycles. It tells logs apart that differ by accident, and
    /// is no defence against anybody.
    #[inline]
    pub(super) fn add(&mut self, word: u64) {
        // A hash of zero would not change with a word of zero.
        let mixed = u128::from(self.hash ^ word ^ 0x9e37_79b9_7f4a_7c15)
            * u128::from(0xd6e8_feb8_6659_fd93_u64);
        self.hash = (mixed as u64) ^ (mixed >> 64) as u64 ^ word.rotate_left(32);
    }

    /// Adds two words of 32 bits.
    #[inline]
    pub(super) fn add_pair(&mut self, [high, low]: [u32; 2]) {
        self.add(u64::from(high) << 32 | u64::from(low));
    }
}

impl PartialEq for Cursor {
    fn eq(&self, other: &Cursor) -> bool {
        let same =
            |one: Cursor, other: Cursor| (one.number, one.hash) == (other.number, other.hash);
        same(*self, *other) || same(self.known(), other.known()) // In this order, as most are the same.
    }
}

/// Returns [`Cursor::START`].
impl Default for Cursor {
    fn default() -> Cursor {
        Cursor::START
    }
}
