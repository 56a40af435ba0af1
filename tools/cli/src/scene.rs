//! Built-in scenes and scene files.

mod kinds;
mod on;
mod read;
mod schema;

use std::path::Path;

use tearmesh_cloth::scene::Preset;

pub(crate) use self::read::SceneSource;
use self::read::near;
pub(crate) use self::schema::schema;
use crate::choice::Choice as _;
use crate::exit::Stop;
use crate::input::Input;
use crate::say::Fault;
use crate::streams::Streams;

impl SceneSource {
    /// Finds what `--scene` names: a scene that stands ready, which is that of a file with nothing but its name,
    /// or a file.
    pub(crate) fn find(name: &str, streams: &mut Streams<'_>) -> Result<SceneSource, Stop> {
        if Preset::of(name).is_some() {
            return Ok(SceneSource::read(name, &format!("base = \"{name}\""))?);
        }
        if !Path::new(name).exists() && !name.contains(['.', '/', '\\']) {
            let fault = Fault::error("E-SCENE-NAME", format!("there is no scene `{name}`"));
            let known = Preset::ALL.iter().map(|(name, _)| *name);
            let near = near(name, &known.collect::<Vec<_>>());
            let meant = near.map_or_else(String::new, |near| format!("did you mean `{near}`? "));
            let scenes = Preset::words();
            let help = format!("{meant}scenes are {scenes}, and files such as scene.toml");
            return Err(fault.help(help).into());
        }
        let file = Input::find(Path::new(name), streams.input)?;
        Ok(SceneSource::read(&file.name, &file.text()?)?)
    }

    /// As it is called in the report.
    pub(crate) fn name(&self) -> &str {
        &self.text.path
    }
}

#[cfg(test)]
mod tests {
    use tearmesh::shapes;
    use tearmesh_cloth::scene::{Axis, Frame};
    use tearmesh_lab::statistics::Random;

    use std::collections::BTreeSet;

    use super::schema::Section;
    use super::*;

    fn frame() -> Frame {
        let (mesh, positions) = shapes::grid(4, 4);
        Frame::new(&mesh, positions.as_slice(), Axis::Y)
    }

    /// What a file makes of the scene `fall`, in words; or the codes of its faults.
    fn read(text: &str) -> Result<String, Vec<&'static str>> {
        let codes = |faults: Vec<Fault>| faults.iter().map(|fault| fault.code).collect::<Vec<_>>();
        let file = SceneSource::read("test.toml", text).map_err(codes)?;
        let scene = file
            .scene(&frame(), None)
            .map_err(|stop| codes(stop.faults))?;
        Ok(format!("{scene:?} {:?} {:?}", file.up(), file.vt_m()))
    }

    /// All keys, with their tables, as the answer to an unknown one lists them.
    fn keys() -> Vec<(&'static str, String)> {
        let sections = Section::all();
        let tables: Vec<&str> = sections.iter().map(|section| section.table).collect();
        let mut keys = Vec::new();
        for &table in &tables {
            let text = head(table) + "unknown_to_all_of_them = 1\n";
            let faults = SceneSource::read("test.toml", &text).expect_err("no such key");
            let help = faults[0].help.as_deref().expect("the keys");
            let names = help.strip_prefix("it has ").expect("the keys").split(", ");
            let names = names.filter(|name| !tables.contains(name));
            keys.extend(names.map(|name| (table, name.to_owned())));
        }
        keys
    }

    /// The line with which a table begins.
    fn head(table: &str) -> String {
        let mut sections = Section::all().into_iter();
        let section = sections.find(|section| section.table == table);
        let title = section.map_or("", |section| section.title);
        match table {
            "" => String::new(),
            _ => format!("{title}\n"),
        }
    }

    /// The fields of a table, as it lists them where it is given another one.
    fn fields(table: &str) -> BTreeSet<String> {
        let refused = read::check_alone(table, "unknown_to_all_of_them = 1");
        let said = refused.expect_err("no such field");
        let names = said.split('`').skip(3).step_by(2);
        names.map(str::to_owned).collect()
    }

    #[test]
    fn the_guide_has_a_row_for_each_field_and_no_others() {
        let sections = Section::all();
        let tables = sections.iter().map(|section| section.table.to_owned());
        let tables: BTreeSet<String> = tables.filter(|table| !table.is_empty()).collect();
        for section in &sections {
            let rows = section.keys.iter().map(|key| key.name.to_owned());
            let mut rows: BTreeSet<String> = rows.collect();
            let (mut fields, table) = (fields(section.table), section.title);
            if section.table.is_empty() {
                assert!(
                    tables.is_subset(&fields),
                    "the file has a field for each table"
                );
                fields.retain(|field| !tables.contains(field));
            }
            let missing: Vec<_> = fields.difference(&rows).collect();
            assert!(
                missing.is_empty(),
                "{table}: add a row to the guide for {missing:?}"
            );
            rows.retain(|row| !fields.contains(row));
            assert!(
                rows.is_empty(),
                "{table}: add a field to the table for {rows:?}"
            );
        }
    }

    /// What stands before keys so that they mean something, and values of every kind.
    const TEXTS: &str = include_str!("scene/keys.txt");

    /// A file with one key, and what stands before it.
    fn file(table: &str, key: &str, value: &str) -> String {
        let is_it = |row: &(&str, &str)| {
            let mut names = row.0.split(' ');
            let is_table = names.next() == Some(table);
            is_table && names.any(|name| name == key || name == format!("{key}={value}"))
        };
        let mut rows = TEXTS.lines().filter_map(|row| row.split_once(" | "));
        let lines = rows.find(is_it).map_or("", |(_, lines)| lines);
        let head = if lines.starts_with('[') {
            String::new()
        } else {
            head(table)
        };
        format!("{head}{}\n{key} = {value}\n", lines.replace("; ", "\n"))
    }

    #[test]
    fn every_key_is_read_and_means_something() {
        for (table, key) in keys() {
            let values = TEXTS.lines().filter_map(|row| row.strip_prefix("= "));
            let made = values.map(|value| read(&file(table, &key, value)));
            let made: BTreeSet<String> = made.flatten().collect();
            assert!(made.len() >= 2, "[{table}] {key} changes nothing: {made:?}");
        }
    }

    #[test]
    fn every_key_refuses_what_it_does_not_mean() {
        for (table, key) in keys() {
            for value in ["1979-05-27", "{ a = 1 }", "[[[1]]]", "-0.5", "nan", "\"\""] {
                let text = file(table, &key, value);
                match read(&text) {
                    Err(codes) => assert!(codes[0].starts_with("E-"), "{text}"),
                    Ok(_) => panic!("accepted\n{text}"),
                }
            }
        }
    }

    #[test]
    fn garbage_is_refused_and_never_panics() {
        let good = [
            include_str!("../../../tests/data/scarf.toml"),
            include_str!("../../../tests/data/pull.toml"),
        ];
        let mut random = Random::new(2014);
        let mut random = |below: usize| random.below(below);
        let bits: Vec<&str> = "[ ] = \" \n - 9e999 é [[hold]] nan ' 0x"
            .split(' ')
            .collect();
        let mut accepted = 0;
        for i in 0..4000 {
            let mut text: Vec<char> = good[i % 2].chars().collect();
            for _ in 0..=random(3) {
                let at = random(text.len());
                match random(3) {
                    0 => drop(text.splice(at..(at + random(9)).min(text.len()), [])),
                    1 => drop(text.splice(at..at, bits[random(bits.len())].chars())),
                    _ => text.swap(at, i % 7),
                }
            }
            let text: String = text.into_iter().collect();
            accepted += usize::from(read(&text).is_ok());
        }
        assert!(accepted > 0 && accepted < 4000, "{accepted}");
    }
}
