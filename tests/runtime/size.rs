//! A newcomer reads the runtime in an hour: it stays under 1,700 lines of code, comments apart.

use std::fs;
use std::path::Path;

/// Lines of code that the runtime may have.
const LIMIT: usize = 1700;

/// Lines that are neither empty nor a comment.
fn lines_of_code(source: &str) -> usize {
    let lines = source.lines().map(str::trim);
    lines.filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

/// Those of all sources in `folder`, and how many files there are.
fn count(folder: &Path) -> (usize, usize) {
    let (mut lines, mut files) = (0, 0);
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            let (more_lines, more_files) = count(&path);
            (lines, files) = (lines + more_lines, files + more_files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            lines += lines_of_code(&fs::read_to_string(path).unwrap());
            files += 1;
        }
    }
    (lines, files)
}

#[test]
fn the_runtime_can_be_read_in_an_hour() {
    let (lines, files) = count(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(files > 10, "looked in the wrong place");
    println!("the runtime has {lines} lines of code in {files} files");
    assert!(lines <= LIMIT, "{lines} lines of code are too many, {LIMIT} the limit");
}

#[test]
fn comments_and_empty_lines_are_free() {
    assert_eq!(lines_of_code("//! Docs.\n\n/// More.\nfn f() {\n    // Why.\n    g() // Code.\n}\n"), 3);
}
