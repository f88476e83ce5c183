//! No large circle of files: files that use each other in a loop can only be understood and changed together.

use crate::imports::{Arrows, arrows};
use crate::tree::{File, files, none, one};
use std::collections::{BTreeMap, BTreeSet};

/// Largest number of files that may use each other in a loop.
const LARGEST: usize = 3;

/// A crate and the largest circle that it may have; a larger one than [`LARGEST`] needs a reason.
const CRATES: &[(&str, usize)] = &[
    // A context can reach every object of its thread, and every object receives the context.
    ("runtime", 9),
    ("anim", LARGEST),
    ("editor/store", LARGEST),
    ("editor/movie", LARGEST),
    ("editor/fbx", LARGEST),
    ("editor/document", LARGEST),
    ("editor/picture", LARGEST),
    ("editor", LARGEST),
];

/// Returns the files that a file uses directly or through other files.
fn reached<'a>(arrows: &'a Arrows, start: &'a str) -> BTreeSet<&'a str> {
    let mut found = BTreeSet::new();
    let mut open = vec![start];
    while let Some(file) = open.pop() {
        for next in arrows.get(file).into_iter().flat_map(BTreeMap::keys) {
            if found.insert(next.as_str()) {
                open.push(next);
            }
        }
    }
    found
}

/// Returns the sets of files in which each file uses every other one, directly or through other files.
fn circles(arrows: &Arrows) -> Vec<BTreeSet<&str>> {
    let leads: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|file| (file.as_str(), reached(arrows, file))).collect();
    let circle = |file: &str| -> BTreeSet<&str> {
        let back = |next: &&&str| leads.get(**next).is_some_and(|further| further.contains(file));
        leads[file].iter().filter(back).copied().collect()
    };
    let distinct: BTreeSet<BTreeSet<&str>> = leads.keys().map(|file| circle(file)).collect();
    distinct.into_iter().filter(|circle| circle.len() > 1).collect()
}

/// Describes a circle by its arrows, each with the names that make it.
fn described(arrows: &Arrows, circle: &BTreeSet<&str>) -> String {
    let mut lines = Vec::new();
    for (file, targets) in arrows.iter().filter(|(file, _)| circle.contains(file.as_str())) {
        for (target, names) in targets.iter().filter(|(target, _)| circle.contains(target.as_str())) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            lines.push(format!("    {file} -> {target}: {}", names.join(", ")));
        }
    }
    lines.join("\n")
}

fn large_circles(files: &[File], crates: &[(&str, usize)]) -> Vec<String> {
    let mut complaints = Vec::new();
    for (folder, largest) in crates {
        let arrows = arrows(files, folder);
        for circle in circles(&arrows).iter().filter(|circle| circle.len() > *largest) {
            let arrows = described(&arrows, circle);
            complaints.push(format!(
                "{folder}: {} files use each other in a loop (at most {largest}):\n{arrows}",
                circle.len()
            ));
        }
    }
    complaints
}

#[test]
fn no_large_group_of_files_is_connected_in_a_loop() {
    let files = files();
    for (folder, _) in CRATES {
        let arrows = arrows(&files, folder);
        assert!(arrows.len() > 5, "the imports of {folder} were not understood: {arrows:?}");
    }
    none(large_circles(&files, CRATES));
}

/// Returns the files of a made-up crate.
fn planted(files: &[(&str, &str)]) -> Vec<File> {
    files.iter().map(|(path, text)| File::planted(&format!("made/up/src/{path}.rs"), text)).collect()
}

fn complaints(files: &[(&str, &str)]) -> Vec<String> {
    large_circles(&planted(files), &[("made/up", LARGEST)])
}

#[test]
fn a_planted_loop_of_four_files_is_found_in_every_spelling() {
    let found = complaints(&[
        ("lib", "mod a; mod b; mod c; mod d; pub use self::a::A; pub use d::D as Last;"),
        // A list in braces, and a name that the root exports.
        ("a", "use super::{b::{B as Other, self}, Last}; pub struct A;"),
        // A path without `use`.
        ("b", "pub struct B(crate::c::inner::C);"),
        // A glob, and a name only in the code.
        ("c", "pub mod inner { use super::super::d::*; pub struct C { d: D } }"),
        ("d", "use crate::A; pub struct D { a: Box<A> }"),
    ]);
    one(found.clone());
    assert!(found[0].contains("4 files"), "{found:?}");
    assert!(found[0].contains("made/up/src/d.rs -> made/up/src/a.rs: A, crate::A"), "{found:?}");
}

#[test]
fn loops_of_three_files_and_chains_are_allowed() {
    let root = ("lib", "mod a; mod b; mod c; mod d;");
    let [a, b] = [("a", "use crate::b::B; pub struct A;"), ("b", "use crate::c::C; pub struct B;")];
    none(complaints(&[root, a, b, ("c", "use crate::a::A; pub struct C;")]));
    let c = ("c", "use crate::d::D; pub struct C;");
    none(complaints(&[root, a, b, c, ("d", "pub struct D;")]));
    one(complaints(&[root, a, b, c, ("d", "use crate::a::A; pub struct D;")]));
}

#[test]
fn re_exports_of_a_parent_and_test_code_are_no_loop() {
    let children = [
        ("part/a", "use super::B; pub struct A;"),
        ("part/b", "use super::C; pub struct B;"),
        ("part/c", "use super::D; pub struct C;"),
    ];
    let parent =
        ("part/mod", "mod a; mod b; mod c; mod d; pub use a::A; pub use {b::B, c::C}; pub(crate) use d::D;");
    let [a, b, c] = children;
    none(complaints(&[("lib", "mod part;"), parent, a, b, c, ("part/d", "pub struct D;")]));
    // The last file closes the loop only in its test.
    let tests = "pub struct D; #[cfg(test)] mod tests { use crate::part::A; use super::*; }";
    none(complaints(&[("lib", "mod part;"), parent, a, b, c, ("part/d", tests)]));
    let closed = "use crate::part::A; pub struct D;";
    one(complaints(&[("lib", "mod part;"), parent, a, b, c, ("part/d", closed)]));
}

#[test]
fn a_parent_that_uses_what_it_lists_is_part_of_the_loop() {
    let child = "use super::Row; pub const ROW: Row = Row;";
    let parent = "mod a; mod b; mod c; pub struct Row; pub const ALL: [Row; 3] = [a::ROW, b::ROW, c::ROW];";
    one(complaints(&[("list/mod", parent), ("list/a", child), ("list/b", child), ("list/c", child)]));
}

#[test]
fn a_name_that_a_macro_defines_belongs_to_the_file_of_the_macro() {
    let list = "macro_rules! kinds { ($($K:ident => $m:ident::$T:ident,)*) => { pub enum Kind { $($K($m::$T),)* } } } \
                kinds! { A => a::Kind1, }";
    let loop_of_four = [
        ("lib", "mod list; mod ask; mod prompts;"),
        ("list/mod", list),
        ("list/a", "use crate::ask::Ask; pub struct Kind1;"),
        ("ask", "use crate::prompts::Prompts; pub struct Ask;"),
        ("prompts", "use crate::list::Kind; pub struct Prompts;"),
    ];
    one(complaints(&loop_of_four));
}
