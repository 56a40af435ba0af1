//! A scene file, read and checked key by key against the schema.

use std::collections::BTreeMap;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::file::{Content, SceneFile, Source, Table, Value};
use super::schema::{Key, Kind, LISTS, REMOVED, keys_of, tables};
use crate::rays::{self, Pair};
use crate::say::Fault;

/// Reads a scene file, or says everything that is wrong with it.
pub(crate) fn file(path: &str, text: &str) -> Result<SceneFile, Vec<Fault>> {
    // A mark of the byte order is no column.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source::new(path, text);
    let parsed = match DeTable::parse(text) {
        Ok(parsed) => parsed,
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let message = error.message().lines().collect::<Vec<_>>().join("; ");
            let message = format!("this is not TOML: {message}");
            return Err(vec![source.fault("E-SCENE-SYNTAX", message, &span, "")]);
        }
    };
    let mut reader = Reader {
        source: &source,
        faults: Vec::new(),
    };
    let mut read: BTreeMap<&'static str, Vec<Table>> = BTreeMap::new();
    let top = reader.table("", parsed.get_ref(), 0..0);
    read.insert("", vec![top]);
    for (name, value) in parsed.get_ref() {
        let Some(table) = tables()
            .into_iter()
            .find(|table| *table == &**name.get_ref() && !table.is_empty())
        else {
            continue; // A key of the top, or unknown and already faulted.
        };
        let found = reader.tables(table, value.get_ref(), name.span());
        read.insert(table, found);
    }
    let mut faults = reader.faults;
    if faults.is_empty() {
        return Ok(SceneFile {
            source,
            tables: read,
        });
    }
    sort(&mut faults);
    Err(faults)
}

/// In the order of the text.
pub(super) fn sort(faults: &mut [Fault]) {
    faults.sort_by_key(|fault| fault.excerpt.as_ref().map(|at| (at.line, at.span.start)));
}

struct Reader<'s> {
    source: &'s Source,
    faults: Vec<Fault>,
}

impl Reader<'_> {
    /// The tables behind a name: one, or a list.
    fn tables(&mut self, name: &'static str, value: &DeValue<'_>, at: Range<usize>) -> Vec<Table> {
        let is_list = LISTS.contains(&name);
        match value {
            DeValue::Table(table) if !is_list => vec![self.table(name, table, at)],
            DeValue::Array(array) if is_list => {
                let mut tables = Vec::new();
                for element in array {
                    if let DeValue::Table(table) = element.get_ref() {
                        tables.push(self.table(name, table, element.span()));
                    } else {
                        self.wrong_table(name, element.span());
                    }
                }
                tables
            }
            _ => {
                self.wrong_table(name, at);
                Vec::new()
            }
        }
    }

    fn wrong_table(&mut self, name: &str, at: Range<usize>) {
        let written = if LISTS.contains(&name) {
            format!("[[{name}]]")
        } else {
            format!("[{name}]")
        };
        let message = format!("`{name}` is a table");
        let label = format!("expected {written}");
        let fault = self.source.fault("E-SCENE-TYPE", message, &at, &label);
        self.faults.push(fault);
    }

    /// The values of a table; of the top, those that are no tables.
    fn table(&mut self, name: &'static str, table: &DeTable<'_>, span: Range<usize>) -> Table {
        let mut values = BTreeMap::new();
        for (found, value) in table {
            let word = &**found.get_ref();
            if name.is_empty() && tables().contains(&word) && !word.is_empty() {
                continue;
            }
            let Some(key) = keys_of(name).find(|key| key.name == word) else {
                self.unknown(name, word, found.span());
                continue;
            };
            match self.value(key, value.get_ref(), value.span()) {
                Ok(content) => {
                    let span = value.span();
                    values.insert(key.name, Value { content, span });
                }
                Err(fault) => self.faults.push(*fault),
            }
        }
        Table { values, span }
    }

    fn unknown(&mut self, table: &str, word: &str, span: Range<usize>) {
        let place = match table {
            "" => "a scene file".to_owned(),
            table => format!("[{table}]"),
        };
        let removed = REMOVED
            .iter()
            .find(|(of, key, _)| *of == table && *key == word);
        if let Some((_, _, instead)) = removed {
            let message = format!("`{word}` of {place} was removed");
            let label = "no longer a key";
            let fault = self.source.fault("E-SCENE-KEY", message, &span, label);
            self.faults.push(fault.help(*instead));
            return;
        }
        let message = format!("{place} has no key `{word}`");
        let mut names: Vec<&str> = keys_of(table).map(|key| key.name).collect();
        if table.is_empty() {
            names.extend(tables().into_iter().filter(|table| !table.is_empty()));
        }
        let near = names
            .iter()
            .map(|name| (strsim::damerau_levenshtein(word, name), *name))
            .min()
            .filter(|(distance, name)| 2 * distance <= name.len());
        let fault = self
            .source
            .fault("E-SCENE-KEY", message, &span, "unknown key");
        let help = match near {
            Some((_, name)) => format!("did you mean `{name}`?"),
            None => format!("it has {}", names.join(", ")),
        };
        self.faults.push(fault.help(help));
    }

    fn value(
        &self,
        key: &Key,
        value: &DeValue<'_>,
        span: Range<usize>,
    ) -> Result<Content, Box<Fault>> {
        let fault = |code| {
            let message = format!("`{}` is {}", key.name, key.kind.name());
            let label = match code {
                "E-SCENE-TYPE" if value.is_array() => "these are others".to_owned(),
                "E-SCENE-TYPE" => format!("this is {}", kind_of(value)),
                _ => "out of range".to_owned(),
            };
            Box::new(self.source.fault(code, message, &span, &label))
        };
        let wrong = || fault("E-SCENE-TYPE");
        let admit = |number: f64, is_in: bool| {
            is_in
                .then_some(Content::Number(number))
                .ok_or_else(|| fault("E-SCENE-RANGE"))
        };
        let row = |count: usize| {
            let row = numbers(value).filter(|row| row.len() == count);
            row.ok_or_else(wrong)
        };
        match key.kind {
            Kind::Positive | Kind::NotNegative | Kind::Ratio | Kind::Part => {
                let x = number(value).ok_or_else(wrong)?;
                let is_in = x.is_finite()
                    && match key.kind {
                        Kind::Positive => x > 0.0,
                        Kind::NotNegative => x >= 0.0,
                        Kind::Ratio => x > 1.0,
                        _ => (0.0..=1.0).contains(&x),
                    };
                admit(x, is_in)
            }
            Kind::Count => {
                let n = integer(value).ok_or_else(wrong)?;
                admit(n as f64, (1..=i64::from(u32::MAX)).contains(&n))
            }
            Kind::Bool => value.as_bool().map(Content::Bool).ok_or_else(wrong),
            Kind::Word(words) => {
                let word = value.as_str().ok_or_else(wrong)?;
                if words.contains(&word) {
                    Ok(Content::Text(word.to_owned()))
                } else {
                    Err(fault("E-SCENE-RANGE"))
                }
            }
            Kind::Pair => Ok(Content::Rows(vec![row(2)?])),
            Kind::Range => match row(2)? {
                row if row[0] <= row[1] => Ok(Content::Rows(vec![row])),
                _ => Err(fault("E-SCENE-RANGE")),
            },
            Kind::Vector => Ok(Content::Rows(vec![row(3)?])),
            Kind::NumberOrVector => match number(value) {
                Some(x) => admit(x, x >= 0.0 && x.is_finite()),
                None => Ok(Content::Rows(vec![row(3)?])),
            },
            Kind::Rays => {
                let array = value.as_array().ok_or_else(wrong)?;
                let words: Option<Vec<_>> = array
                    .iter()
                    .map(|ray| Some((ray.get_ref().as_str()?, ray.span())))
                    .collect();
                let pair = self.rays(&words.ok_or_else(wrong)?, &span)?;
                Ok(Content::Rays(Box::new(pair)))
            }
            Kind::Numbers => {
                let array = value.as_array().ok_or_else(wrong)?;
                let numbers: Option<Vec<i64>> =
                    array.iter().map(|n| integer(n.get_ref())).collect();
                let numbers = numbers.ok_or_else(wrong)?;
                let in_range = |n: &i64| (1..=i64::from(u32::MAX)).contains(n);
                if numbers.is_empty() || !numbers.iter().all(in_range) {
                    return Err(fault("E-SCENE-RANGE"));
                }
                let row = numbers.into_iter().map(|n| n as f64).collect();
                Ok(Content::Rows(vec![row]))
            }
            Kind::Moves => {
                let array = value.as_array().ok_or_else(wrong)?;
                let rows: Option<Vec<Vec<f64>>> = array
                    .iter()
                    .map(|row| numbers(row.get_ref()).filter(|row| row.len() == 4))
                    .collect();
                let rows = rows.ok_or_else(wrong)?;
                let ascend = rows.windows(2).all(|pair| pair[0][0] < pair[1][0]);
                if rows.is_empty() || !ascend {
                    return Err(fault("E-SCENE-RANGE"));
                }
                Ok(Content::Rows(rows))
            }
        }
    }
}

impl Reader<'_> {
    /// Two rays, in strings that stand in the text at these places.
    fn rays(
        &self,
        strings: &[(&str, Range<usize>)],
        all: &Range<usize>,
    ) -> Result<Pair, Box<Fault>> {
        let mut found = Vec::new();
        for (text, span) in strings {
            for part in rays::split_pair(text) {
                let ray = rays::ray(&text[part.clone()]).map_err(|wrong| {
                    let part = part.start + wrong.part.start..part.start + wrong.part.end;
                    let at = self.source.within(span, text, part);
                    let fault = self
                        .source
                        .fault(wrong.code, wrong.message, &at, wrong.label);
                    Box::new(fault.help(rays::RAY_HELP))
                })?;
                found.push(ray);
            }
        }
        Pair::try_from(found).map_err(|found| {
            let (message, label) = rays::miscounted(found.len());
            let fault = self.source.fault("E-RAY-COUNT", message, all, label);
            Box::new(fault.help(rays::PAIR_HELP))
        })
    }
}

fn kind_of(value: &DeValue<'_>) -> &'static str {
    match value {
        DeValue::String(_) => "a text",
        DeValue::Integer(_) => "a whole number",
        DeValue::Float(_) => "a number",
        DeValue::Boolean(_) => "true or false",
        DeValue::Datetime(_) => "a date",
        DeValue::Array(_) => "a list",
        DeValue::Table(_) => "a table",
    }
}

/// A number, whole or not. Underscores are allowed as in TOML.
fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Integer(_) => integer(value).map(|n| n as f64),
        DeValue::Float(float) => float.as_str().parse().ok(),
        _ => None,
    }
}

fn integer(value: &DeValue<'_>) -> Option<i64> {
    let integer = value.as_integer()?;
    i64::from_str_radix(integer.as_str(), integer.radix()).ok()
}

/// A list of finite numbers.
fn numbers(value: &DeValue<'_>) -> Option<Vec<f64>> {
    let finite = |x: &f64| x.is_finite();
    let array = value.as_array()?.iter();
    array.map(|x| number(x.get_ref()).filter(finite)).collect()
}
