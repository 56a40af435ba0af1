//! Built-in scenes and scene files.

mod apply;
mod fabric;
mod kinds;
mod method;
mod read;
mod schema;

use std::path::Path;

use tearmesh_cloth::scene::Preset;

pub(crate) use self::read::SceneFile;
pub(crate) use self::schema::schema;
use crate::choice::Choice as _;
use crate::exit::Stop;
use crate::input::Input;
use crate::say::Fault;
use crate::streams::Streams;

impl SceneFile {
    /// Finds what `--scene` names: a scene that stands ready, which is that of a file with nothing but its name,
    /// or a file.
    pub(crate) fn find(name: &str, streams: &mut Streams<'_>) -> Result<SceneFile, Stop> {
        if Preset::of(name).is_some() {
            return Ok(SceneFile::read(name, &format!("base = \"{name}\""))?);
        }
        if !Path::new(name).exists() && !name.contains(['.', '/', '\\']) {
            let fault = Fault::error("E-SCENE-NAME", format!("there is no scene `{name}`"));
            let scenes = Preset::words();
            let help = format!("scenes are {scenes}, and files such as scene.toml");
            return Err(fault.help(help).into());
        }
        let file = Input::find(Path::new(name), streams.input)?;
        Ok(SceneFile::read(&file.name, &file.text()?)?)
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
        let file = SceneFile::read("test.toml", text).map_err(codes)?;
        let scene = file
            .scene(&frame(), None)
            .map_err(|stop| codes(stop.faults))?;
        Ok(format!("{scene:?} {:?}", file.up()))
    }

    /// What has to stand beside a key so that it means something.
    fn beside(table: &str, key: &str) -> &'static str {
        match (table, key) {
            ("solver", "substeps" | "sweeps") => "method = \"xpbd\"",
            ("solver", "stiffness" | "bend_stiffness") => "method = \"pbd\"",
            ("solver", "limit_ratio" | "limit_passes") => "method = \"provot\"",
            ("solver", "order" | "tolerance") => "method = \"implicit\"",
            ("wind", "velocity_m_per_s") => "",
            ("wind", _) => "velocity_m_per_s = [1, 0, 0]",
            ("collider", "point") => "normal = [0, 1, 0]",
            ("collider", "normal") => "point = [0, 0, 0]",
            ("collider", "centre") | ("hold", "centre") => "radius_m = 0.25",
            ("collider", "radius_m") | ("hold", "radius_m") => "centre = [0, 1, 0]",
            ("hold", "radius") => "near = [0, 1]",
            ("hold", "from") => "to = [9, 9, 9]",
            ("hold", "to") => "from = [0, 0, 0]",
            ("hold", "from_s" | "until_s" | "moves") => "near = [0, 1]",
            ("cut", "rays") => "",
            ("cut", _) => "rays = [\"0,1,5:0,0,-1\", \"0,-1,5:0,0,-1\"]",
            ("strength", "factor") => "near = [0, 1]",
            ("strength", "centre") => "factor = 2\nradius_m = 0.25",
            ("strength", "radius_m") => "factor = 2\ncentre = [0, 1, 0]",
            ("strength", "radius") => "factor = 2\nnear = [0, 1]",
            ("strength", "from") => "factor = 2\nto = [9, 9, 9]",
            ("strength", "to") => "factor = 2\nfrom = [0, 0, 0]",
            ("strength", _) => "factor = 2",
            ("fabric", "copies") => "stretch_n_per_m = 300",
            ("tear", "threshold_warp") => "threshold_weft = 1.25",
            ("tear", "threshold_weft") => "threshold_warp = 1.25",
            ("tear", "warp") => "threshold_weft = 1.25\nthreshold_warp = 1.25",
            _ => "",
        }
    }

    /// All keys, with their tables, as the answer to an unknown one lists them.
    fn keys() -> Vec<(&'static str, String)> {
        let sections = Section::all();
        let tables: Vec<&str> = sections.iter().map(|section| section.table).collect();
        let mut keys = Vec::new();
        for &table in &tables {
            let text = head(table) + "unknown_to_all_of_them = 1\n";
            let faults = SceneFile::read("test.toml", &text).expect_err("no such key");
            let help = faults[0].help.as_deref().expect("the keys");
            let names = help.strip_prefix("it has ").expect("the keys").split(", ");
            let names = names.filter(|name| !tables.contains(name));
            keys.extend(names.map(|name| (table, name.to_owned())));
        }
        assert_eq!(keys.len(), 73);
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

    /// Values of every kind.
    const VALUES: &[&str] = &[
        "0.375",
        "0.625",
        "0.75",
        "1.375",
        "2",
        "3",
        "true",
        "false",
        r#""hang""#,
        r#""rip""#,
        r#""z""#,
        r#""-x""#,
        r#""whole""#,
        r#""halved""#,
        r#""vertex""#,
        r#""seam""#,
        r#""buckling""#,
        r#""spring""#,
        r#""1""#,
        r#""2""#,
        r#""verlet""#,
        r#""implicit""#,
        r#""partition""#,
        r#""uniform""#,
        "[0, 0.375]",
        "[0.5, 1]",
        "[0.5, 1, 0.375]",
        "[0, 0.25, 0.5]",
        r#"["0,1,5:0,0,-1", "0,-1,5:0,0,-1"]"#,
        r#"["0.5,1,5:0,0,-1", "0.5,-1,5:0,0,-1"]"#,
        "[1, 2]",
        "[3]",
        "[[0, 0, 0, 0], [1, 0, 1, 0]]",
        "[[0, 0, 0, 1]]",
    ];

    fn file(table: &str, key: &str, value: &str) -> String {
        let line = format!("{key} = {value}\n");
        let implicit = "[solver]\nmethod = \"implicit\"\n[fabric]\n";
        let woven = ["warp_n_per_m", "weft_n_per_m", "shear_n_per_m", "warp"];
        match (table, key) {
            ("fabric", key) if woven.contains(&key) => {
                let others = woven[..2].iter().filter(|&&other| other != key);
                let others: String = others.map(|other| format!("{other} = 300\n")).collect();
                format!("{implicit}{others}{line}")
            }
            ("fabric", "rigidity_n_m") => format!("{implicit}bend_law = \"buckling\"\n{line}"),
            ("fabric", "buckles_below") => {
                format!("{implicit}bend_law = \"buckling\"\nrigidity_n_m = 1e-6\n{line}")
            }
            // A law without a number is none.
            ("fabric", "bend_law") if value == "\"buckling\"" => {
                format!("{implicit}rigidity_n_m = 1e-6\n{line}")
            }
            _ => format!("{}{}\n{line}", head(table), beside(table, key)),
        }
    }

    #[test]
    fn every_key_is_read_and_means_something() {
        for (table, key) in keys() {
            let made = VALUES.iter().map(|value| read(&file(table, &key, value)));
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

    /// So that whoever mends one finds no other behind it.
    #[test]
    fn all_faults_of_a_table_are_found() {
        let text = "[fabric]\nstretch_n_per_m = 0\nwarp = 3\nwoof = 1\n[[cut]]\nat_s = -1\nrays = [\"1\"]\n";
        let codes = ["RANGE", "TYPE", "KEY", "RANGE"].map(|code| format!("E-SCENE-{code}"));
        let mut found = read(text).expect_err("faults");
        assert_eq!(found.pop(), Some("E-RAY-SYNTAX"));
        assert_eq!(found, codes);
    }

    #[test]
    fn garbage_is_refused_and_never_panics() {
        let good = [
            include_str!("../../../tests/data/scarf.toml"),
            include_str!("../../../tests/data/pull.toml"),
        ];
        let mut state = 2014_u64;
        let mut random = |below: usize| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 33) as usize % below
        };
        let bits = [
            "[", "]", "=", "\"", "\n", "-", "9e999", "é", "[[hold]]", "nan", "'", "0x",
        ];
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
