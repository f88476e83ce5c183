//! One conversation: a document, and who talks to it.

use super::{Deed, Request};
use crate::Editable;
use crate::adapter::ModelAdapter;
use crate::history::Edited;
use dragonfly_anim::format::SavePlan;
use serde_json::{Value, json};
use std::path::Path;

/// A document that is talked to.
pub struct Session {
    editable: Editable,
    edited: Edited,
}

impl Session {
    /// Begins with what was opened.
    pub fn new(editable: Editable) -> Self {
        let edited = Edited::new(ModelAdapter::new(&editable.model.animation));
        Self { editable, edited }
    }

    /// The answer to a line, without its end; nothing to an empty one.
    pub fn answer(&mut self, line: &str) -> Option<String> {
        if line.trim().is_empty() {
            return None;
        }
        let mut id = None;
        let answered = match serde_json::from_str(line) {
            Ok(Value::Object(mut object)) => {
                id = object.remove("id");
                Request::read(object).and_then(|request| self.carry_out(&request))
            }
            Ok(_) => Err("a request is an object".to_owned()),
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

    fn carry_out(&mut self, request: &Request) -> Result<Value, String> {
        let deed = match request {
            Request::Query(query) => return query.answer(&self.edited),
            Request::Deed(deed) => deed,
        };
        let done = match deed {
            Deed::Edit { edit, gesture } => {
                self.edited.ask(edit.clone(), *gesture).map_err(|error| error.to_string())?;
                true
            }
            Deed::Cancel { gesture } => self.edited.cancel(*gesture),
            Deed::Undo => self.edited.undo(),
            Deed::Redo => self.edited.redo(),
            Deed::GoTo { steps } => self.edited.go_to(*steps),
            Deed::Plan => return Ok(changes(&self.plan()?)),
            Deed::Save { to } => return self.save(to.as_deref()),
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
        let target =
            to.map(Path::to_path_buf).or(own).ok_or("the built-in model has no file; say where \"to\"")?;
        let plan = self.plan()?;
        let written = self.editable.save(self.edited.adapter(), &plan, &target)?;
        // A copy elsewhere leaves the file that is open as it was.
        if to.is_none() {
            self.edited.mark_saved();
        }
        let mut said = json!({"written": written, "changes": changes(&plan)});
        // What is pending is not lost, but it is not in the file either.
        let pending = self.edited.adapter().pending_poses();
        if let (1.., Some(said)) = (pending, said.as_object_mut()) {
            said.insert("pending_not_saved".to_owned(), json!(pending));
        }
        Ok(said)
    }
}

/// What a save changes; null where the whole file is written.
fn changes(plan: &SavePlan) -> Value {
    plan.changes.as_ref().and_then(|changes| serde_json::from_str(&changes.json).ok()).unwrap_or(Value::Null)
}
