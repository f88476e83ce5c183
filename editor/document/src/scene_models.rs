//! The models of a scene, which are read in jobs: each once, and again when its file or the edits that the project keeps change.

use super::Folder;
use super::job::JobNews;
use super::scene_model_source::{ReadFileState, ReadSceneModel, SceneModelSource};
use super::scene_view::SceneModel;
use super::source::LoadError;
use dragonfly_anim::stage::StageAssets;
use dragonfly_runtime::{Address, Job};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Largest number of models that are read at once: each is as large as its file.
const MOST_JOBS: usize = 4;

/// Distinguishes a job from others for a model of the same name.
type JobMark = Arc<()>;

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
    /// The files of the models that are shown.
    files: BTreeMap<String, ReadFileState>,
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
            files: BTreeMap::new(),
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

    /// Returns the models that the script names and that were read from there: the name, the source, and the state of the file.
    pub(super) fn read(&self) -> impl Iterator<Item = (&str, &SceneModelSource, &ReadFileState)> {
        self.wanted.iter().filter_map(|(name, source)| {
            let file = self.files.get(name)?;
            (self.tried.get(name) == Some(source)).then_some((&**name, source, file))
        })
    }

    /// Returns whether a model is being read.
    pub(super) fn are_read_again(&self) -> bool {
        !self.jobs.is_empty()
    }

    /// Reads all models again, from another folder.
    pub(super) fn move_to(&mut self, folder: Result<Folder, String>) {
        self.folder = folder;
        (self.tried, self.jobs) = (BTreeMap::new(), BTreeMap::new());
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
                self.files.insert(name.clone(), read.state);
                SceneModel::Loaded(Arc::new(read.loaded))
            }
            Err(error) => {
                assets.remove_model(&name);
                self.files.remove(&name);
                SceneModel::Missing(error.to_string())
            }
        };
        Arc::make_mut(&mut self.models).insert(name, model);
        true
    }

    /// Forgets that the models of a file were read: it changed.
    pub(super) fn forget(&mut self, file: &str) {
        self.tried.retain(|_, source| source.file != file);
    }

    /// Tries again to read the models that are missing, because they may be there now, and those whose files another program changed.
    /// Returns whether there are any.
    pub(super) fn look_again(&mut self) -> bool {
        let before = self.tried.len();
        let (models, files) = (&self.models, &self.files);
        self.tried.retain(|name, _| match models.get(name) {
            Some(SceneModel::Missing(_)) => false,
            Some(SceneModel::Loaded(_)) => files.get(name).is_none_or(|file| file.stamps.changed().is_none()),
            Some(SceneModel::Loading) | None => true,
        });
        self.tried.len() < before
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
            let outcome = source.read(&folder, job.cancel_flag());
            JobNews::SceneModel(Box::new(SceneModelNews { mark, name, outcome }))
        },
        move |panic| {
            let reason = format!("the importer failed: {panic}");
            let outcome = Err(LoadError::Format { title: title.clone(), reason });
            JobNews::SceneModel(Box::new(SceneModelNews { mark: other, name: title, outcome }))
        },
    )
}
