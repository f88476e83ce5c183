//! Checks the texts of a scene with everything that they name: the one place for the command line, the protocol and images without a
//! window.

use super::adapter::{TextFile, TextFiles};
use super::checked_models::{CheckedModel, CheckedModels};
use super::checked_sounds::CheckedSounds;
use super::project_models::ProjectModels;
use super::project_notes::ProjectNotes;
use super::scene_includes::read_includes;
use super::scene_lines::SceneLines;
use super::scene_model_source::SceneModelSource;
use super::source::LoadError;
use super::text_source::{is_project, read_texts, text_of};
use super::{Cancel, Folder};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{
    MOST_BYTES, MOST_ERRORS, ScriptContext, ScriptError, ScriptTree, StageScript,
};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// A text of a scene, with everything that is wrong in it.
#[derive(Clone, Debug, Default)]
pub struct CheckedText {
    /// Its name, relative to the folder of the document.
    pub name: Arc<str>,
    /// Its errors, in the order of the text.
    pub errors: Vec<ScriptError>,
    /// Edits of models that are not applied to them, in the order of the text.
    pub unfit: Vec<ScriptError>,
    /// Notes about things that are probably not meant, in the order of the text.
    pub notes: Vec<ScriptError>,
}

/// A project, or what is wrong with its text.
type ReadProject = Result<StageProject, Vec<ScriptError>>;

/// A scene that is checked: a script, or a project with its scripts. Models are read once and kept; what cannot be read is tried once for each
/// question.
pub(super) struct SceneCheck {
    is_project: bool,
    /// The text of the project that was read last, and what it has.
    project: Option<(Arc<str>, ReadProject)>,
    /// The folder of the document; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    assets: StageAssets,
    lines: SceneLines,
    models: CheckedModels,
    sounds: CheckedSounds,
}

/// A script that was checked.
#[derive(Default)]
pub(super) struct CheckedScript {
    /// Its own text, with its errors and notes.
    pub(super) text: CheckedText,
    /// The errors of the cast that it shares with its project, with the places in the text of the project.
    pub(super) shared: Vec<ScriptError>,
    /// The script, if it can be read.
    pub(super) script: Option<StageScript>,
    /// Its plan, if nothing is wrong; sounds do not matter for it.
    pub(super) plan: Option<StagePlan>,
}

/// Checks the script or the project at `path`: all its texts, models, lines and sounds. Files are read only from its folder and below.
///
/// # Errors
///
/// The file itself cannot be read, or it was cancelled.
pub fn check_scene(path: &Path, cancel: &Cancel) -> Result<Vec<CheckedText>, LoadError> {
    let read = read_texts(path)?;
    SceneCheck::of(Some(path)).all(&read.texts, cancel)
}

impl SceneCheck {
    /// Begins to check the script or project at `path`.
    pub(super) fn of(path: Option<&Path>) -> Self {
        let folder = path.ok_or_else(|| "the document has no file".to_owned());
        let folder = folder.and_then(|path| Folder::of(path).map_err(|error| error.to_string()));
        // Each missing model has its own error.
        let mut assets = StageAssets::default();
        assets.allow_missing_models();
        Self {
            is_project: path.is_some_and(is_project),
            project: None,
            folder,
            assets,
            lines: SceneLines::default(),
            models: CheckedModels::default(),
            sounds: CheckedSounds::new(path.and_then(Path::parent)),
        }
    }

    /// Returns whether the document is a project.
    pub(super) fn is_project(&self) -> bool {
        self.is_project
    }

    /// Returns the project, which is read when its text is another one; `None` for a script alone.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub(super) fn project(&mut self, texts: &TextFiles) -> Result<Option<StageProject>, Vec<ScriptError>> {
        let Some(main) = texts.main().filter(|_| self.is_project) else { return Ok(None) };
        let known = self.project.take().filter(|(text, _)| text == main);
        let read = || (Arc::clone(main), StageProject::read(Arc::clone(main)));
        self.project.insert(known.unwrap_or_else(read)).1.clone().map(Some)
    }

    /// Returns the models that were read, by the names that scripts give them.
    pub(super) fn models(&self) -> &BTreeMap<String, CheckedModel> {
        self.models.read()
    }

    /// Checks all texts with their sounds: that of a project first, then its scripts and its lines. Each has at most [`MOST_ERRORS`].
    ///
    /// # Errors
    ///
    /// It was cancelled.
    pub(super) fn all(&mut self, texts: &TextFiles, cancel: &Cancel) -> Result<Vec<CheckedText>, LoadError> {
        let Some(main) = texts.list().first() else { return Ok(Vec::new()) };
        self.begin();
        let mut own = CheckedText { name: Arc::clone(&main.name), ..CheckedText::default() };
        let project = match self.project(texts) {
            Ok(Some(project)) => project,
            Ok(None) => return Ok(vec![self.with_sounds(main, None, texts, cancel)?.text]),
            Err(errors) => return Ok(vec![CheckedText { errors, ..own }]),
        };
        self.missing_texts(&project, texts, &mut own.errors);
        // Also where no script can be read.
        self.lines.update(Some(&project), texts, &mut self.assets);
        let mut checked = Vec::new();
        for file in project.scripts().filter_map(|name| texts.called(name)) {
            if checked.iter().any(|other: &CheckedText| other.name == file.name) {
                continue;
            }
            let script = self.with_sounds(file, Some(&project), texts, cancel)?;
            for error in script.shared {
                // Each script finds the same errors of the shared cast.
                if !own.errors.contains(&error) {
                    own.errors.push(error);
                }
            }
            checked.push(script.text);
        }
        self.unused_models(&project, texts, cancel, &mut own.errors)?;
        let notes = self.notes(&project);
        (own.unfit, own.notes) = (notes.unfit, notes.changed);
        own.errors = limited(own.errors);
        if let Some(name) = project.lines().filter(|_| !self.lines.errors.is_empty()) {
            let errors = self.lines.errors.to_vec();
            checked.push(CheckedText { name: name.into(), errors, ..CheckedText::default() });
        }
        Ok([own].into_iter().chain(checked).collect())
    }

    /// Checks one script, without its sounds.
    ///
    /// # Errors
    ///
    /// It was cancelled.
    pub(super) fn script(
        &mut self,
        file: &TextFile,
        project: Option<&StageProject>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<CheckedScript, LoadError> {
        self.begin();
        self.without_sounds(file, project, texts, cancel)
    }

    /// Begins a question: what could not be read before may be there now.
    fn begin(&mut self) {
        self.models.begin();
        self.sounds.begin();
    }

    fn with_sounds(
        &mut self,
        file: &TextFile,
        project: Option<&StageProject>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<CheckedScript, LoadError> {
        let mut checked = self.without_sounds(file, project, texts, cancel)?;
        if let Some(script) = &checked.script {
            let (own, shared) = separated(project, self.sound_errors(script, cancel)?);
            checked.text.errors.extend(own);
            checked.shared.extend(shared);
            checked.text.errors = limited(checked.text.errors);
        }
        Ok(checked)
    }

    fn without_sounds(
        &mut self,
        file: &TextFile,
        project: Option<&StageProject>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<CheckedScript, LoadError> {
        let text = CheckedText { name: Arc::clone(&file.name), ..CheckedText::default() };
        let mut checked = CheckedScript { text, ..CheckedScript::default() };
        self.lines.update(project, texts, &mut self.assets);
        let mut errors = Vec::new();
        let folder = self.folder.as_ref().map_err(Clone::clone);
        let context = ScriptContext {
            name: Arc::clone(&file.name),
            project: project.cloned(),
            files: read_includes((&file.name, &file.text), texts, folder, cancel),
        };
        if cancel.is_cancelled() {
            return Err(LoadError::Cancelled);
        }
        match StageScript::read_in(Arc::clone(&file.text), &context) {
            Ok(script) => {
                errors = self.read_models(&script, project, texts, cancel)?;
                match StagePlan::new(&script, &self.assets) {
                    Ok(plan) if errors.is_empty() && self.lines.errors.is_empty() => {
                        checked.text.notes = plan.schedule().notes().to_vec();
                        checked.plan = Some(plan);
                    }
                    Ok(_) => {}
                    Err(more) => errors.extend(more),
                }
                checked.script = Some(script);
            }
            Err(more) => errors.extend(more),
        }
        (checked.text.errors, checked.shared) = separated(project, limited(errors));
        Ok(checked)
    }

    /// Returns what the user should know about the models of a project that were read.
    pub(super) fn notes(&self, project: &StageProject) -> ProjectNotes {
        let read =
            self.models.read().iter().map(|(name, model)| (name.as_str(), &model.source, &model.state));
        ProjectNotes::of(project, &ProjectModels::of(project), read)
    }

    /// Returns the lines of the project.
    pub(super) fn lines(&self) -> &SceneLines {
        &self.lines
    }

    /// Reports the texts that a project names and that are missing.
    fn missing_texts(&self, project: &StageProject, texts: &TextFiles, errors: &mut Vec<ScriptError>) {
        let named = ["script", "lines", "edits"].into_iter().flat_map(|name| project.elements_called(name));
        for element in named {
            let Some(name) = element.value("src").filter(|name| texts.called(name).is_none()) else {
                continue;
            };
            let read =
                self.folder.as_ref().map_err(Clone::clone).map(|folder| folder.read(name, MOST_BYTES as u64));
            let message = match read {
                Err(reason) => format!("{name} {reason}"),
                Ok(Err(reason)) => format!("{name} {reason}"),
                Ok(Ok(bytes)) => match text_of(bytes) {
                    Ok(_) => format!("{name} was not there when the project was opened; open it again"),
                    Err(reason) => format!("{name}:{reason}"),
                },
            };
            errors.push(self.error(project.tree(), element.value_range("src"), name, message));
        }
        if project.scripts().next().is_none() {
            let range = project.tree().elements()[0].name.clone();
            let (message, help) = ("the project has no script", "add <script id=\"main\" src=\"main.xml\"/>");
            errors.push(project.tree().error(range, message, help));
        }
    }

    /// Returns an error about `file`, which the bytes `range` name; with help where the file is not found.
    fn error(&self, tree: &ScriptTree, range: Range<usize>, file: &str, message: String) -> ScriptError {
        let of = if self.is_project { "project" } else { "script" };
        let help = match self.folder.as_ref().is_ok_and(|folder| folder.path_of(file).is_ok()) {
            true => String::new(),
            false => {
                format!("files are named relative to the folder of the {of}, and are in it or below it")
            }
        };
        tree.error(range, message, help)
    }

    /// Returns an error for each place that names a sound which cannot be read, in the order of the text: at most [`MOST_ERRORS`].
    fn sound_errors(&mut self, script: &StageScript, cancel: &Cancel) -> Result<Vec<ScriptError>, LoadError> {
        let mut errors = Vec::new();
        for element in script.tree().elements().iter().filter(|element| element.row.name == "sound") {
            if errors.len() >= MOST_ERRORS {
                break;
            }
            let Some(name) = element.value("src") else { continue };
            if let Err(reason) = self.sounds.check(name, cancel)? {
                let error = self.error(script.tree(), element.value_range("src"), name, reason);
                // A file that is included often has it once.
                if !errors.contains(&error) {
                    errors.push(error);
                }
            }
        }
        Ok(errors)
    }

    /// Reads the models of a project that no script uses. Reports those that are missing.
    fn unused_models(
        &mut self,
        project: &StageProject,
        texts: &TextFiles,
        cancel: &Cancel,
        errors: &mut Vec<ScriptError>,
    ) -> Result<(), LoadError> {
        let named = ProjectModels::of(project);
        for model in project.elements_called("model") {
            let (Some(id), Some(file)) = (model.value("id"), model.value("src")) else { continue };
            // One that a script uses is reported there.
            if self.models.is_tried(id) || self.models.is_tried(file) {
                continue;
            }
            if errors.len() >= MOST_ERRORS {
                break;
            }
            if let Err(reason) = self.read_model(id, Some(&named), texts, cancel)? {
                errors.push(self.error(project.tree(), model.value_range("src"), file, reason));
            }
        }
        Ok(())
    }

    fn read_model(
        &mut self,
        name: &str,
        models: Option<&ProjectModels<'_>>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<Result<(), String>, LoadError> {
        let source = SceneModelSource::of(name, models, texts);
        let folder = self.folder.as_ref().map_err(Clone::clone);
        self.models.add(name, source, folder, &mut self.assets, cancel)
    }

    /// Reads the models that a script names. Returns an error for each that is missing.
    fn read_models(
        &mut self,
        script: &StageScript,
        project: Option<&StageProject>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<Vec<ScriptError>, LoadError> {
        let models = project.map(ProjectModels::of);
        let mut named: BTreeMap<&str, Range<usize>> = BTreeMap::new();
        for attribute in script.things().filter_map(|thing| thing.attribute("model")) {
            named.entry(&attribute.value).or_insert_with(|| attribute.value_range.clone());
        }
        let mut errors = Vec::new();
        for (name, range) in named {
            if errors.len() >= MOST_ERRORS {
                break;
            }
            if let Err(reason) = self.read_model(name, models.as_ref(), texts, cancel)? {
                let file = project.map_or(name, |project| project.source_of(name));
                errors.push(self.error(script.tree(), range, file, reason));
            }
        }
        Ok(errors)
    }
}

/// Separates errors of the text of a script from those of the cast that it shares with its project.
fn separated(
    project: Option<&StageProject>,
    errors: Vec<ScriptError>,
) -> (Vec<ScriptError>, Vec<ScriptError>) {
    match project {
        Some(project) => project.separated(errors),
        None => (errors, Vec::new()),
    }
}

/// Returns errors in the order of the text: those at which a user looks.
fn limited(mut errors: Vec<ScriptError>) -> Vec<ScriptError> {
    errors.sort_by_key(|error| error.range.start);
    errors.truncate(MOST_ERRORS);
    errors
}
