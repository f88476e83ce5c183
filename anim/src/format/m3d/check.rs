//! The rules that an `.m3d` file can break: codes of errors and warnings.

/// An index is not in range.
pub const INDEX_OUT_OF_RANGE: &str = "INDEX_OUT_OF_RANGE";
/// A number is where a label was expected.
pub const LABEL_MISSING: &str = "LABEL_MISSING";
/// Text after the last section is ignored.
pub const TEXT_IGNORED: &str = "TEXT_IGNORED";
/// A parent comes after its child, or is the bone itself.
pub const PARENT_LATER: &str = "PARENT_LATER";
/// The offset of a bone has no inverse, or is sheared.
pub const OFFSET_INVALID: &str = "OFFSET_INVALID";
/// Weights do not add up to one.
pub const WEIGHTS_INVALID: &str = "WEIGHTS_INVALID";
/// Triangles belong to no subset; they have no material.
pub const SUBSET_MISSING: &str = "SUBSET_MISSING";
/// A bone of a clip has no key; it is at rest.
pub const KEYS_MISSING: &str = "KEYS_MISSING";
/// Times of keys do not ascend.
pub const TIMES_NOT_ASCENDING: &str = "TIMES_NOT_ASCENDING";
/// A rotation is not of unit length.
pub const ROTATION_NON_UNIT: &str = "ROTATION_NON_UNIT";
/// A position is too large for single precision.
pub const HUGE_POSITION: &str = "HUGE_TRANSLATION";
/// The file has no bones, and so no room for takes.
pub const TAKE_NOT_STORED: &str = "TAKE_NOT_STORED";
/// A name is not possible in the file.
pub const NAME_NOT_STORED: &str = "NAME_NOT_STORED";
/// Layers, contacts and events have no room in the file.
pub const EXTRAS_NOT_STORED: &str = "EXTRAS_NOT_STORED";
/// Shape keys have no room in the file.
pub const MORPHS_NOT_STORED: &str = "MORPHS_NOT_STORED";
/// A curve between two keys is no straight line.
pub const INTERPOLATION_NOT_STORED: &str = "INTERPOLATION_NOT_STORED";
/// A vertex has more than four influences.
pub const INFLUENCES_NOT_STORED: &str = "INFLUENCES_NOT_STORED";
/// The file has more vertices than indices of 16 bits reach.
pub const INDICES_TOO_LARGE: &str = "INDICES_TOO_LARGE";
/// Something of a material has no room in the file.
pub const MATERIAL_NOT_STORED: &str = "MATERIAL_NOT_STORED";
/// Something of a vertex has no room in the file.
pub const VERTICES_NOT_STORED: &str = "VERTICES_NOT_STORED";
/// Two skins bind a bone differently; the file has one offset for it.
pub const OFFSET_NOT_STORED: &str = "OFFSET_NOT_STORED";
/// The rest pose is not that in which the mesh is bound; the file has no other.
pub const REST_NOT_STORED: &str = "REST_NOT_STORED";
