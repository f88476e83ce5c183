//! Requests of a client, one per line.

use super::Query;
use crate::edit::Edit;
use crate::history::Gesture;
use crate::{Change, OutdatedEditsChoice};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::path::PathBuf;

/// A command of a client.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum ProtocolCommand {
    /// Apply an edit. Each edit of a gesture replaces the one before.
    Edit {
        /// The edit.
        edit: Edit,
        /// All edits of one gesture are one step.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        gesture: Option<Gesture>,
    },
    /// Cancel a gesture, as if it had never started.
    Cancel {
        /// The gesture.
        gesture: Gesture,
    },
    /// Undo the last step.
    Undo,
    /// Redo the next step.
    Redo,
    /// Undo or redo until exactly this many steps are applied.
    GoTo {
        /// Number of steps.
        steps: usize,
    },
    /// Apply the edits of models that a project keeps and that were made for other files, or remove them, as one step.
    SettleEdits {
        /// Whether they are applied or removed.
        choice: OutdatedEditsChoice,
        /// The models, as scripts name them; all of them if absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        models: Option<Vec<String>>,
    },
    /// Return what a save would change.
    Plan,
    /// Save.
    Save {
        /// The path; the opened file where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<PathBuf>,
    },
}

impl ProtocolCommand {
    /// Returns the command for a change made in the window; `None` where none is needed.
    pub fn of(change: &Change) -> Option<Self> {
        Some(match change {
            Change::Edit(edit, gesture) => Self::Edit { edit: edit.clone(), gesture: *gesture },
            Change::Release(_) => return None,
            Change::Cancel(gesture) => Self::Cancel { gesture: *gesture },
            Change::Undo => Self::Undo,
            Change::Redo => Self::Redo,
            Change::GoTo(steps) => Self::GoTo { steps: *steps },
        })
    }
}

/// Requests of a client.
#[derive(Clone, Debug, PartialEq)]
pub enum ProtocolRequest {
    /// A command.
    Command(ProtocolCommand),
    /// A query.
    Query(Query),
}

impl ProtocolRequest {
    /// Parses the request in a JSON object without its id.
    ///
    /// # Errors
    ///
    /// The reason why it is not a request.
    pub fn read(mut object: Map<String, Value>) -> Result<Self, String> {
        let said = |error: serde_json::Error| error.to_string();
        // An edit alone is short for the command that applies it.
        if object.get("edit").is_some_and(Value::is_string) && !object.contains_key("do") {
            let edit = serde_json::from_value(Value::Object(object)).map_err(said)?;
            return Ok(Self::Command(ProtocolCommand::Edit { edit, gesture: None }));
        }
        if object.contains_key("do") {
            // The edit is parsed separately, so that errors name its fields.
            if let Some(edit) = object.remove("edit") {
                let edit: Edit = serde_json::from_value(edit).map_err(said)?;
                object.insert("edit".to_owned(), serde_json::to_value(edit).map_err(said)?);
            }
            return serde_json::from_value(Value::Object(object)).map(Self::Command).map_err(said);
        }
        if object.contains_key("query") {
            return serde_json::from_value(Value::Object(object)).map(Self::Query).map_err(said);
        }
        Err("one of \"edit\", \"do\", \"query\" is needed".to_owned())
    }
}
