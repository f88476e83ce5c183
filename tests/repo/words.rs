//! Language of the source: plain English, one name for one type, and no path of one machine.

use crate::tree::{File, files, none, one};
use regex::Regex;
use std::collections::BTreeMap;

/// Folders of one machine. Written in two pieces, so that this file does not break its own rule.
const PLACES: &[&str] =
    &[concat!("/wo", "rk/"), concat!("/ro", "ot/"), concat!("/tmp/", "bash"), concat!("/tmp/", "t-")];

fn names_no_machine(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for file in files {
        for place in PLACES.iter().filter(|place| file.text.contains(**place)) {
            complaints.push(format!("{}: names {place}, a folder of one machine", file.path));
        }
    }
    complaints
}

#[test]
fn no_file_names_a_folder_of_one_machine() {
    none(names_no_machine(&files()));
    one(names_no_machine(&[File::planted("README.md", &format!("see {}notes", PLACES[0]))]));
}

/// Phrasing that readers had to read twice, as a pattern over one comment block.
const UNCLEAR: &[(&str, &str)] = &[
    ("a clause with 'who' as its subject", r"(^|[.;:] )Who(ever)? \w+"),
    (
        "a clause without a subject",
        r"^(What|Which|Where|How far|How much|Whom|As (many|much|far|it)|So (many|often|much|long))\b[^?]*$",
    ),
    (
        "a question instead of 'Returns whether'",
        r"^(Is|Are|Does|Do|Has|Have|Was|Were|May|Can|Will|Did) [^.]*\?",
    ),
    ("an old word", r"\banew\b|\ball the same\b|(^|[;.,] )[Ee]lse (it|they|the|a)\b"),
    (
        "data that acts like a person",
        r"\b(says|said|tells|told|hears|heard|wants|believes|lies|stands|stand|lie)\b",
    ),
    (
        "an old word",
        r"\bthe begin\b|\bwholly\b|\blikewise\b|\bbesides\b|\bmeanwhile\b|\bunasked\b|\b[Nn]obody\b|\b[Ss]omebody\b",
    ),
    ("'so many' without what is counted", r"\bso many\b|\bas many\b"),
    ("'beside' or 'behind' for 'after'", r"\bbeside\b|\bbehind\b"),
    (
        "a house word",
        r"\b[Aa] person\b|\bthe person\b|\bdeeds?\b|\bmend(ed|s)?\b|\btake[ns]? back\b|\bgoes on\b|\bgo on\b|\blets? go\b|\bhad back\b|\bbrought back\b",
    ),
];

/// Parts of names that only this project gave a meaning.
const HOUSE_WORDS: &str = r"(deed|hasten|hinder|heard|told|mended|unasked|fate\b|keeper|grasp|(^|_)lay($|_)|(^|_)hands?($|_)|so_often|stand_still|let_go)";

/// Percentage of comment blocks of a folder in which a pattern of [`UNCLEAR`] may occur: some are right in their context.
const TOLERATED: usize = 5;

/// The comment blocks of a file: neighboring lines of one kind, without code, longer than a few words.
fn comment_blocks(text: &str) -> Vec<(usize, String)> {
    let mut blocks: Vec<(usize, String)> = Vec::new();
    let mut open: Option<&str> = None;
    for (index, line) in text.lines().enumerate() {
        let line = line.trim_start();
        let kind = ["///", "//!", "//"].into_iter().find(|kind| line.starts_with(kind));
        let Some(kind) = kind.filter(|_| !line.starts_with("////")) else {
            open = None;
            continue;
        };
        let words = line[kind.len()..].trim_start();
        match blocks.last_mut().filter(|_| open == Some(kind)) {
            Some((_, block)) => {
                block.push(' ');
                block.push_str(words);
            }
            None => blocks.push((index + 1, words.to_owned())),
        }
        open = Some(kind);
    }
    blocks.retain(|(_, block)| block.len() > 25 && !block.contains("```"));
    blocks
}

/// Names of functions, types, modules and variants with a house word.
fn house_names(file: &File) -> Vec<String> {
    let declaration =
        Regex::new(r"\b(?:fn|struct|enum|trait|mod|type)\s+([A-Za-z_][A-Za-z0-9_]*)").expect("a pattern");
    let hump = Regex::new(r"([a-z0-9])([A-Z])").expect("a pattern");
    let house = Regex::new(HOUSE_WORDS).expect("a pattern");
    let names = declaration.captures_iter(&file.text).map(|found| found[1].to_owned());
    names
        .filter(|name| house.is_match(&hump.replace_all(name, "${1}_$2").to_lowercase()))
        .map(|name| format!("{}: the name {name} has a house word", file.path))
        .collect()
}

/// The folder whose share is counted: a crate, or the tests of one.
fn folder_of(path: &str) -> String {
    let parts: Vec<&str> = path.split('/').collect();
    let depth = match parts.as_slice() {
        ["editor", "src", _, ..] | ["anim", "src", _, ..] => 2,
        ["editor" | "tests" | "benches", _, _, ..] => 2,
        _ => 1,
    };
    parts[..depth].join("/")
}

fn unclear_language(files: &[File]) -> Vec<String> {
    let patterns: Vec<(&str, Regex)> =
        UNCLEAR.iter().map(|(name, pattern)| (*name, Regex::new(pattern).expect("a pattern"))).collect();
    let mut folders: BTreeMap<String, (usize, Vec<String>)> = BTreeMap::new();
    let mut complaints = Vec::new();
    let rust = files.iter().filter(|file| file.is_rust() && !file.path.starts_with("tests/repo/"));
    for file in rust {
        complaints.extend(house_names(file));
        let (total, unclear) = folders.entry(folder_of(&file.path)).or_default();
        for (line, block) in comment_blocks(&file.text) {
            *total += 1;
            if let Some((name, _)) = patterns.iter().find(|(_, pattern)| pattern.is_match(&block)) {
                unclear.push(format!("{}:{line}: {name}: {block}", file.path));
            }
        }
    }
    for (folder, (total, unclear)) in folders {
        if unclear.len() * 100 > total * TOLERATED {
            let share = unclear.len() * 100 / total;
            complaints.push(format!(
                "{folder}: {share} % of {total} comment blocks have to be read twice, at most {TOLERATED} % may:\n    {}",
                unclear.join("\n    ")
            ));
        }
    }
    complaints
}

#[test]
fn comments_and_names_are_plain_english() {
    none(unclear_language(&files()));
    for comment in [
        "/// Is it made now? Then it is made so often less later.",
        "/// Nothing, of so many bones that a skeleton has.",
        "/// What is smaller than this part of the largest number.",
        "// The file says where its buffers are, and is believed.",
        "//! What a person did last, and what is beside it.",
    ] {
        one(unclear_language(&[File::planted("anim/src/poses.rs", comment)]));
    }
    one(unclear_language(&[File::planted("editor/src/app/mod.rs", concat!("fn has", "ten(&mut self) {}"))]));
    one(unclear_language(&[File::planted("editor/src/app/mod.rs", concat!("enum File", "Deed {}"))]));
    none(unclear_language(&[File::planted(
        "anim/src/poses.rs",
        "/// Returns whether the skeleton has no bones.\nfn handle_of() {}",
    )]));
}

/// Returns the types of the workspace that are declared in two or more files without a comment that gives the reason.
fn shared_type_names(files: &[File]) -> Vec<String> {
    let declaration = Regex::new(
        r"(?m)^[ \t]*(?:pub(?:\([^)]*\))? )?(?:(?:unsafe )?(?:struct|enum|trait|union)|type) +([A-Z]\w*)",
    )
    .expect("a pattern");
    let mut types: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    let sources = |path: &str| path.contains("/src/") && !path.starts_with("tests/");
    for file in files.iter().filter(|file| file.is_rust() && sources(&file.path)) {
        for found in declaration.captures_iter(&file.code()) {
            // An associated type has the name that its trait gives it.
            if !found[0].starts_with(' ') || !found[0].contains("type ") {
                types.entry(found[1].to_owned()).or_default().push(&file.path);
            }
        }
    }
    let reason = |name: &str, path: &str| {
        let file = files.iter().find(|file| file.path == path);
        file.is_some_and(|file| file.text.contains(&format!("// Same name as another `{name}`")))
    };
    types
        .into_iter()
        .filter(|(name, paths)| paths.len() > 1 && !paths.iter().any(|path| reason(name, path)))
        .map(|(name, paths)| format!("{name} is {} different types: {}", paths.len(), paths.join(", ")))
        .collect()
}

#[test]
fn no_two_types_share_a_name_without_a_reason() {
    none(shared_type_names(&files()));
    let two = |comment: &str| {
        [
            File::planted("anim/src/fast/level.rs", &format!("{comment}\npub enum Level {{}}")),
            File::planted("editor/src/panels/status.rs", "pub(crate) enum Level {}"),
        ]
    };
    one(shared_type_names(&two("")));
    none(shared_type_names(&two("// Same name as another `Level`: both are the thesis's.")));
}
