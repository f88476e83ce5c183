//! Opening a model: bytes, data, pixels; with progress, cancellable, the same for window and command line.

use super::{Cancel, DoorError, Editable, LoadedModel, Progress, Stage, read_file};
use super::{images, import};
use crate::demo::DRAGONFLY_GLB;
use dragonfly_anim::bounds::bounds_of_pose;
use dragonfly_anim::limits::FILE_BYTES;
use dragonfly_store::{FileData, FileStamp, RealFiles};
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use thiserror::Error;

/// What to open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The model that is part of the program.
    BuiltIn,
    /// A file.
    File(PathBuf),
}

impl Source {
    /// File name without folder, or "Dragonfly" for the built-in model.
    pub fn title(&self) -> String {
        match self {
            Self::BuiltIn => "Dragonfly".to_owned(),
            Self::File(path) => file_name(path),
        }
    }
}

/// Why a model could not be opened; says the place and the reason.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The file itself.
    #[error("{}: file: {reason}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// Why.
        reason: DoorError,
    },
    /// Its contents.
    #[error("{title}: {reason}")]
    Format {
        /// Which.
        title: String,
        /// Where in it, and why.
        reason: String,
    },
    /// Somebody asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// A model that is open: what is shown, and what it takes to save it.
#[derive(Debug)]
pub struct Opened {
    /// What is shown.
    pub loaded: LoadedModel,
    /// The file behind it, from the same bytes; why it cannot be saved, where it cannot.
    pub editable: Result<Editable, String>,
}

impl From<LoadedModel> for Opened {
    /// A model without a file.
    fn from(loaded: LoadedModel) -> Self {
        Self { loaded, editable: Err("it was not read from a file".to_owned()) }
    }
}

/// A way to open a model, such as [`open_model`].
pub type Loader = fn(&Source, &mut dyn FnMut(Progress), &Cancel) -> Result<Opened, LoadError>;

/// Opens `source` to be shown. `progress` hears how far it is; raising `cancel` ends it at the next step.
///
/// What is wrong but bearable becomes a warning of the model.
///
/// # Errors
/// Place and reason.
pub fn load_model(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<LoadedModel, LoadError> {
    let read = Read::file(source)?;
    read.load(progress, cancel)
}

/// Opens `source` to be shown and edited: read once, imported once. The rest is as in [`load_model`].
///
/// # Errors
/// Place and reason.
pub fn open_model(
    source: &Source,
    progress: &mut dyn FnMut(Progress),
    cancel: &Cancel,
) -> Result<Opened, LoadError> {
    progress(Progress { stage: Stage::Reading, done: 0.0 });
    let read = Read::file(source)?;
    let loaded = read.load(progress, cancel)?;
    let stamp = read.stamp()?;
    let editable = Editable::of(source, read.bytes, stamp, &loaded);
    Ok(Opened { loaded, editable })
}

/// The bytes of a model.
struct Read<'a> {
    source: &'a Source,
    bytes: Vec<u8>,
    /// What the file was before it was read.
    before: Option<FileData>,
}

impl<'a> Read<'a> {
    fn file(source: &'a Source) -> Result<Self, LoadError> {
        let (bytes, before) = match source {
            Source::BuiltIn => (DRAGONFLY_GLB.to_vec(), None),
            Source::File(path) => {
                let before = FileStamp::before(&RealFiles, path).ok();
                let failed = |reason| LoadError::File { path: path.clone(), reason };
                (read_file(path, FILE_BYTES).map_err(failed)?, before)
            }
        };
        Ok(Self { source, bytes, before })
    }

    /// What the file is now that it was read; none where there is no file.
    fn stamp(&self) -> Result<Option<FileStamp>, LoadError> {
        let (Source::File(path), Some(before)) = (self.source, &self.before) else { return Ok(None) };
        match FileStamp::of_read(&RealFiles, path, before, &self.bytes) {
            Ok(stamp) => Ok(Some(stamp)),
            Err(error) if error.kind() == std::io::ErrorKind::WouldBlock => Err(LoadError::Format {
                title: self.source.title(),
                reason: "file: it changed while it was read".to_owned(),
            }),
            // What cannot be asked for now will be noticed when it is saved.
            Err(_) => Ok(None),
        }
    }

    fn load(&self, progress: &mut dyn FnMut(Progress), cancel: &Cancel) -> Result<LoadedModel, LoadError> {
        progress(Progress { stage: Stage::Reading, done: 0.0 });
        check(cancel)?;
        let imported = {
            // The importer may only look at its listener, so the listener is lent to it inside a cell.
            let progress = RefCell::new(&mut *progress);
            let understanding = |done: f32| {
                let done = 0.1 + 0.4 * done.clamp(0.0, 1.0);
                (progress.borrow_mut())(Progress { stage: Stage::Understanding, done });
            };
            match self.source {
                Source::BuiltIn => import::built_in(&understanding, cancel)?,
                Source::File(path) => import::file(path, &self.bytes, &understanding, cancel)?,
            }
        };
        check(cancel)?;
        let import::Imported { model, format, mut warnings } = imported;
        let count = model.images.len().max(1) as f32;
        progress(Progress { stage: Stage::Decoding, done: 0.5 });
        let decoded = images::decode_all(&model.images, cancel, |done| {
            progress(Progress { stage: Stage::Decoding, done: 0.5 + 0.5 * done as f32 / count });
        });
        check(cancel)?;
        warnings.extend(decoded.warnings);
        let path = match self.source {
            Source::BuiltIn => None,
            Source::File(path) => Some(path.clone()),
        };
        let model = Arc::new(model);
        let first = model.animation.takes.first().map(|take| take.start);
        let bounds = bounds_of_pose(&model, first.map(|_| 0), first.unwrap_or(0.0));
        let title = self.source.title();
        Ok(LoadedModel { title, path, format: Some(format), model, bounds, images: decoded.images, warnings })
    }
}

fn check(cancel: &Cancel) -> Result<(), LoadError> {
    if cancel.is_cancelled() { Err(LoadError::Cancelled) } else { Ok(()) }
}

/// The last part of `path`; all of it when there is none.
pub(super) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}
