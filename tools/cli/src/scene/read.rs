//! A scene file as it is read: its tables, and the place of each key, for diagnostics.

use std::collections::BTreeMap;
use std::ops::{Deref, Range};

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::schema::{
    ColliderKeys, Cut, Fabric, REMOVED, Section, Solver, Tear, Top, Vertices, Wind,
};
use crate::rays;
use crate::say::Fault;

/// A scene file in which every key is known and every value has the right kind.
#[derive(Clone, Debug)]
pub(crate) struct SceneFile {
    pub(super) text: Text,
    /// Of each table, in the order of the file.
    places: BTreeMap<&'static str, Vec<Place>>,
    pub(super) top: Table<Top>,
    pub(super) fabric: Option<Table<Fabric>>,
    pub(super) solver: Option<Table<Solver>>,
    pub(super) wind: Option<Table<Wind>>,
    pub(super) colliders: Vec<Table<ColliderKeys>>,
    pub(super) holds: Vec<Table<Vertices>>,
    pub(super) cuts: Vec<Table<Cut>>,
    pub(super) tear: Option<Table<Tear>>,
    pub(super) strengths: Vec<Table<Vertices>>,
}

/// The keys of a table, and where they stand.
#[derive(Clone, Debug)]
pub(super) struct Table<T> {
    keys: T,
    pub(super) place: Place,
}

impl<T> Deref for Table<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.keys
    }
}

/// Where a table and the values in it stand.
#[derive(Clone, Debug)]
pub(super) struct Place {
    name: &'static str,
    pub(super) span: Range<usize>,
    pub(super) values: BTreeMap<String, Range<usize>>,
}

impl Place {
    /// Which of these keys stand in the table.
    pub(super) fn those_of<'n>(&self, names: &[&'n str]) -> Vec<&'n str> {
        let mut found = names.to_vec();
        found.retain(|name| self.values.contains_key(*name));
        found
    }
}

impl SceneFile {
    /// Reads a scene file, or says everything that is wrong with it.
    pub(super) fn read(path: &str, text: &str) -> Result<SceneFile, Vec<Fault>> {
        // A mark of the byte order is no column.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let source = Text {
            path: path.to_owned(),
            text: text.to_owned(),
        };
        let parsed = match DeTable::parse(text) {
            Ok(parsed) => parsed.into_inner(),
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                let message = error.message().lines().collect::<Vec<_>>().join("; ");
                let message = format!("this is not TOML: {message}");
                return Err(vec![source.fault("E-SCENE-SYNTAX", message, &span, "")]);
            }
        };
        let mut reader = Reader {
            parsed: &parsed,
            sections: Section::all(),
            text: &source,
            places: BTreeMap::new(),
            faults: Vec::new(),
        };
        let file = SceneFile {
            top: reader.table("", &parsed, 0..0),
            fabric: reader.tables("fabric").pop(),
            solver: reader.tables("solver").pop(),
            wind: reader.tables("wind").pop(),
            colliders: reader.tables("collider"),
            holds: reader.tables("hold"),
            cuts: reader.tables("cut"),
            tear: reader.tables("tear").pop(),
            strengths: reader.tables("strength"),
            places: reader.places,
            text: source.clone(),
        };
        let mut faults = reader.faults;
        let cuts = file.cuts.iter().filter(|cut| cut.rays.is_some());
        faults.extend(
            cuts.filter_map(|cut| file.rays(cut).err())
                .map(|fault| *fault),
        );
        match faults.is_empty() {
            true => Ok(file),
            false => Err(sorted(faults)),
        }
    }

    /// The two rays of a cut.
    pub(super) fn rays(&self, cut: &Table<Cut>) -> Result<rays::Pair, Box<Fault>> {
        let texts = cut.rays.as_ref();
        let texts = &texts.ok_or_else(|| self.missing(&cut.place, "rays"))?.0;
        let mut found = Vec::new();
        for text in texts {
            let (span, text) = (text.span(), text.get_ref());
            for part in rays::split_pair(text) {
                let ray = rays::ray(&text[part.clone()]).map_err(|wrong| {
                    let part = part.start + wrong.part.start..part.start + wrong.part.end;
                    let at = self.text.within(&span, text, part);
                    let fault = self.text.fault(wrong.code, wrong.message, &at, wrong.label);
                    Box::new(fault.help(rays::RAY_HELP))
                })?;
                found.push(ray);
            }
        }
        rays::Pair::try_from(found).map_err(|found| {
            let (message, label) = rays::miscounted(found.len());
            let all = &cut.place.values["rays"];
            let fault = self.text.fault("E-RAY-COUNT", message, all, label);
            Box::new(fault.help(rays::PAIR_HELP))
        })
    }

    /// Whether the file has such a key, or such a table where the key is empty.
    pub(crate) fn has(&self, table: &str, key: &str) -> bool {
        let has = |place: &Place| key.is_empty() || place.values.contains_key(key);
        self.places
            .get(table)
            .is_some_and(|all| all.iter().any(has))
    }

    /// A fault with the place of a key in the table of this number, or of the table where it lacks the key.
    pub(crate) fn blame(
        &self,
        (table, number, key): (&str, usize, &str),
        code: &'static str,
        message: String,
    ) -> Fault {
        let all = self.places.get(table);
        match all.and_then(|all| all.get(number)) {
            Some(place) => *self.fault(place, key, code, message),
            None => Fault::error(code, message),
        }
    }

    pub(super) fn missing(&self, place: &Place, key: &str) -> Box<Fault> {
        let message = format!("[{}] lacks `{key}`", place.name);
        self.fault(place, "", "E-SCENE-MISSING", message)
    }

    pub(super) fn fault(
        &self,
        place: &Place,
        key: &str,
        code: &'static str,
        message: String,
    ) -> Box<Fault> {
        let span = place.values.get(key).unwrap_or(&place.span);
        Box::new(self.text.fault(code, message, span, ""))
    }
}

/// In the order of the text.
pub(super) fn sorted(mut faults: Vec<Fault>) -> Vec<Fault> {
    faults.sort_by_key(|fault| fault.excerpt.as_ref().map(|at| (at.line, at.span.start)));
    faults
}

struct Reader<'s> {
    parsed: &'s DeTable<'s>,
    sections: Vec<Section>,
    text: &'s Text,
    places: BTreeMap<&'static str, Vec<Place>>,
    faults: Vec<Fault>,
}

impl Reader<'_> {
    /// The tables of a name: one, or any number of those in lists.
    fn tables<T: DeserializeOwned>(&mut self, name: &'static str) -> Vec<Table<T>> {
        let Some((key, value)) = self.parsed.get_key_value(name) else {
            return Vec::new();
        };
        let mut sections = self.sections.iter();
        let section = sections.find(|section| section.table == name);
        let (title, is_list) = section.map_or(("", false), |one| (one.title, one.is_list()));
        let mut tables = Vec::new();
        match value.get_ref() {
            DeValue::Table(table) if !is_list => tables.push(self.table(name, table, key.span())),
            DeValue::Array(array) if is_list => {
                for element in array {
                    match element.get_ref() {
                        DeValue::Table(table) => {
                            tables.push(self.table(name, table, element.span()));
                        }
                        _ => self.wrong_table(name, title, element.span()),
                    }
                }
            }
            _ => self.wrong_table(name, title, key.span()),
        }
        tables
    }

    fn wrong_table(&mut self, name: &str, title: &str, at: Range<usize>) {
        let message = format!("`{name}` is a table");
        let label = format!("expected {title}");
        let fault = self.text.fault("E-SCENE-TYPE", message, &at, &label);
        self.faults.push(fault);
    }

    /// A table, key by key, so that all faults are found; of the top, what is no table.
    fn table<T: DeserializeOwned>(
        &mut self,
        name: &'static str,
        table: &DeTable<'_>,
        span: Range<usize>,
    ) -> Table<T> {
        let mut sections = self.sections.iter();
        let section = sections.find(|section| section.table == name);
        let names = section.map_or(&[][..], |section| &section.keys).iter();
        let names: Vec<&str> = names.map(|[name, ..]| *name).collect();
        let mut place = Place {
            name,
            span,
            values: BTreeMap::new(),
        };
        let mut admitted = DeTable::new();
        for (key, value) in table {
            let word = &**key.get_ref();
            let is_table = self.sections.iter().any(|section| section.table == word);
            if name.is_empty() && is_table {
                continue;
            }
            if !names.contains(&word) {
                self.unknown(name, word, names.clone(), key.span());
                continue;
            }
            let one = DeTable::from_iter([(key.clone(), value.clone())]);
            match keys::<T>(one) {
                Ok(_) => {
                    place.values.insert(word.to_owned(), value.span());
                    admitted.insert(key.clone(), value.clone());
                }
                Err(error) => self.refused(word, value, error.message()),
            }
        }
        self.places.entry(name).or_default().push(place.clone());
        let keys = keys(admitted).expect("each key alone was admitted");
        Table { keys, place }
    }

    /// A value that its kind does not admit. `error` is its code, and what is admitted.
    fn refused(&mut self, key: &str, value: &Spanned<DeValue<'_>>, error: &str) {
        // A boolean is serde's own, and its error has no code.
        let (code, what) = match error.split_once(' ') {
            Some((code, what)) if code.starts_with("E-") => (code, what),
            _ => ("E-SCENE-TYPE", "true or false"),
        };
        let (code, label) = match (code, value.get_ref()) {
            ("E-SCENE-RANGE", _) => ("E-SCENE-RANGE", "out of range".to_owned()),
            (_, DeValue::Array(_)) => ("E-SCENE-TYPE", "these are others".to_owned()),
            (_, other) => ("E-SCENE-TYPE", format!("this is {}", kind_of(other))),
        };
        let message = format!("`{key}` is {what}");
        let fault = self.text.fault(code, message, &value.span(), &label);
        self.faults.push(fault);
    }

    fn unknown(&mut self, table: &str, word: &str, mut names: Vec<&str>, span: Range<usize>) {
        let place = match table {
            "" => "a scene file".to_owned(),
            table => format!("[{table}]"),
        };
        if table.is_empty() {
            let tables = self.sections.iter().map(|section| section.table);
            names.extend(tables.filter(|table| !table.is_empty()));
        }
        let is_it = |(of, key, _): &&(&str, &str, &str)| *of == table && *key == word;
        let (message, label, help) = match REMOVED.iter().find(is_it) {
            Some((_, _, instead)) => (
                format!("`{word}` of {place} was removed"),
                "no longer a key",
                (*instead).to_owned(),
            ),
            None => (
                format!("{place} has no key `{word}`"),
                "unknown key",
                match near(word, &names) {
                    Some(name) => format!("did you mean `{name}`?"),
                    None => format!("it has {}", names.join(", ")),
                },
            ),
        };
        let fault = self.text.fault("E-SCENE-KEY", message, &span, label);
        self.faults.push(fault.help(help));
    }
}

/// The name that is nearest to a word, if it is near.
fn near<'n>(word: &str, names: &[&'n str]) -> Option<&'n str> {
    let distances = names
        .iter()
        .map(|name| (strsim::damerau_levenshtein(word, name), *name));
    let (distance, name) = distances.min()?;
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

fn keys<T: DeserializeOwned>(table: DeTable<'_>) -> Result<T, toml::de::Error> {
    let value = Spanned::new(0..0, DeValue::Table(table));
    T::deserialize(ValueDeserializer::from(value))
}

/// The text, for those who find fault with it.
#[derive(Clone, Debug)]
pub(super) struct Text {
    pub(super) path: String,
    text: String,
}

impl Text {
    /// A fault with the line in which a part of the text begins.
    pub(super) fn fault(
        &self,
        code: &'static str,
        message: String,
        span: &Range<usize>,
        label: &str,
    ) -> Fault {
        let mut start = span.start.min(self.text.len());
        while !self.text.is_char_boundary(start) {
            start -= 1;
        }
        let line_start = self.text[..start].rfind('\n').map_or(0, |at| at + 1);
        let rest = &self.text[line_start..];
        let line_text = rest.lines().next().unwrap_or_default();
        let at = (start - line_start).min(line_text.len());
        let mut end = (span.end.max(start) - line_start).clamp(at, line_text.len());
        while !line_text.is_char_boundary(end) {
            end += 1;
        }
        let line = self.text[..line_start].matches('\n').count() + 1;
        Fault::error(code, message).at((&self.path, line), line_text, at..end, label)
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
