//! The number of elements that a file in memory is likely to hold, from samples of its lines.
//!
//! Lists that are long enough from the start are not moved as they grow; in a small file that is a
//! tenth of the time. To count all lines would take as long; the sections of a file are found in samples
//! all over it. What a list is expected to hold is a part of the file, so that all room together is
//! bounded by the file: five bytes for each of its bytes at worst, and one as a rule. What is not needed
//! is given back.

use memchr::memchr_iter;

use crate::document::Document;
use crate::store::reserve;

/// How many samples there are, of how many bytes. Where sections meet, the expected number is wrong by half
/// of what lies between two samples.
const SAMPLES: usize = 64;
const LENGTH: usize = 256;

/// What the sampled lines hold.
#[derive(Debug, Default)]
struct Sample {
    bytes: usize,
    vertices: usize,
    texture: usize,
    texture_numbers: usize,
    normals: usize,
    faces: usize,
    corners: usize,
    corners_with_texture: usize,
    corners_with_normal: usize,
}

impl Document {
    /// Makes room for a file. One that is shorter than a few times its samples gets none.
    pub(super) fn make_room(&mut self, file: &[u8]) {
        if file.len() < 4 * SAMPLES * LENGTH {
            return;
        }
        let mut sample = Sample::default();
        for at in 0..SAMPLES {
            sample.add(&file[at * (file.len() / SAMPLES)..][..LENGTH]);
        }
        // A sixteenth more, for what the samples miss.
        let scale = 17 * file.len() as u64;
        let expected =
            |count: usize| (count as u64 * scale / (16 * sample.bytes.max(1) as u64)) as usize;
        let polygons = &mut self.polygons;
        reserve(&mut self.positions, expected(sample.vertices));
        reserve(&mut self.normals, expected(sample.normals));
        reserve(&mut polygons.starts, expected(sample.faces));
        reserve(&mut polygons.vertices, expected(sample.corners));
        polygons
            .texture
            .reserve(expected(sample.corners_with_texture));
        polygons
            .normals
            .reserve(expected(sample.corners_with_normal));
        self.texture
            .reserve(expected(sample.texture), expected(sample.texture_numbers));
    }

    /// Gives back the room that was not needed.
    pub(super) fn give_back_room(&mut self) {
        let polygons = &mut self.polygons;
        self.positions.shrink_to_fit();
        self.normals.shrink_to_fit();
        polygons.starts.shrink_to_fit();
        polygons.vertices.shrink_to_fit();
        polygons.texture.shrink_to_fit();
        polygons.normals.shrink_to_fit();
        self.texture.shrink_to_fit();
    }
}

impl Sample {
    /// Adds the whole lines of some bytes; the first one may have begun before them.
    fn add(&mut self, bytes: &[u8]) {
        let mut ends = memchr_iter(b'\n', bytes);
        let Some(mut start) = ends.next() else {
            return;
        };
        for end in ends {
            self.bytes += end - start;
            self.add_line(&bytes[start + 1..end]);
            start = end;
        }
    }

    fn add_line(&mut self, line: &[u8]) {
        // Numbers and indices take a byte at least, whatever a hostile line has in their place.
        let count = |byte: u8| line.iter().filter(|&&other| other == byte).count();
        match line {
            [b'v', b' ', ..] if line.len() >= 7 => self.vertices += 1,
            [b'v', b't', b' ', ..] => {
                self.texture += 1;
                self.texture_numbers += count(b' ').min(3);
            }
            [b'v', b'n', b' ', ..] if line.len() >= 8 => self.normals += 1,
            [b'f', b' ', ..] => {
                let (corners, slashes) = (count(b' ').min(line.len() / 2), count(b'/'));
                self.faces += 1;
                self.corners += corners;
                self.corners_with_texture += slashes.min(corners);
                self.corners_with_normal += (slashes - slashes.min(corners)).min(corners);
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The room of each list, in bytes.
    fn room(document: &Document) -> [usize; 8] {
        let polygons = &document.polygons;
        let [values, ends] = document.texture.room();
        [
            24 * document.positions.capacity(),
            24 * document.normals.capacity(),
            4 * polygons.starts.capacity(),
            4 * polygons.vertices.capacity(),
            polygons.texture.room(),
            polygons.normals.room(),
            values,
            ends,
        ]
    }

    fn made(file: &str) -> [usize; 8] {
        let mut document = Document::default();
        document.make_room(file.as_bytes());
        room(&document)
    }

    #[test]
    fn room_is_enough_and_little_more() {
        let lines = |line: &str| line.repeat(9000);
        let numbers = lines("v -0.123456 0.5 1.25\n") + &lines("vt 0.25 0.75\n");
        for face in [
            "1 2 3",
            "1/1 2/2 3/3",
            "1//1 2//1 3//1",
            "1/1/1 2/2/1 3/3/1 4/4/1",
        ] {
            let file = format!("{numbers}vn 0 0 1\n{}", lines(&format!("f {face}\n")));
            let read = Document::read(file.as_bytes()).expect("a mesh");
            for (made, needed) in made(&file).into_iter().zip(room(&read)) {
                assert!(needed < 100 || needed <= made, "{face}: {made} of {needed}");
                assert!(
                    made <= needed + file.len() / 4,
                    "{face}: {made} for {needed}"
                );
            }
        }
    }

    #[test]
    fn room_is_bounded_by_the_file() {
        let lines = [
            "v \n",
            "v 0 0 0\n",
            "vt \n",
            "vt 0\n",
            "vt         \n",
            "vn \n",
            "f \n",
            "f 1 2 3\n",
            "f 1/1/1 2/1/1\n",
            "f / / / / / / / /\n",
            "f // // // // //\n",
            "f           ////////\n",
        ];
        for line in lines {
            let file = line.repeat(400_000 / line.len());
            let all: usize = made(&file).iter().sum();
            assert!(all <= 5 * file.len(), "{line:?}: {all} for {}", file.len());
        }
    }

    #[test]
    fn room_that_is_not_needed_is_given_back() {
        let file = "v 0 0 0\n".repeat(20_000) + "f 1 2 3\n";
        let document = Document::read(file.as_bytes()).expect("a mesh");
        assert_eq!(document.positions.capacity(), document.positions.len());
    }
}
