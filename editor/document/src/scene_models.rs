//! The models of a scene, which are read in jobs: each once, and again when its file or its unsaved edits change.

use super::adapter::ModelAdapter;
use super::edit::parse_lines;
use super::job::JobNews;
use super::load::load_inside;
use super::scene_view::SceneModel;
use super::source::LoadError;
use super::{Folder, LoadedModel};
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::stage::{StageAssets, StageModel};
use dragonfly_runtime::{Address, CancelFlag, Job};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Largest number of models that are read at once: each is as large as its file.
const MOST_JOBS: usize = 4;

/// Number of edits that do not fit a model of which the message names each.
const NAMED: usize = 3;

/// Distinguishes a job from others for a model of the same name.
type JobMark = Arc<()>;

/// The origin of a model of a scene.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct SceneModelSource {
    /// The file, relative to the folder of the scene.
    pub(super) file: String,
    /// The edits that are not saved into it, one a line.
    pub(super) edits: Option<Arc<str>>,
}

/// A model of a scene that was read.
#[derive(Clone, Debug)]
pub(super) struct ReadSceneModel {
    loaded: Arc<LoadedModel>,
    stage: Arc<StageModel>,
    /// Hash of its file.
    hash: u64,
    /// A sentence for the user about edits that do not fit it.
    unfit: Option<String>,
}

/// The outcome of reading a model of a scene.
#[derive(Debug)]
pub(super) struct SceneModelNews {
    mark: JobMark,
    name: String,
    outcome: Result<ReadSceneModel, LoadError>,
}

/// A job that reads a model; dropping it cancels it.
struct ReadingModel {
    mark: JobMark,
    source: SceneModelSource,
    _job: Job,
}

/// The models of a scene, by the text with which the script names them.
pub(super) struct SceneModels {
    /// The folder of the scene; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    wanted: BTreeMap<String, SceneModelSource>,
    /// The models that were read, or could not be read.
    tried: BTreeMap<String, SceneModelSource>,
    jobs: BTreeMap<String, ReadingModel>,
    models: Arc<BTreeMap<String, SceneModel>>,
    hashes: BTreeMap<String, u64>,
    unfit: BTreeMap<String, String>,
}

impl SceneModels {
    /// Models in this folder, none of which is named so far.
    pub(super) fn new(folder: Result<Folder, String>) -> Self {
        Self {
            folder,
            wanted: BTreeMap::new(),
            tried: BTreeMap::new(),
            jobs: BTreeMap::new(),
            models: Arc::default(),
            hashes: BTreeMap::new(),
            unfit: BTreeMap::new(),
        }
    }

    /// Returns the folder of the scene.
    pub(super) fn folder(&self) -> Result<&Folder, String> {
        self.folder.as_ref().map_err(Clone::clone)
    }

    /// Returns the models as they are shown.
    pub(super) fn shown(&self) -> &Arc<BTreeMap<String, SceneModel>> {
        &self.models
    }

    /// Returns the hash of the file of a model that was read.
    pub(super) fn hash(&self, name: &str) -> Option<u64> {
        self.hashes.get(name).copied()
    }

    /// Returns a sentence for the user about edits of a model that do not fit it.
    pub(super) fn unfit(&self, name: &str) -> Option<&str> {
        self.unfit.get(name).map(String::as_str)
    }

    /// Starts to read the models that are named now and were not read from there, and stops to read others.
    pub(super) fn want(&mut self, wanted: BTreeMap<String, SceneModelSource>, document: &Address<JobNews>) {
        self.jobs.retain(|name, job| wanted.get(name) == Some(&job.source));
        let is_kept = |name: &String, model: &SceneModel| match model {
            // It may be named again by an undo.
            SceneModel::Loaded(_) => true,
            SceneModel::Loading | SceneModel::Missing(_) => wanted.contains_key(name),
        };
        if self.models.iter().any(|(name, model)| !is_kept(name, model)) {
            Arc::make_mut(&mut self.models).retain(|name, model| is_kept(name, model));
            self.tried.retain(|name, _| self.models.contains_key(name));
        }
        for name in wanted.keys().filter(|name| !self.models.contains_key(*name)).cloned().collect::<Vec<_>>()
        {
            Arc::make_mut(&mut self.models).insert(name, SceneModel::Loading);
        }
        self.wanted = wanted;
        self.start_jobs(document);
    }

    /// Starts jobs for models that are to be read, at most [`MOST_JOBS`].
    fn start_jobs(&mut self, document: &Address<JobNews>) {
        let is_new = |(name, source): &(&String, &SceneModelSource)| {
            self.tried.get(*name) != Some(*source) && !self.jobs.contains_key(*name)
        };
        let room = MOST_JOBS.saturating_sub(self.jobs.len());
        let new: Vec<(String, SceneModelSource)> = self
            .wanted
            .iter()
            .filter(is_new)
            .take(room)
            .map(|(name, source)| (name.clone(), source.clone()))
            .collect();
        for (name, source) in new {
            let mark = JobMark::default();
            let started = match &self.folder {
                Ok(folder) => {
                    let (mark, folder) = (Arc::clone(&mark), folder.clone());
                    start_reading(document, mark, folder, name.clone(), source.clone())
                        .map_err(|error| error.to_string())
                }
                Err(reason) => Err(reason.clone()),
            };
            match started {
                Ok(job) => {
                    self.jobs.insert(name, ReadingModel { mark, source, _job: job });
                }
                Err(reason) => {
                    self.tried.insert(name.clone(), source);
                    Arc::make_mut(&mut self.models).insert(name, SceneModel::Missing(reason));
                }
            }
        }
    }

    /// Takes a model that was read. Returns whether the scene changed.
    pub(super) fn take(&mut self, news: SceneModelNews, assets: &mut StageAssets) -> bool {
        let SceneModelNews { mark, name, outcome } = news;
        if !self.jobs.get(&name).is_some_and(|job| Arc::ptr_eq(&job.mark, &mark)) {
            return false;
        }
        if let Some(job) = self.jobs.remove(&name) {
            self.tried.insert(name.clone(), job.source);
        }
        let model = match outcome {
            Ok(read) => {
                assets.add_model(name.as_str(), read.stage);
                self.hashes.insert(name.clone(), read.hash);
                match read.unfit {
                    Some(unfit) => self.unfit.insert(name.clone(), unfit),
                    None => self.unfit.remove(&name),
                };
                SceneModel::Loaded(read.loaded)
            }
            Err(error) => {
                assets.remove_model(&name);
                SceneModel::Missing(error.to_string())
            }
        };
        Arc::make_mut(&mut self.models).insert(name, model);
        true
    }

    /// Forgets that a model was read: its file changed.
    pub(super) fn forget(&mut self, name: &str) {
        self.tried.remove(name);
    }

    /// Tries again to read the models that are missing: they may be there now. Returns whether there are any.
    pub(super) fn look_again(&mut self) -> bool {
        let missing = |(name, model): (&String, &SceneModel)| match model {
            SceneModel::Missing(_) => Some(name.clone()),
            SceneModel::Loading | SceneModel::Loaded(_) => None,
        };
        let names: Vec<String> = self.models.iter().filter_map(missing).collect();
        names.iter().for_each(|name| self.forget(name));
        !names.is_empty()
    }
}

/// Starts to read a model in a job.
fn start_reading(
    document: &Address<JobNews>,
    mark: JobMark,
    folder: Folder,
    name: String,
    source: SceneModelSource,
) -> std::io::Result<Job> {
    let (title, other) = (name.clone(), Arc::clone(&mark));
    Job::start(
        document,
        "scene model",
        move |job| {
            let outcome = read(&folder, &source, job.cancel_flag());
            JobNews::SceneModel(Box::new(SceneModelNews { mark, name, outcome }))
        },
        move |panic| {
            let reason = format!("the importer failed: {panic}");
            let outcome = Err(LoadError::Format { title: title.clone(), reason });
            JobNews::SceneModel(Box::new(SceneModelNews { mark: other, name: title, outcome }))
        },
    )
}

/// Reads a model and applies its edits.
fn read(
    folder: &Folder,
    source: &SceneModelSource,
    cancel: &CancelFlag,
) -> Result<ReadSceneModel, LoadError> {
    let (mut loaded, hash) = load_inside(folder, &source.file, cancel)?;
    let mut unfit = None;
    if let Some(edits) = &source.edits {
        (loaded.model, unfit) = with_edits(&loaded.model, &source.file, edits);
    }
    let stage = Arc::new(StageModel::new(Arc::clone(&loaded.model)));
    Ok(ReadSceneModel { loaded: Arc::new(loaded), stage, hash, unfit })
}

/// Returns a model with edits, one a line, and a sentence about those that do not fit; `file` is its name.
pub(super) fn with_edits(
    model: &Arc<ModelData>,
    file: &str,
    edits: &str,
) -> (Arc<ModelData>, Option<String>) {
    if edits.trim().is_empty() {
        return (Arc::clone(model), None);
    }
    let mut adapter = ModelAdapter::of(model);
    let mut reasons = Vec::new();
    match parse_lines(edits) {
        Ok(edits) => {
            for (line, edit) in edits {
                if let Err(error) = adapter.allows(&edit).and_then(|()| adapter.apply(&edit)) {
                    reasons.push(format!("line {line}: {error}"));
                }
            }
        }
        Err(error) => reasons.push(error.to_string()),
    }
    let animation = AnimationData { skeleton: Arc::clone(adapter.skeleton()), takes: adapter.saved_takes() };
    let skeleton = Arc::clone(adapter.skeleton());
    let shift = dragonfly_anim::root_bone::BoneShift::between(&model.animation.skeleton, &skeleton);
    let shifted = shift.and_then(|shift| shift.model(model, &skeleton));
    let base = shifted.unwrap_or_else(|| ModelData::clone(model));
    (Arc::new(ModelData { animation, ..base }), unfit_text(file, &reasons))
}

fn unfit_text(file: &str, reasons: &[String]) -> Option<String> {
    let named = reasons.iter().take(NAMED).cloned().collect::<Vec<_>>().join("; ");
    match reasons.len().saturating_sub(NAMED) {
        _ if reasons.is_empty() => None,
        0 => Some(format!("edits of {file} do not fit it: {named}")),
        more => Some(format!("edits of {file} do not fit it: {named}; and {more} more")),
    }
}
