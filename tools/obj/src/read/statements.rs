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
        if let Some(place) = scan.usual_numbers(&mut self.widths.places) {
            return self.add_vertex(scan, place, &[]);
        }
        let mut numbers = [0.0; NUMBERS_MAX];
        let count = self.numbers(scan, &mut numbers, 3, "a vertex")?;
        let [x, y, z, ..] = numbers;
        self.add_vertex(scan, [x, y, z], &numbers[3..count])
    }

    #[inline(always)]
    fn add_vertex(&mut self, scan: &Scan<'_>, place: [f64; 3], extras: &[f64]) -> Parsed<()> {
        let [x, y, z] = place;
        if x.abs().max(y.abs()).max(z.abs()) > COORDINATE_MAX {
            return Err(too_large(*scan, place));
        }
        let index = self.document.positions.len();
        limit(index, Mesh::MAX_VERTICES, "vertices")?;
        push(&mut self.document.positions, Point::new(x, y, z));
        if !extras.is_empty() {
            let all = &mut self.document.extras;
            limit(all.value_count(), Rows::LIMIT - NUMBERS_MAX, "numbers")?;
            all.set(index, extras);
        }
        self.document.layout.push(Kind::Vertex, scan.line.number);
        Ok(())
    }

    #[inline(always)]
    pub(super) fn texture(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        if let Some::<[f64; 2]>(numbers) = scan.usual_numbers(&mut self.widths.places) {
            return self.add_texture(scan, &numbers);
        }
        let mut numbers = [0.0; 3];
        let count = self.numbers(scan, &mut numbers, 1, "a texture coordinate")?;
        self.add_texture(scan, &numbers[..count])
    }

    #[inline(always)]
    fn add_texture(&mut self, scan: &Scan<'_>, numbers: &[f64]) -> Parsed<()> {
        let texture = &mut self.document.texture;
        limit(texture.value_count(), Rows::LIMIT - NUMBERS_MAX, "numbers")?;
        texture.set(texture.len(), numbers);
        self.document.layout.push(Kind::Texture, scan.line.number);
        Ok(())
    }

    #[inline(always)]
    pub(super) fn normal(&mut self, scan: &mut Scan<'_>) -> Parsed<()> {
        let mut numbers = [0.0; 3];
        match scan.usual_numbers(&mut self.widths.places) {
            Some(usual) => numbers = usual,
            None => _ = self.numbers(scan, &mut numbers, 3, "a normal")?,
        }
        limit(self.document.normals.len(), Column::LIMIT, "normals")?;
        push(&mut self.document.normals, numbers);
        self.document.layout.push(Kind::Normal, scan.line.number);
        Ok(())
    }

    /// Reads the numbers of a statement, of which there must be `least` and may be as many as there
    /// is room for; how many there are.
    fn numbers(
        &mut self,
        scan: &mut Scan<'_>,
        numbers: &mut [f64],
        least: usize,
        what: &'static str,
    ) -> Parsed<usize> {
        let (behind, count) = read_numbers(*scan, &mut self.widths.places, numbers, least, what)?;
        *scan = behind;
        Ok(count)
    }
}

#[inline(never)]
fn read_numbers<'l>(
    mut scan: Scan<'l>,
    places: &mut Expected,
    numbers: &mut [f64],
    least: usize,
    what: &'static str,
) -> Parsed<(Scan<'l>, usize)> {
    let mut count = 0;
    while !scan.at_line_end() {
        let number = scan.usual_number(places);
        if number.is_none() && !scan.find_token() {
            break;
        }
        let Some(slot) = numbers.get_mut(count) else {
            return Err(too_many_numbers(scan, what, numbers.len()));
        };
        *slot = match number {
            Some(number) => number,
            None => scan.number()?,
        };
        count += 1;
    }
    if count < least {
        Err(too_few_numbers(scan, what, count, least))
    } else {
        Ok((scan, count))
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
fn too_large(scan: Scan<'_>, place: [f64; 3]) -> Box<Fault> {
    let at = place.iter().position(|x| x.abs() > COORDINATE_MAX);
    let span = scan.argument(at.unwrap_or(0));
    let text = quoted(&scan.line.bytes[span.clone()]);
    let message = format!("the coordinate {text} is too large");
    let label = format!("expected at most {COORDINATE_MAX:e}");
    let fault = Fault::new("E-OBJ-COORDINATE", span, message, label);
    fault.help("scale the model: computations with larger numbers would overflow")
}
