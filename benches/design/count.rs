//! Reads source text in which the lines of a feature are marked: removes these lines, and counts the cost of the
//! feature.
//!
//! A line that ends in `// feature` belongs to the feature, and so do those between `// feature: begin` and `//
//! feature: end`. A line that ends in `// feature, before: …` replaced the line that the comment contains. The build
//! script uses this file too, so it depends on no other.

/// Name and text of a file.
pub type SourceFile = (&'static str, &'static str);

const BEGIN: &str = "// feature: begin";
const END: &str = "// feature: end";
const ADDED: &str = "// feature";
const CHANGED: &str = "// feature, before: ";

/// Lines for the tests, which are not part of an editor.
const TESTS: [&str; 3] = ["pub mod refused;", "#[cfg(test)]", "mod traps;"];

/// Origin of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LineOrigin<'a> {
    /// The line existed before the feature.
    Base,
    /// The feature added the line.
    Added,
    /// The feature replaced this line.
    Changed(&'a str),
    /// The line only marks the start or end of the feature.
    Mark,
}

fn lines(text: &str) -> impl Iterator<Item = (&str, LineOrigin<'_>)> {
    let mut inside = false;
    text.lines().map(move |line| {
        let trimmed = line.trim();
        let whose = if trimmed == BEGIN || trimmed == END {
            inside = trimmed == BEGIN;
            LineOrigin::Mark
        } else if inside || trimmed.ends_with(ADDED) {
            LineOrigin::Added
        } else if let Some((_, before)) = line.split_once(CHANGED) {
            LineOrigin::Changed(before)
        } else {
            LineOrigin::Base
        };
        (line, whose)
    })
}

/// Returns the text as it was before the feature.
pub fn before(text: &str) -> String {
    let mut before = String::new();
    for (line, whose) in lines(text) {
        match whose {
            LineOrigin::Base => before += line,
            LineOrigin::Changed(line) => before += line,
            LineOrigin::Added | LineOrigin::Mark => continue,
        }
        before.push('\n');
    }
    before
}

/// Cost of a feature in one design, in lines of code: without comments, empty lines and tests.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// Number of lines before the feature.
    pub base: usize,
    /// Number of lines that the feature added.
    pub added: usize,
    /// Number of existing lines that had to change.
    pub changed: usize,
    /// Number of added types and enum variants, each with a name of its own.
    pub types: usize,
    /// Number of added functions.
    pub functions: usize,
    /// Existing functions, types and implementations that had to be edited, except `use`.
    pub places: Vec<String>,
    /// Number of files that had to be edited.
    pub files: usize,
}

/// Counts the marked lines of `sources`.
pub fn cost(sources: &[SourceFile]) -> Cost {
    let mut cost = Cost::default();
    for (file, text) in sources {
        let mut touched = false;
        // The items around the line: indentation, text, and whether they existed before the feature.
        let mut around: Vec<(usize, &str, bool)> = Vec::new();
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap_or(text);
        for (line, whose) in lines(code) {
            let trimmed = line.trim();
            if trimmed.is_empty() || trimmed.starts_with("//") || TESTS.contains(&trimmed) {
                continue;
            }
            let indent = line.len() - line.trim_start().len();
            around.retain(|(outer, ..)| *outer < indent);
            match whose {
                LineOrigin::Base => cost.base += 1,
                LineOrigin::Added => cost.added += 1,
                LineOrigin::Changed(_) => {
                    cost.base += 1;
                    cost.changed += 1;
                }
                LineOrigin::Mark => {}
            }
            if !matches!(whose, LineOrigin::Base) {
                touched = true;
                cost.functions += usize::from(item(trimmed) == Some("fn"));
                let variant = around.last().is_some_and(|(_, around, _)| item(around) == Some("enum"))
                    && trimmed.starts_with(char::is_uppercase);
                let is_type = matches!(item(trimmed), Some("struct" | "enum" | "type" | "trait"));
                cost.types += usize::from(variant || is_type);
                let place = around.iter().rev().find(|(_, _, there)| *there);
                let place = place.map(|(_, head, _)| format!("{file}: {}", head.trim_end_matches(" {")));
                let new_inside = around.last().is_some_and(|(_, _, there)| !there);
                if let Some(place) = place.filter(|_| !new_inside)
                    && !cost.places.contains(&place)
                {
                    cost.places.push(place);
                }
            }
            if item(trimmed).is_some() {
                around.push((indent, trimmed, whose == LineOrigin::Base));
            }
        }
        cost.files += usize::from(touched);
    }
    cost
}

/// Returns the kind of item that starts in a line, if any.
fn item(line: &str) -> Option<&'static str> {
    let line = line.strip_prefix("pub ").unwrap_or(line);
    ["fn", "struct", "enum", "type", "trait", "impl"]
        .into_iter()
        .find(|kind| line.strip_prefix(kind).is_some_and(|rest| rest.starts_with([' ', '<'])))
}

/// Returns the headings of a file of examples that do not compile.
pub fn refused(text: &'static str) -> Vec<&'static str> {
    let headings = text.lines().filter_map(|line| line.strip_prefix("//! # "));
    headings.map(|heading| heading.split_once(". ").map_or(heading, |(_, words)| words)).collect()
}

/// Returns the names of the tests in a file of mistakes that compile, as words.
pub fn traps(text: &str) -> Vec<String> {
    let tests = text.split("#[test]\nfn ").skip(1);
    tests.filter_map(|test| test.split('(').next()).map(|name| name.replace('_', " ")).collect()
}
