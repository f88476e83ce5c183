//! Scripts of scenes from files, with the models that they name.

use super::images::ImageSurvey;
use super::import::{self, ImportDoor};
use super::scene_view::{SceneModel, SceneView};
use super::source::{LoadError, file_name};
use super::{Cancel, FileAccessError, Folder, LoadedModel, read_file};
use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{Conventions, Conversion};
use dragonfly_anim::limits::{FILE_BYTES, MEMORY_MAX};
use dragonfly_anim::stage::script::{MOST_BYTES, ScriptAttribute, ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// A scene that can be shown at any time.
#[derive(Clone, Debug)]
pub struct LoadedScene {
    /// Name of the script's file.
    pub title: String,
    /// The script.
    pub script: StageScript,
    /// Its plan, with the models.
    pub plan: StagePlan,
}

impl LoadedScene {
    /// Returns the scene as it is drawn, with the images of its models. Stops early, without the rest of the images, when `cancel` is raised.
    pub fn view(&self, cancel: &Cancel) -> SceneView {
        let mut models = BTreeMap::new();
        for (element, thing) in self.script.things().zip(self.plan.things()) {
            if let (Some(source), Some(model)) = (element.value("model"), &thing.model) {
                models
                    .entry(source.to_owned())
                    .or_insert_with(|| SceneModel::Loaded(Arc::new(drawn(source, model.data(), cancel))));
            }
        }
        SceneView {
            text: Arc::clone(self.script.tree().text()),
            script: Some(Arc::new(self.script.clone())),
            plan: Some(Arc::new(self.plan.clone())),
            errors: Arc::default(),
            models: Arc::new(models),
        }
    }
}

/// Returns a model of a scene as it is drawn, at rest.
fn drawn(source: &str, model: &Arc<ModelData>, cancel: &Cancel) -> LoadedModel {
    let (images, warnings) = ImageSurvey::new(&model.images, MEMORY_MAX, cancel);
    LoadedModel {
        title: file_name(Path::new(source)),
        path: None,
        format: None,
        conversion: Conversion::default(),
        bounds: bounds_of_pose(model, None, 0.0),
        model: Arc::clone(model),
        images,
        warnings,
        notes: Vec::new(),
    }
}

/// The reason why a scene cannot be shown.
#[derive(Debug, Error)]
pub enum SceneLoadError {
    /// The script's file cannot be read.
    #[error("{}: {reason}", path.display())]
    File {
        /// The path.
        path: PathBuf,
        /// The reason.
        reason: FileAccessError,
    },
    /// The script, or a model that it names, is wrong.
    #[error("{}", listed(title, errors))]
    Script {
        /// Name of the script's file.
        title: String,
        /// Everything that is wrong, in the order of the text; at least one.
        errors: Vec<ScriptError>,
    },
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Returns the errors, a line each: `FILE:LINE:COLUMN: MESSAGE`.
fn listed(title: &str, errors: &[ScriptError]) -> String {
    errors.iter().map(|error| error.in_file(title)).collect::<Vec<_>>().join("\n")
}

/// Returns whether a file is a script by its name.
pub fn is_script(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
}

/// Reads a script and the models that it names. Files are read only from the folder of the script and below.
///
/// # Errors
///
/// The script cannot be read, or something in it or in its models is wrong.
pub fn load_scene(path: &Path, cancel: &Cancel) -> Result<LoadedScene, SceneLoadError> {
    let title = file_name(path);
    let unread = |reason| SceneLoadError::File { path: path.to_path_buf(), reason };
    let bytes = read_file(path, MOST_BYTES as u64).map_err(unread)?;
    let folder = Folder::of(path).map_err(unread)?;
    let wrong = |errors| SceneLoadError::Script { title: title.clone(), errors };
    let script = StageScript::read(text(bytes).map_err(wrong)?).map_err(wrong)?;
    let assets = load_assets(&script, &folder, cancel)?.map_err(wrong)?;
    let plan = StagePlan::new(&script, &assets).map_err(wrong)?;
    Ok(LoadedScene { title, script, plan })
}

/// Returns the text of a file.
fn text(bytes: Vec<u8>) -> Result<String, Vec<ScriptError>> {
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let before = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
        // The part before is read only for its lines.
        vec![ScriptError::at(&before, at..at, "this is not UTF-8 text", "save the file as UTF-8")]
    })
}

/// Loads each model that a script names, once.
fn load_assets(
    script: &StageScript,
    folder: &Folder,
    cancel: &Cancel,
) -> Result<Result<StageAssets, Vec<ScriptError>>, SceneLoadError> {
    let (mut assets, mut errors) = (StageAssets::default(), Vec::new());
    for source in script.things().filter_map(|thing| thing.attribute("model")) {
        if cancel.is_cancelled() {
            return Err(SceneLoadError::Cancelled);
        }
        if assets.model(&source.value).is_some() {
            continue;
        }
        match load(source, folder, cancel) {
            Ok(model) => assets.add_model(&*source.value, Arc::new(model)),
            Err(None) => return Err(SceneLoadError::Cancelled),
            Err(Some(reason)) => {
                let message = format!("{}: {reason}", source.value);
                errors.push(ScriptError::at(
                    script.tree().text(),
                    source.value_range.clone(),
                    message,
                    "models are files below the folder of the script",
                ));
            }
        }
    }
    Ok(if errors.is_empty() { Ok(assets) } else { Err(errors) })
}

/// Loads a model. The error has a reason, or none where loading was cancelled.
fn load(source: &ScriptAttribute, folder: &Folder, cancel: &Cancel) -> Result<StageModel, Option<String>> {
    let reason = |error: FileAccessError| Some(error.to_string());
    let path = folder.path_of(&source.value).map_err(reason)?;
    let bytes = folder.read(&source.value, FILE_BYTES).map_err(reason)?;
    let beside = Folder::of(&path).map_err(reason)?;
    let door = ImportDoor { files: &beside, conventions: Conventions::default() };
    match import::read(&file_name(&path), &bytes, door, &|_| {}, cancel) {
        Ok(imported) => Ok(StageModel::new(Arc::new(imported.model))),
        Err(LoadError::Cancelled) => Err(None),
        Err(LoadError::Format { reason, .. }) => Err(Some(reason)),
        Err(error @ LoadError::File { .. }) => Err(Some(error.to_string())),
    }
}
