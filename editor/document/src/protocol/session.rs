//! A session: a document and its client.

use super::{ProtocolCommand, ProtocolRequest};
use crate::Editable;
use crate::adapter::ModelAdapter;
use crate::history::Edited;
use dragonfly_anim::format::SavePlan;
use serde_json::{Value, json};
use std::path::Path;

/// A document that a client edits.
pub struct Session {
    editable: Editable,
    edited: Edited,
}

impl Session {
    /// Starts with an opened file.
    pub fn new(editable: Editable) -> Self {
        let edited = Edited::new(ModelAdapter::new(&editable.model.animation));
        Self { editable, edited }
    }

    /// Returns the answer to a line, without a line end; `None` for an empty line.
    pub fn answer(&mut self, line: &str) -> Option<String> {
        if line.trim().is_empty() {
            return None;
        }
        let mut id = None;
        let answered = match serde_json::from_str(line) {
            Ok(Value::Object(mut object)) => {
                id = object.remove("id");
                ProtocolRequest::read(object).and_then(|request| self.carry_out(&request))
            }
            Ok(_) => Err("a request must be a JSON object".to_owned()),
            Err(error) => Err(error.to_string()),
        };
        let mut answer = match answered {
            Ok(value) => json!({"ok": value}),
            Err(reason) => json!({"error": reason}),
        };
        if let (Some(id), Some(answer)) = (id, answer.as_object_mut()) {
            answer.insert("id".to_owned(), id);
        }
        Some(answer.to_string())
    }

    fn carry_out(&mut self, request: &ProtocolRequest) -> Result<Value, String> {
        let command = match request {
            ProtocolRequest::Query(query) => return query.answer(&self.edited),
            ProtocolRequest::Command(command) => command,
        };
        let done = match command {
            ProtocolCommand::Edit { edit, gesture } => {
                self.edited.ask(edit.clone(), *gesture).map_err(|error| error.to_string())?;
                true
            }
            ProtocolCommand::Cancel { gesture } => self.edited.cancel(*gesture),
            ProtocolCommand::Undo => self.edited.undo(),
            ProtocolCommand::Redo => self.edited.redo(),
            ProtocolCommand::GoTo { steps } => self.edited.go_to(*steps),
            ProtocolCommand::Plan => return Ok(changes(&self.plan()?)),
            ProtocolCommand::Save { to } => return self.save(to.as_deref()),
        };
        if !done {
            return Err("there is no such step".to_owned());
        }
        debug_assert_eq!(self.edited.adapter().check(), Ok(()));
        let (steps, done) = self.edited.steps();
        Ok(json!({"steps": steps.len(), "done": done}))
    }

    fn plan(&self) -> Result<SavePlan, String> {
        self.editable.plan(self.edited.adapter()).map_err(|error| error.to_string())
    }

    fn save(&mut self, to: Option<&Path>) -> Result<Value, String> {
        let own = self.editable.path.clone();
        let target = to
            .map(Path::to_path_buf)
            .or(own)
            .ok_or("the built-in model has no file; give a path in \"to\"")?;
        let plan = self.plan()?;
        let written = self.editable.save(self.edited.adapter(), &plan, &target)?;
        // A copy leaves the opened file as it was.
        if to.is_none() {
            self.edited.mark_saved();
        }
        let mut answer = json!({"written": written, "changes": changes(&plan)});
        // Pending poses are not lost, but they are not in the file.
        let pending = self.edited.adapter().pending_poses();
        if let (1.., Some(answer)) = (pending, answer.as_object_mut()) {
            answer.insert("pending_not_saved".to_owned(), json!(pending));
        }
        Ok(answer)
    }
}

/// Returns the changes of a save; null where the whole file is written.
fn changes(plan: &SavePlan) -> Value {
    plan.changes.as_ref().and_then(|changes| serde_json::from_str(&changes.json).ok()).unwrap_or(Value::Null)
}
