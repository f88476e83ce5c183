//! Files in, models out: one file a format, one line in [`FORMATS`].
//!
//! A file is an opponent until it is read. So every count is compared with the bytes that are there before anything
//! is allocated, every index is checked, trees are walked without recursion, memory is charged to a
//! [`ByteBudget`], and other files are reached through an [`AssetFs`] alone. No input makes [`read`] panic.
//!
//! A new format is a module with a `pub const …: Format` and a line in the list.

pub mod dfm;
mod door;
mod error;
#[cfg(feature = "gltf")]
pub mod gltf;
// Some of it is for glTF alone.
#[cfg_attr(not(feature = "gltf"), allow(dead_code))]
mod guard;
mod options;
pub mod uri;

pub use door::{AssetError, AssetFs, NoFiles};
pub(crate) use error::one_line;
pub use error::{ImportError, Place, Warning};
pub use options::{ByteBudget, OverBudget, ReadOptions};

use crate::data::ModelData;
use crate::limits::FILE_BYTES;
use guard::Guard;

/// A kind of file.
pub struct Format {
    /// Short and lower case, as shown to people: `"glb"`.
    pub name: &'static str,
    /// Endings of file names, lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Do these bytes begin like such a file? Looks at the first few only.
    pub detect: fn(bytes: &[u8]) -> bool,
    /// Reads the whole file.
    pub(crate) read:
        fn(bytes: &[u8], door: &dyn AssetFs, guard: &Guard<'_>) -> Result<ModelData, ImportError>,
}

/// Every format that can be read.
pub const FORMATS: &[Format] = &[
    dfm::DFM,
    #[cfg(feature = "gltf")]
    gltf::GLB,
    #[cfg(feature = "gltf")]
    gltf::GLTF,
];

/// What a file held.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The model: every index in range, every number finite.
    pub model: ModelData,
    /// [`Format::name`] of what it was.
    pub format: &'static str,
    /// What was mended or left out, in the order met.
    pub warnings: Vec<Warning>,
}

/// The format of a file called `name` that holds `bytes`: by content, else by the name's ending.
pub fn format_of(name: &str, bytes: &[u8]) -> Option<&'static Format> {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_ascii_lowercase());
    let by_name = || {
        let ending = ending.as_deref()?;
        FORMATS.iter().find(|format| format.extensions.contains(&ending))
    };
    FORMATS.iter().find(|format| (format.detect)(bytes)).or_else(by_name)
}

/// Reads a model from the bytes of a file.
///
/// `name` is the file's name, used to tell the format where its content does not; `door` is asked for the files it
/// names (buffers, images). Works in the calling thread, takes at most about a second and 100 ms a megabyte, and
/// at most 256 MiB and 32 times the bytes read. Any input gives a model or an error; a model that is not quite
/// right comes with warnings.
pub fn read(
    name: &str,
    bytes: &[u8],
    door: &dyn AssetFs,
    options: &ReadOptions<'_>,
) -> Result<Imported, ImportError> {
    if bytes.len() as u64 > FILE_BYTES {
        let size = bytes.len() as u64;
        return Err(ImportError::TooLarge { place: Place::File, what: "bytes", size, limit: FILE_BYTES });
    }
    let format =
        format_of(name, bytes).ok_or_else(|| ImportError::UnknownFormat { name: name.to_owned() })?;
    options.budget.input(bytes.len());
    let guard = Guard::new(options);
    guard.progress(0.0)?;
    let model = (format.read)(bytes, door, &guard)?;
    guard.progress(1.0)?;
    Ok(Imported { model, format: format.name, warnings: guard.into_warnings() })
}
