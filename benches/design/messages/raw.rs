//! The panel again, without handles: it names the messages and decides about their loss at every call.

use super::{Edit, PanelMessage, View, ViewportMessage};
use crate::design::skeleton::Colour; // feature
use crate::design::skeleton::{Point, describe};
use dragonfly_runtime::{Address, Context, Receiver};
use std::sync::Arc;

/// [`Panel`](super::Panel) without handles.
pub struct RawPanel {
    view: View,
    selected: Option<usize>,
    document: Address<Edit>,
    viewport: Address<ViewportMessage>,
}

impl RawPanel {
    /// An empty panel.
    pub fn new(document: Address<Edit>, viewport: Address<ViewportMessage>) -> Self {
        Self { view: Arc::new([]), selected: None, document, viewport }
    }

    /// What it shows.
    pub fn rows(&self) -> Vec<String> {
        self.view.iter().map(describe).collect()
    }

    /// The bone that was clicked last.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// The user moves a slider.
    pub fn drag_angle(&self, bone: usize, angle: f32) {
        let _ = self.document.send(Edit::SetAngle { bone, angle });
    }

    // feature: begin
    /// The user chooses a colour.
    pub fn choose_colour(&self, bone: usize, colour: Colour) {
        let _ = self.document.send(Edit::SetColour { bone, colour });
    }

    /// The user clicks the eye beside a bone.
    pub fn toggle_visible(&self, bone: usize) {
        let _ = self.document.send(Edit::ToggleVisible { bone });
    }
    // feature: end

    /// The user clicks into the picture; the answer comes later.
    pub fn click(&self, point: Point) {
        let _ = self.viewport.send(ViewportMessage::Pick(point));
    }
}

impl Receiver for RawPanel {
    type Message = PanelMessage;

    fn receive(&mut self, message: PanelMessage, _: &mut Context) {
        match message {
            PanelMessage::Show(view) => self.view = view,
            PanelMessage::Picked(bone) => self.selected = bone,
        }
    }
}
