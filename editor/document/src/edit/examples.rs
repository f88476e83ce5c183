//! Examples of edits: for the help of the command line, and for the tests, which apply each.

/// An edit as JSON, with a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// One line of JSON.
    pub json: &'static str,
    /// The effect of the edit, in one sentence.
    pub description: &'static str,
}
