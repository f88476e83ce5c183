//! Finds the files that a project, or the script of a scene, needs: those that its texts name, and those that its models need themselves.

use super::adapter::{TextFile, TextFiles};
use super::import::{self, ImportDoor};
use super::scene_includes::read_includes;
use super::source::file_name;
use super::{Cancel, FileAccessError, Folder};
use dragonfly_anim::format::{AssetError, AssetFs, Conventions};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_anim::stage::project::StageProject;
use dragonfly_anim::stage::script::{ScriptContext, ScriptElement, ScriptTree, StageScript};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// The files that texts need, by names relative to the folder of the main one. The texts themselves may be among them.
#[derive(Debug, Default)]
pub(super) struct NeededFiles {
    /// Their names, also of those that are missing.
    pub(super) names: BTreeSet<String>,
    /// Reasons why there may be more: texts and models with errors, a sentence each.
    pub(super) reasons: Vec<String>,
}

impl NeededFiles {
    /// Finds the files that `texts`, a project with its scripts or a script alone, need in `folder`. Reads each model to know what it needs;
    /// `progress` is called after each with the fraction of the models that were read.
    pub(super) fn of(
        texts: &TextFiles,
        is_project: bool,
        folder: &Folder,
        cancel: &Cancel,
        progress: &dyn Fn(f32),
    ) -> Self {
        let (mut found, models) = Self::listed(texts, is_project, folder, cancel);
        for (read, name) in models.iter().enumerate() {
            if cancel.is_cancelled() {
                break;
            }
            found.add_files_of(name, folder, cancel);
            progress((read + 1) as f32 / models.len() as f32);
        }
        found
    }

    /// Finds the files that `texts` name themselves. Reads no model.
    pub(super) fn named(texts: &TextFiles, is_project: bool, folder: &Folder, cancel: &Cancel) -> Self {
        Self::listed(texts, is_project, folder, cancel).0
    }

    /// Returns the files that `texts` name, and the models among them.
    fn listed(
        texts: &TextFiles,
        is_project: bool,
        folder: &Folder,
        cancel: &Cancel,
    ) -> (Self, BTreeSet<String>) {
        let mut search = FileSearch { folder, cancel, found: Self::default(), models: BTreeSet::new() };
        search.of_texts(texts, is_project);
        let FileSearch { mut found, models, .. } = search;
        found.names.extend(models.iter().cloned());
        (found, models)
    }

    /// Adds the files that a model of `folder` needs.
    fn add_files_of(&mut self, name: &str, folder: &Folder, cancel: &Cancel) {
        // A missing model is found when it is copied.
        let Ok(path) = folder.path_of(name) else { return };
        let Ok(bytes) = folder.read(name, FILE_BYTES) else { return };
        let Ok(Self { names, reasons }) = Self::of_model(&path, &bytes, cancel) else { return };
        let inside = name.rsplit_once('/').map_or("", |(folder, _)| folder);
        self.names.extend(names.iter().map(|own| below(inside, own)));
        self.reasons.extend(reasons.into_iter().map(|reason| format!("{name}: {reason}")));
    }

    /// Finds the files that the model at `path` with these bytes needs itself, by names relative to its folder.
    ///
    /// # Errors
    ///
    /// Its folder cannot be read.
    pub(super) fn of_model(path: &Path, bytes: &[u8], cancel: &Cancel) -> Result<Self, FileAccessError> {
        let door = RecordingDoor { folder: Folder::of(path)?, names: RefCell::default() };
        let files = ImportDoor { files: &door, conventions: Conventions::default() };
        let read = import::read(&file_name(path), bytes, files, &|_| {}, cancel);
        let reasons = read.err().map(|error| error.to_string()).into_iter().collect();
        Ok(Self { names: door.names.into_inner(), reasons })
    }
}

/// The search for the files that texts name.
struct FileSearch<'a> {
    folder: &'a Folder,
    cancel: &'a Cancel,
    found: NeededFiles,
    models: BTreeSet<String>,
}

impl FileSearch<'_> {
    fn of_texts(&mut self, texts: &TextFiles, is_project: bool) {
        let Some((main, scripts)) = texts.list().split_first() else { return };
        if !is_project {
            return self.of_script(main, texts, None);
        }
        match StageProject::read(main.text.clone()) {
            Ok(project) => {
                let own: Vec<String> = project.files().into_iter().map(str::to_owned).collect();
                for model in project.tree().elements().iter().filter_map(model_of) {
                    self.models.insert(project.source_of(model).to_owned());
                }
                self.found.names.extend(own);
                for file in scripts.iter().filter(|file| project.scripts().any(|name| *name == *file.name)) {
                    self.of_script(file, texts, Some(&project));
                }
            }
            Err(errors) => {
                let what = format!("{}: with errors in it, the files that it names are not known", main.name);
                self.found.reasons.push(what);
                self.found.reasons.extend(errors.iter().map(|error| error.in_file(&main.name)));
            }
        }
    }

    fn of_script(&mut self, file: &TextFile, texts: &TextFiles, project: Option<&StageProject>) {
        let TextFile { name, text } = file;
        let files = read_includes((name, text), texts, Ok(self.folder), self.cancel);
        let context = ScriptContext { name: name.clone(), project: project.cloned(), files };
        match StageScript::read_in(text.clone(), &context) {
            Ok(script) => {
                self.found.names.extend(script.tree().included_files().into_iter().map(str::to_owned));
                self.of_tree(script.tree(), "", project);
            }
            Err(errors) => {
                self.found.reasons.extend(errors.iter().map(|error| error.in_file(name)));
                // The names in its files may be known although it has errors.
                for (file, text) in context.files.texts().chain([(&**name, text)]) {
                    self.found.names.insert(file.to_owned());
                    if let Ok(tree) = ScriptTree::read(Arc::clone(text)) {
                        // In a project all names are relative to its folder.
                        let inside = file.rsplit_once('/').filter(|_| project.is_none());
                        self.of_tree(&tree, inside.map_or("", |(inside, _)| inside), project);
                    }
                }
            }
        }
    }

    /// Adds what elements name, relative to the folder `inside`.
    fn of_tree(&mut self, tree: &ScriptTree, inside: &str, project: Option<&StageProject>) {
        for element in tree.elements() {
            if let Some(model) = element.value("model") {
                self.models.insert(match project.filter(|project| project.model_id(model).is_some()) {
                    Some(project) => project.source_of(model).to_owned(),
                    None => below(inside, model),
                });
            }
            if let Some(source) = element.value("src").filter(|_| element.row.name != "include") {
                self.found.names.insert(below(inside, source));
            }
        }
    }
}

/// Returns the name of a file in the folder `inside`; an empty name means the folder of the document.
fn below(inside: &str, name: &str) -> String {
    if inside.is_empty() { name.to_owned() } else { format!("{inside}/{name}") }
}

/// Returns the model that an element of a project names by its file or its id, or is.
fn model_of(element: &ScriptElement) -> Option<&str> {
    match element.row.name {
        "model" => element.value("src"),
        _ => element.value("model"),
    }
}

/// The folder of a model, which notes the names of the files that were read.
struct RecordingDoor {
    folder: Folder,
    names: RefCell<BTreeSet<String>>,
}

impl AssetFs for RecordingDoor {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, AssetError> {
        let bytes = self.folder.read(name, limit)?;
        self.names.borrow_mut().insert(name.to_owned());
        Ok(bytes)
    }
}
