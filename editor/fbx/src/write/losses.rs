//! Content that a written file does not contain.

use crate::code::NOT_IN_FBX;
use dragonfly_anim::format::{Place, Warning};

/// A list of losses, each once.
#[derive(Default)]
pub(super) struct FbxLosses(Vec<Warning>);

impl FbxLosses {
    /// Adds a loss; `pointer` is a JSON pointer into the model.
    pub(super) fn add(&mut self, pointer: impl Into<String>, text: impl Into<String>) {
        let lost = Warning { place: Place::Pointer(pointer.into()), code: NOT_IN_FBX, text: text.into() };
        if !self.0.contains(&lost) {
            self.0.push(lost);
        }
    }

    /// Returns the list.
    pub(super) fn into_list(self) -> Vec<Warning> {
        self.0
    }
}
