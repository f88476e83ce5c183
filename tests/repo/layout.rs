//! Layout of the repository: only listed entries in the root folder, every file declared in a module, and no file too
//! long.

use crate::tree::{File, files, none, one, root};
use std::collections::BTreeSet;

/// Folders in the root folder.
const FOLDERS: &[&str] = &["runtime", "anim", "editor", "shaders", "tests", "benches", ".ci"];

/// Files in the root folder.
const FILES: &[&str] = &[
    ".gitignore",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "clippy.toml",
    "run",
    "rustfmt.toml",
    "test",
];

/// Largest number of lines of a source file; longer files are hard to read.
const LONGEST: usize = 600;

fn unlisted_root_entries(files: &[File]) -> Vec<String> {
    let allowed = |path: &str| match path.split_once('/') {
        Some((folder, _)) => FOLDERS.contains(&folder),
        None => FILES.contains(&path),
    };
    let strays: BTreeSet<&str> =
        files.iter().map(|file| file.path.as_str()).filter(|path| !allowed(path)).collect();
    strays.into_iter().map(|path| format!("{path}: does not belong at the top of the project")).collect()
}

#[test]
fn the_root_folder_contains_only_the_listed_entries() {
    none(unlisted_root_entries(&files()));
    one(unlisted_root_entries(&[File::planted("notes.txt", ""), File::planted("anim/src/lib.rs", "")]));
    one(unlisted_root_entries(&[File::planted("scripts/do.sh", "")]));
}

/// Returns the files that may declare `mod name;` for the module in `path`, and that name; `None` for the root of a
/// crate.
fn declaring_files(path: &str) -> Option<(Vec<String>, String)> {
    let (folder, file) = path.rsplit_once('/')?;
    let stem = file.strip_suffix(".rs")?;
    let root = matches!(stem, "lib" | "main" | "build");
    if root {
        return None;
    }
    let (folder, name) = if stem == "mod" { folder.rsplit_once('/')? } else { (folder, stem) };
    let lists = ["mod.rs", "lib.rs", "main.rs"].iter().map(|list| format!("{folder}/{list}"));
    // `panels.rs` next to the folder `panels`.
    let lists = lists.chain([format!("{folder}.rs")]).collect();
    Some((lists, name.to_owned()))
}

fn undeclared_files(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    for file in files.iter().filter(|file| file.is_rust() && !file.path.contains("/bin/")) {
        let Some((lists, name)) = declaring_files(&file.path) else { continue };
        let says = |list: &File| {
            let says = |line: &str| {
                line.trim_end().ends_with(&format!("mod {name};")) || line.contains(&format!("mod {name} {{"))
            };
            lists.contains(&list.path) && list.code().lines().any(says)
        };
        // A manifest or a `path` attribute may contain the path itself.
        let end = file.path.rsplit('/').next().unwrap_or(&file.path);
        let points = |list: &File| {
            let points = |line: &str| line.contains("path = \"") && line.contains(&format!("{end}\""));
            (list.is_rust() || list.path.ends_with("Cargo.toml")) && list.code().lines().any(points)
        };
        if !files.iter().any(|list| says(list) || points(list)) {
            complaints.push(format!("{}: nothing says `mod {name};`, so it is not compiled", file.path));
        }
    }
    complaints
}

#[test]
fn every_module_and_test_file_is_declared() {
    none(undeclared_files(&files()));
    let main = || File::planted("tests/anim/main.rs", "mod poses;\n// mod forgotten;");
    one(undeclared_files(&[
        main(),
        File::planted("tests/anim/poses.rs", ""),
        File::planted("tests/anim/forgotten.rs", ""),
    ]));
    one(undeclared_files(&[
        File::planted("editor/src/lib.rs", "pub mod panels;"),
        File::planted("editor/src/panels/mod.rs", ""),
        File::planted("editor/src/panels/takes.rs", ""),
    ]));
}

fn too_long_files(files: &[File]) -> Vec<String> {
    let long = |file: &&File| file.is_rust() && file.text.lines().count() > LONGEST;
    let complain =
        |file: &File| format!("{}: {} lines, at most {LONGEST}", file.path, file.text.lines().count());
    files.iter().filter(long).map(complain).collect()
}

#[test]
fn no_source_file_exceeds_the_length_limit() {
    none(too_long_files(&files()));
    one(too_long_files(&[File::planted("anim/src/long.rs", &"\n".repeat(LONGEST + 1))]));
}

#[test]
fn the_readme_names_two_commands_and_both_can_be_run() {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("README.md");
    for command in ["run", "test"] {
        assert!(readme.contains(&format!("./{command}")), "README.md does not name ./{command}");
        let metadata = std::fs::metadata(root().join(command)).expect("the command");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            assert!(metadata.permissions().mode() & 0o111 == 0o111, "./{command} cannot be executed");
        }
        assert!(metadata.is_file());
    }
}

fn broken_links(path: &str, text: &str, exists: impl Fn(&str) -> bool) -> Vec<String> {
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    let local = targets.filter(|target| !target.contains("://") && !target.starts_with('#'));
    local
        .map(|target| target.split('#').next().unwrap_or(target))
        .filter(|target| !exists(target))
        .map(|target| format!("{path}: links to {target}, which is not there"))
        .collect()
}

#[test]
fn every_link_in_the_root_documents_has_a_target() {
    for document in ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"] {
        let text = std::fs::read_to_string(root().join(document)).expect(document);
        none(broken_links(document, &text, |target| root().join(target).exists()));
    }
    one(broken_links("README.md", "see [this](nowhere.md) and [that](https://example.org)", |_| false));
}

fn too_long_documents(path: &str, text: &str) -> Vec<String> {
    let (words, lines) = (text.split_whitespace().count(), text.lines().count());
    match path {
        "ARCHITECTURE.md" if words > 1500 => vec![format!("{path}: {words} words; a map has at most 1,500")],
        "CHANGELOG.md" if lines > 40 => vec![format!("{path}: {lines} lines, at most 40 for a version")],
        _ => Vec::new(),
    }
}

#[test]
fn the_map_and_the_change_log_stay_short() {
    for path in ["ARCHITECTURE.md", "CHANGELOG.md"] {
        none(too_long_documents(path, &std::fs::read_to_string(root().join(path)).expect(path)));
    }
    one(too_long_documents("ARCHITECTURE.md", &"word ".repeat(1501)));
    one(too_long_documents("CHANGELOG.md", &"line\n".repeat(41)));
}
