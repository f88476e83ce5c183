//! Every public item has a doc comment, every file has a module comment, every example fits on a screen.
//!
//! Each rule is also run on text that breaks it, so that a rule that never reports anything is detected. The compiler's
//! `missing_docs` finds the same for items; it is a warning there, and a failure here.

use std::fs;
use std::path::{Path, PathBuf};

fn manifest(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Returns every Rust file below `folder`.
fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Returns the lines of public items without a doc comment. Items of private modules are included, since they may be
/// re-exported.
fn undocumented(text: &str) -> Vec<String> {
    let mut complaints = Vec::new();
    let (mut documented, mut in_attribute) = (false, false);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line == "#[cfg(test)]" {
            break;
        }
        let attribute = in_attribute || line.starts_with("#[");
        in_attribute = attribute && !line.ends_with(']');
        if line.starts_with("///") {
            documented = true;
        } else if !attribute {
            // A module has its doc comment in its own file.
            let item =
                line.starts_with("pub ") && !line.starts_with("pub use ") && !line.starts_with("pub mod ");
            if item && !documented {
                complaints.push(format!("line {}: {line}", number + 1));
            }
            documented = false;
        }
    }
    complaints
}

#[test]
fn every_public_item_is_documented() {
    let files = rust_files(&manifest("src"));
    assert!(files.len() > 40, "{files:?}");
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        assert_eq!(undocumented(&text), [""; 0], "{}", file.display());
    }
    let planted = "/// Documented.\n#[derive(\n  Clone)]\npub struct A {\n    pub b: u32,\n}\npub use a::B;\npub fn c() {}";
    assert_eq!(undocumented(planted), ["line 5: pub b: u32,", "line 8: pub fn c() {}"]);
}

#[test]
fn the_missing_docs_lint_is_enabled() {
    let lints = |path: &str| fs::read_to_string(manifest(path)).unwrap();
    assert!(lints("../Cargo.toml").contains("\nmissing_docs = \"warn\""));
    assert!(lints("Cargo.toml").contains("[lints]\nworkspace = true"));
}

#[test]
fn every_file_has_a_module_comment() {
    for file in rust_files(&manifest("src")).into_iter().chain(rust_files(&manifest("examples"))) {
        let text = fs::read_to_string(&file).unwrap();
        let documented = text.starts_with("//! ") || text.starts_with("#![doc = include_str!(");
        assert!(documented, "{} does not start with //!", file.display());
    }
}

#[test]
fn the_tutorial_has_ten_steps_and_names_its_sections() {
    let text = fs::read_to_string(manifest("src/tutorial/mod.rs")).unwrap();
    let steps: Vec<&str> = text.lines().filter(|line| line.starts_with("//! # Step ")).collect();
    assert_eq!(steps.len(), 10, "{steps:?}");
    for step in text.split("//! # Step ").skip(1) {
        let title = step.lines().next().unwrap_or_default();
        assert!(
            step.contains("§") || title.contains("offsets"),
            "step {title} refers to no section of the thesis"
        );
        assert!(step.contains("//! ```\n"), "step {title} has no code");
    }
}
