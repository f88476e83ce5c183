//! The panel, in the main thread.

use super::{DocumentHandle, View, ViewportHandle};
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Point, describe};
use dragonfly_runtime::{Context, Receiver};
use std::sync::Arc;

/// What others tell the panel.
pub enum PanelMessage {
    /// Show this from now on.
    Show(View),
    /// The answer to a click.
    Picked(Option<usize>),
}

/// Shows the newest view, and sends on what the user does. It waits for nobody.
pub struct Panel {
    view: View,
    selected: Option<usize>,
    document: DocumentHandle,
    viewport: ViewportHandle,
}

impl Panel {
    /// An empty panel.
    pub fn new(document: DocumentHandle, viewport: ViewportHandle) -> Self {
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
        self.document.set_angle(bone, angle);
    }

    // feature: begin
    /// The user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        self.document.set_color(bone, color);
    }

    /// The user clicks the eye beside a bone.
    pub fn toggle_visible(&self, bone: usize) {
        self.document.toggle_visible(bone);
    }
    // feature: end

    /// The user clicks into the picture; the answer comes later.
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
