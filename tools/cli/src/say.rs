//! Diagnostics, on a screen and in the report.

use std::ops::{Deref, DerefMut, Range};
use std::path::Path;

use annotate_snippets::{AnnotationKind, Group, Level as Title, Origin, Renderer, Snippet};
use clap::ValueEnum;
pub(crate) use tearmesh_cloth::text::{count, short, three_digits, two_digits};
use tearmesh_obj::{Diagnostic, Excerpt, Level, Location};

/// Something that has to be said: an error, a warning or a note.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    diagnostic: Box<Diagnostic>,
    /// The file that it is about, or the option, where it has a location.
    pub(crate) path: String,
    /// Other lines that have to do with it.
    pub(crate) related: Vec<(Location, Excerpt)>,
    /// How many more of its kind are not listed.
    pub(crate) unlisted: usize,
}

impl Deref for Fault {
    type Target = Diagnostic;

    fn deref(&self) -> &Diagnostic {
        &self.diagnostic
    }
}

impl DerefMut for Fault {
    fn deref_mut(&mut self) -> &mut Diagnostic {
        &mut self.diagnostic
    }
}

impl Fault {
    fn new(level: Level, code: &'static str, message: String) -> Fault {
        let diagnostic = Diagnostic {
            level,
            code,
            location: None,
            message,
            excerpt: None,
            help: None,
        };
        Fault::of_file("", &diagnostic)
    }

    pub(crate) fn error(code: &'static str, message: impl Into<String>) -> Fault {
        Fault::new(Level::Error, code, message.into())
    }

    pub(crate) fn warning(code: &'static str, message: impl Into<String>) -> Fault {
        Fault::new(Level::Warning, code, message.into())
    }

    pub(crate) fn note(code: &'static str, message: impl Into<String>) -> Fault {
        Fault::new(Level::Note, code, message.into())
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Fault {
        self.help = Some(help.into());
        self
    }

    /// With the place in a text that it is about: bytes of a whole line of a file, or of what was typed.
    pub(crate) fn at(
        mut self,
        (path, line): (&str, usize),
        text: &str,
        span: Range<usize>,
        label: impl Into<String>,
    ) -> Fault {
        let (location, excerpt) = excerpt(line, text, span, label.into());
        self.path = path.to_owned();
        (self.location, self.excerpt) = (Some(location), Some(excerpt));
        self
    }

    /// What the OBJ library says of a file, with the name of the file.
    pub(crate) fn of_file(path: &str, diagnostic: &Diagnostic) -> Fault {
        Fault {
            diagnostic: Box::new(diagnostic.clone()),
            path: path.to_owned(),
            related: Vec::new(),
            unlisted: 0,
        }
    }

    /// All in one line, without the name of the file.
    pub(crate) fn line(&self) -> String {
        let (message, code) = (&self.message, self.code);
        printable(&match self.location {
            Some(at) if !self.related.is_empty() => {
                format!("line {}: {message}  [{code}]", at.line)
            }
            _ => format!("{}  [{code}]", **self),
        })
    }

    pub(crate) fn render(&self, colored: bool) -> String {
        let level = match self.level {
            Level::Error => Title::ERROR,
            Level::Warning => Title::WARNING,
            _ => Title::NOTE,
        };
        let (message, path) = (printable(&self.message), printable(&self.path));
        let mut group = Group::with_title(level.primary_title(&*message).id(self.code));
        if let Some((at, excerpt)) = self.location.zip(self.excerpt.as_ref()) {
            let label = Some(&*excerpt.label).filter(|label| !label.is_empty());
            let span = bytes(at, excerpt);
            let annotation = AnnotationKind::Primary.span(span).label(label);
            let snippet = Snippet::source(&*excerpt.text).line_start(at.line);
            let mut snippet = snippet.annotation(annotation);
            if excerpt.first_column == 1 {
                snippet = snippet.path(&*path);
            } else {
                // The column counts from the beginning of the line, not of the excerpt.
                let origin = Origin::path(&*path);
                group = group.element(origin.line(at.line).char_column(at.column));
            }
            group = group.element(snippet);
            for (at, excerpt) in &self.related {
                let annotation = AnnotationKind::Context.span(bytes(*at, excerpt));
                let snippet = Snippet::source(&*excerpt.text).line_start(at.line);
                group = group.element(snippet.path(&*path).annotation(annotation));
            }
        } else if let Some(at) = self.location {
            group = group.element(Origin::path(&*path).line(at.line));
        }
        if let Some(help) = &self.help {
            group = group.element(Title::HELP.message(printable(help)));
        }
        let renderer = match colored {
            true => Renderer::styled(),
            false => Renderer::plain(),
        };
        renderer.render(&[group])
    }
}

/// The place of bytes of a line, and the line.
pub(crate) fn excerpt(
    line: usize,
    text: &str,
    span: Range<usize>,
    label: String,
) -> (Location, Excerpt) {
    let column = text[..span.start].chars().count() + 1;
    let excerpt = Excerpt {
        text: text.to_owned(),
        first_column: 1,
        length: text[span].chars().count(),
        label,
    };
    (Location { line, column }, excerpt)
}

/// The bytes of an excerpt that are meant.
fn bytes(at: Location, excerpt: &Excerpt) -> Range<usize> {
    let text = &excerpt.text;
    let byte = |n| text.char_indices().nth(n).map_or(text.len(), |(at, _)| at);
    let from = at.column.saturating_sub(excerpt.first_column);
    byte(from)..byte(from + excerpt.length)
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

/// A number of pieces, of which so many are crumbs.
pub(crate) fn pieces(all: usize, crumbs: usize) -> String {
    let pieces = count(all - crumbs, "piece", "pieces");
    match crumbs {
        0 => pieces,
        _ => format!("{pieces} and {}", count(crumbs, "crumb", "crumbs")),
    }
}

/// The name of a file for people.
pub(crate) fn shown(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// A text in one line that leaves a terminal as it is: symbols stand for control characters, and U+FFFD for those
/// that turn the direction of writing.
pub(crate) fn printable(text: &str) -> String {
    let printed = |c: char| match c {
        '\0'..='\x1f' => char::from_u32(0x2400 + u32::from(c)).unwrap_or('\u{fffd}'),
        '\x7f' => '\u{2421}',
        '\u{80}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        c => c,
    };
    text.chars().map(printed).collect()
}

/// The name of a file as a shell reads it, and no option.
pub(crate) fn quoted(name: &str) -> String {
    let here = if name.starts_with('-') { "./" } else { "" };
    let name = format!("{here}{name}");
    // No file has a name that no shell can be told.
    shlex::try_quote(&name).map_or_else(|_| name.clone(), Into::into)
}

/// A point for people, as it can be typed.
pub(crate) fn place(at: [f64; 3]) -> String {
    at.map(short).join(",")
}
