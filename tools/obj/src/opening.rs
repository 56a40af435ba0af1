//! What the first bytes of a file say of all of it.

/// A byte order mark, which only the start of a file has.
pub(crate) const MARK: &[u8] = b"\xef\xbb\xbf";

/// Anything but [`Opening::Text`] is so only at the start of a file: elsewhere it is text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Opening {
    Text,
    /// [`MARK`], and text behind it.
    Mark,
    Utf16,
    /// A model in another format.
    Binary,
}

impl Opening {
    /// How many bytes tell, of a file that has as many.
    pub(crate) const LENGTH: usize = 4;

    /// That of a file which begins like this.
    pub(crate) fn of(first: &[u8]) -> Opening {
        match first {
            [0xff, 0xfe, ..] | [0xfe, 0xff, ..] => Opening::Utf16,
            // Without a byte order mark, UTF-16 shows by every other byte being zero.
            &[0, a, 0, b, ..] | &[a, 0, b, 0, ..] if a != 0 && b != 0 => Opening::Utf16,
            [b'g', b'l', b'T', b'F', ..] => Opening::Binary,
            _ if first.starts_with(MARK) => Opening::Mark,
            _ => Opening::Text,
        }
    }
}
