//! Answers about the scene of a script: its texts, what is wrong with it, when its actions begin and end.

use crate::Folder;
use crate::adapter::{ModelAdapter, TextFiles};
use crate::edit::TextRef;
use crate::project_models::ProjectModels;
use crate::scene_includes::read_includes;
use crate::scene_lines::SceneLines;
use crate::scene_model_source::SceneModelSource;
use crate::text_source::is_project;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The models of a script or a project, which are read when an answer needs them.
pub(super) struct SceneAnswers {
    is_project: bool,
    lines: SceneLines,
    /// The folder of the script; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    assets: StageAssets,
    /// The models that were read, with their sources, and a sentence about edits that were not applied.
    read: BTreeMap<String, (SceneModelSource, Option<String>)>,
}

/// A script as it is now: its plan, if it has no errors, its errors and its notes.
#[derive(Default)]
struct CheckedScript {
    /// Name of the text that has the errors and notes.
    name: Arc<str>,
    script: Option<StageScript>,
    plan: Option<StagePlan>,
    errors: Vec<ScriptError>,
    notes: Vec<ScriptError>,
    /// Name of the text of the lines, and its errors.
    lines: Option<(String, Arc<[ScriptError]>)>,
    /// Edits of models that were not applied to them, a sentence for each model.
    unfit: Vec<String>,
}

impl SceneAnswers {
    /// Answers about the script or project at `path`.
    pub(super) fn of(path: Option<&Path>) -> Self {
        let folder = path.ok_or_else(|| "the document has no file".to_owned());
        let folder = folder.and_then(|path| Folder::of(path).map_err(|error| error.to_string()));
        // Each missing model has its own error.
        let mut assets = StageAssets::default();
        assets.allow_missing_models();
        Self {
            is_project: path.is_some_and(is_project),
            lines: SceneLines::default(),
            folder,
            assets,
            read: BTreeMap::new(),
        }
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
            let mut row = json!({"line": error.place.line, "column": error.place.column, "from": error.range.start,
                                 "to": error.range.end, "message": error.message, "help": error.help});
            if let (Some(inside), Some(object)) = (&error.inside, row.as_object_mut()) {
                let inside = json!({"file": &*inside.file, "line": inside.place.line, "column": inside.place.column,
                                    "from": inside.range.start, "to": inside.range.end});
                object.insert("inside".to_owned(), inside);
            }
            row
        };
        let [errors, notes] =
            [checked.errors, checked.notes].map(|list| list.iter().map(row).collect::<Vec<_>>());
        let mut answer = json!({"text": &*checked.name, "errors": errors, "notes": notes});
        if let Some(object) = answer.as_object_mut() {
            if let Some((name, errors)) = &checked.lines {
                let errors: Vec<Value> = errors.iter().map(row).collect();
                object.insert("lines".to_owned(), json!({"text": name, "errors": errors}));
            }
            if !checked.unfit.is_empty() {
                object.insert("edits".to_owned(), json!(checked.unfit));
            }
        }
        Ok(answer)
    }

    /// Returns when each action begins and ends.
    ///
    /// # Errors
    ///
    /// The document is no script, or something is wrong with it.
    pub(super) fn schedule(&mut self, texts: &TextFiles) -> Result<Value, String> {
        let checked = self.check(texts)?;
        let (Some(script), Some(plan)) = (&checked.script, &checked.plan) else {
            return Err(checked.reasons().join("\n"));
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

    fn check(&mut self, texts: &TextFiles) -> Result<CheckedScript, String> {
        let main = texts.list().first().ok_or("the document has no text")?;
        let (mut file, mut project) = (main, None);
        if self.is_project {
            let found = match StageProject::read(Arc::clone(&main.text)) {
                Ok(found) => found,
                Err(errors) => {
                    return Ok(CheckedScript { name: main.name.clone(), errors, ..CheckedScript::default() });
                }
            };
            file = found.scripts().find_map(|name| texts.called(name)).ok_or("the project has no script")?;
            self.lines.update(Some(&found), texts, &mut self.assets);
            project = Some(found);
        }
        let name = file.name.clone();
        let folder = self.folder.as_ref().map_err(Clone::clone);
        let context = ScriptContext {
            name: name.clone(),
            project: project.clone(),
            files: read_includes((&name, &file.text), texts, folder),
        };
        let script = match StageScript::read_in(Arc::clone(&file.text), &context) {
            Ok(script) => script,
            Err(errors) => return Ok(CheckedScript { name, errors, ..CheckedScript::default() }),
        };
        let (mut errors, unfit) = self.read_models(&script, project.as_ref(), texts);
        let mut plan = None;
        match StagePlan::new(&script, &self.assets) {
            Ok(found) if errors.is_empty() && self.lines.errors.is_empty() => plan = Some(found),
            Ok(_) => {}
            Err(more) => errors.extend(more),
        }
        errors.sort_by_key(|error| error.range.start);
        let notes = plan.as_ref().map(|plan| plan.schedule().notes().to_vec()).unwrap_or_default();
        let lines = project.as_ref().and_then(StageProject::lines).filter(|_| !self.lines.errors.is_empty());
        let lines = lines.map(|name| (name.to_owned(), Arc::clone(&self.lines.errors)));
        Ok(CheckedScript { name, script: Some(script), plan, errors, notes, lines, unfit })
    }

    /// Reads the models that the script names and that were not read from there before. Returns an error for each that is missing, and a
    /// sentence for each whose edits were not applied.
    fn read_models(
        &mut self,
        script: &StageScript,
        project: Option<&StageProject>,
        texts: &TextFiles,
    ) -> (Vec<ScriptError>, Vec<String>) {
        let mut errors = Vec::new();
        let models = project.map(ProjectModels::of);
        let mut tried: BTreeMap<&str, Option<String>> = BTreeMap::new();
        for attribute in script.things().filter_map(|thing| thing.attribute("model")) {
            let name = &*attribute.value;
            if tried.contains_key(name) {
                continue;
            }
            let source = SceneModelSource::of(name, models.as_ref(), texts);
            if let Some((_, unfit)) = self.read.get(name).filter(|(own, _)| *own == source) {
                tried.insert(name, unfit.clone());
                continue;
            }
            let read = self.folder.as_ref().map_err(Clone::clone).and_then(|folder| {
                source.read(folder, &crate::Cancel::default()).map_err(|error| error.to_string())
            });
            match read {
                Ok(read) => {
                    self.assets.add_model(name, read.stage);
                    tried.insert(name, read.state.unfit.clone());
                    self.read.insert(name.to_owned(), (source, read.state.unfit));
                }
                Err(reason) => {
                    tried.insert(name, None);
                    self.assets.remove_model(name);
                    self.read.remove(name);
                    let help = "models are files below the folder of the script";
                    errors.push(script.tree().error(attribute.value_range.clone(), reason, help));
                }
            }
        }
        (errors, tried.into_values().flatten().collect())
    }
}

impl CheckedScript {
    /// Returns why there is no plan, one sentence each.
    fn reasons(&self) -> Vec<String> {
        let lines =
            self.lines.iter().flat_map(|(name, errors)| errors.iter().map(|error| error.in_file(name)));
        self.errors.iter().map(ToString::to_string).chain(lines).collect()
    }
}
