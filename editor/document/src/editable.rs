//! A file that is edited: its data, and everything needed to save it without changing the rest.

use super::adapter::{ModelAdapter, TakeId, TakeVersions, TextFiles};
use super::beside::{BesideStamps, ReadOnce, stamp_of};
use super::copied_files::EarlierCopies;
use super::edited_content::{EditedContent, plan_of_texts};
use super::images::ImageSurvey;
use super::import::ImportDoor;
use super::new_folders::ensure_folder;
use super::source::{LoadError, Source, file_name};
use super::text_source::{ReadTexts, is_scene, read_texts};
use super::unused;
use super::writing::{Overwrite, Writing};
use super::{Cancel, LoadedModel, import, read_file};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::bounds::Bounds;
use dragonfly_anim::data::ModelData;
use dragonfly_anim::format::{
    AssetFs, Conventions, EditableFile, EditedTake, ExportError, Format, ImportError, NoFiles, ReadOptions,
    SavePlan,
};
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{FileStamp, FileState, RealFiles, Vfs};
use std::collections::HashMap;
use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file that is edited. A clone is cheap: large data is shared.
#[derive(Clone)]
pub struct Editable {
    /// File name without folder.
    pub title: String,
    /// Its path; `None` for the built-in model.
    pub path: Option<PathBuf>,
    /// The data as it was read.
    pub model: Arc<ModelData>,
    /// Contents that are not shown or were sanitized, one sentence each.
    pub warnings: Vec<String>,
    /// Units, axes and frame rate that the user chose for the file.
    pub(super) conventions: Conventions,
    /// The edited content, as it is in the files.
    pub(super) content: EditedContent,
    /// State of the file when it was last read or saved.
    pub(super) stamp: Option<FileStamp>,
    /// State of its buffers in other files when they were last read or saved.
    pub(super) beside: BesideStamps,
    /// State of the files that saves into other folders wrote there, which later ones may replace.
    pub(super) copies: EarlierCopies,
    /// The model with the skeleton and the takes that are in the file now.
    pub(super) on_disk: Arc<ModelData>,
    /// Index of each take among the animations of the file, once it was saved.
    pub(super) places: Option<HashMap<TakeId, usize>>,
}

impl Editable {
    /// Opens `source` to edit it without decoding textures.
    pub fn open(source: &Source, cancel: &Cancel) -> Result<Self, LoadError> {
        if let Some(path) = source.path().filter(|path| is_scene(path)) {
            return Ok(Self::of_texts(read_texts(path)?));
        }
        // Taken before the file is read, so that a change in between is found.
        let before = source.path().and_then(|path| FileStamp::before(&RealFiles, path).ok());
        let (name, bytes, path) = match source {
            Source::BuiltIn => ("dragonfly.glb".to_owned(), DRAGONFLY_GLB.to_vec(), None),
            Source::File(path) | Source::FileAs(path, _) => {
                let failed = |reason| LoadError::File { path: path.clone(), reason };
                (file_name(path), read_file(path, FILE_BYTES).map_err(failed)?, Some(path.clone()))
            }
        };
        let wrong = |reason: String| LoadError::Format { title: source.title(), reason };
        let stamp = stamp_of(path.as_deref().zip(before.as_ref()), &bytes).map_err(wrong)?;
        let door = match &path {
            Some(path) => Some(ReadOnce::of(path).map_err(|error| wrong(error.to_string()))?),
            None => None,
        };
        let read_once = &door;
        let door: &dyn AssetFs = read_once.as_ref().map_or(&NoFiles, |folder| folder);
        let conventions = source.conventions();
        let imported = import::read(&name, &bytes, ImportDoor { files: door, conventions }, &|_| {}, cancel)?;
        let options = ReadOptions { conventions, ..ReadOptions::default() };
        let file = imported.format.edit(&name, bytes, door, &options);
        let file = file.map_err(|error| wrong(error.to_string()))?;
        let (model, mut warnings) = (Arc::new(imported.model), imported.warnings);
        warnings.extend(imported.notes);
        let on_disk = Arc::clone(&model);
        let beside = read_once.as_ref().map(ReadOnce::stamps).unwrap_or_default();
        let content = EditedContent::Model(Arc::new(file));
        Ok(Self {
            title: source.title(),
            path,
            model,
            warnings,
            conventions,
            content,
            stamp,
            beside,
            copies: EarlierCopies::default(),
            on_disk,
            places: None,
        })
    }

    /// Returns the file of `loaded`, which was read from `bytes` while the file had this stamp, and the files next to it through `door`.
    pub(super) fn of(
        source: &Source,
        bytes: Vec<u8>,
        stamp: Option<FileStamp>,
        loaded: &LoadedModel,
        door: Option<&ReadOnce>,
    ) -> Result<Self, String> {
        let format = loaded.format.ok_or("it was not read from a file")?;
        let name = loaded.path.as_deref().map_or_else(|| "dragonfly.glb".to_owned(), file_name);
        let conventions = loaded.conversion.chosen();
        let file = opened(format, &name, bytes, door, conventions).map_err(|error| error.to_string())?;
        Ok(Self {
            title: source.title(),
            path: loaded.path.clone(),
            model: Arc::clone(&loaded.model),
            warnings: loaded.warnings.iter().chain(&loaded.notes).cloned().collect(),
            conventions,
            content: EditedContent::Model(Arc::new(file)),
            stamp,
            beside: door.map(ReadOnce::stamps).unwrap_or_default(),
            copies: EarlierCopies::default(),
            on_disk: Arc::clone(&loaded.model),
            places: None,
        })
    }

    /// Returns texts to edit, as they were read.
    pub(super) fn of_texts(read: ReadTexts) -> Self {
        let ReadTexts { path, texts, stamp, beside, warnings } = read;
        let model = Arc::new(ModelData::default());
        Self {
            title: file_name(&path),
            path: Some(path),
            on_disk: Arc::clone(&model),
            model,
            warnings,
            conventions: Conventions::default(),
            content: EditedContent::Texts(texts),
            stamp,
            beside,
            copies: EarlierCopies::default(),
            places: None,
        }
    }

    /// Returns the model as it was read, without its images.
    pub(super) fn loaded(&self) -> LoadedModel {
        LoadedModel {
            conversion: Default::default(),
            title: self.title.clone(),
            path: self.path.clone(),
            format: self.format(),
            model: Arc::clone(&self.model),
            bounds: Bounds::of_points(&[]),
            images: ImageSurvey::default(),
            warnings: self.warnings.clone(),
            notes: Vec::new(),
        }
    }

    /// Returns the unchanged takes and texts as they are in the file.
    pub fn adapter(&self) -> ModelAdapter {
        ModelAdapter::of(&self.model).with_texts(self.texts())
    }

    /// Returns the texts as they are in the files; none for a model.
    pub fn texts(&self) -> TextFiles {
        self.content.texts()
    }

    /// Returns what saving the takes and texts of `adapter` would write.
    pub fn plan(&self, adapter: &ModelAdapter) -> Result<SavePlan, ExportError> {
        let file = match &self.content {
            EditedContent::Model(file) => file,
            EditedContent::Texts(texts) => return Ok(plan_of_texts(texts, adapter)),
        };
        let takes = adapter.slots().iter().zip(adapter.saved_takes());
        let takes: Vec<EditedTake> =
            takes.map(|(slot, take)| EditedTake { origin: self.place(slot), take }).collect();
        file.plan_with_skeleton(&self.on_disk, adapter.skeleton(), &takes)
    }

    /// Returns what removing the unused data of earlier saves would write.
    pub fn compact(&self) -> Result<SavePlan, ExportError> {
        match &self.content {
            EditedContent::Model(file) => file.compact(&self.on_disk),
            EditedContent::Texts(texts) => Ok(plan_of_texts(texts, &self.adapter())),
        }
    }

    /// Returns whether the takes of `adapter` are those of the file, so that a save keeps its bytes also where the format has no edits in
    /// place.
    pub(super) fn is_unedited(&self, adapter: &ModelAdapter) -> bool {
        let own = &self.on_disk.animation;
        let saved = adapter.saved_takes();
        let takes = adapter.slots().iter().zip(&saved).zip(&own.takes).enumerate();
        Arc::ptr_eq(adapter.skeleton(), &own.skeleton)
            && saved.len() == own.takes.len()
            && takes.into_iter().all(|(index, ((slot, take), old))| {
                self.place(slot) == Some(index) && (Arc::ptr_eq(take, old) || take == old)
            })
    }

    /// Returns the index of a take among the animations of the file.
    fn place(&self, slot: &TakeVersions) -> Option<usize> {
        match &self.places {
            None => slot.origin,
            Some(places) => places.get(&slot.id).copied(),
        }
    }

    /// Returns whether the model needs other files next to it after the save of `plan`.
    pub fn needs_others(&self, plan: &SavePlan) -> bool {
        plan.files.len() > 1 || !self.content.neighbors().is_empty()
    }

    /// Saves as `output`. The opened file is overwritten only if no other program has changed it. Later saves are relative to what was
    /// written.
    ///
    /// # Errors
    ///
    /// The path and the reason. The old file is unchanged then; of several texts, some may have been written before.
    pub fn save(
        &mut self,
        adapter: &ModelAdapter,
        plan: &SavePlan,
        output: &Path,
    ) -> Result<Vec<PathBuf>, String> {
        self.save_through(&RealFiles, adapter, plan, output)
    }

    /// Saves as [`Self::save`], with another file system than that of the machine.
    ///
    /// # Errors
    ///
    /// As there.
    pub fn save_through(
        &mut self,
        disk: &dyn Vfs,
        adapter: &ModelAdapter,
        plan: &SavePlan,
        output: &Path,
    ) -> Result<Vec<PathBuf>, String> {
        let own = self.is_own(output);
        let overwrite = if own { Overwrite::AsRead } else { Overwrite::Anything };
        // A mistyped name makes no folder.
        ensure_folder(output)?;
        let cancel = Cancel::default();
        let files = self.files(plan, output, &cancel, &|_| {})?;
        let is_elsewhere = files.is_elsewhere;
        let how = Writing {
            disk,
            overwrite,
            replaces: &[],
            versions: None,
            becomes: own,
            is_elsewhere,
            copied: &|_, _| {},
        };
        let saved = self.write(adapter, files, how, &cancel).map_err(|error| error.to_string())?;
        Ok(saved.files)
    }

    /// Returns the first of its buffers in other files that another program changed, and how.
    pub(super) fn changed_beside(&self) -> Option<(&Path, FileState)> {
        self.beside.changed()
    }

    /// Removes the buffer files of earlier saves that nothing uses any more. Returns their paths.
    pub fn remove_unused(&self) -> Vec<PathBuf> {
        self.path.as_deref().map(|path| unused::remove(path, &self.content.neighbors())).unwrap_or_default()
    }

    /// Returns whether this is the path of the opened file, which may be deleted.
    pub(super) fn is_own(&self, path: &Path) -> bool {
        self.path.as_deref().is_some_and(|own| is_same_path(own, path))
    }

    /// Returns the format of the file; `None` for texts.
    pub(super) fn format(&self) -> Option<Format> {
        match &self.content {
            EditedContent::Model(file) => Some(file.format()),
            EditedContent::Texts(_) => None,
        }
    }

    /// Returns the file extension.
    pub fn ending(&self) -> String {
        let ending = self.path.as_deref().and_then(|path| path.extension()?.to_str().map(str::to_owned));
        ending.unwrap_or_else(|| self.format().map_or("xml", |format| format.extension()).to_owned())
    }

    /// Returns the state of the file when it was last read or saved.
    pub(super) fn stamp(&self) -> Option<&FileStamp> {
        self.stamp.as_ref()
    }

    /// Sets the index of each take among the animations of the file, for takes that did not come from the file.
    pub(super) fn set_places(&mut self, places: HashMap<TakeId, usize>) {
        self.places = Some(places);
    }

    /// Detaches the document from its file: the next save asks for a path.
    pub(super) fn forget_file(&mut self) {
        self.stamp = None;
    }
}

/// Returns the index of each take in a file that has them all in this order.
pub(super) fn places(adapter: &ModelAdapter) -> HashMap<TakeId, usize> {
    adapter.slots().iter().enumerate().map(|(place, slot)| (slot.id, place)).collect()
}

impl fmt::Debug for Editable {
    /// Writes only the name: the data would fill pages.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "Editable({})", self.title)
    }
}

/// Opens `bytes` for editing, with access to the files of its folder where there is one.
pub(super) fn opened(
    format: Format,
    name: &str,
    bytes: Vec<u8>,
    door: Option<&ReadOnce>,
    conventions: Conventions,
) -> Result<EditableFile, ImportError> {
    let options = ReadOptions { conventions, ..ReadOptions::default() };
    match door {
        Some(door) => format.edit(name, bytes, door, &options),
        None => format.edit(name, bytes, &NoFiles, &options),
    }
}

/// Returns whether two paths lead to the same file or folder. It need not exist where they are equal.
pub(super) fn is_same_path(a: &Path, b: &Path) -> bool {
    a == b || matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}
