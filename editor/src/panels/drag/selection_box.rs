//! A box that selects what it touches.

use crate::panels::theme::Theme;
use dragonfly_document::bones::Choice;
use egui::{CornerRadius, Modifiers, Pos2, Rect, Stroke, StrokeKind, Ui};

/// A selection box that is being drawn. Its first corner stays in place when the content is panned or zoomed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::panels) struct SelectionBox {
    /// First corner in the units of the content: seconds, and the panel's vertical unit.
    pub(in crate::panels) from: [f32; 2],
    /// How the box alters the selection.
    pub(in crate::panels) choice: Choice,
}

impl SelectionBox {
    /// Draws the box from `corner`, where the first corner is now, to the pointer.
    pub(in crate::panels) fn paint(ui: &Ui, clip: Rect, corner: Pos2, pointer: Pos2) {
        let theme = Theme::of(ui);
        let frame = Rect::from_two_pos(corner, pointer);
        let painter = ui.painter().with_clip_rect(clip);
        painter.rect_filled(frame, CornerRadius::ZERO, theme.accent.gamma_multiply(0.12));
        let edge = Stroke::new(1.0, theme.accent);
        painter.rect_stroke(frame, CornerRadius::ZERO, edge, StrokeKind::Inside);
    }

    /// Returns the ranges from the first corner to `to`, ascending, in the units of the content.
    pub(in crate::panels) fn ranges(&self, to: [f32; 2]) -> [[f32; 2]; 2] {
        std::array::from_fn(|axis| {
            let (a, b) = (self.from[axis], to[axis]);
            [a.min(b), a.max(b)]
        })
    }
}

/// Returns how a click or a box with these modifier keys changes the selection.
pub(in crate::panels) fn choice_of(modifiers: Modifiers) -> Choice {
    match modifiers {
        Modifiers { command: true, .. } => Choice::Toggle,
        Modifiers { shift: true, .. } => Choice::Add,
        _ => Choice::Replace,
    }
}
