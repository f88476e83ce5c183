//! Lines and indentation of a script.

use crate::stage::script::ScriptTree;

/// Indentation of a level where the script shows none.
const UNIT: &str = "  ";

/// Returns the first byte of the line of `at`.
pub(super) fn line_start(text: &str, at: usize) -> usize {
    text.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1)
}

/// Returns the blanks in front of `at` where nothing else is in front of it in its line.
pub(super) fn indentation(text: &str, at: usize) -> Option<&str> {
    let before = text.get(line_start(text, at)..at)?;
    before.bytes().all(|byte| matches!(byte, b' ' | b'\t')).then_some(before)
}

/// Returns the end of line that the script uses.
pub(super) fn line_end(text: &str) -> &'static str {
    match text.find('\n') {
        Some(at) if text.as_bytes().get(at.wrapping_sub(1)) == Some(&b'\r') => "\r\n",
        Some(_) | None => "\n",
    }
}

/// Returns the byte of the end of line after `at`, or of the end of the text, where only blanks are in between; with
/// `over_comments`, also comments.
pub(super) fn rest_of_line(text: &str, at: usize, over_comments: bool) -> Option<usize> {
    let mut at = at;
    loop {
        let rest = text.get(at..)?;
        let blanks = rest.len() - rest.trim_start_matches([' ', '\t']).len();
        let rest = &rest[blanks..];
        at += blanks;
        if rest.is_empty() || rest.starts_with('\n') || rest.starts_with("\r\n") {
            return Some(at);
        }
        let comment = rest.strip_prefix("<!--").filter(|_| over_comments)?;
        let length = comment.find("-->")?;
        if comment[..length].contains('\n') {
            return None;
        }
        at += "<!---->".len() + length;
    }
}

/// Returns the byte after the end of line at `at`.
pub(super) fn after_line_end(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + if rest.starts_with("\r\n") { 2 } else { usize::from(rest.starts_with('\n')) }
}

/// Returns the first byte of the comments directly above the line that begins at `start`: without an empty line in
/// between, and with nothing else in their lines.
pub(super) fn comments_above(text: &str, start: usize) -> usize {
    let mut first = start;
    while let Some(above) = text.get(..first).filter(|above| above.ends_with('\n')) {
        let line = above.trim_end_matches(['\n', '\r']);
        // An empty line separates.
        let is_near = above[line.len()..].matches('\n').count() == 1;
        let line = line.trim_end_matches([' ', '\t']);
        let Some(open) = line.rfind("<!--").filter(|_| is_near && line.ends_with("-->")) else { break };
        // The comment that ends there must be the one that begins there.
        let is_one = line.get(open + 4..).is_some_and(|rest| rest.find("-->") == rest.len().checked_sub(3));
        let begin = line_start(text, open);
        if !is_one || indentation(text, open).is_none() || begin >= first {
            break;
        }
        first = begin;
    }
    first
}

/// Returns the indentation of one level: that of the first element that is indented more than its parent.
pub(super) fn unit(tree: &ScriptTree) -> &str {
    let text = tree.text();
    let of = |element: usize| indentation(text, tree.own(element)?.range.start);
    let steps = tree.elements().iter().enumerate().filter_map(|(index, element)| {
        let step = of(index)?.strip_prefix(of(element.parent?)?)?;
        (!step.is_empty()).then_some(step)
    });
    let mut steps = steps;
    steps.next().unwrap_or(UNIT)
}

/// Returns the lines of `block` with `new` in place of the indentation `old`.
pub(super) fn indented(block: &str, old: &str, new: &str) -> String {
    let mut text = String::with_capacity(block.len());
    for (number, line) in block.split_inclusive('\n').enumerate() {
        match line.strip_prefix(old).filter(|_| number > 0) {
            Some(rest) => {
                text += new;
                text += rest;
            }
            None => text += line,
        }
    }
    text
}
