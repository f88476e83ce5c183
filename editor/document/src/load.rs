//! Opens a model for the window and for the command line: reads its bytes, imports its data, surveys its images.
//! Loading reports its progress and can be cancelled.

use super::adapter::{ModelAdapter, TextFiles, unused_layers};
use super::beside::stamp_of;
use super::beside::{BesideStamps, ReadOnce};
use super::images::ImageSurvey;
use super::import;
use super::source::{LoadError, Source};
use super::text_source::{ReadTexts, is_scene, read_texts};
use super::{Cancel, Editable, FileAccessError, Folder, LoadStage, LoadedModel, Progress, read_file};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::format::Conventions;
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{FileData, FileStamp, RealFiles};
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;

/// An open model: the data to show, and everything needed to save it.
#[derive(Debug)]
pub struct OpenedModel {
    /// The data to show.
    pub loaded: LoadedModel,
    /// Its file, from the same bytes; or the reason why it cannot be saved.
    pub editable: Result<Editable, String>,
    /// The texts of a scene or project, whose model is empty; none for a model.
    pub texts: TextFiles,
}

impl From<LoadedModel> for OpenedModel {
    /// Makes an opened model that has no file and cannot be saved.
    fn from(loaded: LoadedModel) -> Self {
        let editable = Err("it was not read from a file".to_owned());
        Self { loaded, editable, texts: TextFiles::default() }
    }
}

/// A function that opens a model, such as [`open_model`].
pub type Loader = fn(&Source, &mut dyn FnMut(Progress), &Cancel) -> Result<OpenedModel, LoadError>;

/// Opens `source` to show it. `progress` is called with the progress; raising `cancel` stops it at the next step.
///
/// Errors that can be tolerated become warnings of the model.
///
/// # Errors
/// The place and the reason.
pub fn load_model(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<LoadedModel, LoadError> {
    let read = Read::file(source)?;
    read.load(progress, cancel)
}

/// Opens `source` to show and edit it. It is read once and imported once, otherwise as by [`load_model`].
///
/// # Errors
/// The place and the reason.
pub fn open_model(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<OpenedModel, LoadError> {
    progress(Progress { stage: LoadStage::Reading, done: 0.0 });
    if let Some(path) = source.path().filter(|path| is_scene(path)) {
        return Ok(OpenedModel::of_texts(read_texts(path)?));
    }
    let read = Read::file(source)?;
    let loaded = read.load(progress, cancel)?;
    let stamp = read.stamp()?;
    let editable = Editable::of(source, read.bytes, stamp, &loaded, read.door.as_ref());
    Ok(OpenedModel { loaded, editable, texts: TextFiles::default() })
}

/// Loads the model called `name` in `folder`, for a scene, and returns also the hash of its file, and the state of it and of the files
/// next to it. It is not edited.
pub(super) fn load_inside(
    folder: &Folder,
    name: &str,
    conventions: Conventions,
    cancel: &Cancel,
) -> Result<(LoadedModel, u64, BesideStamps), LoadError> {
    let title = name.rsplit('/').next().unwrap_or(name).to_owned();
    let wrong =
        |error: FileAccessError| LoadError::Format { title: title.clone(), reason: error.to_string() };
    let path = folder.path_of(name).map_err(wrong)?;
    let before = FileStamp::before(&RealFiles, &path).ok();
    let bytes = folder.read(name, FILE_BYTES).map_err(wrong)?;
    let door = Some(ReadOnce::of(&path).map_err(wrong)?);
    let read = Read { source: &Source::of(path.clone(), conventions), bytes, before, door };
    let stamp = read.stamp()?;
    let loaded = read.load(&mut |_| {}, cancel)?;
    let mut stamps = read.door.as_ref().map(ReadOnce::stamps).unwrap_or_default();
    if let Some(stamp) = stamp {
        stamps.add(path, stamp);
    }
    Ok((loaded, dragonfly_store::hash(&read.bytes), stamps))
}

impl OpenedModel {
    /// Returns a model that the caller read from `bytes`, the contents of `source`. It is saved as one that was opened here; files next
    /// to it are not read.
    pub fn of_bytes(loaded: LoadedModel, source: &Source, bytes: Vec<u8>) -> Self {
        let stamp = source.path().and_then(|path| FileStamp::take(&RealFiles, path).ok());
        let editable = match stamp.filter(|stamp| !stamp.is_of(&bytes)) {
            Some(_) => Err("the file changed while it was read; open it again".to_owned()),
            None => Editable::of(source, bytes, stamp, &loaded, None),
        };
        Self { loaded, editable, texts: TextFiles::default() }
    }

    /// Returns its unchanged takes and texts.
    pub(super) fn adapter(&self) -> ModelAdapter {
        ModelAdapter::of(&self.loaded.model).with_texts(self.texts.clone())
    }

    /// Returns the document of texts that were read.
    fn of_texts(read: ReadTexts) -> Self {
        let texts = read.texts.clone();
        let editable = Editable::of_texts(read);
        Self { loaded: editable.loaded(), editable: Ok(editable), texts }
    }
}

/// The bytes of a model.
struct Read<'a> {
    source: &'a Source,
    bytes: Vec<u8>,
    /// State of the file before it was read.
    before: Option<FileData>,
    /// The files next to it.
    door: Option<ReadOnce>,
}

impl<'a> Read<'a> {
    fn file(source: &'a Source) -> Result<Self, LoadError> {
        let (bytes, before, door) = match source {
            Source::BuiltIn => (DRAGONFLY_GLB.to_vec(), None, None),
            Source::File(path) | Source::FileAs(path, _) => {
                let before = FileStamp::before(&RealFiles, path).ok();
                let failed = |reason| LoadError::File { path: path.clone(), reason };
                let bytes = read_file(path, FILE_BYTES).map_err(failed)?;
                let wrong = |error: FileAccessError| LoadError::Format {
                    title: source.title(),
                    reason: error.to_string(),
                };
                (bytes, before, Some(ReadOnce::of(path).map_err(wrong)?))
            }
        };
        Ok(Self { source, bytes, before, door })
    }

    /// Returns the state of the file now that it was read; `None` where there is no file.
    fn stamp(&self) -> Result<Option<FileStamp>, LoadError> {
        let wrong = |reason| LoadError::Format { title: self.source.title(), reason };
        stamp_of(self.source.path().zip(self.before.as_ref()), &self.bytes).map_err(wrong)
    }

    fn load(&self, progress: &mut dyn FnMut(Progress), cancel: &Cancel) -> Result<LoadedModel, LoadError> {
        progress(Progress { stage: LoadStage::Reading, done: 0.0 });
        check(cancel)?;
        let imported = {
            // The importer takes its listener by shared reference, so the listener is in a cell.
            let progress = RefCell::new(&mut *progress);
            let understanding = |done: f32| {
                let done = 0.1 + 0.4 * done.clamp(0.0, 1.0);
                (progress.borrow_mut())(Progress { stage: LoadStage::Understanding, done });
            };
            match (&self.door, self.source) {
                (Some(files), source) => {
                    let door = import::ImportDoor { files, conventions: source.conventions() };
                    import::read(&source.title(), &self.bytes, door, &understanding, cancel)?
                }
                (None, _) => import::built_in(&understanding, cancel)?,
            }
        };
        check(cancel)?;
        let import::ImportedModel { model, format, conversion, mut warnings, notes, memory } = imported;
        let model = Arc::new(model);
        warnings.extend(unused_layers(&model.animation));
        let first = model.animation.takes.first().map(|take| take.start);
        let bounds = bounds_of_pose(&model, first.map(|_| 0), first.unwrap_or(0.0));
        progress(Progress { stage: LoadStage::Decoding, done: 0.5 });
        let (images, of_images) = ImageSurvey::new(&model.images, memory, cancel);
        check(cancel)?;
        progress(Progress { stage: LoadStage::Decoding, done: 1.0 });
        warnings.extend(of_images);
        let path = self.source.path().map(Path::to_owned);
        let title = self.source.title();
        Ok(LoadedModel {
            conversion,
            title,
            path,
            format: Some(format),
            model,
            bounds,
            images,
            warnings,
            notes,
        })
    }
}

fn check(cancel: &Cancel) -> Result<(), LoadError> {
    if cancel.is_cancelled() { Err(LoadError::Cancelled) } else { Ok(()) }
}
