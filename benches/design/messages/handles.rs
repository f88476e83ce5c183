//! Handles: the same method names as the objects, from any thread (the thesis's method pairs, §2.2.6.2).
//!
//! A message to an object whose thread has stopped is dropped, because the program is ending. Only the handles have to
//! decide this.

use super::{Edit, PanelMessage, View, ViewportMessage};
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::Point;
use dragonfly_runtime::Address;

/// Sends the calls of [`Document`](super::Document) from any thread.
#[derive(Clone)]
pub struct DocumentHandle(pub Address<Edit>);

impl DocumentHandle {
    /// Turns a bone.
    pub fn set_angle(&self, bone: usize, angle: f32) {
        let _ = self.0.send(Edit::SetAngle { bone, angle });
    }

    // feature: begin
    /// Chooses a bone's color.
    pub fn set_color(&self, bone: usize, color: Color) {
        let _ = self.0.send(Edit::SetColor { bone, color });
    }

    /// Hides a bone, or shows it again.
    pub fn toggle_visible(&self, bone: usize) {
        let _ = self.0.send(Edit::ToggleVisible { bone });
    }
    // feature: end
}

/// Sends the calls of [`Viewport`](super::Viewport) from any thread.
#[derive(Clone)]
pub struct ViewportHandle(pub Address<ViewportMessage>);

impl ViewportHandle {
    /// Draws `view` in the next frame.
    pub fn show(&self, view: View) {
        let _ = self.0.send(ViewportMessage::Show(view));
    }

    /// Requests the bone at `point`; the panel receives the answer.
    pub fn pick(&self, point: Point) {
        let _ = self.0.send(ViewportMessage::Pick(point));
    }
}

/// Sends the calls of [`Panel`](super::Panel) from any thread.
#[derive(Clone)]
pub struct PanelHandle(pub Address<PanelMessage>);

impl PanelHandle {
    /// Shows `view` from now on.
    pub fn show(&self, view: View) {
        let _ = self.0.send(PanelMessage::Show(view));
    }

    /// Passes the answer to a click.
    pub fn picked(&self, bone: Option<usize>) {
        let _ = self.0.send(PanelMessage::Picked(bone));
    }
}
