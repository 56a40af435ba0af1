//! A scene file as it is read, and the place of each key in it, for diagnostics.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

use serde::Deserialize;
use tearmesh_cloth::scene::file::{self, OUT_OF_RANGE, SceneFault, SceneFile};
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::schema::{Key, REMOVED, Section};
use crate::rays;
use crate::say::Fault;

/// A scene file in which every key is known and every value has the right kind, and where all of it stands.
#[derive(Clone, Debug)]
pub(crate) struct SceneSource {
    pub(super) file: SceneFile,
    pub(super) text: Text,
    /// Those of each name in the order of the file. There is always one without a name, the top.
    tables: Vec<Table>,
}

/// Where a table and the values in it stand.
#[derive(Clone, Debug)]
struct Table {
    name: &'static str,
    span: Range<usize>,
    values: BTreeMap<&'static str, Range<usize>>,
}

impl SceneSource {
    /// Reads a scene file, or says everything that is wrong with it.
    pub(super) fn read(path: &str, text: &str) -> Result<SceneSource, Vec<Fault>> {
        let source = Text {
            path: path.to_owned(),
            text: text.to_owned(),
        };
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
            sections: &Section::all(),
            text: &source,
            tables: Vec::new(),
            faults: Vec::new(),
        };
        let top = parsed.get_ref();
        for section in reader.sections {
            match top.get_key_value(section.table) {
                _ if section.table.is_empty() => reader.table(section, top, 0..0),
                Some((key, value)) => reader.tables(section, key.span(), value),
                None => {}
            }
        }
        let (tables, faults) = (reader.tables, reader.faults);
        none_of(faults)?;
        let whole = Spanned::new(parsed.span(), DeValue::Table(parsed.into_inner()));
        let file = SceneFile::deserialize(ValueDeserializer::from(whole));
        Ok(SceneSource {
            file: file.expect("every value was read alone"),
            text: source,
            tables,
        })
    }

    /// Whether the file has a table of this name.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.tables(name).next().is_some()
    }

    /// The tables of this name.
    fn tables(&self, name: &str) -> impl Iterator<Item = &Table> {
        self.tables.iter().filter(move |table| table.name == name)
    }

    /// A fault with the place of a key in the table of this number, or of the table where it lacks the key.
    pub(crate) fn blame(
        &self,
        (table, number, key): (&str, usize, &str),
        code: &'static str,
        message: String,
    ) -> Fault {
        match self.tables(table).nth(number) {
            Some(table) => {
                let span = table.values.get(key).unwrap_or(&table.span);
                self.text.fault(code, message, span, "")
            }
            None => Fault::error(code, message),
        }
    }

    /// A fault of the scene, with its place.
    pub(super) fn placed(&self, fault: SceneFault) -> Fault {
        let at = (fault.table, fault.number, fault.key);
        let placed = self.blame(at, fault.code, fault.message);
        match fault.help {
            Some(help) => placed.help(help),
            None => placed,
        }
    }
}

/// Fails if there are faults, which are then in the order of the text.
pub(super) fn none_of(mut faults: Vec<Fault>) -> Result<(), Vec<Fault>> {
    faults.sort_by_key(|fault| fault.location);
    match faults.is_empty() {
        true => Ok(()),
        false => Err(faults),
    }
}

struct Reader<'s> {
    sections: &'s [Section],
    text: &'s Text,
    tables: Vec<Table>,
    faults: Vec<Fault>,
}

impl Reader<'_> {
    /// The tables of a name: one, or any number of those in lists.
    fn tables(&mut self, section: &Section, key: Range<usize>, value: &Spanned<DeValue<'_>>) {
        let (name, title) = (section.table, section.title);
        match value.get_ref() {
            DeValue::Table(table) if !section.is_list() => self.table(section, table, key),
            DeValue::Array(array) if section.is_list() => {
                for element in array {
                    match element.get_ref() {
                        DeValue::Table(table) => self.table(section, table, element.span()),
                        _ => self.wrong_table(name, title, element.span()),
                    }
                }
            }
            _ => self.wrong_table(name, title, key),
        }
    }

    fn wrong_table(&mut self, name: &str, title: &str, at: Range<usize>) {
        let message = format!("`{name}` is a table");
        let label = format!("expected {title}");
        let fault = self.text.fault("E-SCENE-TYPE", message, &at, &label);
        self.faults.push(fault);
    }

    /// A table, key by key, so that all faults are found; of the top, what is no table.
    fn table(&mut self, section: &Section, table: &DeTable<'_>, span: Range<usize>) {
        let mut values = BTreeMap::new();
        for (key, value) in table {
            let word = &**key.get_ref();
            let is_table = self.sections.iter().any(|section| section.table == word);
            if section.table.is_empty() && is_table {
                continue;
            }
            let Some(known) = section.keys.iter().find(|known| known.name == word) else {
                self.unknown(section, word, key.span());
                continue;
            };
            match check(section.table, key.clone(), value.clone()) {
                Ok(()) => {
                    values.insert(known.name, value.span());
                }
                Err(code) => self.refused(known, value, code),
            }
        }
        self.tables.push(Table {
            name: section.table,
            span,
            values,
        });
    }

    /// A value that its kind does not admit.
    fn refused(&mut self, key: &Key, value: &Spanned<DeValue<'_>>, code: &'static str) {
        if key.kind == "two rays"
            && let Some(fault) = self.text.rays(value)
        {
            self.faults.push(fault);
            return;
        }
        let label = match (code, value.get_ref()) {
            ("E-SCENE-RANGE", _) => "out of range".to_owned(),
            (_, DeValue::Array(_)) => "these are others".to_owned(),
            (_, other) => format!("this is {}", kind_of(other)),
        };
        let message = format!("`{}` is {}", key.name, key.admits());
        let fault = self.text.fault(code, message, &value.span(), &label);
        self.faults.push(fault);
    }

    fn unknown(&mut self, section: &Section, word: &str, span: Range<usize>) {
        let mut names: Vec<&str> = section.keys.iter().map(|key| key.name).collect();
        let place = match section.table {
            "" => "a scene file".to_owned(),
            table => format!("[{table}]"),
        };
        if section.table.is_empty() {
            let tables = self.sections.iter().map(|section| section.table);
            names.extend(tables.filter(|table| !table.is_empty()));
        }
        let whole = format!("{}.{word}", section.table);
        let removed = REMOVED.iter().find(|(key, _)| *key == whole);
        let (message, label) = match removed {
            Some(_) => (
                format!("`{word}` of {place} was removed"),
                "no longer a key",
            ),
            None => (format!("{place} has no key `{word}`"), "unknown key"),
        };
        let help = match (removed, near(word, &names)) {
            (Some((_, instead)), _) => (*instead).to_owned(),
            (None, Some(name)) => format!("did you mean `{name}`?"),
            (None, None) => format!("it has {}", names.join(", ")),
        };
        let fault = self.text.fault("E-SCENE-KEY", message, &span, label);
        self.faults.push(fault.help(help));
    }
}

/// Reads a value alone, as the field that its key names in a table. Refuses it with the code of the error.
fn check(
    table: &str,
    key: Spanned<Cow<'_, str>>,
    value: Spanned<DeValue<'_>>,
) -> Result<(), &'static str> {
    let span = value.span();
    let mut alone = DeTable::new();
    alone.insert(key, value);
    let read = read_alone(table, Spanned::new(span, DeValue::Table(alone)));
    read.map_err(|error| match error.message().contains(OUT_OF_RANGE) {
        true => "E-SCENE-RANGE",
        false => "E-SCENE-TYPE",
    })
}

/// Reads a table of this name.
fn read_alone(table: &str, alone: Spanned<DeValue<'_>>) -> Result<(), toml::de::Error> {
    let alone = ValueDeserializer::from(alone);
    match table {
        "" => SceneFile::deserialize(alone).map(drop),
        "fabric" => file::FabricTable::deserialize(alone).map(drop),
        "solver" => file::SolverTable::deserialize(alone).map(drop),
        "wind" => file::WindTable::deserialize(alone).map(drop),
        "collider" => file::ColliderTable::deserialize(alone).map(drop),
        "hold" => file::HoldTable::deserialize(alone).map(drop),
        "seam" => file::SeamTable::deserialize(alone).map(drop),
        "cut" => file::CutTable::deserialize(alone).map(drop),
        "tear" => file::TearTable::deserialize(alone).map(drop),
        "strength" => file::StrengthTable::deserialize(alone).map(drop),
        _ => unreachable!("the guide lists no other table"),
    }
}

/// What is wrong with a text that is read as a table of this name.
#[cfg(test)]
pub(super) fn check_alone(table: &str, text: &str) -> Result<(), String> {
    let parsed = DeTable::parse(text).expect("TOML");
    let alone = Spanned::new(parsed.span(), DeValue::Table(parsed.into_inner()));
    read_alone(table, alone).map_err(|error| error.message().to_owned())
}

/// The name that is nearest to a word, if it is near.
pub(super) fn near<'n>(word: &str, names: &[&'n str]) -> Option<&'n str> {
    let distance = |name| (strsim::damerau_levenshtein(word, name), name);
    let (distance, name) = names.iter().copied().map(distance).min()?;
    (2 * distance <= name.len()).then_some(name)
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

/// The text, for those who find fault with it.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) path: String,
    text: String,
}

impl Text {
    /// All of it.
    pub(super) fn content(&self) -> &str {
        &self.text
    }

    /// A fault with the line in which a part of the text begins.
    pub(super) fn fault(
        &self,
        code: &'static str,
        message: String,
        span: &Range<usize>,
        label: &str,
    ) -> Fault {
        let is_boundary = |text: &str, at: &usize| text.is_char_boundary(*at);
        let before = (0..=span.start.min(self.text.len())).rev();
        let start = { before }
            .find(|at| is_boundary(&self.text, at))
            .unwrap_or(0);
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let rest = &self.text[line_start..];
        let line_text = rest.lines().next().unwrap_or_default();
        let at = (start - line_start).min(line_text.len());
        let end = (span.end.max(start) - line_start).clamp(at, line_text.len());
        let end = (end..).find(|at| is_boundary(line_text, at)).unwrap_or(end);
        let line = self.text[..line_start].matches('\n').count() + 1;
        Fault::error(code, message).at((&self.path, line), line_text, at..end, label)
    }

    /// Why the texts of two rays cannot be read; none where they are no texts.
    fn rays(&self, value: &Spanned<DeValue<'_>>) -> Option<Fault> {
        let texts = Vec::<String>::deserialize(ValueDeserializer::from(value.clone())).ok()?;
        let spans = value.get_ref().as_array().into_iter().flatten();
        let mut count = 0;
        for (text, span) in texts.iter().zip(spans.map(Spanned::span)) {
            for part in rays::split_pair(text) {
                count += 1;
                if let Err(wrong) = rays::ray(&text[part.clone()]) {
                    let part = part.start + wrong.part.start..part.start + wrong.part.end;
                    let at = self.within(&span, text, part);
                    let fault = self.fault(wrong.code, wrong.message, &at, wrong.label);
                    return Some(fault.help(rays::RAY_HELP));
                }
            }
        }
        let (message, label) = rays::miscounted(count);
        let fault = self.fault("E-RAY-COUNT", message, &value.span(), label);
        Some(fault.help(rays::PAIR_HELP))
    }

    /// Where a part of a string stands; the whole string if it is written with escapes.
    fn within(&self, string: &Range<usize>, content: &str, part: Range<usize>) -> Range<usize> {
        let written = self.text.get(string.clone()).unwrap_or_default();
        match written.find(content) {
            Some(at) => string.start + at + part.start..string.start + at + part.end,
            None => string.clone(),
        }
    }
}
