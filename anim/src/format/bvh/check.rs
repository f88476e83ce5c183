//! The rules that a BVH file can break: codes of errors and warnings.

/// Two joints have one name; the second is renamed.
pub const NAME_TWICE: &str = "NAME_TWICE";
/// A channel is neither a position nor a rotation about an axis.
pub const CHANNEL_UNKNOWN: &str = "CHANNEL_UNKNOWN";
/// A position is too large for single precision.
pub const HUGE_POSITION: &str = "HUGE_TRANSLATION";
/// The file has no section `MOTION`; the model has no take.
pub const MOTION_MISSING: &str = "MOTION_MISSING";
/// The frame time is zero, negative, not finite, or not that of a motion; 1/30 s is used.
pub const FRAME_TIME_INVALID: &str = "FRAME_TIME_INVALID";
/// The file has fewer frames than it announces.
pub const FRAMES_MISSING: &str = "FRAMES_MISSING";
/// Numbers or text after the last frame are ignored.
pub const TEXT_IGNORED: &str = "TEXT_IGNORED";
/// The up axis of the figure seems to be another one than y.
pub const UP_DOUBTFUL: &str = "UP_DOUBTFUL";
/// A BVH file has one take.
pub const TAKE_NOT_STORED: &str = "TAKE_NOT_STORED";
/// A take has no name in the file, or the name of a bone is not possible there.
pub const NAME_NOT_STORED: &str = "NAME_NOT_STORED";
/// Layers, contacts and events have no room in the file.
pub const EXTRAS_NOT_STORED: &str = "EXTRAS_NOT_STORED";
/// Weights of shape keys have no room in the file.
pub const MORPHS_NOT_STORED: &str = "MORPHS_NOT_STORED";
/// Meshes, skins, materials and images have no room in the file.
pub const MESHES_NOT_STORED: &str = "MESHES_NOT_STORED";
/// A joint has no channels that can express a property.
pub const CHANNEL_MISSING: &str = "CHANNEL_MISSING";
/// Bones have no scale in the file.
pub const SCALE_NOT_STORED: &str = "SCALE_NOT_STORED";
/// Keys are not at the time of a frame.
pub const KEYS_BETWEEN_FRAMES: &str = "KEYS_BETWEEN_FRAMES";
/// A curve between two frames is no straight line.
pub const INTERPOLATION_NOT_STORED: &str = "INTERPOLATION_NOT_STORED";
/// The file does not contain its unit, and it is one that readers do not guess from the size of the figure.
pub const UNIT_NOT_STORED: &str = "UNIT_NOT_STORED";
/// Several root bones are below one more joint in the file.
pub const COMMON_ROOT_ADDED: &str = "COMMON_ROOT_ADDED";
/// A take starts at zero in the file.
pub const START_NOT_STORED: &str = "START_NOT_STORED";
