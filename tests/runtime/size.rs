//! A newcomer can read how threads and messages work in an hour: that stays under 1,500 lines of code without comments,
//! and each file under 250.

use std::fs;
use std::path::{Path, PathBuf};

/// Largest number of lines of code in the core: the thread, its objects and its messages.
const CORE: usize = 1500;

/// Largest number of lines of code in one file. There is no limit on the whole crate: a reader of the core needs none
/// of the files that only use it, so further ones cost that reader nothing.
const FILE: usize = 250;

/// Files that only use the core: background jobs, the trace, the watchdog, and the scheduler for tests.
const USERS: [&str; 4] = ["job.rs", "trace.rs", "watchdog.rs", "stage.rs"];

/// Returns the number of lines that are neither empty nor a comment.
fn lines_of_code(source: &str) -> usize {
    let lines = source.lines().map(str::trim);
    lines.filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Returns the source files below `folder`, each with its lines of code.
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
fn the_core_of_the_runtime_can_be_read_in_an_hour() {
    let files = count(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(files.len() > 10, "looked in the wrong folder");
    let uses_core = |path: &Path| USERS.iter().any(|user| path.ends_with(user));
    assert_eq!(
        files.iter().filter(|(path, _)| uses_core(path)).count(),
        USERS.len(),
        "a file of USERS is missing"
    );
    let core: usize = files.iter().filter(|(path, _)| !uses_core(path)).map(|(_, lines)| lines).sum();
    println!("the core of the runtime has {core} lines of code in {} files", files.len() - USERS.len());
    assert!(core <= CORE, "the core has {core} lines of code, the limit is {CORE}");
    for (path, lines) in files {
        assert!(lines <= FILE, "{} has {lines} lines of code, the limit is {FILE}", path.display());
    }
}

#[test]
fn comments_and_empty_lines_are_not_counted() {
    assert_eq!(lines_of_code("//! Docs.\n\n/// More.\nfn f() {\n    // Why.\n    g() // Code.\n}\n"), 3);
}
