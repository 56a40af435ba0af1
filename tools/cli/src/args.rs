//! The arguments of the command.

mod chart;
mod check;
mod cut;
mod files;
mod look;
mod mend;
mod play;
mod read;
mod render;
mod scene;
mod shell;
mod tear;
mod view;

use std::ffi::OsString;

use clap::builder::StyledStr;
use clap::error::ContextValue;
use clap::{Parser, Subcommand};

use crate::rays;
use crate::say::printable;

pub(crate) use self::chart::{ChartArgs, DrawArgs, ParetoArgs, StepArgs, TearChartArgs, What};
pub(crate) use self::check::CheckArgs;
pub(crate) use self::cut::{CameraArgs, CutArgs, Mass};
pub(crate) use self::files::{FileArgs, Format};
pub(crate) use self::look::LookArgs;
pub(crate) use self::mend::MendArgs;
pub(crate) use self::play::PlayArgs;
pub(crate) use self::read::{Gap, numbers};
pub(crate) use self::render::RenderArgs;
pub(crate) use self::scene::ChangeArgs;
pub(crate) use self::shell::{CompletionsArgs, ManArgs};
pub(crate) use self::tear::{TearArgs, Topology};
pub(crate) use self::view::ViewArgs;

/// Cuts and tears triangle meshes in OBJ files, and verifies what it does.
#[derive(Debug, Parser)]
#[command(name = "tearmesh", version)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

impl Args {
    /// Reads arguments, the first of which is the program's name.
    pub(crate) fn read(args: &[OsString]) -> Result<Args, clap::Error> {
        let parsed = Args::try_parse_from(join_rays(args));
        let mut args = parsed.map_err(|error| cleaned(error, args))?;
        let files = match &mut args.verb {
            Verb::Cut(cut) => Some(&mut cut.files),
            Verb::Tear(tear) => Some(&mut tear.files),
            Verb::Mend(mend) => Some(&mut mend.files),
            _ => None,
        };
        if let Some(files) = files.filter(|files| files.in_place) {
            files.output.get_or_insert_with(|| files.input.clone());
        }
        Ok(args)
    }
}

/// An error about arguments, some of which a terminal may not get as they are.
fn cleaned(mut error: clap::Error, args: &[OsString]) -> clap::Error {
    let is_clean = |arg: &OsString| printable(&arg.to_string_lossy()) == arg.to_string_lossy();
    if args.iter().all(is_clean) {
        return error;
    }
    let plain = |text: &StyledStr| StyledStr::from(printable(&text.to_string()));
    let clean = |value: &ContextValue| match value {
        ContextValue::String(text) => ContextValue::String(printable(text)),
        ContextValue::Strings(all) => {
            ContextValue::Strings(all.iter().map(|text| printable(text)).collect())
        }
        ContextValue::StyledStrs(all) => ContextValue::StyledStrs(all.iter().map(plain).collect()),
        // What else there is holds no argument.
        other => other.clone(),
    };
    let context = error.context();
    let context: Vec<_> = context.map(|(kind, value)| (kind, clean(value))).collect();
    for (kind, value) in context {
        error.insert(kind, value);
    }
    error
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Cut(Box<CutArgs>),
    Tear(Box<TearArgs>),
    Mend(MendArgs),
    Render(Box<RenderArgs>),
    View(ViewArgs),
    Play(PlayArgs),
    Check(CheckArgs),
    Chart(ChartArgs),
    Completions(CompletionsArgs),
    Man(ManArgs),
}

/// Makes one argument of `--rays A B`, so that a negative number is no option, and an option is
/// no second ray; and likewise of `--points A B`. A blank beside a comma, a colon or `@` makes two
/// arguments of one ray: they are joined again.
///
/// `--rays A B`, `--rays "A B"`, `--rays "A;B"` and `--rays=A B` all become `--rays=A;B`. What
/// does not look like a ray is left to the parser.
fn join_rays(args: &[OsString]) -> Vec<OsString> {
    let mut joined = Vec::with_capacity(args.len());
    let mut rest = args;
    while let [arg, after @ ..] = rest {
        rest = after;
        if arg == "--" {
            joined.push(arg.clone());
            joined.extend_from_slice(rest);
            break;
        }
        let text = arg.to_str().unwrap_or_default();
        let (name, given) = text.split_once('=').unwrap_or((text, ""));
        // How many values of numbers with commas between them an option takes.
        let takes = match name {
            "--rays" | "--points" => 2,
            "--plane" | "--camera" | "--up" | "--near" | "--cache-origin" => 1,
            _ => {
                joined.push(arg.clone());
                continue;
            }
        };
        let mut value = given.to_owned();
        while let [next, after @ ..] = rest {
            let next = next.to_string_lossy();
            let is_begun = !value.is_empty();
            let goes_on = is_begun && (rays::goes_on(&value) || rays::is_continued(&next));
            let following = after.first().map(|arg| arg.to_string_lossy());
            let is_split = following.is_some_and(|arg| rays::is_continued(&arg));
            let is_new = looks_like_rays(&next) || is_split && is_of_numbers(&next);
            let is_wanted = match goes_on {
                true => is_of_numbers(&next),
                false => is_new && rays::split_pair(&value).count() < takes,
            };
            if !is_wanted {
                break;
            }
            value.push(if goes_on { ' ' } else { ';' });
            value.push_str(&next);
            rest = after;
        }
        if value.is_empty() && arg == name {
            joined.push(arg.clone());
        } else {
            joined.push(format!("{name}={}", value.trim_start_matches(';')).into());
        }
    }
    joined
}

/// Whether an argument is meant as a ray: numbers with commas between them, or what is written like
/// one, for which an error about the ray says more than one about an argument too many.
fn looks_like_rays(text: &str) -> bool {
    let number = text.trim_start().trim_start_matches(['+', '-']);
    let is_number = number.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_ray = !text.starts_with('-') && text.contains([':', '@']);
    text.contains(',') && (is_number || is_ray)
}

/// Whether an argument is made of nothing but numbers and the marks between those of a ray.
fn is_of_numbers(text: &str) -> bool {
    let is_part = |c: char| c.is_ascii_digit() || c.is_whitespace() || "+-.eE,:@>;".contains(c);
    !text.is_empty() && text.chars().all(is_part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arguments_parse_without_a_clash() {
        use clap::CommandFactory as _;
        Args::command().debug_assert();
    }

    #[test]
    fn rays_points_and_planes_become_one_argument_each() {
        let rows = include_str!("args/joined.txt").lines();
        for (typed, expected) in rows.filter_map(|row| row.split_once(" => ")) {
            let args: Vec<OsString> = typed.split('|').map(OsString::from).collect();
            let args = join_rays(&args);
            let words: Vec<_> = args.iter().map(|arg| arg.to_string_lossy()).collect();
            assert_eq!(words.join("|"), expected, "{typed}");
        }
    }
}
