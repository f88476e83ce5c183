//! Scripts of scenes from files, with the models that they name.

use super::Cancel;
use super::checked_models::CheckedModel;
use super::scene_check::{CheckedScript, CheckedText, SceneCheck};
use super::scene_lines::SceneLines;
use super::scene_view::{SceneModel, SceneView};
use super::source::LoadError;
use super::text_source::{first_script, read_texts};
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::StageScript;
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
    lines: Option<Arc<DrawnLines>>,
    project: Option<Arc<StageProject>>,
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
            lines: self.lines.clone(),
            project: self.project.clone(),
            ..SceneView::default()
        }
    }
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
    /// The project has no script of this name.
    #[error("{title}: no script is called \"{script}\"; there is {}", .ids.join(", "))]
    NoSuchScript {
        /// Name of the project's file.
        title: String,
        /// The name that was given.
        script: String,
        /// The ids of its scripts.
        ids: Vec<String>,
    },
    /// A script was chosen, and the file is no project.
    #[error("{0}: only a project (.meproj) has several scripts to choose from")]
    NoProject(String),
    /// A text, or something that it names, is wrong.
    #[error("{}", listed(.0))]
    Wrong(Vec<CheckedText>),
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// Returns the errors, a line each: `FILE:LINE:COLUMN: MESSAGE`.
fn listed(texts: &[CheckedText]) -> String {
    let of =
        |text: &CheckedText| text.errors.iter().map(|error| error.in_file(&text.name)).collect::<Vec<_>>();
    texts.iter().flat_map(of).collect::<Vec<_>>().join("\n")
}

/// Reads a script, or of a project the one called `script` (an id or a file; the first one without it), and the models that it names. Files
/// are read only from its folder and below.
///
/// # Errors
///
/// A text cannot be read, something in it or in its models is wrong, or no script of a project is called so.
pub fn load_scene(path: &Path, script: Option<&str>, cancel: &Cancel) -> Result<LoadedScene, SceneLoadError> {
    let read = read_texts(path)?;
    let mut check = SceneCheck::of(Some(path));
    let main = read.texts.list().first().ok_or(SceneLoadError::NoScript)?;
    let wrong =
        |name: &Arc<str>, errors| CheckedText { name: Arc::clone(name), errors, ..CheckedText::default() };
    let project = check.project(&read.texts);
    let project = project.map_err(|errors| SceneLoadError::Wrong(vec![wrong(&main.name, errors)]))?;
    let chosen = match (script, &project) {
        (None, _) => first_script(project.as_ref(), &read.texts),
        (Some(script), Some(project)) => {
            let file = project.script_called(script).map_err(|ids| {
                let (title, script) = (main.name.to_string(), script.to_owned());
                SceneLoadError::NoSuchScript {
                    title,
                    script,
                    ids: ids.into_iter().map(str::to_owned).collect(),
                }
            })?;
            read.texts.called(file)
        }
        (Some(_), None) => return Err(SceneLoadError::NoProject(main.name.to_string())),
    };
    // A script that could not be read has its reason.
    let file = chosen.ok_or_else(|| match &*read.warnings {
        [] => SceneLoadError::NoScript,
        warnings => SceneLoadError::Unread(warnings.join("\n")),
    })?;
    let CheckedScript { text, shared, script, plan } =
        check.script(file, project.as_ref(), &read.texts, cancel).map_err(SceneLoadError::of)?;
    let SceneLines { lines, errors: line_errors, .. } = check.lines().clone();
    let Some((script, plan)) = script.zip(plan) else {
        let lines: Arc<str> = project.as_ref().and_then(StageProject::lines).unwrap_or_default().into();
        let texts = [wrong(&main.name, shared), text, wrong(&lines, line_errors.to_vec())];
        return Err(SceneLoadError::Wrong(texts.into()));
    };
    let unfit = project.as_ref().map(|project| check.notes(project).unfit).unwrap_or_default();
    let model = |(name, model): (&String, &CheckedModel)| {
        (name.clone(), SceneModel::Loaded(Arc::clone(&model.loaded)))
    };
    Ok(LoadedScene {
        title: text.name.to_string(),
        script,
        plan,
        warnings: unfit.into_iter().map(|note| note.message).collect(),
        models: Arc::new(check.models().iter().map(model).collect()),
        lines,
        project: project.map(Arc::new),
    })
}

impl SceneLoadError {
    fn of(error: LoadError) -> Self {
        match error {
            LoadError::Cancelled => Self::Cancelled,
            other => Self::Text(other),
        }
    }
}
