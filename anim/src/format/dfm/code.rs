//! Names of the rules that a `.dfm` file can break: the codes of [`ImportError::Invalid`].
//!
//! [`ImportError::Invalid`]: crate::format::ImportError::Invalid

/// The file is shorter or longer than its first four bytes specify.
pub const DFM_LENGTH: &str = "DFM_LENGTH";
/// The file does not have the ending of a `.dfm` file.
pub const DFM_ENDING: &str = "DFM_ENDING";
/// A part was changed after the file was written.
pub const DFM_CHECKSUM: &str = "DFM_CHECKSUM";
/// The parts are not those of this version, in their order and without gaps.
pub const DFM_PARTS: &str = "DFM_PARTS";
/// The number of bytes of a part is not the number of its elements times their size, or the size is not that of the
/// version.
pub const DFM_SIZE: &str = "DFM_SIZE";
/// A part has fewer or more elements than the other parts need.
pub const DFM_COUNT: &str = "DFM_COUNT";
/// An index is out of range, or a parent does not come before its child.
pub const DFM_INDEX: &str = "DFM_INDEX";
/// A number is not one of those allowed.
pub const DFM_VALUE: &str = "DFM_VALUE";
/// A text is not UTF-8.
pub const DFM_TEXT: &str = "DFM_TEXT";
/// The file was written by a newer version; unknown content was left out.
pub const DFM_NEWER: &str = "DFM_NEWER";
/// The format has no room for the extras of a take.
pub const DFM_EXTRAS: &str = "DFM_EXTRAS";
