//! Statements of numbers: `v`, `vt` and `vn`.

use tearmesh::{COORDINATE_MAX, Mesh, Point};

use super::decimal::Expected;
use super::fault::{Fault, Parsed, quoted};
use super::reader::{Reader, limit};
use super::scan::Scan;
use crate::store::{Column, Kind, NUMBERS_MAX, Rows, push};

impl Reader {
    #[inline(always)]
    pub(super) fn vertex(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let mut numbers = [0.0; NUMBERS_MAX];
        let count = read_numbers(scan, &mut self.widths.places, &mut numbers, 3, "a vertex")?;
        let [x, y, z, ..] = numbers;
        let largest = x.abs().max(y.abs()).max(z.abs());
        if largest > COORDINATE_MAX {
            return Err(too_large(*scan, &numbers));
        }
        let index = self.document.positions.len();
        limit(index, Mesh::MAX_VERTICES, "vertices")?;
        push(&mut self.document.positions, Point::new(x, y, z));
        if count > 3 {
            let extras = &mut self.document.extras;
            limit(extras.value_count(), Rows::LIMIT - NUMBERS_MAX, "numbers")?;
            extras.set(index, &numbers[3..count]);
        }
        self.document.layout.push(Kind::Vertex, scan.line.number);
        Ok(())
    }

    #[inline(always)]
    pub(super) fn texture(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let (mut numbers, what) = ([0.0; 3], "a texture coordinate");
        let count = read_numbers(scan, &mut self.widths.places, &mut numbers, 1, what)?;
        let texture = &mut self.document.texture;
        limit(texture.value_count(), Rows::LIMIT - NUMBERS_MAX, "numbers")?;
        texture.set(texture.len(), &numbers[..count]);
        self.document.layout.push(Kind::Texture, scan.line.number);
        Ok(())
    }

    #[inline(always)]
    pub(super) fn normal(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let mut numbers = [0.0; 3];
        read_numbers(scan, &mut self.widths.places, &mut numbers, 3, "a normal")?;
        limit(self.document.normals.len(), Column::LIMIT, "normals")?;
        push(&mut self.document.normals, numbers);
        self.document.layout.push(Kind::Normal, scan.line.number);
        Ok(())
    }
}

/// Reads the numbers of a statement, of which there must be `least` and may be as many as there
/// is room for; how many there are.
#[inline(always)]
fn read_numbers<const MOST: usize>(
    scan: &mut Scan<'_>,
    places: &mut Expected,
    numbers: &mut [f64; MOST],
    least: usize,
    what: &'static str,
) -> Parsed<usize> {
    let mut count = 0;
    while !scan.at_line_end() {
        let number = scan.usual_number(places);
        if number.is_none() && !scan.find_token() {
            break;
        }
        let Some(slot) = numbers.get_mut(count) else {
            return Err(too_many_numbers(*scan, what, MOST));
        };
        *slot = match number {
            Some(number) => number,
            None => scan.number()?,
        };
        count += 1;
    }
    if count < least {
        Err(too_few_numbers(*scan, what, count, least))
    } else {
        Ok(count)
    }
}

#[cold]
fn too_few_numbers(scan: Scan<'_>, what: &str, count: usize, least: usize) -> Box<Fault> {
    let end = scan.end_of_tokens();
    let plural = if least == 1 { "" } else { "s" };
    let message = format!("{what} needs {least} number{plural}, this one has {count}");
    Fault::new("E-OBJ-COUNT", end..end, message, "expected another number")
}

#[cold]
fn too_many_numbers(scan: Scan<'_>, what: &str, most: usize) -> Box<Fault> {
    let span = scan.argument(most);
    let message = format!("{what} has at most {most} numbers");
    Fault::new("E-OBJ-COUNT", span, message, "one too many")
}

#[cold]
fn too_large(scan: Scan<'_>, numbers: &[f64; NUMBERS_MAX]) -> Box<Fault> {
    let at = numbers.iter().position(|x| x.abs() > COORDINATE_MAX);
    let span = scan.argument(at.unwrap_or(0));
    let text = quoted(&scan.line.bytes[span.clone()]);
    let message = format!("the coordinate {text} is too large");
    let label = format!("expected at most {COORDINATE_MAX:e}");
    let fault = Fault::new("E-OBJ-COORDINATE", span, message, label);
    fault.help("scale the model: computations with larger numbers would overflow")
}
