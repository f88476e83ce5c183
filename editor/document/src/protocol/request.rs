//! What a line asks for.

use super::Query;
use crate::Change;
use crate::edit::Edit;
use crate::history::Gesture;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::path::PathBuf;

/// Something that is done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum Deed {
    /// An edit; with a gesture, its newest form.
    Edit {
        /// Which.
        edit: Edit,
        /// All edits of one gesture are one step.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        gesture: Option<Gesture>,
    },
    /// The gesture as if it had never begun.
    Cancel {
        /// Which.
        gesture: Gesture,
    },
    /// The last step undone.
    Undo,
    /// The next step done again.
    Redo,
    /// As many steps done as this.
    GoTo {
        /// From 0.
        steps: usize,
    },
    /// What a save would change.
    Plan,
    /// Saves.
    Save {
        /// Where to; the file that was opened when left out.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        to: Option<PathBuf>,
    },
}

impl Deed {
    /// What a change of the window is in a conversation; nothing where a conversation need not say it.
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

/// What a line asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Something is done.
    Deed(Deed),
    /// Something is read.
    Query(Query),
}

impl Request {
    /// The request in a JSON object without its id.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub fn read(mut object: Map<String, Value>) -> Result<Self, String> {
        let said = |error: serde_json::Error| error.to_string();
        // An edit by itself stands for doing it.
        if object.get("edit").is_some_and(Value::is_string) && !object.contains_key("do") {
            let edit = serde_json::from_value(Value::Object(object)).map_err(said)?;
            return Ok(Self::Deed(Deed::Edit { edit, gesture: None }));
        }
        if object.contains_key("do") {
            // Inside it the edit is read by itself, so that its own mistakes are named.
            if let Some(edit) = object.remove("edit") {
                let edit: Edit = serde_json::from_value(edit).map_err(said)?;
                object.insert("edit".to_owned(), serde_json::to_value(edit).map_err(said)?);
            }
            return serde_json::from_value(Value::Object(object)).map(Self::Deed).map_err(said);
        }
        if object.contains_key("query") {
            return serde_json::from_value(Value::Object(object)).map(Self::Query).map_err(said);
        }
        Err("one of \"edit\", \"do\", \"query\" is needed".to_owned())
    }
}
