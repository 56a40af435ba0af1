//! Compact storage for what a file holds.
//!
//! A hostile file must not cost more than twelve times its size, and an honest one should
//! cost little more than its numbers: rows of numbers are one flat list, an attribute that no
//! corner has takes no memory, and the order of statements is a list of runs.

/// Appends a value. Grows by half where `Vec` doubles: the memory for a file stays within
/// its bound even at the moment of growth, when old and new storage exist side by side.
#[inline(always)]
pub(crate) fn push<T>(list: &mut Vec<T>, value: T) {
    if list.len() == list.capacity() {
        grow(list, 1);
    }
    list.push(value);
}

/// Appends values, growing as [`push`] does.
#[inline]
pub(crate) fn extend<T: Copy>(list: &mut Vec<T>, values: &[T]) {
    if list.capacity() - list.len() < values.len() {
        grow(list, values.len());
    }
    list.extend_from_slice(values);
}

/// Appends the first `count` of four values, growing as [`push`] does. All four are copied, which is a
/// single instruction, and those in excess dropped.
#[inline(always)]
pub(crate) fn extend_by_some(list: &mut Vec<u32>, values: &[u32; 4], count: usize) {
    let first = list.len();
    if list.capacity() - first < values.len() {
        grow(list, values.len());
    }
    list.extend_from_slice(values);
    list.truncate(first + count);
}

/// Makes room for a number of elements.
pub(crate) fn reserve<T>(list: &mut Vec<T>, count: usize) {
    list.reserve_exact(count.saturating_sub(list.len()));
}

/// Adds half, and at first more: most lists of a file are long, and a few are many and short.
#[cold]
fn grow<T>(list: &mut Vec<T>, least: usize) {
    let len = list.len();
    list.reserve_exact((len / 2 + (8 * len).clamp(4, 64)).max(least));
}

/// How many of the numbers below `count` come before the first for which a condition, which then
/// holds for none behind it, does not hold.
pub(crate) fn partition_point(count: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = low.midpoint(high);
        if holds(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}

/// The most numbers of a `v` statement: a position, a weight, a colour with alpha, and as many again.
pub(crate) const NUMBERS_MAX: usize = 16;

/// Rows of numbers, each with a length of its own.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rows {
    values: Vec<f64>,
    /// Where each row ends in `values`. Rows that are missing at the end are empty.
    ends: Vec<u32>,
}

impl Rows {
    /// The most numbers that fit.
    pub(crate) const LIMIT: usize = u32::MAX as usize;

    /// Appends a row as the row `index`; those between the last one and it are empty.
    #[inline(always)]
    pub(crate) fn set(&mut self, index: usize, row: &[f64]) {
        let end = self.values.len() as u32;
        while self.ends.len() < index {
            push(&mut self.ends, end);
        }
        for &value in row {
            push(&mut self.values, value);
        }
        push(&mut self.ends, self.values.len() as u32);
    }

    pub(crate) fn reserve(&mut self, rows: usize, values: usize) {
        reserve(&mut self.ends, rows);
        reserve(&mut self.values, values);
    }

    pub(crate) fn shrink_to_fit(&mut self) {
        self.ends.shrink_to_fit();
        self.values.shrink_to_fit();
    }

    /// How many bytes there is room for, of numbers and of ends.
    #[cfg(test)]
    pub(crate) fn room(&self) -> [usize; 2] {
        [8 * self.values.capacity(), 4 * self.ends.capacity()]
    }

    /// A row; empty beyond the last one.
    #[inline]
    pub(crate) fn row(&self, index: usize) -> &[f64] {
        let Some(&end) = self.ends.get(index) else {
            return &[];
        };
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.values[start as usize..end as usize]
    }

    /// The rows that stay of `count`, in their order.
    pub(crate) fn staying(&self, count: usize, stays: impl Fn(usize) -> bool) -> Rows {
        let mut rows = Rows::default();
        for (new, old) in (0..count).filter(|&old| stays(old)).enumerate() {
            if !self.row(old).is_empty() {
                rows.set(new, self.row(old));
            }
        }
        rows
    }

    /// The number of rows, up to the last that was set.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The number of numbers.
    pub(crate) fn value_count(&self) -> usize {
        self.values.len()
    }
}

/// An optional index for each corner. Costs nothing until the first corner has one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Column {
    /// Corners that are missing at the end have none.
    values: Vec<u32>,
}

impl Column {
    const NONE: u32 = u32::MAX;

    /// The most indices there can be, so that none equals the mark for "none".
    pub(crate) const LIMIT: usize = Self::NONE as usize;

    /// Gives the corner `index`, which comes after all that have one, an index.
    #[inline]
    pub(crate) fn set(&mut self, index: usize, value: u32) {
        while self.values.len() < index {
            push(&mut self.values, Self::NONE);
        }
        push(&mut self.values, value);
    }

    /// Gives the corners from `first` on, which come after all that have one, the first `count` of these
    /// indices.
    #[inline(always)]
    pub(crate) fn extend_by_some(&mut self, first: usize, values: &[u32; 4], count: usize) {
        while self.values.len() < first {
            push(&mut self.values, Self::NONE);
        }
        extend_by_some(&mut self.values, values, count);
    }

    pub(crate) fn reserve(&mut self, count: usize) {
        reserve(&mut self.values, count);
    }

    pub(crate) fn shrink_to_fit(&mut self) {
        self.values.shrink_to_fit();
    }

    /// How many bytes there is room for.
    #[cfg(test)]
    pub(crate) fn room(&self) -> usize {
        4 * self.values.capacity()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    #[inline]
    pub(crate) fn get(&self, index: usize) -> Option<u32> {
        self.values
            .get(index)
            .copied()
            .filter(|&value| value != Self::NONE)
    }
}

/// The kinds of things that a file is a sequence of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// `v`
    Vertex,
    /// `vt`
    Texture,
    /// `vn`
    Normal,
    /// `f`, or `fo` as it was called once
    Polygon,
    /// Anything else, kept as bytes: whole lines, each with `\n` at its end.
    Text,
}

impl Kind {
    /// The kinds that indices count.
    pub(crate) const INDEXED: [Kind; 3] = [Kind::Vertex, Kind::Texture, Kind::Normal];

    /// What one of an indexed kind is called, and several.
    pub(crate) fn names(self) -> [&'static str; 2] {
        match self {
            Kind::Texture => ["texture coordinate", "texture coordinates"],
            Kind::Normal => ["normal", "normals"],
            _ => ["vertex", "vertices"],
        }
    }
}

/// Neighbouring statements of one kind, on consecutive lines or all on one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    pub(crate) kind: Kind,
    is_on_one_line: bool,
    /// How many statements, or for text, how many bytes.
    pub(crate) count: u32,
    /// The line of the first statement.
    line: u32,
    /// How many polygons come before this run.
    polygons_before: u32,
}

impl Run {
    /// The line of a statement, by how many of the run come before it; of text, the first one alone is known.
    pub(crate) fn line(self, before: u32) -> u32 {
        self.line + if self.is_on_one_line { 0 } else { before }
    }

    fn ends_before(self, line: u32) -> bool {
        self.line.wrapping_add(self.count) == line && !self.is_on_one_line
    }
}

/// In which order the statements of a file come, and on which lines they stand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Layout {
    runs: Vec<Run>,
    polygons: u32,
}

impl Layout {
    /// Adds a statement that is not text.
    #[inline]
    pub(crate) fn push(&mut self, kind: Kind, line: u32) {
        match self.runs.last_mut() {
            Some(run) if run.kind == kind && run.ends_before(line) => {
                run.count += 1;
            }
            _ => self.begin(kind, 1, line),
        }
        self.polygons += u32::from(kind == Kind::Polygon);
    }

    fn begin(&mut self, kind: Kind, count: u32, line: u32) {
        let run = Run {
            kind,
            is_on_one_line: false,
            count,
            line,
            polygons_before: self.polygons,
        };
        push(&mut self.runs, run);
    }

    /// Adds bytes of text.
    pub(crate) fn push_text(&mut self, bytes: usize, line: u32) {
        let bytes = u32::try_from(bytes).expect("the cap on the length of a line fits 32 bits");
        match self.runs.last_mut() {
            Some(Run {
                kind: Kind::Text,
                count,
                ..
            }) if count.checked_add(bytes).is_some() => {
                *count += bytes;
            }
            _ => self.begin(Kind::Text, bytes, line),
        }
    }

    /// Adds vertices behind the last one and the bytes that are attached to it. All stand on its line.
    pub(crate) fn add_vertices(&mut self, added: usize, attached: usize) {
        let vertices = self.runs.iter().rposition(|run| run.kind == Kind::Vertex);
        let mut place = vertices.expect("there is a vertex") + 1;
        let last = self.runs[place - 1];
        self.runs.reserve_exact(2);
        if attached > 0 {
            let text = &mut self.runs[place];
            let rest = text.count - attached as u32;
            let behind = Run {
                count: rest,
                ..*text
            };
            text.count = attached as u32;
            place += 1;
            if rest > 0 {
                self.runs.insert(place, behind);
            }
        }
        let added = Run {
            is_on_one_line: true,
            count: added as u32,
            line: last.line(last.count - 1),
            ..last
        };
        self.runs.insert(place, added);
    }

    pub(crate) fn runs(&self) -> &[Run] {
        &self.runs
    }

    /// The line on which a polygon begins. Takes the logarithm of the number of runs.
    pub(crate) fn line_of_polygon(&self, polygon: usize) -> usize {
        let after = self
            .runs
            .partition_point(|run| run.polygons_before as usize <= polygon);
        let run = self.runs[..after]
            .iter()
            .rfind(|run| run.kind == Kind::Polygon);
        let run = run.expect("every polygon belongs to a run");
        run.line as usize + polygon - run.polygons_before as usize
    }

    /// The line on which a vertex stands. Linear in the number of runs.
    pub(crate) fn line_of_vertex(&self, vertex: usize) -> Option<usize> {
        let mut before = 0;
        for run in self.runs.iter().filter(|run| run.kind == Kind::Vertex) {
            if vertex < before + run.count as usize {
                return Some(run.line((vertex - before) as u32) as usize);
            }
            before += run.count as usize;
        }
        None
    }
}
