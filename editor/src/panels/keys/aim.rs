//! Action of the next press over the timeline or the curves, where a command chose it.

use super::KeyEditing;

/// Action over keys that a command prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyAim {
    /// The next drag draws a selection box, also where it begins on a key.
    Box,
    /// A menu of interpolations is open at the pointer.
    InterpolationMenu,
    /// A menu of tangents is open at the pointer.
    TangentMenu,
}

impl KeyEditing {
    /// Returns what a command prepared.
    pub fn aim(&self) -> Option<KeyAim> {
        self.aim
    }

    /// Returns whether the next drag draws a selection box.
    pub fn draws_box(&self) -> bool {
        self.aim == Some(KeyAim::Box)
    }

    /// Prepares something, or nothing.
    pub(in crate::panels) fn set_aim(&mut self, aim: Option<KeyAim>) {
        self.aim = aim.filter(|_| self.drag.is_none() && self.buttonless.is_none());
    }
}
