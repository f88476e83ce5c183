//! The published state of a scene: its script, what plays, and the models of its things.

use super::LoadedModel;
use super::adapter::TextFiles;
use super::outdated_edits::OutdatedEdits;
use dragonfly_anim::stage::StagePlan;
use dragonfly_anim::stage::line::DrawnLines;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{IncludedScripts, ScriptError, StageScript};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The newest state of a scene. Nothing changes it.
#[derive(Clone, Debug, Default)]
pub struct SceneView {
    /// The newest text of the script.
    pub text: Arc<str>,
    /// Name of the script's file among the texts of the document, as edits of it name it.
    pub name: Arc<str>,
    /// All texts of the document: the script alone, or the files of a project.
    pub texts: TextFiles,
    /// The project of its last text without errors; `None` for a script that is open alone.
    pub project: Option<Arc<StageProject>>,
    /// The errors of the newest text of the project, in its order.
    pub project_errors: Arc<[ScriptError]>,
    /// The errors that the script finds in the cast of the project, in the order of the project's text.
    pub shared_errors: Arc<[ScriptError]>,
    /// Notes for the user about the models of the project, in the order of its text: files that changed since their edits were
    /// made, edits that do not fit.
    pub project_notes: Arc<[ScriptError]>,
    /// The edits that the project keeps and that are not applied, because the files of their models changed since they were made.
    pub outdated: Arc<[OutdatedEdits]>,
    /// The drawn lines of a project, as they were in the last text of them without errors; `None` without such a file.
    pub lines: Option<Arc<DrawnLines>>,
    /// The errors of the newest text of the lines, in its order.
    pub line_errors: Arc<[ScriptError]>,
    /// The files that the script includes, as far as they were read.
    pub includes: IncludedScripts,
    /// The script of the last text without errors; `None` before the first one. While [`Self::errors`] has some, its ranges are those of an
    /// older text.
    pub script: Option<Arc<StageScript>>,
    /// The plan of that script, which plays.
    pub plan: Option<Arc<StagePlan>>,
    /// The errors of [`Self::text`], in its order; empty if `script` and `plan` are those of this text.
    pub errors: Arc<[ScriptError]>,
    /// Notes for the user about the scene that plays, in the order of its text: models that are missing, ends before begins.
    pub notes: Arc<[ScriptError]>,
    /// The models, by the text with which the script names them.
    pub models: Arc<BTreeMap<String, SceneModel>>,
}

/// A model that a script names.
#[derive(Clone, Debug)]
pub enum SceneModel {
    /// It is being read.
    Loading,
    /// It was read. Views of a scene share it until it changes.
    Loaded(Arc<LoadedModel>),
    /// It is not there or cannot be read, for this reason. What needs it is shown as a placeholder.
    Missing(String),
}

impl SceneView {
    /// Returns the height of the ground in meters.
    pub fn ground(&self) -> f64 {
        self.script.as_ref().map_or(0.0, |script| script.ground())
    }

    /// Returns whether the scene is one of a project, also of one whose first text had errors.
    pub fn is_of_project(&self) -> bool {
        self.texts.list().first().is_some_and(|main| main.name != self.name)
    }

    /// Returns the first error of the newest texts of the script and its project, after the name of the file, its line and column; `None` if they have none.
    pub fn first_error(&self) -> Option<String> {
        let main = self.texts.list().first().map_or("", |main| &*main.name);
        let texts = [(&self.errors, &*self.name), (&self.project_errors, main), (&self.shared_errors, main)];
        texts.into_iter().find_map(|(errors, name)| errors.first().map(|error| error.in_file(name)))
    }

    /// Returns whether what plays is the newest text, with the cast of the newest project.
    pub fn is_current(&self) -> bool {
        let wrong = [&self.errors, &self.shared_errors, &self.project_errors];
        wrong.into_iter().all(|errors| errors.is_empty()) && self.plan.is_some()
    }
}
