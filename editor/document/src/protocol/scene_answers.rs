//! Answers about the scene of a script: its texts, what is wrong with it, when its actions begin and end.

use crate::Cancel;
use crate::OutdatedEdits;
use crate::adapter::{ModelAdapter, TextFile, TextFiles};
use crate::edit::TextRef;
use crate::project_notes::ProjectNotes;
use crate::scene_check::{CheckedScript, CheckedText, SceneCheck};
use crate::text_source::first_script;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::ScriptError;
use serde_json::{Value, json};
use std::path::Path;

/// The script or project of a session, with its models, which are read when an answer needs them.
pub(super) struct SceneAnswers(SceneCheck);

impl SceneAnswers {
    /// Answers about the script or project at `path`.
    pub(super) fn of(path: Option<&Path>) -> Self {
        Self(SceneCheck::of(path))
    }

    /// Returns names and sizes of the texts.
    pub(super) fn texts(texts: &TextFiles) -> Value {
        let row = |file: &TextFile| json!({"name": &*file.name, "bytes": file.text.len()});
        texts.list().iter().map(row).collect()
    }

    /// Returns a text.
    ///
    /// # Errors
    ///
    /// The document has no such text.
    pub(super) fn text(adapter: &ModelAdapter, text: Option<&TextRef>) -> Result<Value, String> {
        let texts = adapter.texts();
        let file = &texts.list()[texts.find(text).map_err(|error| error.to_string())?];
        Ok(json!({"name": &*file.name, "text": &*file.text}))
    }

    /// Returns what is wrong with all texts, and what is probably not meant. What is wrong with the first script, or with the project where it
    /// cannot be read, is at the top of the answer, too.
    ///
    /// # Errors
    ///
    /// The document is no script.
    pub(super) fn errors(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let checked = self.0.all(texts, &Cancel::default()).map_err(|error| error.to_string())?;
        let project = self.0.project(texts).ok().flatten();
        // The project is at the top where no script can be read.
        let first = first_script(project.as_ref(), texts).map(|file| &file.name);
        let row = |error: &ScriptError| {
            let mut row = json!({"line": error.place.line, "column": error.place.column, "from": error.range.start,
                                 "to": error.range.end, "message": error.message, "help": error.help});
            if let (Some(inside), Some(object)) = (&error.inside, row.as_object_mut()) {
                let inside = json!({"file": &*inside.file, "line": inside.place.line, "column": inside.place.column,
                                    "from": inside.range.start, "to": inside.range.end});
                object.insert("inside".to_owned(), inside);
            }
            row
        };
        let rows = |list: &[ScriptError]| list.iter().map(row).collect::<Vec<_>>();
        let of = |text: &CheckedText| json!({"text": &*text.name, "errors": rows(&text.errors), "notes": rows(&text.notes)});
        let main = checked.iter().find(|text| first == Some(&text.name)).or(checked.first());
        let mut answer = of(main.ok_or("the document has no text")?);
        let Some(object) = answer.as_object_mut() else { return Ok(answer) };
        if self.0.is_project() {
            object.insert("texts".to_owned(), checked.iter().map(of).collect());
        }
        let lines = project.as_ref().and_then(StageProject::lines);
        let is_lines = |text: &&CheckedText| lines == Some(&*text.name);
        if let Some(lines) = checked.iter().find(is_lines) {
            object.insert("lines".to_owned(), json!({"text": &*lines.name, "errors": rows(&lines.errors)}));
        }
        let unfit: Vec<&str> =
            checked.iter().flat_map(|text| &text.unfit).map(|note| note.message.as_str()).collect();
        if !unfit.is_empty() {
            object.insert("edits".to_owned(), json!(unfit));
        }
        Ok(answer)
    }

    /// Returns the edits of models that the project keeps and that were made for other files.
    ///
    /// # Errors
    ///
    /// The document is no project, or its text has errors.
    pub(super) fn outdated(&mut self, texts: &TextFiles) -> Result<Vec<OutdatedEdits>, String> {
        Ok(self.notes(texts)?.outdated)
    }

    /// Returns a sentence for each model whose edits are not applied, or do not fit.
    ///
    /// # Errors
    ///
    /// As for [`Self::outdated`].
    pub(super) fn unfit(&mut self, texts: &TextFiles) -> Result<Vec<String>, String> {
        Ok(self.notes(texts)?.unfit.into_iter().map(|note| note.message).collect())
    }

    /// Reads the models of the project, and returns the notes about them.
    fn notes(&mut self, texts: &TextFiles) -> Result<ProjectNotes, String> {
        self.0.all(texts, &Cancel::default()).map_err(|error| error.to_string())?;
        let project = self.0.project(texts).map_err(|errors| listed(&errors))?;
        let project = project.ok_or("only a project keeps edits of models")?;
        Ok(self.0.notes(&project))
    }

    /// Returns when each action begins and ends.
    ///
    /// # Errors
    ///
    /// The document is no script, or something is wrong with it.
    pub(super) fn schedule(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let project = self.0.project(texts).map_err(|errors| listed(&errors))?;
        let file = first_script(project.as_ref(), texts).ok_or("there is no script that can be read")?;
        let checked = self.0.script(file, project.as_ref(), texts, &Cancel::default());
        let CheckedScript { text, shared, script, plan } = checked.map_err(|error| error.to_string())?;
        let (Some(script), Some(plan)) = (&script, &plan) else {
            let own = text.errors.iter().map(ToString::to_string);
            let main = texts.list().first().map_or("", |main| &main.name);
            let shared = shared.iter().map(|error| error.in_file(main));
            let lines = project.as_ref().and_then(StageProject::lines).unwrap_or_default();
            let lines = self.0.lines().errors.iter().map(|error| error.in_file(lines));
            return Err(own.chain(shared).chain(lines).collect::<Vec<_>>().join("\n"));
        };
        let row = |(action, times): (usize, &dragonfly_anim::stage::schedule::ActionTimes)| {
            let element = script.element(action);
            let mut row = json!({"line": script.tree().place(element.range.start).line, "action": element.row.name,
                                 "id": element.value("id"), "who": element.value("who"),
                                 "begin": times.begin.seconds(), "end": times.end.seconds()});
            if let (Some(file), Some(object)) = (script.tree().file_of(element), row.as_object_mut()) {
                object.insert("file".to_owned(), file.into());
            }
            row
        };
        let actions: Vec<Value> = plan.schedule().times().iter().enumerate().map(row).collect();
        Ok(json!({"length": plan.length().seconds(), "actions": actions}))
    }
}

fn listed(errors: &[ScriptError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
