//! Edits of a model that its project keeps, made for another file than the one that is there now.

use serde::{Deserialize, Serialize};

/// Edits of a model that its project keeps, and that were made for another file than the one that is there now. They may be in it already,
/// so that they are not applied until the user decides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutdatedEdits {
    /// The name by which the script means the model.
    pub model: String,
    /// Name of its file.
    pub title: String,
    /// Hash of the file as it is now.
    pub hash: u64,
}

/// The decision of the user about edits that were made for another file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum OutdatedEditsChoice {
    /// They are applied to the file as it is now.
    Apply,
    /// The project does not keep them any more.
    Remove,
}
