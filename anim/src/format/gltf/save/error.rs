//! Errors of a save.

use crate::format::one_line;
use thiserror::Error;

/// Reason why a save is refused. There is no partial result. Displayed as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The model or the takes do not belong to this file, or break the invariants of their types.
    #[error("{}: {}", one_line(place), one_line(reason))]
    Mismatch {
        /// Place, such as `take 2` or `take 2 bone 5`.
        place: String,
        /// Description of the mismatch, with the numbers.
        reason: String,
    },
    /// Keys that glTF cannot represent, or that no reader would accept.
    #[error("take \"{}\", {} \"{}\", {path}: {}", one_line(take), if *path == "weights" { "mesh" } else { "bone" },
        one_line(bone), one_line(reason))]
    Keys {
        /// Name of the take.
        take: String,
        /// Name of the bone, or number of the mesh instance.
        bone: String,
        /// Property: `translation`, `rotation`, `scale` or `weights`.
        path: &'static str,
        /// Description of the error, with the number of the key.
        reason: String,
    },
    /// An animated bone or mesh is not a node of the file, or a node that glTF cannot animate.
    #[error("take \"{}\": \"{}\" {reason}", one_line(take), one_line(bone))]
    Node {
        /// Name of the take.
        take: String,
        /// Name of the bone, or number of the mesh instance.
        bone: String,
        /// Reason why it cannot be animated.
        reason: &'static str,
    },
    /// The structure of the file does not allow the edit.
    #[error("{}: {}", one_line(place), one_line(reason))]
    File {
        /// JSON pointer, or `file`.
        place: String,
        /// Reason.
        reason: String,
    },
    /// The file would be too large for its container, or to be opened again.
    #[error("file: {bytes} bytes, at most {limit}")]
    TooLarge {
        /// Number of bytes that the file would have.
        bytes: u64,
        /// Largest number of bytes allowed.
        limit: u64,
    },
}
