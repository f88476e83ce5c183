//! Closes tooltips when a question or an overlay opens over their widgets. A tooltip is drawn above everything, and egui keeps it open while the
//! pointer rests on its widget, also below a modal dialog.

use super::context::PanelContext;
use super::overlay::Overlay;
use egui::{Context, PointerState};

/// The dialogs that are open over the panels, and whether tooltips below them are still to be closed.
#[derive(Debug, Default)]
pub(super) struct TooltipCloser {
    question: Option<u64>,
    overlay: Option<Overlay>,
    /// The dialog that has opened since the last frame without a pointer.
    due: Option<ModalKind>,
}

/// A kind of dialog that covers what is below it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ModalKind {
    /// It covers the panels.
    Overlay,
    /// It covers the panels and the overlay.
    Question,
}

/// The pointer while what is below a new dialog is drawn without it.
#[derive(Debug)]
pub(super) struct HiddenPointer {
    below: ModalKind,
    pointer: PointerState,
}

impl TooltipCloser {
    /// Begins a frame. Hides the pointer from what is below a dialog that has just opened, so that its tooltips are closed; a press or a release is
    /// not hidden. [`HiddenPointer::show_above`] shows it again.
    pub(super) fn begin(&mut self, ui: &Context, context: &PanelContext<'_>) -> Option<HiddenPointer> {
        let (question, overlay) = (context.prompts.question_number(), context.overlay);
        if overlay.is_some() && overlay != self.overlay {
            self.due = self.due.or(Some(ModalKind::Overlay));
        }
        if question.is_some() && question != self.question {
            self.due = Some(ModalKind::Question);
        }
        (self.question, self.overlay) = (question, overlay);
        let is_used =
            |pointer: &PointerState| pointer.any_down() || pointer.any_pressed() || pointer.any_released();
        let below = self.due.filter(|_| !ui.input(|input| is_used(&input.pointer)))?;
        self.due = None;
        Some(HiddenPointer { below, pointer: ui.input_mut(|input| std::mem::take(&mut input.pointer)) })
    }
}

impl HiddenPointer {
    /// Shows the pointer to a dialog of this kind if it is not below the new one. Returns what is still hidden.
    pub(super) fn show_above(self, ui: &Context, dialog: ModalKind) -> Option<Self> {
        if self.below != dialog {
            return Some(self);
        }
        ui.input_mut(|input| input.pointer = self.pointer);
        None
    }
}
