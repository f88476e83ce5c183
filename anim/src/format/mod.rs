//! File formats: bytes to models, and models or edits back to bytes.
//!
//! Files are untrusted input. Every count is compared with the bytes that are present before anything is allocated,
//! every index is checked, trees are walked without recursion, memory is charged to a [`ByteBudget`], and referenced
//! files are read only through an [`AssetFs`]. No input makes [`read`] panic.
//!
//! # Add a format
//!
//! In this crate: a module with a `pub const …: Format`, and one line in [`BUILTIN`]. In another crate: the same
//! constant, passed to [`Formats::with`]; [`Format`] has an example. The tests in `tests/anim/formats.rs` check every
//! format of the list: its own files are recognized by their content, what is written reads back, and damaged files are
//! errors.
//!
//! A format that is only written is one line in [`TABLES`].
//!
//! # Units and axes
//!
//! Models are in meters, Y up, right-handed. [`Conversion`] describes what a file has instead, and where that is known
//! from; [`ReadOptions::conventions`] are the user's choices. [`Imported::conversion`] is what was done.
//!
//! # Save edits
//!
//! [`Format::edit`] opens the bytes of a file for editing, [`EditableFile::plan`] returns the files to write. For glTF, BVH
//! and others only those bytes change that the edits concern; a format without such a writer is written as a whole.
//!
//! ```
//! use dragonfly_anim::data::ModelData;
//! use dragonfly_anim::format::{EditedTake, NoFiles, ReadOptions, dfm, read};
//!
//! let bytes = dfm::write(&ModelData::default())?;
//! let options = ReadOptions::default();
//! let opened = read("empty.dfm", &bytes, &NoFiles, &options)?;
//! let file = opened.format.edit("empty.dfm", bytes, &NoFiles, &options)?;
//! let takes: Vec<EditedTake> = Vec::new();
//! let plan = file.plan(&opened.model, &takes)?;
//! assert_eq!(plan.files[0].name, "empty.dfm");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bvh;
mod context;
mod convention;
mod curves;
mod decimal;
mod definition;
pub mod dfm;
mod edited;
mod error;
mod files;
mod fixed_skeleton;
#[cfg(feature = "gltf")]
pub mod gltf;
mod image;
mod image_kind;
mod influences;
mod key_changes;
mod key_rows;
mod key_times;
mod losses;
pub mod m3d;
mod matrices;
mod names;
mod normals;
pub mod obj;
mod patch;
mod pose_rows;
mod read_options;
mod registry;
mod straight;
mod text;
mod triangulate;
pub mod uri;
pub mod x;

pub use context::ImportContext;
pub use convention::{AxisMap, ConventionSource, Conventions, Conversion, Found, Handedness, UpAxis};
pub use curves::{CURVES_CSV, CURVES_JSON};
pub use definition::{
    ExportModel, Format, Imported, OpenSurgical, ReadModel, WholeFile, WriteModel, WriteSupport,
};
pub use edited::{ChangeReport, EditableFile, EditedTake, OutputFile, SavePlan, SurgicalFile};
pub(crate) use error::one_line;
pub use error::{ExportError, ImportError, Place, Warning};
pub use files::{AssetError, AssetFs, NoFiles};
pub use image_kind::{IMAGE_KINDS, ImageKind, measure_image};
pub use read_options::{ByteBudget, OverBudget, ReadOptions};
pub use registry::Formats;

/// The formats of this crate, in the order of precedence.
pub const BUILTIN: &[Format] = &[
    dfm::DFM,
    #[cfg(feature = "gltf")]
    gltf::GLB,
    #[cfg(feature = "gltf")]
    gltf::GLTF,
    #[cfg(feature = "gltf")]
    gltf::VRMA,
    bvh::BVH,
    obj::OBJ,
    m3d::M3D,
    x::X,
];

/// The formats of this crate that are written and never read: tables for other programs.
pub const TABLES: &[Format] = &[CURVES_CSV, CURVES_JSON];

/// Reads a model from the bytes of a file in one of the [`BUILTIN`] formats.
///
/// `name` is the name of the file; its extension determines the format where the content does not. `files` is asked for
/// the files that this one refers to (buffers, images). Runs in the calling thread, takes at most about one second plus
/// 100 ms per megabyte, and at most 256 MiB plus 32 times the bytes read. Any input returns a model or an error; what was
/// corrected in a model is listed as warnings. To read other formats too, use [`Formats::read`].
pub fn read(
    name: &str,
    bytes: &[u8],
    files: &dyn AssetFs,
    options: &ReadOptions<'_>,
) -> Result<Imported, ImportError> {
    Formats::builtin().read(name, bytes, files, options)
}
