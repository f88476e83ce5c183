//! Answers about the scene of a script: its texts, what is wrong with it, when its actions begin and end.

use crate::Cancel;
use crate::adapter::{ModelAdapter, TextFile, TextFiles};
use crate::edit::TextRef;
use crate::scene_check::{CheckedScript, CheckedText, SceneCheck};
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
        let name = self.first(texts)?.name.clone();
        let checked = self.0.all(texts, &Cancel::default()).map_err(|error| error.to_string())?;
        let row = |error: &ScriptError| {
            json!({"line": error.place.line, "column": error.place.column, "from": error.range.start,
                   "to": error.range.end, "message": error.message, "help": error.help})
        };
        let rows = |list: &[ScriptError]| list.iter().map(row).collect::<Vec<_>>();
        let of = |text: &CheckedText| json!({"text": &*text.name, "errors": rows(&text.errors), "notes": rows(&text.notes)});
        let main = checked.iter().find(|text| text.name == name).or(checked.first());
        let mut answer = of(main.ok_or("the document has no text")?);
        let Some(object) = answer.as_object_mut() else { return Ok(answer) };
        if self.0.is_project() {
            object.insert("texts".to_owned(), checked.iter().map(of).collect());
        }
        let is_lines = |text: &&CheckedText| self.is_lines(texts, &text.name);
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

    /// Returns when each action begins and ends.
    ///
    /// # Errors
    ///
    /// The document is no script, or something is wrong with it.
    pub(super) fn schedule(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let project = self.project(texts).map_err(|errors| listed(&errors))?;
        let file = self.first(texts)?;
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
            json!({"line": script.tree().place(element.range.start).line, "action": element.row.name,
                   "id": element.value("id"), "who": element.value("who"),
                   "begin": times.begin.seconds(), "end": times.end.seconds()})
        };
        let actions: Vec<Value> = plan.schedule().times().iter().enumerate().map(row).collect();
        Ok(json!({"length": plan.length().seconds(), "actions": actions}))
    }

    /// Returns the project; `None` for a script.
    fn project(&self, texts: &TextFiles) -> Result<Option<StageProject>, Vec<ScriptError>> {
        let main = texts.main().filter(|_| self.0.is_project());
        main.map(|text| StageProject::read(text.clone())).transpose()
    }

    fn is_lines(&self, texts: &TextFiles, name: &str) -> bool {
        self.project(texts).ok().flatten().is_some_and(|project| project.lines() == Some(name))
    }

    /// Returns the first script; the project where that cannot be read.
    fn first<'a>(&self, texts: &'a TextFiles) -> Result<&'a TextFile, String> {
        let main = texts.list().first().ok_or("the document has no text")?;
        let Ok(Some(project)) = self.project(texts) else { return Ok(main) };
        let first = project.scripts().find_map(|name| texts.called(name));
        first.ok_or_else(|| "the project has no script".to_owned())
    }
}

fn listed(errors: &[ScriptError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}
