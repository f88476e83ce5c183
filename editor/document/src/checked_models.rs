//! The models of a scene that is checked: which of them can be read.

use super::scene_model_source::{ReadFileState, SceneModelSource};
use super::source::LoadError;
use super::{Cancel, Folder, LoadedModel};
use dragonfly_anim::stage::StageAssets;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A model that was read.
pub(super) struct CheckedModel {
    pub(super) source: SceneModelSource,
    pub(super) loaded: Arc<LoadedModel>,
    pub(super) state: ReadFileState,
}

/// Models by the names that scripts give them. One that was read is not read again, one that cannot be read is tried once for each question.
#[derive(Default)]
pub(super) struct CheckedModels {
    read: BTreeMap<String, CheckedModel>,
    /// Those that were looked at for the present question: the reason where one cannot be read.
    tried: BTreeMap<String, Result<(), String>>,
}

impl CheckedModels {
    /// Begins a question: what could not be read before may be there now.
    pub(super) fn begin(&mut self) {
        self.tried.clear();
    }

    /// Returns whether a model was looked at for the present question.
    pub(super) fn is_tried(&self, name: &str) -> bool {
        self.tried.contains_key(name)
    }

    /// Returns the models that were read.
    pub(super) fn read(&self) -> &BTreeMap<String, CheckedModel> {
        &self.read
    }

    /// Reads a model, unless it was read from there before, and adds it to `assets`. Returns the reason where it cannot be read.
    ///
    /// # Errors
    ///
    /// It was cancelled.
    pub(super) fn add(
        &mut self,
        name: &str,
        source: SceneModelSource,
        folder: Result<&Folder, String>,
        assets: &mut StageAssets,
        cancel: &Cancel,
    ) -> Result<Result<(), String>, LoadError> {
        if let Some(known) = self.tried.get(name) {
            return Ok(known.clone());
        }
        let added = self.add_new(name, source, folder, assets, cancel)?;
        self.tried.insert(name.to_owned(), added.clone());
        Ok(added)
    }

    fn add_new(
        &mut self,
        name: &str,
        source: SceneModelSource,
        folder: Result<&Folder, String>,
        assets: &mut StageAssets,
        cancel: &Cancel,
    ) -> Result<Result<(), String>, LoadError> {
        if self.read.get(name).is_some_and(|known| known.source == source) {
            return Ok(Ok(()));
        }
        let read = match folder {
            Ok(folder) => source.read(folder, cancel),
            Err(reason) => return Ok(Err(reason)),
        };
        match read {
            Ok(read) => {
                assets.add_model(name, read.stage);
                let (loaded, state) = (Arc::new(read.loaded), read.state);
                self.read.insert(name.to_owned(), CheckedModel { source, loaded, state });
                Ok(Ok(()))
            }
            Err(LoadError::Cancelled) => Err(LoadError::Cancelled),
            Err(reason) => {
                assets.remove_model(name);
                self.read.remove(name);
                Ok(Err(match reason {
                    LoadError::Format { reason, .. } => format!("{}: {reason}", source.file),
                    other @ (LoadError::File { .. } | LoadError::Cancelled) => other.to_string(),
                }))
            }
        }
    }
}
