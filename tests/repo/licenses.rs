//! Licenses: every dependency may be distributed with the program, under terms as permissive as its own.

use crate::tree::{none, one, root};
use serde_json::Value;
use std::collections::BTreeSet;
use std::process::Command;

/// Licenses that only require their own text to be included.
const PERMISSIVE: &[&str] = &[
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// Packages with other licenses, and the reason why they are accepted.
const EXCEPTIONS: &[(&str, &str, &str)] = &[
    ("epaint_default_fonts", "OFL-1.1", "fonts: may be embedded and given away with any program"),
    ("epaint_default_fonts", "Ubuntu-font-1.0", "fonts: may be embedded and given away with any program"),
    (
        "colored",
        "MPL-2.0",
        "not in the program: used by the schedule checker of the runtime's tests, which is built under its own switch",
    ),
];

/// Returns whether the license expression allows a choice that only needs licenses in `allowed`.
fn permits(expression: &str, allowed: &dyn Fn(&str) -> bool) -> bool {
    let spaced = expression.replace('/', " OR ").replace('(', " ( ").replace(')', " ) ");
    let tokens: Vec<&str> = spaced.split_whitespace().collect();
    let mut position = 0;
    let permitted = any(&tokens, &mut position, allowed);
    permitted && position == tokens.len()
}

/// Parses `A OR B`.
fn any(tokens: &[&str], position: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let mut permitted = all(tokens, position, allowed);
    while tokens.get(*position) == Some(&"OR") {
        *position += 1;
        permitted |= all(tokens, position, allowed);
    }
    permitted
}

/// Parses `A AND B`, which binds tighter.
fn all(tokens: &[&str], position: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let mut permitted = single(tokens, position, allowed);
    while tokens.get(*position) == Some(&"AND") {
        *position += 1;
        permitted &= single(tokens, position, allowed);
    }
    permitted
}

/// Parses a name with its exception, or an expression in parentheses.
fn single(tokens: &[&str], position: &mut usize, allowed: &dyn Fn(&str) -> bool) -> bool {
    let Some(token) = tokens.get(*position) else { return false };
    *position += 1;
    if *token == "(" {
        let permitted = any(tokens, position, allowed);
        *position += 1;
        return permitted;
    }
    if tokens.get(*position) == Some(&"WITH") {
        let name = format!("{token} WITH {}", tokens.get(*position + 1).unwrap_or(&""));
        *position += 2;
        return allowed(&name);
    }
    allowed(token)
}

/// Returns the name and license of every package that is built for this machine.
fn packages() -> Vec<(String, String)> {
    let version = Command::new("rustc").arg("-vV").output().expect("rustc -vV");
    let version = String::from_utf8(version.stdout).expect("text");
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).expect("a host");
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--offline", "--filter-platform", host])
        .current_dir(root())
        .output()
        .expect("cargo metadata");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let nodes = metadata["resolve"]["nodes"].as_array().expect("nodes");
    let built: BTreeSet<&str> = nodes.iter().filter_map(|node| node["id"].as_str()).collect();
    let packages = metadata["packages"].as_array().expect("packages").iter();
    let text = |value: &Value| value.as_str().unwrap_or("").to_owned();
    packages
        .filter(|package| package["id"].as_str().is_some_and(|id| built.contains(id)))
        .map(|package| (text(&package["name"]), text(&package["license"])))
        .collect()
}

fn forbidden_licenses(packages: &[(String, String)]) -> Vec<String> {
    let mut complaints = Vec::new();
    for (name, license) in packages {
        let excepted =
            |term: &str| EXCEPTIONS.iter().any(|(package, other, _)| package == name && *other == term);
        if !permits(license, &|term| PERMISSIVE.contains(&term) || excepted(term)) {
            complaints.push(format!("{name}: license \"{license}\" is neither permissive nor excepted"));
        }
    }
    complaints
}

#[test]
fn every_dependency_has_an_allowed_license() {
    let packages = packages();
    assert!(packages.len() > 100, "only {} packages found", packages.len());
    none(forbidden_licenses(&packages));
    let planted = |license: &str| vec![("planted".to_owned(), license.to_owned())];
    one(forbidden_licenses(&planted("GPL-3.0-only")));
    one(forbidden_licenses(&planted("MIT AND GPL-3.0-only")));
    one(forbidden_licenses(&planted("(MIT OR Apache-2.0) AND MPL-2.0")));
    one(forbidden_licenses(&planted("")));
    none(forbidden_licenses(&planted("GPL-2.0-only OR Apache-2.0")));
    none(forbidden_licenses(&planted("MIT/Apache-2.0")));
}

#[test]
fn no_license_exception_is_unused() {
    let packages = packages();
    for (name, term, _) in EXCEPTIONS.iter().filter(|(name, ..)| *name != "colored") {
        let used = packages.iter().any(|(package, license)| package == name && license.contains(term));
        assert!(used, "{name} ({term}) is excepted but not used");
    }
}
