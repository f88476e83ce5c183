//! Scripts of scenes from files, with the models that they name.

use super::adapter::TextFiles;
use super::project_models::ProjectModels;
use super::scene_includes::read_includes;
use super::scene_lines::SceneLines;
use super::scene_model_source::SceneModelSource;
use super::scene_view::{SceneModel, SceneView};
use super::source::LoadError;
use super::text_source::{is_project, read_texts};
use super::{Cancel, Folder};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use std::collections::BTreeMap;
use std::path::Path;
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
    /// Edits of models that the project keeps and that were not applied to them, a sentence for each model.
    pub warnings: Vec<String>,
    models: Arc<BTreeMap<String, SceneModel>>,
}

impl LoadedScene {
    /// Returns the scene as it is drawn.
    pub fn view(&self) -> SceneView {
        SceneView {
            text: Arc::clone(self.script.tree().text()),
            name: self.title.as_str().into(),
            script: Some(Arc::new(self.script.clone())),
            plan: Some(Arc::new(self.plan.clone())),
            models: Arc::clone(&self.models),
            ..SceneView::default()
        }
    }
}

/// The models of a scene, and what the user should know about them.
#[derive(Default)]
struct SceneAssets {
    assets: StageAssets,
    models: BTreeMap<String, SceneModel>,
    warnings: Vec<String>,
}

/// The reason why a scene cannot be shown.
#[derive(Debug, Error)]
pub enum SceneLoadError {
    /// A text cannot be read.
    #[error(transparent)]
    Text(#[from] LoadError),
    /// The scripts of a project cannot be read, a line each.
    #[error("{0}")]
    Unread(String),
    /// The project has no script.
    #[error("the project has no <script>")]
    NoScript,
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

/// Reads a script, or the first script of a project, and the models that it names. Files are read only from its folder and below.
///
/// # Errors
///
/// A text cannot be read, or something in it or in its models is wrong.
pub fn load_scene(path: &Path, cancel: &Cancel) -> Result<LoadedScene, SceneLoadError> {
    let read = read_texts(path)?;
    let folder = Folder::of(path).map_err(|reason| LoadError::File { path: path.to_owned(), reason })?;
    let Some((main, others)) = read.texts.list().split_first() else { return Err(SceneLoadError::NoScript) };
    let (mut script, mut project) = (main, None);
    if is_project(path) {
        let title = main.name.to_string();
        let found = StageProject::read(Arc::clone(&main.text))
            .map_err(|errors| SceneLoadError::Script { title, errors })?;
        let own = found.scripts().find_map(|name| others.iter().find(|file| *file.name == *name));
        // A script that could not be read has its reason.
        script = own.ok_or_else(|| match &*read.warnings {
            [] => SceneLoadError::NoScript,
            warnings => SceneLoadError::Unread(warnings.join("\n")),
        })?;
        project = Some(found);
    }
    let title = script.name.to_string();
    let wrong = |errors| SceneLoadError::Script { title: title.clone(), errors };
    let context = ScriptContext {
        name: Arc::clone(&script.name),
        project: project.clone(),
        files: read_includes((&script.name, &script.text), &read.texts, Ok(&folder)),
    };
    let script = StageScript::read_in(Arc::clone(&script.text), &context).map_err(wrong)?;
    let found = load_assets(&script, project.as_ref(), &read.texts, &folder, cancel)?.map_err(wrong)?;
    let SceneAssets { mut assets, models, warnings } = found;
    let mut lines = SceneLines::default();
    lines.update(project.as_ref(), &read.texts, &mut assets);
    if !lines.errors.is_empty() {
        let title = project.as_ref().and_then(StageProject::lines).unwrap_or_default().to_owned();
        return Err(SceneLoadError::Script { title, errors: lines.errors.to_vec() });
    }
    let plan = StagePlan::new(&script, &assets).map_err(wrong)?;
    Ok(LoadedScene { title, script, plan, warnings, models: Arc::new(models) })
}

/// Loads each model that a script names, once.
fn load_assets(
    script: &StageScript,
    project: Option<&StageProject>,
    texts: &TextFiles,
    folder: &Folder,
    cancel: &Cancel,
) -> Result<Result<SceneAssets, Vec<ScriptError>>, SceneLoadError> {
    let (mut found, mut errors) = (SceneAssets::default(), Vec::new());
    let named = project.map(ProjectModels::of);
    for source in script.things().filter_map(|thing| thing.attribute("model")) {
        if cancel.is_cancelled() {
            return Err(SceneLoadError::Cancelled);
        }
        if found.assets.model(&source.value).is_some() {
            continue;
        }
        let origin = SceneModelSource::of(&source.value, named.as_ref(), texts);
        match origin.read(folder, cancel) {
            Ok(read) => {
                found.warnings.extend(read.state.unfit);
                found.assets.add_model(&*source.value, read.stage);
                found.models.insert(source.value.to_string(), SceneModel::Loaded(Arc::new(read.loaded)));
            }
            Err(LoadError::Cancelled) => return Err(SceneLoadError::Cancelled),
            Err(reason) => {
                let message = match reason {
                    LoadError::Format { reason, .. } => format!("{}: {reason}", origin.file),
                    other => other.to_string(),
                };
                let help = "models are files below the folder of the script";
                errors.push(script.tree().error(source.value_range.clone(), message, help));
            }
        }
    }
    Ok(if errors.is_empty() { Ok(found) } else { Err(errors) })
}
