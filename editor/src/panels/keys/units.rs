//! The unit of the ruler.

use super::KeyEditing;

impl KeyEditing {
    /// Returns whether the ruler has seconds instead of frames.
    pub fn ruler_in_seconds(&self) -> bool {
        self.seconds
    }

    /// Sets whether the ruler has seconds instead of frames.
    pub(in crate::panels) fn set_ruler_in_seconds(&mut self, seconds: bool) {
        self.seconds = seconds;
    }
}
