//! No test passes without running: a test that cannot run calls `dragonfly_kit::skip`, which counts it.

use crate::tree::{File, files, none, one};

/// Files exempt from the rule: the one with the function that skips, and this one, which plants faults.
const EXEMPT: &[&str] = &["tests/kit/src/skip.rs", "tests/repo/skips.rs"];

/// Words in a message that a test does not run.
const WORDS: &[&str] = &["\"skip", "\"not run", ": skipped"];

/// A folder outside the repository, which may be missing on a machine.
const OUTSIDE: &str = "../shared";

/// Returns the code in one line, so that a rule can match across statements.
fn joined(file: &File) -> String {
    file.code().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns whether a message is printed just before an early return, in code of one line.
fn prints_and_returns(code: &str) -> bool {
    let prints = ["println!(", "eprintln!(", "print!("];
    let ends = |rest: &str| {
        let after = rest.split_once("); ").map_or("", |(_, after)| after);
        after.starts_with("return;") || after.starts_with("return None;")
    };
    prints
        .iter()
        .any(|print| code.contains(&format!("return {print}")) || code.split(print).skip(1).any(ends))
}

fn uncounted_skips(files: &[File]) -> Vec<String> {
    let mut complaints = Vec::new();
    let is_test = |file: &&File| {
        file.is_rust() && file.path.starts_with("tests/") && !EXEMPT.contains(&file.path.as_str())
    };
    for file in files.iter().filter(is_test) {
        let code = joined(file);
        let complaint = if prints_and_returns(&code) {
            "prints and returns early"
        } else if WORDS.iter().any(|word| code.contains(word)) {
            "says that a test does not run"
        } else if code.contains(OUTSIDE) {
            "needs a folder outside the repository"
        } else {
            continue;
        };
        complaints.push(format!(
            "{}: {complaint}: call dragonfly_kit::skip, or add the data to tests/data",
            file.path
        ));
    }
    complaints
}

#[test]
fn a_test_skips_itself_only_through_the_function_that_counts_skips() {
    none(uncounted_skips(&files()));
    let planted = |text: &str| uncounted_skips(&[File::planted("tests/anim/rules.rs", text)]);
    one(planted("if !path.is_dir() {\n    println!(\"no folder\");\n    return;\n}"));
    one(planted("let Some(x) = y else {\n    eprintln!(\"no {}\", x);\n    return None;\n};"));
    one(planted("return println!(\"only root may do this\");"));
    one(planted(&format!("eprint!({} this\");", WORDS[0])));
    one(planted(&format!("let folder = root.join(\"{OUTSIDE}/assets\");")));
    none(planted("println!(\"{count} files\");\nassert!(count > 3);\nreturn;"));
}
