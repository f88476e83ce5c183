//! Examples of edits: for the help of the command line, and for the tests, which apply each.

/// An edit as JSON, and what it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// One line of JSON.
    pub json: &'static str,
    /// What the edit does, in one sentence.
    pub description: &'static str,
}
