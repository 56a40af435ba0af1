//! The uses of one file of a crate by another, as a reader sees them.
//!
//! An arrow is a path in a `use`, or one that begins with `crate::`, `super::` or a module of the
//! file, anywhere in its code. It leads to the file of the last module in the path; where that file
//! only hands the name on from elsewhere, it leads there all the same. A `pub use` of what lies in a
//! module of the file itself is a door and no arrow, unless the file has the name in its own code
//! too. What a crate's first file hands on is that of the file it comes from. Comments, strings and
//! tests do not count.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The files of a crate and the arrows between them.
#[derive(Debug)]
pub(crate) struct Files {
    /// The paths of the files, as from the folder of the crate's root.
    pub(crate) names: Vec<String>,
    /// From a file to another, with a path that leads there.
    pub(crate) edges: BTreeMap<(usize, usize), String>,
    /// The paths that reach what they name through a `pub use` of another file, each told.
    pub(crate) detours: Vec<String>,
    /// The names, signs and literals of each file's code, without its tests.
    pub(crate) words: Vec<Vec<String>>,
}

impl Files {
    /// Reads a crate: the names of its files, the first file of all before the others, and their text.
    pub(crate) fn of(files: Vec<(String, String)>) -> Files {
        let (names, texts): (Vec<String>, Vec<String>) = files.into_iter().unzip();
        let places: Vec<Vec<String>> = names.iter().map(|name| place(name)).collect();
        let codes: Vec<Code> = texts.iter().map(|text| Code::of(text)).collect();
        let handed_on = codes[0].paths.iter().filter(|path| path.is_door);
        let handed_on =
            handed_on.filter_map(|path| Some((path.words.last()?.clone(), path.clone())));
        let handed_on: BTreeMap<String, Path> = handed_on.collect();
        let (mut edges, mut detours) = (BTreeMap::new(), Vec::new());
        for (from, code) in codes.iter().enumerate() {
            for path in &code.paths {
                let mut words = whole(path, &places[from], code);
                let is_detour = |n: &usize| {
                    let place = places.iter().position(|place| place == &words[..*n]);
                    place.is_some_and(|to| to != from && codes[to].hands_on(words.get(*n)))
                };
                if from != 0 && !words.is_empty() && (0..words.len()).any(|n| is_detour(&n)) {
                    detours.push(format!("{} uses {}", names[from], path.words.join("::")));
                }
                if let [first] = &words[..] {
                    words = handed_on
                        .get(first)
                        .map_or(words.clone(), |path| path.words.clone());
                }
                let lengths = (1..=words.len()).rev();
                let mut found =
                    lengths.filter_map(|n| places.iter().position(|place| place == &words[..n]));
                let Some(to) = found.next().filter(|&to| to != from && from != 0) else {
                    continue;
                };
                let is_below = places[to].starts_with(&places[from]);
                let name = path.words.last().expect("a path has a name");
                if !(path.is_door && is_below && code.count(name) < 2) {
                    edges
                        .entry((from, to))
                        .or_insert_with(|| path.words.join("::"));
                }
            }
        }
        let words = codes.into_iter().map(|code| code.words).collect();
        Files {
            names,
            edges,
            detours,
            words,
        }
    }

    /// The sets of files that use each other in a circle, each with the arrows among them.
    pub(crate) fn circles(&self) -> Vec<String> {
        let reach: Vec<BTreeSet<usize>> = (0..self.names.len()).map(|i| self.reach(i)).collect();
        let with = |i: usize| -> BTreeSet<usize> {
            let both = reach[i].iter().filter(|&&j| reach[j].contains(&i));
            both.copied().collect()
        };
        let sets: BTreeSet<BTreeSet<usize>> = (0..self.names.len()).map(with).collect();
        let circles = sets.iter().filter(|set| !set.is_empty());
        let arrows = circles.map(|set| {
            let among = self
                .edges
                .iter()
                .filter(|((from, to), _)| set.contains(from) && set.contains(to));
            let arrow = |(&(from, to), path): (&(usize, usize), &String)| {
                format!("{} -> {} ({path})", self.names[from], self.names[to])
            };
            among.map(arrow).collect::<Vec<_>>().join("\n    ")
        });
        arrows.collect()
    }

    /// The files that a file uses, directly or not.
    fn reach(&self, from: usize) -> BTreeSet<usize> {
        let (mut reached, mut left) = (BTreeSet::new(), vec![from]);
        while let Some(i) = left.pop() {
            let next = self.edges.range((i, 0)..(i + 1, 0));
            left.extend(
                next.map(|(&(_, to), _)| to)
                    .filter(|&to| reached.insert(to)),
            );
        }
        reached
    }
}

/// The modules that lead to a file: none for the first file of a crate.
fn place(name: &str) -> Vec<String> {
    let name = name.trim_end_matches(".rs").trim_end_matches("/mod");
    let words = name.split('/').map(str::to_owned);
    words
        .filter(|word| !["lib", "main"].contains(&&**word))
        .collect()
}

/// A path, from the file in which it stands.
#[derive(Clone, Debug)]
struct Path {
    words: Vec<String>,
    is_door: bool,
}

/// The words of a path from the root of the crate; none for a path into another crate.
fn whole(path: &Path, place: &[String], code: &Code) -> Vec<String> {
    let ups = path
        .words
        .iter()
        .take_while(|word| *word == "super")
        .count();
    let rest = &path.words[ups..];
    match rest.first().map(String::as_str) {
        _ if ups > 0 => [&place[..place.len().saturating_sub(ups)], rest].concat(),
        Some("crate") => rest[1..].to_vec(),
        Some("self") => [place, &rest[1..]].concat(),
        Some(first) if code.modules.contains(first) => [place, rest].concat(),
        _ => Vec::new(),
    }
}

/// What counts of the text of a file.
struct Code {
    words: Vec<String>,
    modules: BTreeSet<String>,
    paths: Vec<Path>,
}

impl Code {
    fn of(text: &str) -> Code {
        let mut words = Vec::new();
        let tokens: TokenStream = text.parse().expect("a file of Rust");
        add_words(tokens, false, &mut words);
        let after = |at: usize, ahead: usize| words.get(at + ahead).map_or("", String::as_str);
        let is_module = |at: &usize| words[*at] == "mod" && after(*at, 2) == ";";
        let modules = (0..words.len()).filter(is_module);
        let modules = modules.map(|at| words[at + 1].clone()).collect();
        let mut code = Code {
            words: Vec::new(),
            modules,
            paths: Vec::new(),
        };
        let mut at = 0;
        while at < words.len() {
            if words[at] == "use" {
                let is_door = at > 0 && ["pub", ")"].contains(&&*words[at - 1]);
                at = code.add_tree(&words, at + 1, &[], is_door);
            } else if words[at] == "in" && at > 0 && words[at - 1] == "(" {
                // `pub(in crate::scissor)` says who may look in, and uses nothing.
                at += words[at..].iter().position(|word| word == ")").unwrap_or(0);
            } else if after(at, 1) == "::" {
                let mut path = vec![words[at].clone()];
                while after(at, 1) == "::" {
                    path.push(after(at, 2).to_owned());
                    at += 2;
                }
                code.paths.push(Path {
                    words: path,
                    is_door: false,
                });
            }
            at += 1;
        }
        code.words = words;
        code
    }

    /// Adds the paths of a `use`, whose tree begins at a word. Returns the word after it.
    fn add_tree(
        &mut self,
        words: &[String],
        mut at: usize,
        before: &[String],
        is_door: bool,
    ) -> usize {
        let mut path = before.to_vec();
        loop {
            match &*words[at] {
                "::" => {}
                "{" => loop {
                    at = self.add_tree(words, at + 1, &path, is_door);
                    if words[at] == "}" {
                        return at + 1;
                    }
                },
                "," | "}" | ";" => {
                    if path.len() > before.len() {
                        path.retain(|word| word != "*");
                        self.paths.push(Path {
                            words: path,
                            is_door,
                        });
                    }
                    return at;
                }
                "as" => at += 1,
                word => path.push(word.to_owned()),
            }
            at += 1;
        }
    }

    /// Whether a `pub use` of the file hands on what has this name.
    fn hands_on(&self, name: Option<&String>) -> bool {
        let mut doors = self.paths.iter().filter(|path| path.is_door);
        doors.any(|path| path.words.last() == name)
    }

    /// How often a name stands in the code.
    fn count(&self, name: &str) -> usize {
        self.words.iter().filter(|word| *word == name).count()
    }
}

/// Adds the names and signs of some code without its tests. In a module that has its body in the same
/// file, what is above it is that file.
fn add_words(tokens: TokenStream, is_inside: bool, words: &mut Vec<String>) {
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(name) if is_inside && name == "super" => words.push("self".to_owned()),
            TokenTree::Ident(name) => words.push(name.to_string()),
            TokenTree::Literal(literal) => words.push(literal.to_string()),
            // Comments for the documentation are attributes here.
            TokenTree::Group(group) if group.to_string().starts_with("[doc") => {}
            TokenTree::Punct(sign) => match (sign.as_char(), tokens.peek()) {
                (':', Some(TokenTree::Punct(next))) if next.as_char() == ':' => {
                    tokens.next();
                    words.push("::".to_owned());
                }
                ('#', Some(TokenTree::Group(group))) if group.to_string() == "[cfg (test)]" => {
                    let is_last = |token: &TokenTree| match token {
                        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                        token => token.to_string() == ";",
                    };
                    tokens.find(is_last);
                }
                (sign, _) => words.push(sign.to_string()),
            },
            TokenTree::Group(group) => {
                let [open, close] = match group.delimiter() {
                    Delimiter::Brace => ["{", "}"],
                    Delimiter::Bracket => ["[", "]"],
                    _ => ["(", ")"],
                };
                let is_module = words.len() > 1 && words[words.len() - 2] == "mod" && open == "{";
                words.push(open.to_owned());
                add_words(group.stream(), is_inside || is_module, words);
                words.push(close.to_owned());
            }
        }
    }
}
