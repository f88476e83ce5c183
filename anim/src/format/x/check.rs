//! The rules that an `.x` file can break: codes of errors and warnings.

/// The header is not that of a known encoding.
pub const HEADER_INVALID: &str = "HEADER_INVALID";
/// The version is neither 0302 nor 0303.
pub const VERSION_UNKNOWN: &str = "VERSION_UNKNOWN";
/// The compressed data is damaged.
pub const COMPRESSED_DATA_INVALID: &str = "COMPRESSED_DATA_INVALID";
/// An object has no end, or there is one end too many.
pub const BRACE_INVALID: &str = "BRACE_INVALID";
/// An index is not in range.
pub const INDEX_OUT_OF_RANGE: &str = "INDEX_OUT_OF_RANGE";
/// A list does not fit the mesh, and is left out.
pub const LIST_IGNORED: &str = "LIST_IGNORED";
/// An object that is referred to does not exist.
pub const REFERENCE_UNKNOWN: &str = "REFERENCE_UNKNOWN";
/// A skin refers to a frame that is not in the file; its vertices do not move.
pub const FRAME_MISSING: &str = "FRAME_MISSING";
/// Keys of an unknown type are left out.
pub const KEY_TYPE_UNKNOWN: &str = "KEY_TYPE_UNKNOWN";
/// A second list of keys is left out.
pub const KEYS_TWICE: &str = "KEYS_TWICE";
/// Times of keys do not ascend.
pub const TIMES_NOT_ASCENDING: &str = "TIMES_NOT_ASCENDING";
/// A rotation is not of unit length.
pub const ROTATION_NON_UNIT: &str = "ROTATION_NON_UNIT";
/// The file has no rate of its ticks, and is too short for the usual one; a rate was guessed.
pub const TICKS_GUESSED: &str = "TICKS_GUESSED";
/// A matrix is sheared or not affine.
pub const MATRIX_INVALID: &str = "MATRIX_INVALID";
/// A number is too large for single precision.
pub const HUGE_POSITION: &str = "HUGE_TRANSLATION";
/// Vertices have weights that do not add up to one, or none.
pub const WEIGHTS_INVALID: &str = "WEIGHTS_INVALID";
/// Polygons without area are left out, or cross themselves.
pub const POLYGON_INVALID: &str = "POLYGON_INVALID";
/// Layers, contacts and events have no room in the file.
pub const EXTRAS_NOT_STORED: &str = "EXTRAS_NOT_STORED";
/// Shape keys have no room in the file.
pub const MORPHS_NOT_STORED: &str = "MORPHS_NOT_STORED";
/// A name is not possible in the file.
pub const NAME_NOT_STORED: &str = "NAME_NOT_STORED";
/// A curve between two keys is no straight line.
pub const INTERPOLATION_NOT_STORED: &str = "INTERPOLATION_NOT_STORED";
/// Keys are not at a whole number of ticks.
pub const KEYS_BETWEEN_TICKS: &str = "KEYS_BETWEEN_TICKS";
/// A bone has no frame in the file that keys can refer to.
pub const BONE_NOT_STORED: &str = "BONE_NOT_STORED";
/// Something of a material has no room in the file.
pub const MATERIAL_NOT_STORED: &str = "MATERIAL_NOT_STORED";
/// Something of a vertex has no room in the file.
pub const VERTICES_NOT_STORED: &str = "VERTICES_NOT_STORED";
