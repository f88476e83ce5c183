//! The document and the panel again, with closures as messages: as short as with a lock, and still with one owner. The
//! edit is no longer a value, though: it cannot be written into a journal, undone, or shown in a trace.

use crate::design::messages::{PanelMessage, View, ViewportHandle};
use crate::design::skeleton::Color; // feature
use crate::design::skeleton::{Bone, Point, describe};
use dragonfly_runtime::{Address, Context, Receiver};
use std::sync::Arc;

/// A change of a bone.
pub struct BoneChange {
    bone: usize,
    change: Box<dyn FnOnce(&mut Bone) + Send>,
}

/// The only owner of the bones.
pub struct ClosureDocument {
    bones: Vec<Bone>,
    show: Box<dyn Fn(View)>,
}

impl ClosureDocument {
    /// Returns a document that publishes its state at once, with `show`.
    pub fn new(bones: Vec<Bone>, show: impl Fn(View) + 'static) -> Self {
        show(bones.as_slice().into());
        Self { bones, show: Box::new(show) }
    }
}

impl Receiver for ClosureDocument {
    type Message = BoneChange;

    fn receive(&mut self, BoneChange { bone, change }: BoneChange, _: &mut Context) {
        if let Some(bone) = self.bones.get_mut(bone) {
            change(bone);
            (self.show)(self.bones.as_slice().into());
        }
    }
}

/// The document's handle, whose interface never grows.
#[derive(Clone)]
pub struct ClosureHandle(pub Address<BoneChange>);

impl ClosureHandle {
    /// Applies `change` to a bone, later and in the document's thread.
    pub fn edit(&self, bone: usize, change: impl FnOnce(&mut Bone) + Send + 'static) {
        let _ = self.0.send(BoneChange { bone, change: Box::new(change) });
    }
}

/// The panel that sends closures.
pub struct ClosurePanel {
    view: View,
    selected: Option<usize>,
    document: ClosureHandle,
    viewport: ViewportHandle,
}

impl ClosurePanel {
    /// Returns an empty panel.
    pub fn new(document: ClosureHandle, viewport: ViewportHandle) -> Self {
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
        self.document.edit(bone, move |bone| bone.angle = angle);
    }

    // feature: begin
    /// Called when the user chooses a color.
    pub fn choose_color(&self, bone: usize, color: Color) {
        self.document.edit(bone, move |bone| bone.color = color);
    }

    /// Called when the user toggles the visibility icon of a bone.
    pub fn toggle_visible(&self, bone: usize) {
        self.document.edit(bone, |bone| bone.visible = !bone.visible);
    }
    // feature: end

    /// Called when the user clicks into the image; the answer arrives later.
    pub fn click(&self, point: Point) {
        self.viewport.pick(point);
    }
}

impl Receiver for ClosurePanel {
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
    use crate::design::messages::PanelHandle;
    use dragonfly_runtime::Stage;
    use std::cell::RefCell;
    use std::rc::Rc;

    #[test]
    fn closures_sent_as_messages_edit_the_document() {
        let mut stage = Stage::new();
        let [main, document] = ["main", "document"].map(|name| stage.start(name));
        let to_panel = main.reserve_address();
        let show = PanelHandle(to_panel.clone());
        let bones = vec![Bone::new("hip", 0.0)];
        let to_document =
            document.register_receiver(|_| ClosureDocument::new(bones, move |view| show.show(view)));
        // The viewport has no receiver, because this test draws nothing.
        let viewport = ViewportHandle(main.reserve_address());
        let panel = Rc::new(RefCell::new(ClosurePanel::new(ClosureHandle(to_document), viewport)));
        stage.context(&main).register_receiver_at(&to_panel, Rc::clone(&panel));
        panel.borrow().choose_color(0, [255, 0, 0]);
        panel.borrow().toggle_visible(0);
        panel.borrow().drag_angle(0, 0.5);
        panel.borrow().click([0.5, 0.0]);
        assert!(stage.settle(10));
        assert_eq!(panel.borrow().rows(), ["hip 0.50 #ff0000 hidden"]);
        assert_eq!(panel.borrow().selected(), None);
    }
}
