//! Bytes on their way out, in chunks.

use std::io::{self, Write};

use super::number::{write_integer, write_number};
use crate::opening::Opening;

/// How many bytes are handed to the output at once.
const CHUNK: usize = 64 << 10;

/// Bytes on their way to the output.
pub(super) struct Output<'o, W> {
    sink: &'o mut W,
    pub(super) pending: Vec<u8>,
    /// Whether the sink has anything.
    has_begun: bool,
}

impl<'o, W: Write> Output<'o, W> {
    pub(super) fn new(sink: &'o mut W) -> Output<'o, W> {
        Output {
            sink,
            pending: Vec::with_capacity(CHUNK + 4096),
            has_begun: false,
        }
    }

    pub(super) fn statement(
        &mut self,
        keyword: &[u8],
        numbers: &[f64],
        more: &[f64],
    ) -> io::Result<()> {
        self.pending.extend_from_slice(keyword);
        for &number in numbers.iter().chain(more) {
            self.pending.push(b' ');
            write_number(&mut self.pending, number);
        }
        self.pending.push(b'\n');
        self.flush_if_full()
    }

    /// Adds a corner of a face: a vertex, a texture coordinate and a normal, counted from 0.
    pub(super) fn corner(&mut self, vertex: u32, [texture, normal]: [Option<u32>; 2]) {
        let out = &mut self.pending;
        out.push(b' ');
        write_integer(out, u64::from(vertex) + 1);
        if texture.is_some() || normal.is_some() {
            out.push(b'/');
        }
        if let Some(texture) = texture {
            write_integer(out, u64::from(texture) + 1);
        }
        if let Some(normal) = normal {
            out.push(b'/');
            write_integer(out, u64::from(normal) + 1);
        }
    }

    pub(super) fn text(&mut self, bytes: &[u8]) -> io::Result<()> {
        if bytes.len() > CHUNK {
            self.flush()?;
            return self.send(bytes);
        }
        self.pending.extend_from_slice(bytes);
        self.flush_if_full()
    }

    #[inline]
    pub(super) fn flush_if_full(&mut self) -> io::Result<()> {
        if self.pending.len() < CHUNK {
            Ok(())
        } else {
            self.flush()
        }
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        let mut pending = std::mem::take(&mut self.pending);
        self.send(&pending)?;
        pending.clear();
        self.pending = pending;
        Ok(())
    }

    /// What comes first is kept from being taken for more than text: where it stood, behind what is
    /// dropped or was moved, it was no more.
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        if !self.has_begun && Opening::of(bytes) != Opening::Text {
            self.sink.write_all(b"\n")?;
        }
        self.has_begun |= !bytes.is_empty();
        self.sink.write_all(bytes)
    }
}
