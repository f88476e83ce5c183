//! Saving edited takes into the file that they came from, in whatever way its format allows.

use super::definition::check_file_size;
use super::{
    AssetFs, ExportError, Format, ImportContext, ImportError, ReadOptions, Warning, WriteModel, WriteSupport,
};
use crate::data::{AnimationData, ModelData, Skeleton, Take};
use crate::root_bone::BoneShift;
use std::fmt;
use std::sync::Arc;
use thiserror::Error;

/// Error of a save with another skeleton than that of the opened model.
#[derive(Debug, Error)]
#[error("the bones differ in more than root bones from those that were opened")]
pub(super) struct DifferentBones;

/// A take as it should be in the saved file.
#[derive(Clone, Debug)]
pub struct EditedTake {
    /// Number of the take in the opened file that this one was made from; `None` for a new one. The first take with an
    /// origin replaces that take; further ones are copies of it and also get what the importer left out.
    pub origin: Option<usize>,
    /// Name and keys. A surgical format keeps the bytes of each channel that is the opened one (the same `Arc`, or the
    /// same bits). Formats in which the keys alone determine the start and length of a take, such as glTF, do not store
    /// them.
    pub take: Arc<Take>,
}

/// A file to be written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputFile {
    /// Path relative to the folder of the opened file; the name of the opened file for the main file.
    pub name: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
}

/// The files that a save will write, and what they change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavePlan {
    /// Files in the order in which to write them: referenced files first, the main file last, so that it never refers to
    /// a file that does not exist.
    pub files: Vec<OutputFile>,
    /// Content of the model that the format cannot represent.
    pub lost: Vec<Warning>,
    /// Changes of a surgical save; `None` where the whole file is written.
    pub changes: Option<ChangeReport>,
}

/// A description of what a surgical save changes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ChangeReport {
    /// Text for users, one line for each change.
    pub text: String,
    /// The same as one JSON object, for programs.
    pub json: String,
}

impl fmt::Display for SavePlan {
    /// Writes one line for each change and each loss.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.changes, self.files.last()) {
            (Some(changes), _) => f.write_str(&changes.text)?,
            (None, Some(file)) => writeln!(f, "the whole file is written: {} bytes", file.bytes.len())?,
            (None, None) => writeln!(f, "nothing changes")?,
        }
        self.lost.iter().try_for_each(|lost| writeln!(f, "not saved: {lost}"))
    }
}

/// An opened file of a format that saves edits without touching the rest: the implementation of
/// [`WriteSupport::Surgical`].
pub trait SurgicalFile: Send + Sync {
    /// Plans a save after which the file contains `takes` in this order. `opened` is the model as it was read from the
    /// same bytes; `skeleton`, whose bones the takes move, may have other root bones. Takes that are not edited keep their
    /// bytes.
    fn plan(
        &self,
        opened: &ModelData,
        skeleton: &Skeleton,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError>;

    /// Plans a save that removes what earlier saves appended and nothing uses any more.
    fn compact(&self) -> Result<SavePlan, ExportError>;

    /// Returns the files that this one refers to, as paths relative to its folder, each once.
    fn neighbors(&self) -> Vec<String>;
}

/// A file that is edited: everything that saving takes into it needs. Made by [`Format::edit`].
pub struct EditableFile {
    name: String,
    format: Format,
    source: SaveSource,
}

/// What a save starts from.
enum SaveSource {
    /// Nothing but the model.
    Model(WriteModel),
    /// The model, if it was edited, or else the bytes of the opened file.
    Rewritten(WriteModel, Arc<[u8]>),
    /// The bytes of the opened file.
    File(Box<dyn SurgicalFile>),
}

impl EditableFile {
    pub(super) fn open(
        format: Format,
        name: &str,
        bytes: Arc<[u8]>,
        files: &dyn AssetFs,
        options: &ReadOptions<'_>,
    ) -> Result<Self, ImportError> {
        let source = match format.write {
            WriteSupport::None => return Err(ImportError::ReadOnly { title: format.title }),
            WriteSupport::Whole(write) => SaveSource::Model(write),
            WriteSupport::Rewritten(write) => SaveSource::Rewritten(write, bytes),
            WriteSupport::Surgical(open) => {
                check_file_size(bytes.len())?;
                options.budget.input(bytes.len());
                SaveSource::File(open(name, bytes, &ImportContext::new(files, options))?)
            }
        };
        Ok(Self { name: name.to_owned(), format, source })
    }

    /// Returns the name that the file was opened under.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the format of the file. A save keeps it: a `.glb` stays a binary container.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Plans a save after which the file contains `takes` in this order; nothing is written. `opened` is the model as it
    /// was read from the same bytes.
    pub fn plan(&self, opened: &ModelData, takes: &[EditedTake]) -> Result<SavePlan, ExportError> {
        self.plan_with_skeleton(opened, &opened.animation.skeleton, takes)
    }

    /// Plans a save as [`Self::plan`] does, of takes for the bones of `skeleton`: that of `opened`, with other root bones
    /// above the same bones, see [`root_bone`](crate::root_bone).
    pub fn plan_with_skeleton(
        &self,
        opened: &ModelData,
        skeleton: &Arc<Skeleton>,
        takes: &[EditedTake],
    ) -> Result<SavePlan, ExportError> {
        match &self.source {
            SaveSource::File(file) => file.plan(opened, skeleton, takes),
            SaveSource::Rewritten(_, bytes) if is_unedited(opened, skeleton, takes) => {
                Ok(self.unedited(bytes))
            }
            SaveSource::Model(write) | SaveSource::Rewritten(write, _) => {
                let shift = BoneShift::between(&opened.animation.skeleton, skeleton);
                let model = shift.and_then(|shift| shift.model(opened, skeleton));
                let model = model.ok_or_else(|| ExportError::new(DifferentBones))?;
                let takes = takes.iter().map(|edited| Arc::clone(&edited.take)).collect();
                let animation = AnimationData { skeleton: Arc::clone(skeleton), takes };
                self.whole(*write, &ModelData { animation, ..model })
            }
        }
    }

    /// Plans a save that removes what earlier saves appended and nothing uses any more. Takes are as in `opened`.
    pub fn compact(&self, opened: &ModelData) -> Result<SavePlan, ExportError> {
        match &self.source {
            SaveSource::File(file) => file.compact(),
            SaveSource::Rewritten(_, bytes) => Ok(self.unedited(bytes)),
            SaveSource::Model(write) => self.whole(*write, opened),
        }
    }

    /// Returns the files that this one refers to, as paths relative to its folder, each once.
    pub fn neighbors(&self) -> Vec<String> {
        match &self.source {
            SaveSource::File(file) => file.neighbors(),
            SaveSource::Model(_) | SaveSource::Rewritten(..) => Vec::new(),
        }
    }

    fn unedited(&self, bytes: &[u8]) -> SavePlan {
        let file = OutputFile { name: self.name.clone(), bytes: bytes.to_vec() };
        SavePlan { files: vec![file], ..SavePlan::default() }
    }

    fn whole(&self, write: WriteModel, model: &ModelData) -> Result<SavePlan, ExportError> {
        Ok(write(model)?.named(&self.name))
    }
}

/// Returns whether the takes are those that were opened, in their order.
fn is_unedited(opened: &ModelData, skeleton: &Arc<Skeleton>, takes: &[EditedTake]) -> bool {
    let own = &opened.animation;
    let same = |(index, (edited, take)): (usize, (&EditedTake, &Arc<Take>))| {
        edited.origin == Some(index) && (Arc::ptr_eq(&edited.take, take) || edited.take == *take)
    };
    Arc::ptr_eq(skeleton, &own.skeleton)
        && takes.len() == own.takes.len()
        && takes.iter().zip(&own.takes).enumerate().all(same)
}

impl fmt::Debug for EditableFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "EditableFile({}, {})", self.name, self.format.name)
    }
}
