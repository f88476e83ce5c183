//! A session: a document and its client.

use super::scene_answers::SceneAnswers;
use super::{ProtocolCommand, ProtocolRequest};
use crate::open::Open;
use crate::project_edits::settled;
use crate::save_job::{FailedWrite, SaveTarget, prepare};
use crate::writing::Overwrite;
use crate::{Cancel, Change, Editable, FaultInjection, OpenedModel, OutdatedEdits, OutdatedEditsChoice};
use dragonfly_anim::format::{ChangeReport, SavePlan};
use dragonfly_store::Autosave;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

/// A document that a client edits.
pub struct Session {
    open: Open,
    autosave: Option<Autosave>,
    scene: SceneAnswers,
}

impl Session {
    /// Starts with an opened file. Nothing is recorded.
    pub fn new(editable: Editable) -> Self {
        Self::recorded(editable, None)
    }

    /// Starts with an opened file. Every edit is recorded in a journal in `autosave` before it is answered, if the model is a file.
    pub fn recorded(editable: Editable, autosave: Option<Autosave>) -> Self {
        let (loaded, texts) = (editable.loaded(), editable.texts());
        let autosave = autosave.filter(|_| loaded.path.is_some());
        let mut open = Open::new(OpenedModel { loaded, editable: Ok(editable), texts }, autosave.clone());
        if autosave.is_some() {
            // Sessions that only read leave no journal.
            open.journal_writer.begin_later(open.file.path.clone(), open.stamp());
        }
        let scene = SceneAnswers::of(open.file.path.as_deref());
        Self { open, autosave, scene }
    }

    /// Flushes what was recorded to the disk. To be called when no request waits.
    pub fn keep(&mut self) {
        self.open.keep(Instant::now());
    }

    /// Returns the warnings about the journal since the last call, one sentence each.
    pub fn trouble(&mut self) -> Vec<String> {
        self.open.journal_writer.trouble()
    }

    /// Ends the session. Unsaved edits stay in the journal; a journal without unsaved edits is discarded.
    ///
    /// # Errors
    ///
    /// The reason why the journal could not be closed.
    pub fn end(mut self) -> Result<(), String> {
        self.open.unwanted = false;
        if self.open.edited.is_saved()
            && let Some(autosave) = &self.autosave
            && let Some(journal) = self.open.journal_writer.take()
        {
            let done =
                if journal.is_empty() { journal.close() } else { autosave.discard_own(journal).map(drop) };
            return done.map_err(|error| error.to_string());
        }
        self.open.close(self.autosave.as_ref())
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
            ProtocolRequest::Query(query) => return query.answer(&self.open.edited, &mut self.scene),
            ProtocolRequest::Command(command) => command,
        };
        let change = match command {
            ProtocolCommand::Edit { edit, gesture } => Change::Edit(edit.clone(), *gesture),
            ProtocolCommand::Cancel { gesture } => Change::Cancel(*gesture),
            ProtocolCommand::Undo => Change::Undo,
            ProtocolCommand::Redo => Change::Redo,
            ProtocolCommand::GoTo { steps } => Change::GoTo(*steps),
            ProtocolCommand::SettleEdits { choice, models } => {
                return self.settle_edits(*choice, models.as_deref());
            }
            ProtocolCommand::Plan => return Ok(changes(self.plan()?.changes.as_ref())),
            ProtocolCommand::Save { to } => return self.save(to.as_deref()),
        };
        // When this returns, the journal has the change.
        let done = self.open.change(change, Instant::now()).map_err(|error| error.to_string())?;
        if !done {
            return Err("there is no such step".to_owned());
        }
        let (steps, done) = self.open.edited.steps();
        Ok(json!({"steps": steps.len(), "done": done}))
    }

    /// Carries out a decision about edits of models that were made for other files.
    fn settle_edits(
        &mut self,
        choice: OutdatedEditsChoice,
        models: Option<&[String]>,
    ) -> Result<Value, String> {
        let outdated = self.scene.outdated(self.open.edited.adapter().texts())?;
        let is_wanted = |edits: &OutdatedEdits| models.is_none_or(|models| models.contains(&edits.model));
        let unknown = |name: &&String| !outdated.iter().any(|edits| edits.model == **name);
        if let Some(name) = models.unwrap_or_default().iter().find(unknown) {
            return Err(format!("{name} has no edits that were made for another file"));
        }
        let wanted: Vec<OutdatedEdits> = outdated.iter().filter(|edits| is_wanted(edits)).cloned().collect();
        if let Some(edit) = settled(self.open.edited.adapter().texts(), &wanted, choice)? {
            let change = Change::Edit(edit.into(), None);
            self.open.change(change, Instant::now()).map_err(|error| error.to_string())?;
        }
        let unfit = self.scene.unfit(self.open.edited.adapter().texts())?;
        let models: Vec<&str> = wanted.iter().map(|edits| &*edits.model).collect();
        let (steps, done) = self.open.edited.steps();
        Ok(json!({"models": models, "unfit": unfit, "steps": steps.len(), "done": done}))
    }

    fn plan(&self) -> Result<SavePlan, String> {
        let editable = self.open.editable.as_ref().map_err(Clone::clone)?;
        editable.plan(self.open.edited.adapter()).map_err(|error| error.to_string())
    }

    fn save(&mut self, to: Option<&Path>) -> Result<Value, String> {
        let own = self.open.file.path.clone();
        let target = to
            .map(Path::to_path_buf)
            .or(own)
            .ok_or("the built-in model has no file; give a path in \"to\"")?;
        // A copy leaves the opened file as it was.
        let own = self.open.editable.as_ref().is_ok_and(|editable| editable.is_own(&target));
        let (role, overwrite) = match own {
            true => (SaveTarget::Own, Overwrite::AsRead),
            false => (SaveTarget::Copy, Overwrite::Anything),
        };
        let now = Instant::now();
        let input = self.open.begin_saving(target, role, overwrite, None, FaultInjection::default(), now)?;
        let cancel = Cancel::default();
        let mut prepared = match prepare(input, &cancel, &|_| {}) {
            Ok(prepared) => prepared,
            Err(reason) => {
                self.open.save_failed(None, None);
                return Err(reason);
            }
        };
        self.open.record_saving(&mut prepared, now);
        let (changes, lost) = (changes(prepared.changes()), prepared.lost().to_vec());
        let written = match prepared.write(&cancel, &|_| {}) {
            Ok(written) => written,
            Err(FailedWrite { reason, partly, copies }) => {
                self.open.save_failed(partly, Some(copies));
                return Err(reason.to_string());
            }
        };
        let (files, notices) = (written.saved.files.clone(), written.saved.notices.clone());
        self.open.end_save(written, None, now);
        let mut answer = json!({"written": files, "changes": changes});
        if !notices.is_empty() {
            answer["notices"] = json!(notices);
        }
        if !lost.is_empty() {
            answer["lost"] = json!(lost);
        }
        // Pending poses are not lost, but they are not in the file.
        let pending = self.open.edited.adapter().pending_poses();
        if pending > 0 {
            answer["pending_not_saved"] = json!(pending);
        }
        Ok(answer)
    }
}

/// Returns the changes of a save; null where the whole file is written.
fn changes(changes: Option<&ChangeReport>) -> Value {
    changes.and_then(|changes| serde_json::from_str(&changes.json).ok()).unwrap_or(Value::Null)
}
