//! The files of the project, as input for the rules.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A file and its content.
pub(crate) struct File {
    /// Path from the root of the project, with `/`.
    pub(crate) path: String,
    /// The text; empty for a file that is not text.
    pub(crate) text: String,
}

impl File {
    /// Returns a file that exists only in the test of a rule.
    pub(crate) fn planted(path: &str, text: &str) -> Self {
        Self { path: path.to_owned(), text: text.to_owned() }
    }

    /// Returns whether it is a Rust file.
    pub(crate) fn is_rust(&self) -> bool {
        self.path.ends_with(".rs")
    }

    /// Returns the text without comments and doc comments; exact enough for searching words.
    pub(crate) fn code(&self) -> String {
        let without_comment = |line: &str| match line.find("//") {
            // A URL in a string is not a comment.
            Some(start) if !line[..start].ends_with(':') => line[..start].to_owned(),
            _ => line.to_owned(),
        };
        self.text.lines().map(without_comment).collect::<Vec<_>>().join("\n")
    }
}

/// Returns the root folder of the project.
pub(crate) fn root() -> PathBuf {
    let kit = Path::new(env!("CARGO_MANIFEST_DIR"));
    kit.ancestors().nth(2).expect("the manifest is in tests/kit").to_path_buf()
}

/// Returns every file that is or will be part of the project: the files in git, and new files that git does not
/// ignore.
pub(crate) fn files() -> Vec<File> {
    let root = root();
    let mut paths = listed_by_git(&root).unwrap_or_else(|| walked(&root));
    paths.sort();
    assert!(paths.len() > 50, "the files of the project were not found below {}", root.display());
    let read = |path: String| {
        let text = fs::read(root.join(&path)).ok().and_then(|bytes| String::from_utf8(bytes).ok());
        File { text: text.unwrap_or_default(), path }
    };
    paths.into_iter().map(read).collect()
}

fn listed_by_git(root: &Path) -> Option<Vec<String>> {
    let arguments = ["ls-files", "--cached", "--others", "--exclude-standard", "-z"];
    let output = Command::new("git").args(arguments).current_dir(root).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    // A file deleted but not yet committed is still listed.
    let listed = text.split('\0').filter(|path| !path.is_empty() && root.join(path).exists());
    let paths: Vec<String> = listed.map(str::to_owned).collect();
    (output.status.success() && !paths.is_empty()).then_some(paths)
}

/// Lists the files of a copy of the project without its history.
fn walked(root: &Path) -> Vec<String> {
    let mut paths = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the project").flatten() {
            let path = entry.path();
            let name = entry.file_name();
            if path.is_dir() && name != "target" && name != ".git" {
                folders.push(path);
            } else if path.is_file()
                && let Ok(inside) = path.strip_prefix(root)
            {
                paths.push(inside.to_string_lossy().replace('\\', "/"));
            }
        }
    }
    paths
}

/// Fails with all complaints of a rule.
#[track_caller]
pub(crate) fn none(complaints: Vec<String>) {
    assert!(complaints.is_empty(), "\n  {}\n", complaints.join("\n  "));
}

/// Asserts that a planted fault is reported exactly once.
#[track_caller]
pub(crate) fn one(complaints: Vec<String>) {
    assert_eq!(complaints.len(), 1, "{complaints:?}");
}
