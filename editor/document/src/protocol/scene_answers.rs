//! Answers about the scene of a script: its texts, what is wrong with it, when its actions begin and end.

use crate::Folder;
use crate::adapter::{ModelAdapter, TextFiles};
use crate::edit::TextRef;
use crate::load::load_inside;
use dragonfly_anim::stage::script::{ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// The models of a script, which are read when an answer needs them.
pub(super) struct SceneAnswers {
    /// The folder of the script; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    assets: StageAssets,
    /// The models that cannot be read.
    missing: BTreeSet<String>,
}

/// A script as it is now: its plan, unless something is wrong, and all that is to be said about it.
struct CheckedScript {
    script: Option<StageScript>,
    plan: Option<StagePlan>,
    errors: Vec<ScriptError>,
    notes: Vec<ScriptError>,
}

impl SceneAnswers {
    /// Answers about the script at `path`.
    pub(super) fn of(path: Option<&Path>) -> Self {
        let folder = path.ok_or_else(|| "the document has no file".to_owned());
        let folder = folder.and_then(|path| Folder::of(path).map_err(|error| error.to_string()));
        Self { folder, assets: StageAssets::default(), missing: BTreeSet::new() }
    }

    /// Returns names and sizes of the texts.
    pub(super) fn texts(texts: &TextFiles) -> Value {
        let row = |file: &crate::adapter::TextFile| json!({"name": &*file.name, "bytes": file.text.len()});
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

    /// Returns what is wrong with the script, and what is probably not meant.
    ///
    /// # Errors
    ///
    /// The document is no script.
    pub(super) fn errors(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let checked = self.check(texts)?;
        let row = |error: &ScriptError| {
            json!({"line": error.place.line, "column": error.place.column, "from": error.range.start,
                   "to": error.range.end, "message": error.message, "help": error.help})
        };
        let [errors, notes] =
            [checked.errors, checked.notes].map(|list| list.iter().map(row).collect::<Vec<_>>());
        Ok(json!({"errors": errors, "notes": notes}))
    }

    /// Returns when each action begins and ends.
    ///
    /// # Errors
    ///
    /// The document is no script, or something is wrong with it.
    pub(super) fn schedule(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let checked = self.check(texts)?;
        let (Some(script), Some(plan)) = (&checked.script, &checked.plan) else {
            let errors: Vec<String> = checked.errors.iter().map(ToString::to_string).collect();
            return Err(errors.join("\n"));
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

    fn check(&mut self, texts: &TextFiles) -> Result<CheckedScript, String> {
        let text = texts.main().ok_or("the document has no text")?;
        let script = match StageScript::read(Arc::clone(text)) {
            Ok(script) => script,
            Err(errors) => return Ok(CheckedScript { script: None, plan: None, errors, notes: Vec::new() }),
        };
        let mut errors = self.read_models(&script);
        let mut plan = None;
        match StagePlan::new(&script, &self.assets) {
            Ok(found) if errors.is_empty() => plan = Some(found),
            Ok(_) => {}
            // A missing model has its reason already.
            Err(more) => errors.extend(more.into_iter().filter(|error| {
                let own = texts.main().and_then(|text| text.get(error.range.clone()));
                !own.is_some_and(|name| self.missing.contains(name))
            })),
        }
        errors.sort_by_key(|error| error.range.start);
        let notes = plan.as_ref().map(|plan| plan.schedule().notes().to_vec()).unwrap_or_default();
        Ok(CheckedScript { script: Some(script), plan, errors, notes })
    }

    /// Reads the models that the script names and that were not read before. Returns an error for each that is missing.
    fn read_models(&mut self, script: &StageScript) -> Vec<ScriptError> {
        let mut errors = Vec::new();
        self.missing.clear();
        for source in script.things().filter_map(|thing| thing.attribute("model")) {
            if self.assets.model(&source.value).is_some() || self.missing.contains(&*source.value) {
                continue;
            }
            let loaded = self.folder.as_ref().map_err(Clone::clone).and_then(|folder| {
                load_inside(folder, &source.value, &crate::Cancel::default())
                    .map_err(|error| error.to_string())
            });
            match loaded {
                Ok(loaded) => self.assets.add_model(&*source.value, Arc::new(StageModel::new(loaded.model))),
                Err(reason) => {
                    self.missing.insert(source.value.to_string());
                    let (text, range) = (script.tree().text(), source.value_range.clone());
                    let help = "models are files below the folder of the script";
                    errors.push(ScriptError::at(text, range, reason, help));
                }
            }
        }
        errors
    }
}
