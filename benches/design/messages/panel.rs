//! The panel, in the main thread.

use super::{DocumentHandle, View, ViewportHandle};
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Point, describe};
use dragonfly_runtime::{Context, Receiver};
use std::sync::Arc;

/// The messages of the panel.
pub enum PanelMessage {
    /// Show this view from now on.
    Show(View),
    /// The answer to a click.
    Picked(Option<usize>),
}

/// Shows the newest view, and sends the user's actions. It never waits.
pub struct Panel {
    view: View,
    selected: Option<usize>,
    document: DocumentHandle,
    viewport: ViewportHandle,
}

impl Panel {
    /// Returns an empty panel.
    pub fn new(document: DocumentHandle, viewport: ViewportHandle) -> Self {
        Self { view: Arc::new([]), selected: None, document, viewport }
    }

    /// Returns the rows that it shows.
    pub fn rows(&self) -> Vec<String> {
        self.view.iter().map(describe).collect()
    }

    /// Returns the bone that was clicked last.
    pub fn selected(&self) -> Option<usize> {
        self.selected
    }

    /// Called when the user moves a slider.
    pub fn drag_angle(&self, bone: usize, angle: f32) {
        self.document.set_angle(bone, angle);
    }

    // feature: begin
    /// Called when the user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        self.document.set_color(bone, color);
    }

    /// Called when the user toggles the visibility icon of a bone.
    pub fn toggle_visible(&self, bone: usize) {
        self.document.toggle_visible(bone);
    }
    // feature: end

    /// Called when the user clicks into the image; the answer arrives later.
    pub fn click(&self, point: Point) {
        self.viewport.pick(point);
    }
}

impl Receiver for Panel {
    type Message = PanelMessage;

    fn receive(&mut self, message: PanelMessage, _: &mut Context) {
        match message {
            PanelMessage::Show(view) => self.view = view,
            PanelMessage::Picked(bone) => self.selected = bone,
        }
    }
}
