//! The record, to comments.

use std::io::{self, Write};

use super::number::{write_integer, write_number};
use super::output::Output;
use super::prepare::Prepared;
use crate::families::Families;
use crate::order::Order;
use crate::record::{Apart, END, HEADER, Hash, ITEM, Record, Slid, VERSION, are_last, runs};

/// Writes the record, if there is one: everything before it is written, and its faces have this
/// hash.
pub(super) fn write_record<W: Write>(
    prepared: &Prepared<'_>,
    faces: Hash,
    out: &mut Output<'_, W>,
) -> io::Result<()> {
    let Some(record) = &prepared.record else {
        return Ok(());
    };
    let [vertices, texture, normals] = prepared.orders.each_ref().map(Order::count);
    let inserted = |runs: &[[u32; 2]]| -> usize {
        let counts = runs.iter().map(|[first, end]| end - first);
        counts.sum::<u32>() as usize
    };
    let [new_texture, new_normals] = &record.new_indices;
    let says_where = [(new_texture, texture), (new_normals, normals)]
        .map(|(runs, count)| !are_last(runs, count as u32));
    let is_later = says_where.contains(&true) || !record.slides.is_empty();
    let copies = runs(prepared.fans().map(|[copy, _]| copy));
    let is_later = is_later || !are_last(&copies, vertices as u32);
    let version = match () {
        () if record.families.all().iter().any(|one| one.above.is_some()) => VERSION,
        () if !record.apart.is_empty() => 3,
        () if is_later => 2,
        () => 1,
    };
    let bytes = &mut out.pending;
    bytes.extend_from_slice(HEADER);
    writeln!(
        bytes,
        " {version} v {vertices} f {} vt {} {texture} vn {} {normals} faces {:016x}",
        prepared.slots.faces.len(),
        texture - inserted(new_texture),
        normals - inserted(new_normals),
        faces.0
    )?;
    let mut items = Items {
        out,
        count: 0,
        hash: Hash::default(),
    };
    items.write(record, prepared.fans())?;
    for (word, runs, says_where) in [
        ("vt", new_texture, says_where[0]),
        ("vn", new_normals, says_where[1]),
    ] {
        for [first, end] in runs.iter().filter(|_| says_where) {
            items.item(word, &[first + 1, *end], &[])?;
        }
    }
    items.write_slides(&record.slides)?;
    for Apart { vertex, is, shown } in &record.apart {
        let numbers = [is.x, is.y, is.z, shown.x, shown.y, shown.z];
        items.item("apart", &[vertex + 1], &numbers)?;
    }
    items.write_again(&record.families, prepared.slots.faces.len())?;
    let Items { out, count, hash } = items;
    let bytes = &mut out.pending;
    bytes.extend_from_slice(END);
    writeln!(bytes, " {count} {:016x}", hash.0)?;
    out.flush_if_full()
}

struct Items<'o, 'w, W> {
    out: &'o mut Output<'w, W>,
    count: usize,
    hash: Hash,
}

impl<W: Write> Items<'_, '_, W> {
    fn write(&mut self, record: &Record, fans: impl Iterator<Item = [u32; 2]>) -> io::Result<()> {
        for split in &record.splits {
            let numbers = [split.vertex + 1, split.from + 1, split.cut];
            self.item("split", &numbers, &[])?;
        }
        for [copy, vertex] in fans {
            self.item("fan", &[copy + 1, vertex + 1], &[])?;
        }
        for inserted in &record.inserted {
            let [a, b, c] = inserted.between.map(|root| root + 1);
            let whole = [inserted.vertex + 1, inserted.cut, a, b, c];
            if inserted.is_on_edge() {
                self.item("edge", &whole[..4], &inserted.weights[1..2])?;
            } else {
                self.item("face", &whole, &inserted.weights)?;
            }
        }
        for (parent, faces) in record.families.parents() {
            let [a, b, c] = record.families.all()[parent as usize]
                .corners
                .map(|v| v + 1);
            self.item("parent", &[faces.start + 1, faces.end, a, b, c], &[])?;
        }
        Ok(())
    }

    fn write_slides(&mut self, slides: &[Slid]) -> io::Result<()> {
        for slid in slides {
            self.item("slide", &[slid.vertex + 1, slid.cut], &slid.numbers)?;
            for exchange in &slid.exchanges {
                let word = ["slide-vt", "slide-vn"][exchange.which];
                let indices = [exchange.new + 1, exchange.old + 1];
                self.item(word, &indices, &exchange.value)?;
            }
        }
        Ok(())
    }

    fn write_again(&mut self, families: &Families, faces: usize) -> io::Result<()> {
        let mut of = vec![Vec::new(); families.all().len()];
        for face in 0..faces {
            if let Some(family) = families.of(face) {
                of[family as usize].push(face as u32 + 1);
            }
        }
        // Counted without parents.
        let (mut numbers, mut count) = (Vec::with_capacity(of.len()), 0);
        for (family, faces) in families.all().iter().zip(of) {
            let Some(above) = family.above else {
                numbers.push(0);
                continue;
            };
            count += 1;
            numbers.push(count);
            let [a, b, c] = family.corners.map(|v| v + 1);
            let above = numbers[above as usize];
            self.item("again", &[&[above, a, b, c], &faces[..]].concat(), &[])?;
        }
        Ok(())
    }

    fn item(&mut self, word: &str, whole: &[u32], numbers: &[f64]) -> io::Result<()> {
        let out = &mut self.out.pending;
        let start = out.len();
        out.extend_from_slice(ITEM);
        out.push(b' ');
        out.extend_from_slice(word.as_bytes());
        for &number in whole {
            out.push(b' ');
            write_integer(out, u64::from(number));
        }
        for &number in numbers {
            out.push(b' ');
            write_number(out, number);
        }
        out.push(b'\n');
        self.hash.add(&out[start..]);
        self.count += 1;
        self.out.flush_if_full()
    }
}
