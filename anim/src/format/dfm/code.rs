//! Names of the rules that a `.dfm` file can break: the codes of [`ImportError::Invalid`].
//!
//! [`ImportError::Invalid`]: crate::format::ImportError::Invalid

/// The file is shorter or longer than its first four bytes say.
pub const DFM_LENGTH: &str = "DFM_LENGTH";
/// The file does not end as such files do.
pub const DFM_ENDING: &str = "DFM_ENDING";
/// A part is not what it was when the file was written.
pub const DFM_CHECKSUM: &str = "DFM_CHECKSUM";
/// The parts are not those of this version, in their order, one behind the other.
pub const DFM_PARTS: &str = "DFM_PARTS";
/// Count and size of a part's elements do not give its bytes, or the size is not the version's.
pub const DFM_SIZE: &str = "DFM_SIZE";
/// A part has fewer or more elements than the others ask for.
pub const DFM_COUNT: &str = "DFM_COUNT";
/// A number names something that is not there, or a parent does not come before its child.
pub const DFM_INDEX: &str = "DFM_INDEX";
/// A number is none of those allowed.
pub const DFM_VALUE: &str = "DFM_VALUE";
/// A text is not UTF-8.
pub const DFM_TEXT: &str = "DFM_TEXT";
/// The file was written by a newer version; what this one does not know was left out.
pub const DFM_NEWER: &str = "DFM_NEWER";
