//! Why a file is not saved.

use crate::format::one_line;
use thiserror::Error;

/// Why a save is refused. Nothing is half done then: there is no plan. Shown as `place: reason`, on one line.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SaveError {
    /// The model or the takes do not belong to this file, or break the promises of their types.
    #[error("{}: {}", one_line(place), one_line(reason))]
    Mismatch {
        /// `take 2`, `take 2 bone 5`.
        place: String,
        /// What does not fit, with the numbers.
        reason: String,
    },
    /// Keys that glTF cannot hold, or that no reader would take.
    #[error("take \"{}\", {} \"{}\", {path}: {}", one_line(take), if *path == "weights" { "mesh" } else { "bone" },
        one_line(bone), one_line(reason))]
    Keys {
        /// Name of the take.
        take: String,
        /// Name of the bone, or number of the mesh instance.
        bone: String,
        /// `translation`, `rotation`, `scale` or `weights`.
        path: &'static str,
        /// What is wrong, with the key.
        reason: String,
    },
    /// A bone or mesh that moves is no node of the file, or a node that glTF cannot animate.
    #[error("take \"{}\": \"{}\" {reason}", one_line(take), one_line(bone))]
    Node {
        /// Name of the take.
        take: String,
        /// Name of the bone, or number of the mesh instance.
        bone: String,
        /// Why not.
        reason: &'static str,
    },
    /// The file is of a kind that an edit cannot be put into.
    #[error("{}: {}", one_line(place), one_line(reason))]
    File {
        /// JSON pointer, or `file`.
        place: String,
        /// Why not.
        reason: String,
    },
    /// More bytes than the container can say, or than could be opened again.
    #[error("file: {bytes} bytes, at most {limit}")]
    TooLarge {
        /// Bytes that the file would have.
        bytes: u64,
        /// Bytes that it may have.
        limit: u64,
    },
}
