//! Uses of names between the files of a crate: `use` declarations and paths, followed to the file that
//! defines the name.

use crate::tokens::{after_group, tokens};
use crate::tree::File;
use std::collections::{BTreeMap, BTreeSet};

/// For each file, the files whose names it uses, with those names.
pub(crate) type Arrows = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// A name that a module gets from elsewhere.
struct Import {
    /// The path as written, with `self` at its end left out.
    path: Vec<String>,
    /// The name in this module; `*` for every name.
    name: String,
    /// Whether the declaration gives the name to other modules.
    public: bool,
}

/// A module of a crate: a file or a `mod name { ... }` in one.
#[derive(Default)]
struct Module {
    file: String,
    defined: BTreeSet<String>,
    /// Whether it declares a macro, whose output may define further names.
    has_macro: bool,
    imports: Vec<Import>,
    /// Paths in the code outside of `use`; one word is a path, too.
    paths: Vec<Vec<String>>,
}

/// What a path leads to.
#[derive(Clone, PartialEq, Eq)]
enum Destination {
    Module(String),
    /// The file that defines a name.
    Name(String),
}

/// The modules of one crate by their paths; the path of the root is empty.
struct Crate {
    modules: BTreeMap<String, Module>,
}

/// Returns the arrows between the files below `src` of the crate in a folder.
pub(crate) fn arrows(files: &[File], folder: &str) -> Arrows {
    let start = format!("{folder}/src/");
    let mut all = Crate { modules: BTreeMap::new() };
    for file in files.iter().filter(|file| file.is_rust()) {
        // The program is a crate of its own.
        if let Some(inside) = file.path.strip_prefix(&start).filter(|inside| *inside != "main.rs") {
            let path = inside.trim_end_matches(".rs").trim_end_matches("/mod").replace('/', "::");
            all.read(&file.path, if path == "lib" { "" } else { &path }, &tokens(&file.text));
        }
    }
    all.arrows()
}

fn child(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

/// Words that introduce the name of an item.
const ITEMS: &[&str] = &["struct", "enum", "trait", "type", "fn", "const", "static", "union", "macro_rules"];

impl Crate {
    /// Reads the code of a module.
    fn read(&mut self, file: &str, module: &str, tokens: &[String]) {
        let mut found = Module { file: file.to_owned(), ..Module::default() };
        let word = |at: usize| tokens.get(at).map_or("", String::as_str);
        let mut depth = 0_usize;
        let mut at = 0;
        while at < tokens.len() {
            match word(at) {
                "use" => {
                    // `use` in `impl Trait + use<'a>` declares nothing.
                    if word(at + 1) == "<" {
                        at += 1;
                        continue;
                    }
                    let end = at + tokens[at..].iter().position(|token| token == ";").unwrap_or(1);
                    let public = at > 0 && (word(at - 1) == "pub" || is_restricted(tokens, at));
                    found.imports.extend(tree(&tokens[at + 1..end], &[], public));
                    at = end;
                }
                "mod" if word(at + 2) == "{" => {
                    let end = after_group(tokens, at + 2);
                    self.read(file, &child(module, word(at + 1)), &tokens[at + 3..end - 1]);
                    at = end;
                }
                "mod" => at += 2,
                item if ITEMS.contains(&item) => {
                    let name = at + 1 + usize::from(word(at + 1) == "!");
                    // `const fn` and `*const T` name nothing here.
                    // Inside braces it belongs to a type or a function.
                    found.has_macro |= item == "macro_rules";
                    if is_name(word(name)) && !ITEMS.contains(&word(name)) {
                        if depth == 0 {
                            found.defined.insert(word(name).to_owned());
                        }
                        at = name;
                    }
                    at += 1;
                }
                name if is_name(name) && !matches!(at.checked_sub(1).map(word), Some("." | "::")) => {
                    let mut path = vec![name.to_owned()];
                    while word(at + 1) == "::" && is_name(word(at + 2)) {
                        at += 2;
                        path.push(word(at).to_owned());
                    }
                    // A word in lower case is the name of a function only where it is called.
                    let small = name.starts_with(char::is_lowercase);
                    if path.len() > 1 || !small || matches!(word(at + 1), "(" | "!") {
                        found.paths.push(path);
                    }
                    at += 1;
                }
                sign => {
                    depth = (depth + usize::from(sign == "{")).saturating_sub(usize::from(sign == "}"));
                    at += 1;
                }
            }
        }
        self.modules.insert(module.to_owned(), found);
    }

    /// Returns what a path that is written in a module leads to; `None` outside of the crate.
    fn follow(
        &self,
        module: &str,
        path: &[String],
        visited: &mut BTreeSet<(String, String)>,
    ) -> Option<Destination> {
        let mut current = module.to_owned();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => {
                current.clear();
                rest = &path[1..];
            }
            "self" => rest = &path[1..],
            "super" => {
                while rest.first().is_some_and(|word| word == "super") {
                    current =
                        current.rsplit_once("::").map_or(String::new(), |(parent, _)| parent.to_owned());
                    rest = &rest[1..];
                }
            }
            _ => {}
        }
        let Some((name, after)) = rest.split_first() else { return Some(Destination::Module(current)) };
        match self.find(&current, name, visited)? {
            Destination::Module(inner) if !after.is_empty() => {
                let mut below = vec!["self".to_owned()];
                below.extend_from_slice(after);
                self.follow(&inner, &below, visited)
            }
            found => Some(found),
        }
    }

    /// Returns what a name means in a module.
    fn find(
        &self,
        module: &str,
        name: &str,
        visited: &mut BTreeSet<(String, String)>,
    ) -> Option<Destination> {
        let here = self.modules.get(module)?;
        if here.defined.contains(name) {
            return Some(Destination::Name(here.file.clone()));
        }
        if self.modules.contains_key(&child(module, name)) {
            return Some(Destination::Module(child(module, name)));
        }
        if !visited.insert((module.to_owned(), name.to_owned())) {
            return None;
        }
        let named = here.imports.iter().filter(|import| import.name == name);
        let wide = here.imports.iter().filter(|import| import.name == "*");
        for import in named.chain(wide) {
            let mut path = import.path.clone();
            if import.name == "*" {
                path.push(name.to_owned());
            }
            if let Some(found) = self.follow(module, &path, visited) {
                return Some(found);
            }
        }
        None
    }

    /// Returns the file with the macro that defines the name at the end of a path, for paths that lead into this crate.
    fn macro_file(&self, module: &str, path: &[String]) -> Option<Destination> {
        let (_, parent) = path.split_last()?;
        if !matches!(parent.first()?.as_str(), "crate" | "self" | "super") {
            return None;
        }
        match self.follow(module, parent, &mut BTreeSet::new())? {
            Destination::Module(inner) => {
                let inner = self.modules.get(&inner).filter(|inner| inner.has_macro)?;
                Some(Destination::Name(inner.file.clone()))
            }
            Destination::Name(_) => None,
        }
    }

    fn arrows(&self) -> Arrows {
        let mut arrows = Arrows::new();
        for (module, here) in &self.modules {
            // A re-export depends on nothing; the code that uses the name does.
            let private = here.imports.iter().filter(|import| !import.public && import.name != "*");
            for path in here.paths.iter().chain(private.map(|import| &import.path)) {
                let found = self.follow(module, path, &mut BTreeSet::new());
                if let Some(Destination::Name(file)) = found.or_else(|| self.macro_file(module, path))
                    && file != here.file
                {
                    let targets = arrows.entry(here.file.clone()).or_default();
                    targets.entry(file).or_default().insert(path.join("::"));
                }
            }
        }
        arrows
    }
}

fn is_name(word: &str) -> bool {
    word.starts_with(|first: char| first.is_alphabetic() || first == '_')
}

/// Returns whether `pub(...)` precedes a position.
fn is_restricted(tokens: &[String], at: usize) -> bool {
    let open = tokens[..at].iter().rposition(|token| token == "(");
    tokens[at - 1] == ")" && open.is_some_and(|open| open > 0 && tokens[open - 1] == "pub")
}

/// Returns the imports of a `use` tree below the path `prefix`.
fn tree(tokens: &[String], prefix: &[String], public: bool) -> Vec<Import> {
    let mut path = prefix.to_vec();
    let mut name = None;
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        match token.as_str() {
            "::" => {}
            "as" => {
                name = tokens.get(at + 1).cloned();
                at += 1;
            }
            "*" => name = Some("*".to_owned()),
            "{" => {
                let inside = &tokens[at + 1..after_group(tokens, at) - 1];
                return parts(inside).into_iter().flat_map(|part| tree(part, &path, public)).collect();
            }
            _ => path.push(token.clone()),
        }
        at += 1;
    }
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let name = name.or_else(|| path.last().cloned()).unwrap_or_default();
    vec![Import { path, name, public }]
}

/// Splits a list at the commas that are in no braces.
fn parts(tokens: &[String]) -> Vec<&[String]> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut at = 0;
    while at < tokens.len() {
        if tokens[at] == "{" {
            at = after_group(tokens, at);
            continue;
        }
        if tokens[at] == "," {
            parts.push(&tokens[start..at]);
            start = at + 1;
        }
        at += 1;
    }
    parts.push(&tokens[start..]);
    parts.into_iter().filter(|part| !part.is_empty()).collect()
}
