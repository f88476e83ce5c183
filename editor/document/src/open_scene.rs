//! The scene of an open script: what plays, and the models that it names, which are read in jobs.

use super::adapter::{TextFile, TextFiles};
use super::job::JobNews;
use super::load::load_inside;
use super::scene_lines::SceneLines;
use super::scene_view::{SceneModel, SceneView};
use super::source::LoadError;
use super::text_source::is_project;
use super::{Folder, LoadedModel};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptError, StageScript};
use dragonfly_anim::stage::{LiveStage, StageAssets, StageModel};
use dragonfly_runtime::{Address, Job};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Largest number of models that are read at once: each is as large as its file.
const MOST_JOBS: usize = 4;

/// What a project without a script shows.
const EMPTY: &str = "<script version=\"1\"/>";

/// Distinguishes a job from others for a model of the same name.
type JobMark = Arc<()>;

/// A model of a scene that was read.
#[derive(Clone, Debug)]
pub(super) struct ReadSceneModel {
    loaded: Arc<LoadedModel>,
    stage: Arc<StageModel>,
}

/// The outcome of reading a model of a scene.
#[derive(Debug)]
pub(super) struct SceneModelNews {
    mark: JobMark,
    name: String,
    outcome: Result<ReadSceneModel, LoadError>,
}

/// The scene of an open script.
pub(super) struct OpenScene {
    /// The folder of the script; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    live: LiveStage,
    assets: StageAssets,
    models: Arc<BTreeMap<String, SceneModel>>,
    /// The file of each model, by the name that the script has for it.
    sources: BTreeMap<String, String>,
    /// The jobs that read models; dropping one cancels it.
    jobs: BTreeMap<String, (JobMark, Job)>,
    /// Whether it is a project, and not a script alone.
    is_project: bool,
    /// The last good project, and what is wrong with its newest text.
    project: Option<Arc<StageProject>>,
    project_errors: Vec<ScriptError>,
    lines: SceneLines,
    /// The chosen script of a project.
    shown: Option<String>,
    /// The texts that were planned last; `None` where models changed since then.
    planned: Option<TextFiles>,
    view: Arc<SceneView>,
}

impl OpenScene {
    /// Returns the scene of the script at `path`, without a text so far.
    pub(super) fn of(path: &Path) -> Self {
        let mut assets = StageAssets::default();
        assets.allow_missing_models();
        Self {
            folder: Folder::of(path).map_err(|error| error.to_string()),
            live: LiveStage::default(),
            assets,
            models: Arc::default(),
            sources: BTreeMap::new(),
            jobs: BTreeMap::new(),
            is_project: is_project(path),
            project: None,
            project_errors: Vec::new(),
            lines: SceneLines::default(),
            shown: None,
            planned: None,
            view: Arc::default(),
        }
    }

    /// Returns what is published.
    pub(super) fn view(&self) -> Arc<SceneView> {
        Arc::clone(&self.view)
    }

    /// Plans the script where it or a model changed since the last time, and starts to read the models that it names.
    pub(super) fn update(&mut self, texts: &TextFiles, document: &Address<JobNews>) {
        if self.planned.as_ref() == Some(texts) {
            return;
        }
        self.planned = Some(texts.clone());
        let Some(TextFile { name, text }) = self.script_of(texts) else { return };
        self.lines.update(self.project.as_deref(), texts, &mut self.assets);
        self.live.update_of(Arc::clone(&text), self.project.as_deref(), &self.assets);
        self.read_models(document);
        self.view = Arc::new(SceneView {
            text,
            name,
            texts: texts.clone(),
            project: self.project.clone(),
            project_errors: self.project_errors.as_slice().into(),
            lines: self.lines.lines.clone(),
            line_errors: Arc::clone(&self.lines.errors),
            script: self.live.script().cloned(),
            plan: self.live.plan().cloned(),
            errors: self.live.errors().into(),
            notes: self.notes().into(),
            models: Arc::clone(&self.models),
        });
    }

    /// Shows another script of the project. Returns whether it has one of this name.
    pub(super) fn show(&mut self, name: &str, texts: &TextFiles) -> bool {
        let is_there = self.is_project && texts.list().iter().skip(1).any(|file| *file.name == *name);
        if is_there {
            (self.shown, self.planned, self.live) = (Some(name.to_owned()), None, LiveStage::default());
        }
        is_there
    }

    /// Reads the project, if it is one, and returns the script that is shown: the chosen one, or else the first.
    fn script_of(&mut self, texts: &TextFiles) -> Option<TextFile> {
        let main = texts.list().first()?;
        if !self.is_project {
            return Some(main.clone());
        }
        match StageProject::read(Arc::clone(&main.text)) {
            Ok(project) => (self.project, self.project_errors) = (Some(Arc::new(project)), Vec::new()),
            // The last good project stays.
            Err(errors) => self.project_errors = errors,
        }
        let named = |name: &str| texts.called(name).cloned();
        let chosen = self.shown.as_deref().and_then(named);
        let first = || self.project.iter().flat_map(|project| project.scripts()).find_map(named);
        // A project without a script has an empty scene.
        chosen.or_else(first).or_else(|| {
            let (name, text) = ("".into(), EMPTY.into());
            Some(TextFile { name, text })
        })
    }

    /// Starts to read models that were not read, and stops to read those that are not named any more.
    fn read_models(&mut self, document: &Address<JobNews>) {
        let Some(script) = self.live.script().cloned() else { return };
        let named = |name: &str| names(&script).any(|other| other == name);
        self.jobs.retain(|name, _| named(name));
        let is_kept = |name: &String, model: &SceneModel| match model {
            // It may be named again by an undo.
            SceneModel::Loaded(_) => true,
            SceneModel::Loading | SceneModel::Missing(_) => named(name),
        };
        if self.models.iter().any(|(name, model)| !is_kept(name, model)) {
            Arc::make_mut(&mut self.models).retain(|name, model| is_kept(name, model));
        }
        let project = self.project.clone();
        for name in names(&script) {
            let source = project.as_ref().map_or(name, |project| project.source_of(name));
            if self.models.contains_key(name) && self.sources.get(name).is_some_and(|old| old == source) {
                continue;
            }
            // It is new, or its id means another file now.
            self.jobs.remove(name);
            self.assets.remove_model(name);
            self.sources.insert(name.to_owned(), source.to_owned());
            Arc::make_mut(&mut self.models).insert(name.to_owned(), SceneModel::Loading);
        }
        self.start_jobs(document);
    }

    /// Starts jobs for models that are to be read, as many as may run at once.
    fn start_jobs(&mut self, document: &Address<JobNews>) {
        let waiting = self.models.iter().filter(|(_, model)| matches!(model, SceneModel::Loading));
        let waiting = waiting.map(|(name, _)| name).filter(|name| !self.jobs.contains_key(*name));
        let room = MOST_JOBS.saturating_sub(self.jobs.len());
        let names: Vec<String> = waiting.take(room).cloned().collect();
        for name in names {
            let mark = JobMark::default();
            let started = match &self.folder {
                Ok(folder) => {
                    let source = self.sources.get(&name).unwrap_or(&name).clone();
                    start_reading(document, Arc::clone(&mark), folder.clone(), name.clone(), source)
                        .map_err(|error| error.to_string())
                }
                Err(reason) => Err(reason.clone()),
            };
            match started {
                Ok(job) => {
                    self.jobs.insert(name, (mark, job));
                }
                Err(reason) => {
                    Arc::make_mut(&mut self.models).insert(name, SceneModel::Missing(reason));
                }
            }
        }
    }

    /// Takes a model that was read. Returns whether the scene changed.
    pub(super) fn take(&mut self, news: SceneModelNews) -> bool {
        let SceneModelNews { mark, name, outcome } = news;
        if !self.jobs.get(&name).is_some_and(|(own, _)| Arc::ptr_eq(own, &mark)) {
            return false;
        }
        self.jobs.remove(&name);
        let model = match outcome {
            Ok(read) => {
                self.assets.add_model(name.as_str(), read.stage);
                SceneModel::Loaded(read.loaded)
            }
            Err(error) => SceneModel::Missing(error.to_string()),
        };
        Arc::make_mut(&mut self.models).insert(name, model);
        self.planned = None;
        true
    }

    /// Tries again to read the models that are missing: they may be there now. Returns whether there are any.
    pub(super) fn look_again(&mut self) -> bool {
        let is_missing = |model: &SceneModel| matches!(model, SceneModel::Missing(_));
        if !self.models.values().any(is_missing) {
            return false;
        }
        Arc::make_mut(&mut self.models).retain(|_, model| !is_missing(model));
        self.planned = None;
        true
    }

    /// Returns what the user should know about the scene that plays: models that are missing, and what is probably not meant.
    fn notes(&self) -> Vec<ScriptError> {
        let Some(script) = self.live.script() else { return Vec::new() };
        let missing = script.things().filter_map(|thing| {
            let attribute = thing.attribute("model")?;
            let SceneModel::Missing(reason) = self.models.get(&*attribute.value)? else { return None };
            let text = script.tree().text();
            let help =
                "what needs it is shown as a placeholder; models are files below the folder of the script";
            Some(ScriptError::at(text, attribute.value_range.clone(), reason.clone(), help))
        });
        let plan = self.live.plan().into_iter().flat_map(|plan| plan.schedule().notes()).cloned();
        let mut notes: Vec<ScriptError> = missing.chain(plan).collect();
        notes.sort_by_key(|note| note.range.start);
        notes
    }
}

/// Returns the models that a script names.
fn names(script: &StageScript) -> impl Iterator<Item = &str> {
    script.things().filter_map(|thing| thing.value("model"))
}

/// Starts to read a model in a job.
fn start_reading(
    document: &Address<JobNews>,
    mark: JobMark,
    folder: Folder,
    name: String,
    source: String,
) -> std::io::Result<Job> {
    let (title, other) = (name.clone(), Arc::clone(&mark));
    Job::start(
        document,
        "scene model",
        move |job| {
            let outcome = load_inside(&folder, &source, job.cancel_flag()).map(|loaded| ReadSceneModel {
                stage: Arc::new(StageModel::new(Arc::clone(&loaded.model))),
                loaded: Arc::new(loaded),
            });
            JobNews::SceneModel(Box::new(SceneModelNews { mark, name, outcome }))
        },
        move |panic| {
            let reason = format!("the importer failed: {panic}");
            let outcome = Err(LoadError::Format { title: title.clone(), reason });
            JobNews::SceneModel(Box::new(SceneModelNews { mark: other, name: title, outcome }))
        },
    )
}
