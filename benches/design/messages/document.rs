//! The document, in its thread.

use super::{PanelHandle, ViewportHandle};
use crate::design::skeleton::Bone;
use crate::design::skeleton::Color; // feature
use dragonfly_runtime::{Context, Receiver};
use std::sync::Arc;

/// A version of the document; never changed.
pub type View = Arc<[Bone]>;

/// The messages of the document.
pub enum Edit {
    /// Turns a bone.
    SetAngle {
        /// Index of the bone.
        bone: usize,
        /// Angle relative to the previous bone, in radians.
        angle: f32,
    },
    // feature: begin
    /// Chooses a color.
    SetColor {
        /// Index of the bone.
        bone: usize,
        /// The new color.
        color: Color,
    },
    /// Hides a bone, or shows it again.
    ToggleVisible {
        /// Index of the bone.
        bone: usize,
    },
    // feature: end
}

/// The only owner of the bones.
pub struct Document {
    bones: Vec<Bone>,
    panel: PanelHandle,
    viewport: ViewportHandle,
}

impl Document {
    /// Returns a document that publishes its state at once.
    pub fn new(bones: Vec<Bone>, panel: PanelHandle, viewport: ViewportHandle) -> Self {
        let document = Self { bones, panel, viewport };
        document.publish();
        document
    }

    /// Turns a bone.
    pub fn set_angle(&mut self, bone: usize, angle: f32) {
        self.change(bone, |bone| bone.angle = angle);
    }

    // feature: begin
    /// Chooses a bone's color.
    pub fn set_color(&mut self, bone: usize, color: Color) {
        self.change(bone, |bone| bone.color = color);
    }

    /// Hides a bone, or shows it again.
    pub fn toggle_visible(&mut self, bone: usize) {
        self.change(bone, |bone| bone.visible = !bone.visible);
    }
    // feature: end

    /// The only way to change the document, so that every change is published.
    fn change(&mut self, bone: usize, change: impl FnOnce(&mut Bone)) {
        if let Some(bone) = self.bones.get_mut(bone) {
            change(bone);
            self.publish();
        }
    }

    fn publish(&self) {
        let view: View = self.bones.as_slice().into();
        self.panel.show(Arc::clone(&view));
        self.viewport.show(view);
    }
}

impl Receiver for Document {
    type Message = Edit;

    fn receive(&mut self, edit: Edit, _: &mut Context) {
        match edit {
            Edit::SetAngle { bone, angle } => self.set_angle(bone, angle),
            // feature: begin
            Edit::SetColor { bone, color } => self.set_color(bone, color),
            Edit::ToggleVisible { bone } => self.toggle_visible(bone),
            // feature: end
        }
    }
}
