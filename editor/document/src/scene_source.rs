//! Scripts of scenes from files, with the models that they name.

use super::load::load_inside;
use super::scene_lines::SceneLines;
use super::source::LoadError;
use super::text_source::{is_project, read_texts};
use super::{Cancel, Folder};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StageModel, StagePlan};
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

/// Returns whether a file is a script by its name.
pub fn is_script(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("xml"))
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
    let script = StageScript::read_of(Arc::clone(&script.text), project.as_ref()).map_err(wrong)?;
    let mut assets = load_assets(&script, project.as_ref(), &folder, cancel)?.map_err(wrong)?;
    let mut lines = SceneLines::default();
    lines.update(project.as_ref(), &read.texts, &mut assets);
    if !lines.errors.is_empty() {
        let title = project.as_ref().and_then(StageProject::lines).unwrap_or_default().to_owned();
        return Err(SceneLoadError::Script { title, errors: lines.errors.to_vec() });
    }
    let plan = StagePlan::new(&script, &assets).map_err(wrong)?;
    Ok(LoadedScene { title, script, plan })
}

/// Loads each model that a script names, once.
fn load_assets(
    script: &StageScript,
    project: Option<&StageProject>,
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
        let file = project.map_or(&*source.value, |project| project.source_of(&source.value));
        match load_inside(folder, file, cancel) {
            Ok(loaded) => assets.add_model(&*source.value, Arc::new(StageModel::new(loaded.model))),
            Err(LoadError::Cancelled) => return Err(SceneLoadError::Cancelled),
            Err(reason) => {
                let message = match reason {
                    LoadError::Format { reason, .. } => format!("{file}: {reason}"),
                    other => other.to_string(),
                };
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
