//! Hides the pointer from what is below a question or an overlay. A tooltip is drawn above everything, and egui keeps it open while the pointer rests
//! on its widget, also below a modal dialog.

use super::context::PanelContext;
use egui::{Context, PointerState};

/// A kind of dialog that covers what is below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ModalKind {
    /// It covers the panels.
    Overlay,
    /// It covers the panels and the overlay.
    Question,
}

/// The pointer while what is below a dialog is drawn without it.
#[derive(Debug)]
pub(super) struct HiddenPointer {
    below: ModalKind,
    pointer: PointerState,
}

impl HiddenPointer {
    /// Hides the pointer from what is below the dialog that is open, so that no tooltip is shown there; a press or a release is not hidden.
    /// [`Self::show_above`] shows it again.
    pub(super) fn begin(ui: &Context, context: &PanelContext<'_>) -> Option<Self> {
        let question = context.prompts.question_number().map(|_| ModalKind::Question);
        let below = question.or(context.overlay.map(|_| ModalKind::Overlay))?;
        let is_used =
            |pointer: &PointerState| pointer.any_down() || pointer.any_pressed() || pointer.any_released();
        if ui.input(|input| is_used(&input.pointer)) {
            return None;
        }
        Some(Self { below, pointer: ui.input_mut(|input| std::mem::take(&mut input.pointer)) })
    }

    /// Shows the pointer to a dialog of this kind if it is not below the one that is open. Returns what is still hidden.
    pub(super) fn show_above(self, ui: &Context, dialog: ModalKind) -> Option<Self> {
        if self.below != dialog {
            return Some(self);
        }
        ui.input_mut(|input| input.pointer = self.pointer);
        None
    }
}
