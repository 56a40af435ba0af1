//! What can be typed.

mod chart;
mod check;
mod cut;
mod files;
mod mend;
mod read;
mod render;
mod tear;

use std::ffi::{OsStr, OsString};

use clap::{Parser, Subcommand};

pub(crate) use self::chart::{ChartArgs, DrawArgs, Fig7Args, ParetoArgs, What};
pub(crate) use self::check::CheckArgs;
pub(crate) use self::cut::{CameraArgs, CutArgs, Layers, Mass, Method, Tips, cut_name};
pub(crate) use self::files::{FileArgs, Format};
pub(crate) use self::mend::MendArgs;
pub(crate) use self::read::{Gap, numbers};
pub(crate) use self::render::RenderArgs;
pub(crate) use self::tear::{TearArgs, Topology};

/// Cuts and tears triangle meshes in OBJ files, and verifies what it does.
#[derive(Debug, Parser)]
#[command(name = "tearmesh", version, disable_help_subcommand = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Cut(Box<CutArgs>),
    Tear(Box<TearArgs>),
    Mend(MendArgs),
    Render(Box<RenderArgs>),
    Check(CheckArgs),
    Chart(ChartArgs),
}

/// Makes one argument of `--rays A B`, so that a negative number is no option, and an option is
/// no second ray; and likewise of `--points A B`.
///
/// `--rays A B`, `--rays "A B"`, `--rays "A;B"` and `--rays=A B` all become `--rays=A;B`. What
/// does not look like a ray is left to the parser.
pub(crate) fn join_rays(args: &[OsString]) -> Vec<OsString> {
    let mut joined = Vec::with_capacity(args.len());
    let mut rest = args.iter().peekable();
    while let Some(arg) = rest.next() {
        if arg == "--" {
            joined.push(arg.clone());
            joined.extend(rest.by_ref().cloned());
            break;
        }
        let text = arg.to_str().unwrap_or_default();
        let (name, given) = text.split_once('=').unwrap_or((text, ""));
        if !["--rays", "--points"].contains(&name) {
            joined.push(arg.clone());
            continue;
        }
        let mut value = given.to_owned();
        while crate::rays::split_pair(&value).count() < 2
            && let Some(ray) = rest.next_if(|next| looks_like_rays(next))
        {
            value.push(';');
            value.push_str(&ray.to_string_lossy());
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
fn looks_like_rays(arg: &OsStr) -> bool {
    let text = arg.to_string_lossy();
    let number = text.trim_start().trim_start_matches(['+', '-']);
    let is_number = number.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_ray = !text.starts_with('-') && text.contains([':', '@']);
    text.contains(',') && (is_number || is_ray)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joined(args: &str) -> String {
        let args: Vec<OsString> = args.split('|').map(OsString::from).collect();
        let joined = join_rays(&args);
        joined
            .iter()
            .map(|arg| arg.to_string_lossy())
            .collect::<Vec<_>>()
            .join("|")
    }

    #[test]
    fn the_arguments_parse_without_a_clash() {
        use clap::CommandFactory as _;
        Args::command().debug_assert();
    }

    #[test]
    fn two_rays_become_one_argument_however_they_are_written() {
        let one = "cut|--rays=1,2,3:4,5,6;-1,0,0@7,8,9|-o|x";
        for args in [
            "cut|--rays|1,2,3:4,5,6|-1,0,0@7,8,9|-o|x",
            "cut|--rays|1,2,3:4,5,6;-1,0,0@7,8,9|-o|x",
            "cut|--rays=1,2,3:4,5,6;-1,0,0@7,8,9|-o|x",
            "cut|--rays=1,2,3:4,5,6|-1,0,0@7,8,9|-o|x",
        ] {
            assert_eq!(joined(args), one);
        }
        assert_eq!(
            joined("cut|--rays|1,2,3:4,5,6 -1,0,0@7,8,9|-o|x"),
            "cut|--rays=1,2,3:4,5,6 -1,0,0@7,8,9|-o|x"
        );
    }

    #[test]
    fn so_do_two_points() {
        let one = "cut|--points=-1,2;3,-4|-o|x";
        for args in ["cut|--points|-1,2|3,-4|-o|x", "cut|--points=-1,2|3,-4|-o|x"] {
            assert_eq!(joined(args), one);
        }
    }

    #[test]
    fn what_is_no_ray_is_left_alone() {
        assert_eq!(
            joined("cut|--rays|1,2,3:4,5,6|-o|x"),
            "cut|--rays=1,2,3:4,5,6|-o|x"
        );
        assert_eq!(joined("cut|--rays|-o|x"), "cut|--rays|-o|x");
        assert_eq!(
            joined("cut|--|--rays|1,2,3:4,5,6|1,2,3:4,5,6"),
            "cut|--|--rays|1,2,3:4,5,6|1,2,3:4,5,6"
        );
        assert_eq!(joined("cut|--rays-file|a,b"), "cut|--rays-file|a,b");
    }
}
