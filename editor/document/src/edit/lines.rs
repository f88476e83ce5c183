//! Edits as text, one JSON object per line.

use super::Edit;
use thiserror::Error;

/// A line that is not an edit.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}: {reason}")]
pub struct LineError {
    /// Line number, from 1.
    pub line: usize,
    /// The reason, with the column.
    pub reason: String,
}

/// Maximum length of a line in bytes: enough for 100,000 keys selected one by one.
pub const LONGEST_LINE: usize = 16 << 20;

/// Returns the edits of a text with their line numbers, from 1. Empty lines are skipped.
///
/// # Errors
///
/// The first line that is not an edit, and the reason.
pub fn parse_lines(text: &str) -> Result<Vec<(usize, Edit)>, LineError> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(at, line)| Ok((at + 1, parse_line(line, at + 1)?))).collect()
}

fn parse_line(text: &str, line: usize) -> Result<Edit, LineError> {
    if text.len() > LONGEST_LINE {
        return Err(LineError { line, reason: format!("it is longer than {LONGEST_LINE} bytes") });
    }
    // The parser sees one line, so only its column is of use.
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
    fn each_line_is_parsed_as_an_edit_and_an_error_names_its_line() {
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
