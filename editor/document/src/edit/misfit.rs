//! The reasons why an edit of one version of a model does not fit another version.

use super::Property;
use crate::adapter::EditError;
use thiserror::Error;

/// The reason why an edit, or a part of it, cannot be applied to the new version of a model.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Misfit {
    /// The new version does not have the take, or the edit that created it did not fit.
    #[error("the new version has no take {0:?}")]
    NoTake(String),
    /// The new version does not have the layer, or the edit that created it did not fit.
    #[error("the take {take:?} has no layer {layer:?} in the new version")]
    NoLayer {
        /// Name of the take.
        take: String,
        /// Name of the layer.
        layer: String,
    },
    /// The new version does not have the bone.
    #[error("the new version has no bone {0:?}")]
    NoBone(String),
    /// Several bones have the name, and the new version has none below the same parents.
    #[error("several bones are called {0:?}, and the new version has none of them in the same place")]
    ManyBones(String),
    /// The new version does not have the mesh with shape keys.
    #[error("the new version has no mesh {0:?} with shape keys")]
    NoMesh(String),
    /// The mesh has lost the shape key.
    #[error("the mesh {mesh:?} has no shape key {shape:?} in the new version")]
    NoShape {
        /// Name of the mesh.
        mesh: String,
        /// Name of the shape key.
        shape: String,
    },
    /// The new version has no key where the edit expects one.
    #[error("{bone:?} has no {} key at {time} s in the new version{}", property.name(), further(*more))]
    NoKey {
        /// Name of the bone.
        bone: String,
        /// Which channel.
        property: Property,
        /// Seconds: time of the first missing key.
        time: f32,
        /// Number of further missing keys of the channel.
        more: usize,
    },
    /// The new version does not have the text.
    #[error("the new version has no text {0:?}")]
    NoText(String),
    /// The new version has a text of the name of a new one.
    #[error("the new version has a text of this name already")]
    TextIsThere,
    /// The new version has another text there.
    #[error("line {line} of {text} is another one in the new version")]
    OtherText {
        /// Name of the text.
        text: String,
        /// Line of the old version, from 1.
        line: usize,
    },
    /// Steps were undone that the file contains.
    #[error("an undone step that was saved before cannot be undone in another version of the file")]
    UndoneSave,
    /// The edit cannot be applied to the new version.
    #[error(transparent)]
    Refused(#[from] EditError),
}

/// Returns the end of a sentence about a number of keys.
fn further(more: usize) -> String {
    match more {
        0 => String::new(),
        1 => ", nor at one more time".to_owned(),
        _ => format!(", nor at {more} more times"),
    }
}
