//! Diagnostics, on a screen and in the report.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};
use clap::ValueEnum;
use tearmesh_obj::{Diagnostic, Level as ObjLevel};

/// Something that has to be said: an error, a warning or a note.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fault {
    pub(crate) severity: Severity,
    pub(crate) code: &'static str,
    pub(crate) message: String,
    /// The file and line concerned, where there is no text to show.
    pub(crate) place: Option<Box<(String, usize)>>,
    /// The text concerned.
    pub(crate) excerpt: Option<Box<Excerpt>>,
    /// Other lines that have to do with it.
    pub(crate) related: Vec<Excerpt>,
    pub(crate) help: Option<String>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Severity {
    #[default]
    Error,
    Warning,
    Note,
}

impl Severity {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        }
    }
}

/// A line of text, and the part of it that is meant.
#[derive(Clone, Debug)]
pub(crate) struct Excerpt {
    pub(crate) path: String,
    pub(crate) line: usize,
    pub(crate) text: String,
    /// The column of the first character of `text`, where it is a part of a long line.
    pub(crate) first_column: usize,
    /// Bytes of `text`.
    pub(crate) span: Range<usize>,
    pub(crate) label: String,
}

impl Excerpt {
    /// The column, from 1, at which the part that is meant begins.
    pub(crate) fn column(&self) -> usize {
        self.first_column + self.text[..self.span.start].chars().count()
    }
}

impl Fault {
    pub(crate) fn error(code: &'static str, message: impl Into<String>) -> Fault {
        Fault {
            code,
            message: message.into(),
            ..Fault::default()
        }
    }

    pub(crate) fn warning(code: &'static str, message: impl Into<String>) -> Fault {
        Fault {
            severity: Severity::Warning,
            ..Fault::error(code, message)
        }
    }

    pub(crate) fn help(self, help: impl Into<String>) -> Fault {
        Fault {
            help: Some(help.into()),
            ..self
        }
    }

    /// With the place in a text that it is about: bytes of a whole line of a file, or of what was typed.
    pub(crate) fn at(
        self,
        (path, line): (&str, usize),
        text: &str,
        span: Range<usize>,
        label: impl Into<String>,
    ) -> Fault {
        Fault {
            excerpt: Some(Box::new(Excerpt {
                path: path.to_owned(),
                line,
                text: text.to_owned(),
                first_column: 1,
                span,
                label: label.into(),
            })),
            ..self
        }
    }

    /// What the OBJ library says of a file, with the name of the file.
    pub(crate) fn of_file(path: &str, diagnostic: &Diagnostic) -> Fault {
        let excerpt = match (&diagnostic.location, &diagnostic.excerpt) {
            (Some(location), Some(excerpt)) => {
                let from = location.column.saturating_sub(excerpt.first_column);
                let byte = |n: usize| {
                    excerpt
                        .text
                        .char_indices()
                        .nth(n)
                        .map_or(excerpt.text.len(), |(at, _)| at)
                };
                Some(Box::new(Excerpt {
                    path: path.to_owned(),
                    line: location.line,
                    text: excerpt.text.clone(),
                    first_column: excerpt.first_column,
                    span: byte(from)..byte(from + excerpt.length),
                    label: excerpt.label.clone(),
                }))
            }
            _ => None,
        };
        Fault {
            severity: match diagnostic.level {
                ObjLevel::Error => Severity::Error,
                ObjLevel::Warning => Severity::Warning,
                ObjLevel::Note => Severity::Note,
            },
            code: diagnostic.code,
            message: diagnostic.message.clone(),
            place: diagnostic
                .location
                .map(|at| Box::new((path.to_owned(), at.line))),
            excerpt,
            related: Vec::new(),
            help: diagnostic.help.clone(),
        }
    }

    /// All in one line, without the name of the file.
    pub(crate) fn line(&self) -> String {
        let place = match (&self.excerpt, &self.place) {
            (Some(at), _) if self.related.is_empty() => {
                format!("line {}, column {}: ", at.line, at.column())
            }
            (Some(at), _) => format!("line {}: ", at.line),
            (None, Some(place)) => format!("line {}: ", place.1),
            (None, None) => String::new(),
        };
        format!("{place}{}  [{}]", self.message, self.code)
    }

    pub(crate) fn render(&self, colored: bool) -> String {
        let level = match self.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
            Severity::Note => Level::NOTE,
        };
        let mut group = Group::with_title(level.primary_title(&*self.message).id(self.code));
        if let Some(excerpt) = &self.excerpt {
            let label = Some(&*excerpt.label).filter(|label| !label.is_empty());
            let annotation = AnnotationKind::Primary
                .span(excerpt.span.clone())
                .label(label);
            let mut snippet = Snippet::source(&*excerpt.text)
                .line_start(excerpt.line)
                .annotation(annotation);
            if excerpt.first_column == 1 {
                snippet = snippet.path(&*excerpt.path);
            } else {
                // The column counts from the beginning of the line, not of the excerpt.
                let origin = Origin::path(&*excerpt.path);
                group = group.element(origin.line(excerpt.line).char_column(excerpt.column()));
            }
            group = group.element(snippet);
            for other in &self.related {
                let annotation = AnnotationKind::Context.span(other.span.clone());
                let snippet = Snippet::source(&*other.text).line_start(other.line);
                group = group.element(snippet.path(&*other.path).annotation(annotation));
            }
        } else if let Some((path, line)) = self.place.as_deref() {
            group = group.element(Origin::path(&**path).line(*line));
        }
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(&**help));
        }
        let renderer = if colored {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.render(&[group])
    }
}

/// When to use colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    #[default]
    Auto,
    Always,
    Never,
}

/// Whether to use colours, by the option, the environment, and the kind of stream.
pub(crate) fn is_colored(color: Color, is_terminal: bool) -> bool {
    match color {
        Color::Always => true,
        Color::Never => false,
        Color::Auto => is_terminal && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty()),
    }
}

/// A number of things.
pub(crate) fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}

/// The name of a file as a shell reads it, and no option.
pub(crate) fn quoted(name: &str) -> String {
    let name = match name.starts_with('-') {
        true => format!("./{name}"),
        false => name.to_owned(),
    };
    // No file has a name that no shell can be told.
    shlex::try_quote(&name).map_or_else(|_| name.clone(), Into::into)
}

/// A point for people, as it can be typed.
pub(crate) fn place(at: [f64; 3]) -> String {
    at.map(short).join(",")
}

/// A number for people: six digits.
pub(crate) fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.5e}")
        .parse()
        .expect("a number that was just printed");
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Three digits or all of those before the point; nothing below a billionth.
pub(crate) fn three_digits(x: f64) -> String {
    if x.abs() < 1e-9 {
        return "0".to_owned();
    }
    let mut scale = 1.0;
    while (x * scale).abs() < 100.0 {
        scale *= 10.0;
    }
    short((x * scale).round() / scale)
}

/// Two digits, rounded down: a step that is typed like this stays below its limit.
pub(crate) fn two_digits(x: f64) -> String {
    let mut scale = 1.0;
    while x * scale < 10.0 && scale < 1e15 {
        scale *= 10.0;
    }
    let rounded = (x * scale).floor() / scale;
    rounded.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people_have_six_digits() {
        for (x, text) in [
            (1.0, "1"),
            (0.0, "0"),
            (4.123_456_789, "4.12346"),
            (0.1 + 0.2, "0.3"),
            (1e-12, "1e-12"),
            (123_456_789.0, "123457000"),
            (1e300, "1e300"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn steps_are_rounded_down() {
        for (x, text) in [
            (0.005_39, "0.0053"),
            (0.0333, "0.033"),
            (0.001_01, "0.001"),
            (1.29e-5, "0.000012"),
        ] {
            assert_eq!(two_digits(x), text);
            assert!(two_digits(x).parse::<f64>().expect("a number") <= x);
        }
    }
}
