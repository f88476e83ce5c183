//! The panel again, without handles: each call names a message and handles the error of sending it.

use crate::design::messages::{Edit, PanelMessage, View, ViewportMessage};
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Point, describe};
use dragonfly_runtime::{Address, Context, Receiver};
use std::sync::Arc;

/// [`Panel`](crate::design::messages::Panel) without handles.
pub struct RawPanel {
    view: View,
    selected: Option<usize>,
    document: Address<Edit>,
    viewport: Address<ViewportMessage>,
}

impl RawPanel {
    /// Returns an empty panel.
    pub fn new(document: Address<Edit>, viewport: Address<ViewportMessage>) -> Self {
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
        let _ = self.document.send(Edit::SetAngle { bone, angle });
    }

    // feature: begin
    /// Called when the user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        let _ = self.document.send(Edit::SetColor { bone, color });
    }

    /// Called when the user toggles the visibility icon of a bone.
    pub fn toggle_visible(&self, bone: usize) {
        let _ = self.document.send(Edit::ToggleVisible { bone });
    }
    // feature: end

    /// Called when the user clicks into the image; the answer arrives later.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design::messages::{Document, PanelHandle, ViewportHandle};
    use crate::design::skeleton::Bone;
    use dragonfly_runtime::Stage;
    use std::cell::RefCell;
    use std::rc::Rc;

    #[test]
    fn a_panel_without_handles_works_like_the_one_with_handles() {
        let bones = ["hip", "knee", "foot"].map(|name| Bone::new(name, 0.0)).to_vec();
        let mut stage = Stage::new();
        let [main, document, graphics] = ["main", "document", "graphics"].map(|name| stage.start(name));
        let panel_address = main.reserve_address();
        let document_address = document.reserve_address();
        let viewport_address = graphics.reserve_address();
        let raw = RawPanel::new(document_address.clone(), viewport_address.clone());
        let panel = Rc::new(RefCell::new(raw));
        stage.context(&main).register_receiver_at(&panel_address, Rc::clone(&panel));
        let handles = (PanelHandle(panel_address), ViewportHandle(viewport_address));
        document.register_receiver_at(&document_address, move |_| Document::new(bones, handles.0, handles.1));
        assert!(stage.settle(10));
        panel.borrow().choose_color(0, [255, 128, 0]);
        panel.borrow().toggle_visible(1);
        panel.borrow().drag_angle(2, 0.5);
        panel.borrow().click([0.5, 0.0]);
        assert!(stage.settle(10));
        assert_eq!(
            panel.borrow().rows(),
            ["hip 0.00 #ff8000", "knee 0.00 #ffffff hidden", "foot 0.50 #ffffff"]
        );
        assert_eq!(panel.borrow().selected(), None);
    }
}
