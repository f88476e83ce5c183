//! A newcomer reads how threads and messages work in an hour: that stays under 1,500 lines of code, comments
//! apart, and all of the crate under 1,700.

use std::fs;
use std::path::{Path, PathBuf};

/// Lines of code of the thread, its objects and its messages.
const CORE: usize = 1500;

/// Lines of code with what looks on: it uses the core, and nothing of the core has to be known from it.
const ALL: usize = 1700;

/// What looks on: who sent what to whom, who does not come back, and threads on a test's strings.
const AIDS: [&str; 3] = ["trace.rs", "watchdog.rs", "stage.rs"];

/// Lines that are neither empty nor a comment.
fn lines_of_code(source: &str) -> usize {
    let lines = source.lines().map(str::trim);
    lines.filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// The sources in `folder` and below it, with their lines of code.
fn count(folder: &Path) -> Vec<(PathBuf, usize)> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(count(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let lines = lines_of_code(&fs::read_to_string(&path).unwrap());
            files.push((path, lines));
        }
    }
    files
}

#[test]
fn the_runtime_can_be_read_in_an_hour() {
    let files = count(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(files.len() > 10, "looked in the wrong place");
    let is_aid = |path: &Path| AIDS.iter().any(|aid| path.ends_with(aid));
    assert_eq!(files.iter().filter(|(path, _)| is_aid(path)).count(), AIDS.len(), "an aid is not there");
    let all: usize = files.iter().map(|(_, lines)| lines).sum();
    let core: usize = files.iter().filter(|(path, _)| !is_aid(path)).map(|(_, lines)| lines).sum();
    println!("the runtime has {all} lines of code in {} files, {core} of them the core", files.len());
    assert!(core <= CORE, "{core} lines of code are too many, {CORE} the limit of the core");
    assert!(all <= ALL, "{all} lines of code are too many, {ALL} the limit");
}

#[test]
fn comments_and_empty_lines_are_free() {
    assert_eq!(lines_of_code("//! Docs.\n\n/// More.\nfn f() {\n    // Why.\n    g() // Code.\n}\n"), 3);
}
