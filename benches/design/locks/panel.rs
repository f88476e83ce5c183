//! The panel, in the main thread.

use super::Shared;
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Point, describe};
use std::sync::Arc;

/// Shows the document, and edits it where it is.
pub struct Panel {
    shared: Arc<Shared>,
    selected: Option<usize>,
}

impl Panel {
    /// A panel over `shared`.
    pub fn new(shared: Arc<Shared>) -> Self {
        Self { shared, selected: None }
    }

    /// What it shows.
    pub fn rows(&self) -> Vec<String> {
        self.shared.bones().iter().map(describe).collect()
    }

    /// The bone that was clicked last.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// The user moves a slider.
    pub fn drag_angle(&self, bone: usize, angle: f32) {
        self.shared.edit(bone, |bone| bone.angle = angle);
    }

    // feature: begin
    /// The user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        self.shared.edit(bone, |bone| bone.color = color);
    }

    /// The user clicks the eye beside a bone.
    pub fn toggle_visible(&self, bone: usize) {
        self.shared.edit(bone, |bone| bone.visible = !bone.visible);
    }
    // feature: end

    /// The user clicks into the picture.
    pub fn click(&mut self, point: Point) {
        self.selected = self.shared.pick(point);
    }
}
