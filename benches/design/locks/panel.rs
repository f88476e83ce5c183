//! The panel, in the main thread.

use super::SharedState;
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Point, describe};
use std::sync::Arc;

/// Shows the document, and edits it in place.
pub struct Panel {
    shared: Arc<SharedState>,
    selected: Option<usize>,
}

impl Panel {
    /// Returns a panel of `shared`.
    pub fn new(shared: Arc<SharedState>) -> Self {
        Self { shared, selected: None }
    }

    /// Returns the rows that it shows.
    pub fn rows(&self) -> Vec<String> {
        self.shared.bones().iter().map(describe).collect()
    }

    /// Returns the bone that was clicked last.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// Called when the user moves a slider.
    pub fn drag_angle(&self, bone: usize, angle: f32) {
        self.shared.edit(bone, |bone| bone.angle = angle);
    }

    // feature: begin
    /// Called when the user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        self.shared.edit(bone, |bone| bone.color = color);
    }

    /// Called when the user toggles the visibility icon of a bone.
    pub fn toggle_visible(&self, bone: usize) {
        self.shared.edit(bone, |bone| bone.visible = !bone.visible);
    }
    // feature: end

    /// Called when the user clicks into the image.
    pub fn click(&mut self, point: Point) {
        self.selected = self.shared.pick(point);
    }
}
