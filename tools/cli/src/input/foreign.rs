//! Files of other formats, recognized by their first bytes.

/// How much of a file tells its format.
pub(super) const OPENING: usize = 1024;

/// How long a binary STL file is before its triangles, and how long each of these.
const STL_HEADER: u64 = 84;
const STL_TRIANGLE: u64 = 50;

/// A format that is not OBJ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Format {
    Ply,
    Stl,
}

impl Format {
    /// The format of a file of this length that begins so, if it is one of these.
    pub(super) fn of(opening: &[u8], length: u64) -> Option<Format> {
        let has = |text: &[u8]| opening.windows(text.len()).any(|window| window == text);
        let is_ply = [&b"ply\n"[..], b"ply\r"]
            .iter()
            .any(|mark| opening.starts_with(mark));
        let triangles = opening.get(80..84).map(|count| {
            let count = count.try_into().expect("four bytes");
            u64::from(u32::from_le_bytes(count))
        });
        // Some binary files begin with `solid` too.
        let is_binary = |triangles: u64| length == STL_HEADER + STL_TRIANGLE * triangles;
        if is_ply {
            Some(Format::Ply)
        } else if triangles.is_some_and(is_binary) || opening.starts_with(b"solid") && has(b"facet")
        {
            Some(Format::Stl)
        } else {
            None
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Format::Ply => "a PLY",
            Format::Stl => "an STL",
        }
    }

    /// How a file is converted.
    pub(super) fn advice(self, file: &str) -> String {
        let stem = file.rsplit_once('.').map_or(file, |(stem, _)| stem);
        let convert = format!("convert it first, as with `assimp export {file} {stem}.obj");
        match self {
            Format::Ply => convert + "`",
            Format::Stl => convert + " -jiv`, which joins the corners that STL has once a face",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Format;

    #[test]
    fn formats_are_told_by_their_openings() {
        let mut binary = [0; 84];
        binary[..5].copy_from_slice(b"solid");
        binary[80] = 3;
        for (opening, length, format) in [
            (&b"ply\nformat ascii 1.0\n"[..], 900, Some(Format::Ply)),
            (b"ply\r\nformat", 900, Some(Format::Ply)),
            (b"polygons\n", 900, None),
            (b"solid cube\nfacet normal 0 0 1\n", 900, Some(Format::Stl)),
            (b"solid ground\nv 0 0 0\n", 900, None),
            (&binary, 84 + 150, Some(Format::Stl)),
            (&binary, 84 + 151, None),
            (b"", 0, None),
        ] {
            assert_eq!(Format::of(opening, length), format);
        }
    }
}
