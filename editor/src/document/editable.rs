//! A file that is edited: its data, and what it takes to save it without touching the rest.

use super::adapter::ModelAdapter;
use super::load::{LoadError, Source, file_name};
use super::{Cancel, Folder, import, read_file};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::data::{AnimationData, ModelData};
use dragonfly_anim::format::gltf::save::{self, Changes, OutputFile, Plan, SourceFile, TakeNow};
use dragonfly_anim::format::{AssetFs, NoFiles, ReadOptions, dfm};
use dragonfly_anim::limits::FILE_BYTES;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// A file that is edited.
pub struct Editable {
    /// File name without folder.
    pub title: String,
    /// Where it is; `None` for the built-in model.
    pub path: Option<PathBuf>,
    /// The data as it was read.
    pub model: Arc<ModelData>,
    /// What is not shown or was mended, one sentence each.
    pub warnings: Vec<String>,
    kind: Kind,
}

/// How its format is saved.
enum Kind {
    /// By exchanging the few bytes that an edit concerns.
    Gltf(Box<SourceFile>),
    /// As a whole: the format is ours, and holds nothing that we do not know.
    Dfm,
}

/// What a save will write.
pub struct SavePlan {
    /// The files, in the order in which to write them; names relative to the folder of the file that was opened.
    pub files: Vec<OutputFile>,
    /// What changes in a file that is patched; none where the whole file is written.
    pub changes: Option<Changes>,
}

/// Why something cannot be saved; nothing was written.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The takes do not fit into the file.
    #[error(transparent)]
    Gltf(#[from] save::SaveError),
    /// The same for our own format.
    #[error(transparent)]
    Dfm(#[from] dfm::WriteError),
}

impl Editable {
    /// Opens `source` to edit it: no texture is decoded.
    pub fn open(source: &Source, cancel: &Cancel) -> Result<Self, LoadError> {
        let (name, bytes, path) = match source {
            Source::BuiltIn => ("dragonfly.glb".to_owned(), DRAGONFLY_GLB.to_vec(), None),
            Source::File(path) => {
                let failed = |reason| LoadError::File { path: path.clone(), reason };
                (file_name(path), read_file(path, FILE_BYTES).map_err(failed)?, Some(path.clone()))
            }
        };
        let wrong = |reason: String| LoadError::Format { title: source.title(), reason };
        let door = match &path {
            Some(path) => Some(Folder::of(path).map_err(|error| wrong(error.to_string()))?),
            None => None,
        };
        let door: &dyn AssetFs = door.as_ref().map_or(&NoFiles, |folder| folder);
        let imported = import::read(&name, &bytes, door, &|_| {}, cancel)?;
        let kind = if imported.format == "dfm" {
            Kind::Dfm
        } else {
            let source = SourceFile::open(&name, bytes, door, &ReadOptions::default());
            Kind::Gltf(Box::new(source.map_err(|error| wrong(error.to_string()))?))
        };
        let (model, warnings) = (Arc::new(imported.model), imported.warnings);
        Ok(Self { title: source.title(), path, model, warnings, kind })
    }

    /// What saving the takes of `adapter` will write.
    pub fn plan(&self, adapter: &ModelAdapter) -> Result<SavePlan, SaveError> {
        match &self.kind {
            Kind::Gltf(source) => {
                let now: Vec<TakeNow> = adapter
                    .slots()
                    .iter()
                    .map(|slot| TakeNow { origin: slot.origin, take: Arc::clone(&slot.result) })
                    .collect();
                Ok(SavePlan::of(&save::plan(source, &self.model, &now)?))
            }
            Kind::Dfm => {
                let skeleton = Arc::clone(&self.model.animation.skeleton);
                let animation = AnimationData { skeleton, takes: adapter.results().cloned().collect() };
                let bytes = dfm::write(&ModelData { animation, ..ModelData::clone(&self.model) })?;
                Ok(SavePlan { files: vec![OutputFile { name: self.title.clone(), bytes }], changes: None })
            }
        }
    }

    /// What taking away everything that earlier saves left unused will write.
    pub fn compact(&self) -> Result<SavePlan, SaveError> {
        match &self.kind {
            Kind::Gltf(source) => Ok(SavePlan::of(&save::compact(source)?)),
            // Nothing is ever appended to such a file.
            Kind::Dfm => self.plan(&ModelAdapter::new(&self.model.animation)),
        }
    }

    /// Files beside the one that was opened that it needs, as it names them; they go along when it is saved elsewhere.
    pub fn needs(&self) -> Vec<String> {
        match &self.kind {
            Kind::Gltf(source) => source.files_beside(),
            Kind::Dfm => Vec::new(),
        }
    }

    /// The folder that names are relative to.
    pub fn folder(&self) -> Option<&Path> {
        self.path.as_deref().and_then(Path::parent)
    }
}

impl SavePlan {
    fn of(plan: &Plan<'_>) -> Self {
        Self { files: plan.write(), changes: Some(plan.changes().clone()) }
    }
}
