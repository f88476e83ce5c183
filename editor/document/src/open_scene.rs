//! The scene of an open script or project: what plays, and the models that it names.

use super::Folder;
use super::adapter::{TextFile, TextFiles};
use super::changed_models::{ChangedModelNews, ChangedModels};
use super::job::JobNews;
use super::project_models::ProjectModels;
use super::project_notes::ProjectNotes;
use super::scene_includes::{SceneIncludeNews, SceneIncludes};
use super::scene_lines::SceneLines;
use super::scene_model_source::SceneModelSource;
use super::scene_models::{SceneModelNews, SceneModels};
use super::scene_view::{SceneModel, SceneView};
use super::text_source::{first_script, is_project};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, ScriptError, StageScript};
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{LiveStage, StageAssets};
use dragonfly_runtime::Address;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// The scene of a project without a script.
const EMPTY: &str = "<script version=\"1\"/>";

/// The scene of an open script or project.
pub(super) struct OpenScene {
    live: LiveStage,
    /// The models and lines, without the sounds.
    assets: StageAssets,
    /// The lengths of the sounds that were read, by the texts with which scripts name them.
    sounds: BTreeMap<String, StageTime>,
    models: SceneModels,
    /// Whether it is a project, and not a script alone.
    is_project: bool,
    /// The last good project, and what is wrong with its newest text.
    project: Option<Arc<StageProject>>,
    project_errors: Vec<ScriptError>,
    lines: SceneLines,
    includes: SceneIncludes,
    /// The chosen script of a project.
    chosen: Option<String>,
    /// The texts that were planned last; `None` where models changed since then.
    planned: Option<TextFiles>,
    changed_models: ChangedModels,
    view: Arc<SceneView>,
}

impl OpenScene {
    /// Returns the scene of the script or project at `path`, without a text so far.
    pub(super) fn of(path: &Path) -> Self {
        let mut assets = StageAssets::default();
        assets.allow_missing_models();
        Self {
            live: LiveStage::default(),
            assets,
            sounds: BTreeMap::new(),
            models: SceneModels::new(Folder::of(path).map_err(|error| error.to_string())),
            is_project: is_project(path),
            project: None,
            project_errors: Vec::new(),
            lines: SceneLines::default(),
            includes: SceneIncludes::default(),
            chosen: None,
            planned: None,
            changed_models: ChangedModels::default(),
            view: Arc::default(),
        }
    }

    /// Returns what is published.
    pub(super) fn view(&self) -> Arc<SceneView> {
        Arc::clone(&self.view)
    }

    /// Returns the models.
    pub(super) fn models(&self) -> &SceneModels {
        &self.models
    }

    /// Returns the last good project; `None` for a script alone.
    pub(super) fn project(&self) -> Option<&Arc<StageProject>> {
        self.project.as_ref()
    }

    /// Plans the script where a text or a model changed since the last time, and starts to read the models that it names.
    pub(super) fn update(&mut self, texts: &TextFiles, document: &Address<JobNews>) {
        if self.planned.as_ref() == Some(texts) {
            return;
        }
        self.planned = Some(texts.clone());
        let Some(TextFile { name, text }) = self.script_of(texts) else { return };
        self.lines.update(self.project.as_deref(), texts, &mut self.assets);
        self.includes.update((&name, &text), texts, self.models.folder(), document);
        let project = self.project.clone();
        let context = ScriptContext {
            name: Arc::clone(&name),
            project: project.as_deref().cloned(),
            files: self.includes.files().clone(),
        };
        let mut assets = self.assets.clone();
        self.sounds.iter().for_each(|(name, length)| assets.add_sound(name, *length));
        self.live.update_in(Arc::clone(&text), &context, &assets);
        let models = project.as_deref().map(ProjectModels::of);
        let wanted = self.wanted(models.as_ref(), texts);
        self.models.want(wanted, document);
        let (errors, shared) = self.separated(self.live.errors().to_vec());
        let (notes, shared_notes) = self.separated(self.notes());
        let of_models = self.project_notes(models.as_ref());
        let outdated = of_models.outdated.as_slice().into();
        let project_notes = shared_notes.into_iter().chain(of_models.all());
        self.view = Arc::new(SceneView {
            text,
            name,
            texts: texts.clone(),
            project: self.project.clone(),
            project_errors: self.project_errors.as_slice().into(),
            shared_errors: shared.into(),
            project_notes: project_notes.collect(),
            outdated,
            lines: self.lines.lines.clone(),
            line_errors: Arc::clone(&self.lines.errors),
            includes: context.files,
            script: self.live.script().cloned(),
            plan: self.live.plan().cloned(),
            errors: errors.into(),
            notes: notes.into(),
            models: Arc::clone(self.models.shown()),
        });
    }

    /// Shows another script of the project. Returns whether it has one of this name.
    pub(super) fn show(&mut self, name: &str) -> bool {
        let is_there = self.project.as_ref().is_some_and(|project| project.scripts().any(|own| own == name));
        if is_there {
            (self.chosen, self.planned, self.live) = (Some(name.to_owned()), None, LiveStage::default());
        }
        is_there
    }

    /// Takes a model that was read. Returns whether the scene changed.
    pub(super) fn take(&mut self, news: SceneModelNews) -> bool {
        let changed = self.models.take(news, &mut self.assets);
        if changed {
            self.planned = None;
        }
        changed
    }

    /// Takes the length of a sound, by the text with which the script names it; `None` where it is not known any more. Returns whether the
    /// scene changed.
    pub(super) fn take_sound(&mut self, name: &str, length: Option<StageTime>) -> bool {
        let old = match length {
            Some(length) => self.sounds.insert(name.to_owned(), length),
            None => self.sounds.remove(name),
        };
        let changed = old != length;
        if changed {
            self.planned = None;
        }
        changed
    }

    /// Takes files that the script includes. Returns whether the scene changed.
    pub(super) fn take_includes(&mut self, news: SceneIncludeNews) -> bool {
        let changed = self.includes.take(news);
        if changed {
            self.planned = None;
        }
        changed
    }

    /// Reads the models of a file again: it changed.
    pub(super) fn read_again(&mut self, file: &str) {
        self.models.forget(file);
        self.planned = None;
    }

    /// Reads the models again from the folder of the script or project, which was saved at `path`. The sounds of another folder may be others.
    pub(super) fn move_to(&mut self, path: &Path) {
        self.models.move_to(Folder::of(path).map_err(|error| error.to_string()));
        self.includes.forget();
        self.sounds.clear();
        self.planned = None;
    }

    /// Returns whether the newest text of the project has errors, so that it cannot get edits of models.
    pub(super) fn has_project_errors(&self) -> bool {
        !self.project_errors.is_empty()
    }

    /// Reads again the models and included scripts that were missing and those whose files another program changed. Returns whether there are any.
    pub(super) fn look_again(&mut self) -> bool {
        let any = self.includes.look_again() | self.models.look_again();
        if any {
            self.planned = None;
        }
        any
    }

    /// Reads the project, if it is one, and returns the script that is shown: the chosen one, or else the first.
    fn script_of(&mut self, texts: &TextFiles) -> Option<TextFile> {
        let main = texts.list().first()?;
        if !self.is_project {
            return Some(main.clone());
        }
        let is_same = self.project.as_ref().is_some_and(|project| *project.tree().text() == main.text);
        if !is_same {
            match StageProject::read(Arc::clone(&main.text)) {
                Ok(project) => (self.project, self.project_errors) = (Some(Arc::new(project)), Vec::new()),
                // The last good project stays.
                Err(errors) => self.project_errors = errors,
            }
        } else {
            self.project_errors.clear();
        }
        let named = |name: &str| texts.called(name).cloned();
        let chosen = self.chosen.as_deref().and_then(named);
        let first = || first_script(Some(self.project.as_deref()?), texts).cloned();
        // A project without a script has an empty scene.
        chosen.or_else(first).or_else(|| {
            let (name, text) = ("".into(), EMPTY.into());
            Some(TextFile { name, text })
        })
    }

    /// Separates errors of the text of the script from those of the cast that it shares with its project.
    fn separated(&self, errors: Vec<ScriptError>) -> (Vec<ScriptError>, Vec<ScriptError>) {
        match &self.project {
            Some(project) => project.separated(errors),
            None => (errors, Vec::new()),
        }
    }

    /// Returns the models that the script names, each with its source.
    fn wanted(
        &self,
        models: Option<&ProjectModels<'_>>,
        texts: &TextFiles,
    ) -> BTreeMap<String, SceneModelSource> {
        let Some(script) = self.live.script() else { return BTreeMap::new() };
        let source = |name: &str| SceneModelSource::of(name, models, texts);
        names(script).map(|name| (name.to_owned(), source(name))).collect()
    }

    /// Returns what the user should know about the scene that plays: models that are missing, and what is probably not meant.
    fn notes(&self) -> Vec<ScriptError> {
        let Some(script) = self.live.script() else { return Vec::new() };
        let missing = script.things().filter_map(|thing| {
            let attribute = thing.attribute("model")?;
            let range = attribute.value_range.clone();
            match self.models.shown().get(&*attribute.value)? {
                SceneModel::Missing(reason) => {
                    let help =
                        "what needs it is shown as a placeholder; models are files below the folder of the script";
                    Some(script.tree().error(range, reason.clone(), help))
                }
                SceneModel::Loading | SceneModel::Loaded(_) => None,
            }
        });
        let plan = self.live.plan().into_iter().flat_map(|plan| plan.schedule().notes()).cloned();
        let mut notes: Vec<ScriptError> = missing.chain(plan).collect();
        notes.sort_by_key(|note| note.range.start);
        notes
    }

    /// Returns what the user should know about the models of the project that the script names: files that changed, edits that are not
    /// applied.
    fn project_notes(&self, models: Option<&ProjectModels<'_>>) -> ProjectNotes {
        let Some((project, models)) = self.project.as_ref().zip(models) else {
            return ProjectNotes::default();
        };
        ProjectNotes::of(project, models, self.models.read())
    }

    /// Returns what is new for the user once all models were read: see [`ChangedModels::news`].
    pub(super) fn changed_models(&mut self) -> ChangedModelNews {
        self.changed_models.news(&self.models, &self.view.outdated)
    }

    /// Notes that the edits of models were applied again: those that do not fit are named once the models were read.
    pub(super) fn await_fit(&mut self, models: impl IntoIterator<Item = String>) {
        self.changed_models.await_fit(models);
    }
}

/// Returns the models that a script names.
fn names(script: &StageScript) -> impl Iterator<Item = &str> {
    script.things().filter_map(|thing| thing.value("model"))
}
