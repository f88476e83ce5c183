//! Checks the texts of a scene with everything that they name: the one place for the command line, the protocol and images without a
//! window.

use super::adapter::{TextFile, TextFiles};
use super::project_models::ProjectModels;
use super::project_notes::ProjectNotes;
use super::scene_lines::SceneLines;
use super::scene_model_source::{ReadFileState, SceneModelSource};
use super::sound::SoundSource;
use super::source::LoadError;
use super::text_source::{is_project, read_texts};
use super::{Cancel, Folder, LoadedModel};
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{MOST_BYTES, ScriptElement, ScriptError, StageScript};
use dragonfly_anim::stage::{StageAssets, StagePlan};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
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

/// A scene that is checked: a script, or a project with its scripts. Models and sounds are read once and kept.
pub(super) struct SceneCheck {
    is_project: bool,
    /// The folder of the document; the reason why its files cannot be read where it fails.
    folder: Result<Folder, String>,
    path: PathBuf,
    assets: StageAssets,
    lines: SceneLines,
    models: BTreeMap<String, CheckedModel>,
    /// The sounds that can be read.
    sounds: BTreeSet<String>,
}

/// A model that was read.
pub(super) struct CheckedModel {
    pub(super) source: SceneModelSource,
    pub(super) loaded: Arc<LoadedModel>,
    pub(super) state: ReadFileState,
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
    /// Its plan, if nothing but a sound is wrong.
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
            folder,
            path: path.and_then(Path::parent).map(Path::to_owned).unwrap_or_default(),
            assets,
            lines: SceneLines::default(),
            models: BTreeMap::new(),
            sounds: BTreeSet::new(),
        }
    }

    /// Returns whether the document is a project.
    pub(super) fn is_project(&self) -> bool {
        self.is_project
    }

    /// Returns the models that were read, by the names that scripts give them.
    pub(super) fn models(&self) -> &BTreeMap<String, CheckedModel> {
        &self.models
    }

    /// Checks all texts: that of a project first, then its scripts and its lines.
    ///
    /// # Errors
    ///
    /// It was cancelled.
    pub(super) fn all(&mut self, texts: &TextFiles, cancel: &Cancel) -> Result<Vec<CheckedText>, LoadError> {
        let Some(main) = texts.list().first() else { return Ok(Vec::new()) };
        if !self.is_project {
            return Ok(vec![self.script(main, None, texts, cancel)?.text]);
        }
        let mut own = CheckedText { name: Arc::clone(&main.name), ..CheckedText::default() };
        let project = match StageProject::read(Arc::clone(&main.text)) {
            Ok(project) => project,
            Err(errors) => return Ok(vec![CheckedText { errors, ..own }]),
        };
        self.missing_texts(&project, texts, &mut own.errors);
        let mut checked = Vec::new();
        for file in project.scripts().filter_map(|name| texts.called(name)) {
            if checked.iter().any(|other: &CheckedText| other.name == file.name) {
                continue;
            }
            let script = self.script(file, Some(&project), texts, cancel)?;
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
        own.errors.sort_by_key(|error| error.range.start);
        if let Some(name) = project.lines().filter(|_| !self.lines.errors.is_empty()) {
            let errors = self.lines.errors.to_vec();
            checked.push(CheckedText { name: name.into(), errors, ..CheckedText::default() });
        }
        Ok([own].into_iter().chain(checked).collect())
    }

    /// Checks one script.
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
        let text = CheckedText { name: Arc::clone(&file.name), ..CheckedText::default() };
        let mut checked = CheckedScript { text, ..CheckedScript::default() };
        self.lines.update(project, texts, &mut self.assets);
        let mut errors = Vec::new();
        match StageScript::read_of(Arc::clone(&file.text), project) {
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
                errors.extend(self.read_sounds(&script));
                checked.script = Some(script);
            }
            Err(more) => errors.extend(more),
        }
        errors.sort_by_key(|error| error.range.start);
        (checked.text.errors, checked.shared) = match project {
            Some(project) => project.separated(errors),
            None => (errors, Vec::new()),
        };
        Ok(checked)
    }

    /// Returns what the user should know about the models of a project that were read.
    pub(super) fn notes(&self, project: &StageProject) -> ProjectNotes {
        let read = self.models.iter().map(|(name, model)| (name.as_str(), &model.source, &model.state));
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
            let reason = match read {
                Err(reason) => reason,
                Ok(Err(reason)) => reason.to_string(),
                Ok(Ok(_)) => "is no text in UTF-8, or came after the project was opened".to_owned(),
            };
            errors.push(self.error(
                project.tree().text(),
                element.value_range("src"),
                &format!("{name} {reason}"),
            ));
        }
        if project.scripts().next().is_none() {
            let range = project.tree().elements()[0].name.clone();
            let (message, help) = ("the project has no script", "add <script id=\"main\" src=\"main.xml\"/>");
            errors.push(ScriptError::at(project.tree().text(), range, message, help));
        }
    }

    fn error(&self, text: &str, range: Range<usize>, message: &str) -> ScriptError {
        let of = if self.is_project { "project" } else { "script" };
        ScriptError::at(text, range, message, format!("it names files below the folder of the {of}"))
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
            if self.models.contains_key(id) || self.models.contains_key(file) {
                continue;
            }
            if let Err(reason) = self.read_model(id, Some(&named), texts, cancel)? {
                errors.push(self.error(project.tree().text(), model.value_range("src"), &reason));
            }
        }
        Ok(())
    }

    /// Reads the models that a script names. Returns an error for each that is missing.
    fn read_models(
        &mut self,
        script: &StageScript,
        project: Option<&StageProject>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<Vec<ScriptError>, LoadError> {
        let named = project.map(ProjectModels::of);
        let mut tried: BTreeMap<&str, Range<usize>> = BTreeMap::new();
        for attribute in script.things().filter_map(|thing| thing.attribute("model")) {
            tried.entry(&attribute.value).or_insert_with(|| attribute.value_range.clone());
        }
        let mut errors = Vec::new();
        for (name, range) in tried {
            if let Err(reason) = self.read_model(name, named.as_ref(), texts, cancel)? {
                errors.push(self.error(script.tree().text(), range, &reason));
            }
        }
        Ok(errors)
    }

    /// Reads a model, unless it was read from there before. Returns the reason where it cannot be read.
    fn read_model(
        &mut self,
        name: &str,
        named: Option<&ProjectModels<'_>>,
        texts: &TextFiles,
        cancel: &Cancel,
    ) -> Result<Result<(), String>, LoadError> {
        let source = SceneModelSource::of(name, named, texts);
        if self.models.get(name).is_some_and(|known| known.source == source) {
            return Ok(Ok(()));
        }
        let read = match &self.folder {
            Ok(folder) => source.read(folder, cancel),
            Err(reason) => return Ok(Err(reason.clone())),
        };
        match read {
            Ok(read) => {
                self.assets.add_model(name, read.stage);
                let (loaded, state) = (Arc::new(read.loaded), read.state);
                self.models.insert(name.to_owned(), CheckedModel { source, loaded, state });
                Ok(Ok(()))
            }
            Err(LoadError::Cancelled) => Err(LoadError::Cancelled),
            Err(reason) => {
                self.assets.remove_model(name);
                self.models.remove(name);
                Ok(Err(match reason {
                    LoadError::Format { reason, .. } => format!("{}: {reason}", source.file),
                    other => other.to_string(),
                }))
            }
        }
    }

    /// Returns an error for each sound that cannot be read.
    fn read_sounds(&mut self, script: &StageScript) -> Vec<ScriptError> {
        let is_sound = |element: &&ScriptElement| element.row.name == "sound";
        let mut errors = Vec::new();
        for element in script.tree().elements().iter().filter(is_sound) {
            let Some(name) = element.value("src").filter(|name| !self.sounds.contains(*name)) else {
                continue;
            };
            match (SoundSource::Below { folder: self.path.clone(), name: name.to_owned() }).check() {
                Ok(()) => drop(self.sounds.insert(name.to_owned())),
                Err(reason) => {
                    errors.push(self.error(script.tree().text(), element.value_range("src"), &reason));
                }
            }
        }
        errors
    }
}
