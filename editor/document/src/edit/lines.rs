//! Edits in a text, one JSON object a line.

use super::Edit;
use thiserror::Error;

/// A line that is no edit.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}: {reason}")]
pub struct LineError {
    /// From 1.
    pub line: usize,
    /// What is wrong with it, with its column.
    pub reason: String,
}

/// Longest line that is read, in bytes: 100,000 keys chosen one by one fit in.
pub const LONGEST_LINE: usize = 16 << 20;

/// The edits of a text with the numbers of their lines, from 1; empty lines are passed over.
///
/// # Errors
///
/// The first line that is no edit, and why.
pub fn parse_lines(text: &str) -> Result<Vec<(usize, Edit)>, LineError> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(at, line)| Ok((at + 1, parse_line(line, at + 1)?))).collect()
}

fn parse_line(text: &str, line: usize) -> Result<Edit, LineError> {
    if text.len() > LONGEST_LINE {
        return Err(LineError { line, reason: format!("it is longer than {LONGEST_LINE} bytes") });
    }
    // The reader counts lines of its own; only its column is of use.
    serde_json::from_str(text).map_err(|error| {
        let reason = error.to_string();
        let bare = reason.split(" at line ").next().unwrap_or(&reason);
        let place = if error.column() > 0 { format!("column {}: ", error.column()) } else { String::new() };
        LineError { line, reason: format!("{place}{bare}") }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_edits_and_a_wrong_one_says_where_it_is() {
        let good = "{\"edit\":\"delete_take\",\"take\":1}\n\n{\"edit\":\"reverse_take\",\"take\":\"a\"}\n";
        let lines: Vec<usize> = parse_lines(good).unwrap().into_iter().map(|(line, _)| line).collect();
        assert_eq!(lines, [1, 3]);
        for (text, wanted) in [
            ("{\"edit\":\"fly\"}", "line 1: "),
            ("\n{\"edit\":\"delete_take\"}", "line 2: "),
            ("{\"edit\":\"delete_take\",\"take\":1,\"takes\":2}", "unknown field `takes`"),
            ("{\"edit\":\"delete_take\",", "column 22"),
            ("[]", "line 1: "),
        ] {
            let error = parse_lines(text).unwrap_err().to_string();
            assert!(error.contains(wanted), "{text}: {error}");
        }
    }
}
