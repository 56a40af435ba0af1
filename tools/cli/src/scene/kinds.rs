//! The kinds of values in a scene file, as the guide names them.

use super::schema::Key;

/// Examples of kinds where one helps.
const EXAMPLES: [(&str, &str); 8] = [
    ("a name", "\"left side\""),
    ("a file", r#""body.obj""#),
    ("two numbers", "[0.5, 1]"),
    ("three numbers", "[0, 1.5, 0]"),
    ("two ascending numbers", "[0, 0.5]"),
    ("two rays", r#"["0,2,5:0,0,-1", "0,-2,5:0,0,-1"]"#),
    ("numbers of vertices from 1 up", "[1, 33]"),
    (
        "seconds and three numbers each, seconds ascending",
        "[[0, 0, 0, 0], [1, 0, -0.5, 0]]",
    ),
];

impl Key {
    /// What is admitted.
    pub(super) fn admits(&self) -> String {
        let words: Vec<&str> = self.kind.split('`').skip(1).step_by(2).collect();
        if !words.is_empty() {
            return format!("one of {}", words.join(", "));
        }
        let example = EXAMPLES.iter().find(|(kind, _)| *kind == self.kind);
        match example {
            Some((_, example)) => format!("{}, as in {example}", self.kind),
            None => self.kind.to_owned(),
        }
    }
}
