//! Which file of a crate uses what which other file defines, read off the code itself.
//!
//! An edge is every path to an item of another file: in a `use`, inline (`cut::run(…)`), in a type,
//! a pattern or the tokens of a macro. It leads to the file that *defines* the item, through however
//! many `pub use`, which are no edges themselves, as `mod` is none. `Type::function` also leads to
//! the file whose `impl` has the function. What is under `#[cfg(test)]` does not count.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};

/// The files of a crate and the edges between them.
#[derive(Debug)]
pub(crate) struct Files {
    /// The paths of the files, as from the folder of the crate's root.
    pub(crate) names: Vec<String>,
    /// From a file to another, with a path that led there.
    pub(crate) edges: BTreeMap<(usize, usize), String>,
}

impl Files {
    /// Reads a crate. `read` gives the text of a file by its path, if there is such a file.
    pub(crate) fn of(root: &str, read: &dyn Fn(&str) -> Option<String>) -> Files {
        let mut tree = Tree::default();
        let text = read(root).unwrap_or_else(|| panic!("no file {root}"));
        let folder = Path::new(root).parent().map_or(String::new(), folder_name);
        tree.add_file(root, &folder, &text, None, read);
        tree.collect_functions();
        let mut files = Files {
            names: tree.names.clone(),
            edges: BTreeMap::new(),
        };
        for module in 0..tree.modules.len() {
            let from = tree.modules[module].file;
            for path in &tree.modules[module].paths {
                for to in tree.files_of(module, path) {
                    if to != from {
                        let said = || path.segments.join("::");
                        files.edges.entry((from, to)).or_insert_with(said);
                    }
                }
            }
        }
        files
    }

    /// The sets of files that use each other in a circle, each told as one way round.
    pub(crate) fn circles(&self) -> Vec<String> {
        let reach: Vec<BTreeSet<usize>> = (0..self.names.len()).map(|i| self.reach(i)).collect();
        let mut told = BTreeSet::new();
        let mut circles = Vec::new();
        for i in 0..self.names.len() {
            if !reach[i].contains(&i) || told.contains(&i) {
                continue;
            }
            let with: BTreeSet<usize> = reach[i]
                .iter()
                .copied()
                .filter(|&j| reach[j].contains(&i))
                .collect();
            let among = |(from, to): &(usize, usize)| with.contains(from) && with.contains(to);
            let arrows: Vec<String> = self
                .edges
                .iter()
                .filter(|(edge, _)| among(edge))
                .map(|(&(from, to), path)| {
                    format!("{} -> {} ({path})", self.names[from], self.names[to])
                })
                .collect();
            circles.push(arrows.join("\n    "));
            told.extend(with);
        }
        circles
    }

    /// The files that a file uses, directly or not.
    fn reach(&self, from: usize) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut left = vec![from];
        while let Some(i) = left.pop() {
            for &(_, to) in self.edges.range((i, 0)..(i + 1, 0)).map(|(edge, _)| edge) {
                if reached.insert(to) {
                    left.push(to);
                }
            }
        }
        reached
    }
}

fn folder_name(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

fn join(folder: &str, name: &str) -> String {
    if folder.is_empty() {
        name.to_owned()
    } else {
        format!("{folder}/{name}")
    }
}

/// What a name stands for in a module.
#[derive(Clone, Debug)]
enum Meaning {
    /// An item that the module defines.
    Item,
    Module(usize),
    Import(Written),
}

/// A path as it stands in the code.
#[derive(Clone, Debug)]
struct Written {
    segments: Vec<String>,
    /// Inside `impl Type`, the type that `Self` is.
    of_type: Option<Vec<String>>,
}

#[derive(Debug)]
struct Module {
    file: usize,
    parent: Option<usize>,
    names: BTreeMap<String, Vec<Meaning>>,
    /// What `use path::*` brings in.
    globs: Vec<Vec<String>>,
    /// Every path in the module that may be an edge.
    paths: Vec<Written>,
    /// The functions and constants of `impl Type` blocks.
    functions: Vec<(Vec<String>, String)>,
}

#[derive(Debug, Default)]
struct Tree {
    names: Vec<String>,
    modules: Vec<Module>,
    /// The files that implement `Type::function`, by the module that defines the type.
    functions: BTreeMap<(usize, String, String), BTreeSet<usize>>,
}

/// What a path ends at: the module that defines it, and its name there.
type Found = (usize, String);

impl Tree {
    fn add_file(
        &mut self,
        name: &str,
        folder: &str,
        text: &str,
        parent: Option<usize>,
        read: &dyn Fn(&str) -> Option<String>,
    ) -> usize {
        let file = self.names.len();
        self.names.push(name.to_owned());
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        self.add_module(file, folder, &parsed.items, parent, read)
    }

    fn add_module(
        &mut self,
        file: usize,
        folder: &str,
        items: &[syn::Item],
        parent: Option<usize>,
        read: &dyn Fn(&str) -> Option<String>,
    ) -> usize {
        let this = self.modules.len();
        self.modules.push(Module {
            file,
            parent,
            names: BTreeMap::new(),
            globs: Vec::new(),
            paths: Vec::new(),
            functions: Vec::new(),
        });
        for item in items.iter().filter(|item| !is_for_tests(attributes(item))) {
            if let syn::Item::Mod(child) = item {
                let name = child.ident.to_string();
                let inside = join(folder, &name);
                let child = if let Some((_, items)) = &child.content {
                    self.add_module(file, &inside, items, Some(this), read)
                } else {
                    let named = named_path(&child.attrs).map(|name| join(folder, &name));
                    let usual = [format!("{inside}.rs"), format!("{inside}/mod.rs")];
                    let found = named
                        .into_iter()
                        .chain(usual)
                        .find_map(|name| Some((read(&name)?, name)));
                    let (text, name) = found.unwrap_or_else(|| panic!("no file for {inside}"));
                    self.add_file(&name, &inside, &text, Some(this), read)
                };
                self.name(this, &name, Meaning::Module(child));
                continue;
            }
            if let syn::Item::Use(item) = item {
                let is_public = !matches!(item.vis, syn::Visibility::Inherited);
                self.add_use(this, &item.tree, &mut Vec::new(), is_public);
                continue;
            }
            if let Some(name) = name_of(item) {
                self.name(this, &name, Meaning::Item);
            }
            let mut reader = Reader {
                module: &mut self.modules[this],
                of_type: None,
                uses: Vec::new(),
            };
            reader.visit_item(item);
            // What a function brings in is taken for what its module does.
            let inside = reader.uses;
            for item in inside {
                self.add_use(this, &item.tree, &mut Vec::new(), false);
            }
        }
        this
    }

    fn name(&mut self, module: usize, name: &str, meaning: Meaning) {
        let names = &mut self.modules[module].names;
        names.entry(name.to_owned()).or_default().push(meaning);
    }

    fn add_use(
        &mut self,
        module: usize,
        tree: &syn::UseTree,
        before: &mut Vec<String>,
        is_public: bool,
    ) {
        match tree {
            syn::UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.add_use(module, &path.tree, before, is_public);
                before.pop();
            }
            syn::UseTree::Group(group) => {
                for tree in &group.items {
                    self.add_use(module, tree, before, is_public);
                }
            }
            syn::UseTree::Glob(_) => self.modules[module].globs.push(before.clone()),
            syn::UseTree::Name(name) => {
                let name = name.ident.to_string();
                self.import(module, before, &name, &name, is_public);
            }
            syn::UseTree::Rename(renamed) => {
                let (name, to) = (renamed.ident.to_string(), renamed.rename.to_string());
                self.import(module, before, &name, &to, is_public);
            }
        }
    }

    fn import(&mut self, module: usize, before: &[String], name: &str, to: &str, is_public: bool) {
        let mut segments = before.to_vec();
        if name != "self" {
            segments.push(name.to_owned());
        }
        let to = match (to, segments.last()) {
            ("self", Some(last)) => last.clone(),
            _ => to.to_owned(),
        };
        let path = Written {
            segments,
            of_type: None,
        };
        if !is_public {
            self.modules[module].paths.push(path.clone());
        }
        self.name(module, &to, Meaning::Import(path));
    }

    /// Which file has which `Type::function`.
    fn collect_functions(&mut self) {
        for module in 0..self.modules.len() {
            for (of_type, function) in self.modules[module].functions.clone() {
                for (home, name) in self.resolve(module, &of_type, 0).0 {
                    let files = self.functions.entry((home, name, function.clone()));
                    files.or_default().insert(self.modules[module].file);
                }
            }
        }
    }

    /// The files that a path leads to.
    fn files_of(&self, module: usize, path: &Written) -> BTreeSet<usize> {
        let mut segments = path.segments.clone();
        if segments[0] == "Self" {
            let Some(of_type) = &path.of_type else {
                return BTreeSet::new();
            };
            segments.splice(..1, of_type.iter().cloned());
        }
        let (found, after) = self.resolve(module, &segments, 0);
        let mut files = BTreeSet::new();
        for (home, name) in found {
            files.insert(self.modules[home].file);
            if let Some(function) = after.and_then(|after| segments.get(after)) {
                let implemented = self.functions.get(&(home, name, function.clone()));
                files.extend(implemented.into_iter().flatten());
            }
        }
        files
    }

    /// The items at the end of a path, and which of its segments comes behind them.
    fn resolve(
        &self,
        module: usize,
        segments: &[String],
        depth: u32,
    ) -> (Vec<Found>, Option<usize>) {
        let mut at = module;
        for (i, segment) in segments.iter().enumerate() {
            match segment.as_str() {
                "crate" => at = 0,
                "self" => {}
                "super" => at = self.modules[at].parent.expect("a module above"),
                name => {
                    // A name that no import brought, behind the first: an item of that module.
                    let meanings = self.meanings(at, name, depth);
                    let items: Vec<Found> = meanings.items;
                    let last = i + 1 == segments.len();
                    match meanings.module {
                        Some(module) if !last => at = module,
                        _ if !items.is_empty() => return (items, Some(i + 1)),
                        _ => return (Vec::new(), None),
                    }
                }
            }
        }
        (Vec::new(), None)
    }

    fn meanings(&self, module: usize, name: &str, depth: u32) -> Meanings {
        let mut all = Meanings::default();
        if depth > 20 {
            return all; // Globs that bring in each other.
        }
        for meaning in self.modules[module].names.get(name).into_iter().flatten() {
            match meaning {
                Meaning::Item => all.items.push((module, name.to_owned())),
                Meaning::Module(child) => all.module = Some(*child),
                // `use serde;` names a crate, and `use a::a;` an item of the module `a`.
                Meaning::Import(path) if path.segments[0] == name => {
                    if let Some(child) = self.child(module, name) {
                        let rest = &path.segments[1..];
                        all.items.extend(self.resolve(child, rest, depth + 1).0);
                    }
                }
                Meaning::Import(path) => {
                    let found = self.resolve(module, &path.segments, depth + 1).0;
                    all.items.extend(found);
                    let imported = self.module_at(module, &path.segments, depth + 1);
                    all.module = all.module.or(imported);
                }
            }
        }
        if all.items.is_empty() && all.module.is_none() {
            for glob in &self.modules[module].globs {
                if let Some(from) = self.module_at(module, glob, depth + 1) {
                    let brought = self.meanings(from, name, depth + 1);
                    all.items.extend(brought.items);
                    all.module = all.module.or(brought.module);
                }
            }
        }
        all
    }

    /// The module inside a module.
    fn child(&self, module: usize, name: &str) -> Option<usize> {
        let meanings = self.modules[module].names.get(name)?;
        meanings.iter().find_map(|meaning| match meaning {
            Meaning::Module(child) => Some(*child),
            _ => None,
        })
    }

    /// The module that a path names.
    fn module_at(&self, module: usize, segments: &[String], depth: u32) -> Option<usize> {
        let mut at = module;
        for segment in segments {
            at = match segment.as_str() {
                "crate" => 0,
                "self" => at,
                "super" => self.modules[at].parent?,
                name => self.meanings(at, name, depth + 1).module?,
            };
        }
        Some(at)
    }
}

#[derive(Default)]
struct Meanings {
    items: Vec<Found>,
    module: Option<usize>,
}

/// Collects the paths of an item.
struct Reader<'m, 'ast> {
    module: &'m mut Module,
    of_type: Option<Vec<String>>,
    /// Those inside functions.
    uses: Vec<&'ast syn::ItemUse>,
}

impl Reader<'_, '_> {
    fn note(&mut self, segments: Vec<String>) {
        let of_type = self.of_type.clone();
        self.module.paths.push(Written { segments, of_type });
    }

    /// The paths among the tokens of a macro: names joined by `::`, and not fields or methods.
    fn tokens(&mut self, tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let is = |i: usize, c: char| matches!(tokens.get(i), Some(TokenTree::Punct(p)) if p.as_char() == c);
        let mut i = 0;
        while i < tokens.len() {
            match &tokens[i] {
                TokenTree::Group(group) => self.tokens(group.stream()),
                TokenTree::Ident(first) if i == 0 || !is(i - 1, '.') => {
                    let mut segments = vec![first.to_string()];
                    while is(i + 1, ':')
                        && is(i + 2, ':')
                        && let Some(TokenTree::Ident(next)) = tokens.get(i + 3)
                    {
                        segments.push(next.to_string());
                        i += 3;
                    }
                    self.note(segments);
                }
                _ => {}
            }
            i += 1;
        }
    }
}

impl<'ast> Visit<'ast> for Reader<'_, 'ast> {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.uses.push(item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.note(path.segments.iter().map(|s| s.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        self.tokens(called.tokens.clone());
        visit::visit_macro(self, called);
    }

    fn visit_item_macro(&mut self, item: &'ast syn::ItemMacro) {
        self.tokens(item.mac.tokens.clone());
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        if let syn::Type::Path(of) = &*item.self_ty {
            let segments: Vec<String> = of
                .path
                .segments
                .iter()
                .map(|s| s.ident.to_string())
                .collect();
            if item.trait_.is_none() {
                for member in &item.items {
                    let name = match member {
                        syn::ImplItem::Fn(function) => &function.sig.ident,
                        syn::ImplItem::Const(constant) => &constant.ident,
                        _ => continue,
                    };
                    self.module
                        .functions
                        .push((segments.clone(), name.to_string()));
                }
            }
            self.of_type = Some(segments);
        }
        visit::visit_item_impl(self, item);
        self.of_type = None;
    }
}

fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    match item {
        syn::Item::Const(item) => &item.attrs,
        syn::Item::Enum(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Macro(item) => &item.attrs,
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Static(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Trait(item) => &item.attrs,
        syn::Item::Type(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        _ => panic!("a kind of item that this does not know"),
    }
}

fn name_of(item: &syn::Item) -> Option<String> {
    let name = match item {
        syn::Item::Const(item) => &item.ident,
        syn::Item::Enum(item) => &item.ident,
        syn::Item::Fn(item) => &item.sig.ident,
        syn::Item::Static(item) => &item.ident,
        syn::Item::Struct(item) => &item.ident,
        syn::Item::Trait(item) => &item.ident,
        syn::Item::Type(item) => &item.ident,
        syn::Item::Macro(item) => item.ident.as_ref()?,
        _ => return None,
    };
    Some(name.to_string())
}

/// Whether something is there for tests alone: `#[cfg(test)]`, `#[cfg(doctest)]`.
fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    let mut found = attributes
        .iter()
        .filter(|attribute| attribute.path().is_ident("cfg"))
        .map(|attribute| attribute.parse_args::<syn::Path>());
    found.any(|cfg| cfg.is_ok_and(|cfg| cfg.is_ident("test") || cfg.is_ident("doctest")))
}

/// The file of `#[path = "…"] mod …;`.
fn named_path(attributes: &[syn::Attribute]) -> Option<String> {
    let attribute = attributes
        .iter()
        .find(|attribute| attribute.path().is_ident("path"))?;
    let syn::Meta::NameValue(pair) = &attribute.meta else {
        return None;
    };
    match &pair.value {
        syn::Expr::Lit(syn::ExprLit {
            lit: syn::Lit::Str(name),
            ..
        }) => Some(name.value()),
        _ => None,
    }
}
