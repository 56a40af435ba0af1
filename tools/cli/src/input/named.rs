//! The files that inputs name: folders are looked into, and patterns that no shell has expanded are
//! expanded here, since those of Windows expand none.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use super::cannot_read;
use crate::say::Fault;

/// The files that inputs name, in the order of the inputs and each folder's by name; where there are
/// none, why, with what was typed.
pub(crate) fn named(inputs: &[PathBuf], recursive: bool) -> Vec<Result<PathBuf, (PathBuf, Fault)>> {
    let mut files = Vec::new();
    for input in inputs {
        let named = of_input(input, recursive);
        match named {
            Ok(named) => files.extend(named.into_iter().map(Ok)),
            Err(fault) => files.push(Err((input.clone(), fault))),
        }
    }
    files
}

fn of_input(input: &Path, recursive: bool) -> Result<Vec<PathBuf>, Fault> {
    let missing = |message: String| Fault::error("E-IO-MISSING", message);
    if recursive && input.is_dir() {
        let mut files = Vec::new();
        look_into(input, &mut files)?;
        if files.is_empty() {
            let message = format!("there is no OBJ file in `{}`", input.display());
            return Err(missing(message));
        }
        return Ok(files);
    }
    if !is_pattern(input) || input.exists() {
        return Ok(vec![input.to_owned()]);
    }
    let mut files = Vec::new();
    for path in matching(input) {
        match (path.is_dir(), recursive) {
            (true, true) => look_into(&path, &mut files)?,
            (true, false) => {}
            (false, _) => files.push(path),
        }
    }
    if files.is_empty() {
        return Err(missing(format!("no file matches `{}`", input.display())));
    }
    Ok(files)
}

/// Finds the OBJ files of a folder and of those in it. Links to folders are not followed, so
/// there is an end.
fn look_into(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), Fault> {
    let unreadable = |error: &io::Error| cannot_read(&folder.display().to_string(), error);
    let mut folders = vec![folder.to_owned()];
    let first = files.len();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(|error| unreadable(&error))? {
            let entry = entry.map_err(|error| unreadable(&error))?;
            let path = entry.path();
            if entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                folders.push(path);
            } else if is_obj(&path) && !path.is_dir() {
                files.push(path);
            }
        }
    }
    files[first..].sort();
    Ok(())
}

fn is_obj(path: &Path) -> bool {
    let extension = path.extension();
    extension.is_some_and(|extension| extension.eq_ignore_ascii_case("obj"))
}

fn is_pattern(path: &Path) -> bool {
    path.to_string_lossy().contains(['*', '?'])
}

/// The paths that match a pattern, sorted. Names that begin with a dot have to be asked for.
fn matching(pattern: &Path) -> Vec<PathBuf> {
    let mut paths = vec![PathBuf::new()];
    for part in pattern.components() {
        let wanted = match part {
            Component::Normal(name) if is_pattern(Path::new(name)) => name.to_string_lossy(),
            part => {
                paths.iter_mut().for_each(|path| path.push(part));
                continue;
            }
        };
        let mut found = Vec::new();
        for path in &paths {
            let folder = if path.as_os_str().is_empty() {
                Path::new(".")
            } else {
                path
            };
            let entries = folder.read_dir().into_iter().flatten().flatten();
            found.extend(entries.filter_map(|entry| {
                let name = entry.file_name();
                let text = name.to_string_lossy();
                let is_hidden = text.starts_with('.') && !wanted.starts_with('.');
                (!is_hidden && is_match(&wanted, &text)).then(|| path.join(&name))
            }));
        }
        paths = found;
    }
    paths.retain(|path| path.exists());
    paths.sort();
    paths
}

/// Whether a name matches a pattern, in which `*` stands for any text and `?` for one character.
fn is_match(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) =
        (pattern.chars().collect(), name.chars().collect());
    let (mut p, mut n) = (0, 0);
    // Where the last `*` is, and up to where it has taken the name.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
            }
            Some(&c) if c == '?' || c == name[n] => {
                p += 1;
                n += 1;
            }
            _ => {
                let Some((at, taken)) = star else {
                    return false;
                };
                star = Some((at, taken + 1));
                (p, n) = (at + 1, taken + 1);
            }
        }
    }
    pattern[p..].iter().all(|&c| c == '*')
}

#[cfg(test)]
mod tests {
    use super::is_match;

    /// By the definition, letter by letter.
    fn plainly(pattern: &[u8], name: &[u8]) -> bool {
        match (pattern, name) {
            ([], name) => name.is_empty(),
            ([b'*', rest @ ..], name) => (0..=name.len()).any(|n| plainly(rest, &name[n..])),
            ([b'?', rest @ ..], [_, name @ ..]) => plainly(rest, name),
            ([c, rest @ ..], [d, name @ ..]) => c == d && plainly(rest, name),
            _ => false,
        }
    }

    #[test]
    fn patterns_match_as_they_are_defined() {
        let words = |letters: &'static [u8]| {
            let mut words: Vec<Vec<u8>> = vec![Vec::new()];
            let mut from = 0;
            for _ in 0..5 {
                let end = words.len();
                for i in from..end {
                    let word = words[i].clone();
                    words.extend(letters.iter().map(|&c| [&word[..], &[c]].concat()));
                }
                from = end;
            }
            words
        };
        let mut matches = 0;
        for pattern in words(b"ab*?") {
            for name in words(b"ab") {
                let [one, other] =
                    [&pattern, &name].map(|text| str::from_utf8(text).expect("ASCII"));
                assert_eq!(
                    is_match(one, other),
                    plainly(&pattern, &name),
                    "{one} {other}"
                );
                matches += usize::from(is_match(one, other));
            }
        }
        assert!(matches > 1000, "{matches}");
    }
}
