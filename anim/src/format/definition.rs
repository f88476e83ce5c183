//! The description of one file format.

use super::context::ImportContext;
use super::edited::{EditableFile, OutputFile, SavePlan, SurgicalFile};
use super::{AssetFs, Conversion, ExportError, ImportError, Place, ReadOptions, Warning};
use crate::data::ModelData;
use crate::limits::FILE_BYTES;
use std::fmt;
use std::sync::Arc;

/// A file format: what it is called, how its files are recognized, read and written.
///
/// This is the only description of a format. The list of extensions in a file dialog, the title that a user sees and
/// the way in which edits are saved all come from here, so a caller never compares names of formats. Any crate can define
/// one and add it to a [`Formats`](super::Formats) value:
///
/// ```
/// use dragonfly_anim::data::ModelData;
/// use dragonfly_anim::format::{Format, Formats, ImportContext, ImportError, NoFiles, ReadOptions, WriteSupport};
///
/// fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
///     context.work(bytes.len())?;
///     let name = String::from_utf8_lossy(&bytes[5..]).trim().to_owned();
///     Ok(ModelData { name, ..ModelData::default() })
/// }
///
/// const NAME_ONLY: Format = Format {
///     name: "name",
///     title: "Name of a model",
///     extensions: &["name"],
///     sniff: |bytes| bytes.starts_with(b"NAME "),
///     read,
///     write: WriteSupport::None,
///     export: None,
/// };
///
/// let formats = Formats::builtin().with(NAME_ONLY);
/// let imported = formats.read("fox.name", b"NAME Fox", &NoFiles, &ReadOptions::default())?;
/// assert_eq!((imported.format, imported.model.name.as_str()), (NAME_ONLY, "Fox"));
/// # Ok::<(), ImportError>(())
/// ```
#[derive(Clone, Copy)]
pub struct Format {
    /// Short name in lower case, unique among the formats of a program, used in JSON output: `"glb"`.
    pub name: &'static str,
    /// Name in a user interface: `"glTF 2.0, binary"`.
    pub title: &'static str,
    /// File name extensions in lower case, without the dot; the first one is proposed for new files. Never empty.
    pub extensions: &'static [&'static str],
    /// Returns whether the bytes look like a file of this format. Must be cheap: it looks at a few bytes only.
    pub sniff: fn(bytes: &[u8]) -> bool,
    /// Reads a file. Callers use [`Self::import`], which checks the size of the file before and reports the progress.
    ///
    /// No input may make it panic. In the model that it returns every index is in range and every number is finite.
    pub read: ReadModel,
    /// How edits are saved into a file of this format.
    pub write: WriteSupport,
    /// Writes new files from a model of any origin; `None` for a format that is not written.
    pub export: Option<ExportModel>,
}

/// Reads a model from the bytes of a file; budget, cancel flag, listener and referenced files are in the context.
pub type ReadModel = fn(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError>;

/// Writes a whole file from a model.
pub type WriteModel = fn(model: &ModelData) -> Result<WholeFile, ExportError>;

/// Writes a model as a new file called `name`, and the files that it refers to, such as textures.
pub type ExportModel = fn(model: &ModelData, name: &str) -> Result<SavePlan, ExportError>;

/// Opens the bytes of the file called `name` so that edits can be saved into them.
pub type OpenSurgical = fn(
    name: &str,
    bytes: Arc<[u8]>,
    context: &ImportContext<'_>,
) -> Result<Box<dyn SurgicalFile>, ImportError>;

/// How files of a format are written.
#[derive(Clone, Copy)]
pub enum WriteSupport {
    /// Files can only be read.
    None,
    /// The whole file is written from the model. Content of an opened file that the model does not represent is lost.
    Whole(WriteModel),
    /// As [`Self::Whole`], of a format whose files usually contain more than a model, so that users are asked before it is lost. A save
    /// without edits keeps the bytes of the opened file.
    Rewritten(WriteModel),
    /// Edits replace only the bytes that they concern in the file that was opened.
    Surgical(OpenSurgical),
}

/// A file that was written as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WholeFile {
    /// Bytes of the file.
    pub bytes: Vec<u8>,
    /// Content of the model that the format cannot represent; the places are JSON pointers into the model, such as
    /// `/meshes/0`.
    pub lost: Vec<Warning>,
}

impl WholeFile {
    /// Returns the plan that writes this file alone, under this name.
    pub fn named(self, name: &str) -> SavePlan {
        let files = vec![OutputFile { name: name.to_owned(), bytes: self.bytes }];
        SavePlan { files, lost: self.lost, changes: None }
    }
}

impl Format {
    /// Returns the extension to propose for a new file.
    pub fn extension(&self) -> &'static str {
        self.extensions.first().copied().unwrap_or(self.name)
    }

    /// Returns whether `extension`, without the dot and in any case, is one of this format.
    pub fn has_extension(&self, extension: &str) -> bool {
        self.extensions.iter().any(|own| own.eq_ignore_ascii_case(extension))
    }

    /// Returns whether models can be saved in this format.
    pub fn is_writable(&self) -> bool {
        !matches!(self.write, WriteSupport::None)
    }

    /// Returns whether saving replaces only the bytes that an edit concerns.
    pub fn is_surgical(&self) -> bool {
        matches!(self.write, WriteSupport::Surgical(_))
    }

    /// Returns whether saving loses what files of this format usually contain in addition to a model, see [`WriteSupport::Rewritten`].
    pub fn is_rewritten(&self) -> bool {
        matches!(self.write, WriteSupport::Rewritten(_))
    }

    /// Reads `bytes` as a file of this format, with the same limits and promises as [`super::read`].
    pub fn import(
        &self,
        bytes: &[u8],
        files: &dyn AssetFs,
        options: &ReadOptions<'_>,
    ) -> Result<Imported, ImportError> {
        check_file_size(bytes.len())?;
        options.budget.input(bytes.len());
        let context = ImportContext::new(files, options);
        context.progress(0.0)?;
        let model = (self.read)(bytes, &context)?;
        context.progress(1.0)?;
        let conversion = context.conversion();
        Ok(Imported { model, format: *self, conversion, warnings: context.into_warnings() })
    }

    /// Opens `bytes`, the content of a file of this format called `name`, so that edits can be saved into it.
    ///
    /// Referenced files that cannot be read are no error here. Errors: files of this format can only be read
    /// ([`ImportError::ReadOnly`]), or the file is damaged.
    pub fn edit(
        &self,
        name: &str,
        bytes: impl Into<Arc<[u8]>>,
        files: &dyn AssetFs,
        options: &ReadOptions<'_>,
    ) -> Result<EditableFile, ImportError> {
        EditableFile::open(*self, name, bytes.into(), files, options)
    }
}

/// Refuses a file of more than [`FILE_BYTES`].
pub(super) fn check_file_size(bytes: usize) -> Result<(), ImportError> {
    let size = bytes as u64;
    if size > FILE_BYTES {
        return Err(ImportError::TooLarge { place: Place::File, what: "bytes", size, limit: FILE_BYTES });
    }
    Ok(())
}

/// Two formats are the same if their names are.
impl PartialEq for Format {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Format {}

impl fmt::Debug for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Format({})", self.name)
    }
}

impl fmt::Debug for WriteSupport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "None",
            Self::Whole(_) => "Whole",
            Self::Rewritten(_) => "Rewritten",
            Self::Surgical(_) => "Surgical",
        })
    }
}

/// A model that was read from a file.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model: every index in range, every number finite.
    pub model: ModelData,
    /// Format of the file.
    pub format: Format,
    /// Units, axes and frame rate of the file, as they were converted.
    pub conversion: Conversion,
    /// Descriptions of corrected and omitted content, in the order in which it was found.
    pub warnings: Vec<Warning>,
}
