//! Input of the pointer in one frame, and the text next to it.

use crate::panels::theme::Theme;
use egui::{
    CornerRadius, FontId, Key, Modifiers, PointerButton, Pos2, Rect, Response, Stroke, StrokeKind, Ui, pos2,
    vec2,
};

/// The pointer and the keys that drags depend on, read once a frame.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::panels) struct PointerInput {
    /// Whether the primary button is down.
    pub(in crate::panels) primary_down: bool,
    /// Whether the primary button went down and up again in this frame.
    pub(in crate::panels) clicked: bool,
    /// Whether the secondary button went down in this frame.
    pub(in crate::panels) secondary_pressed: bool,
    /// Whether Escape or the secondary button is down, which cancels a drag.
    pub(in crate::panels) cancels: bool,
    /// Whether the key is down that makes a drag of keys a ripple.
    pub(in crate::panels) ripple: bool,
    /// Whether the modifier keys are held with which the primary button pans.
    pub(in crate::panels) pans: bool,
    /// Modifier keys.
    pub(in crate::panels) modifiers: Modifiers,
    /// Position, points.
    pub(in crate::panels) pointer: Option<Pos2>,
    /// Position of the last press, points.
    pub(in crate::panels) pressed_at: Option<Pos2>,
}

impl PointerInput {
    /// Reads the input of this frame.
    pub(in crate::panels) fn read(ui: &Ui) -> Self {
        ui.input(|input| Self {
            primary_down: input.pointer.primary_down(),
            clicked: input.pointer.primary_pressed() && input.pointer.primary_released(),
            secondary_pressed: input.pointer.button_pressed(PointerButton::Secondary),
            cancels: input.pointer.secondary_down() || input.key_down(Key::Escape),
            ripple: input.key_down(Key::Num2),
            pans: input.modifiers.alt && input.modifiers.shift,
            modifiers: input.modifiers,
            pointer: input.pointer.interact_pos(),
            pressed_at: input.pointer.press_origin(),
        })
    }

    /// Reads the input for a widget that egui drags: the button counts as down while egui reports a drag.
    pub(in crate::panels) fn of_widget(ui: &Ui, response: &Response) -> Self {
        let escape = ui.input(|input| input.key_pressed(Key::Escape));
        let read = Self::read(ui);
        let primary_down = response.dragged_by(PointerButton::Primary);
        Self { primary_down, cancels: read.cancels || escape, pans: false, ..read }
    }
}

/// Converts a position of the drag machine into the type of egui.
pub(in crate::panels) fn position(at: glam::Vec2) -> Pos2 {
    pos2(at.x, at.y)
}

/// Draws the present amount of a drag, or a value, next to the pointer; not over an open menu.
pub(in crate::panels) fn readout(ui: &Ui, pointer: Pos2, text: &str) {
    if egui::Popup::is_any_open(ui.ctx()) {
        return;
    }
    let theme = Theme::of(ui);
    let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::unique("readout"));
    let painter = ui.ctx().layer_painter(layer);
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(11.0), theme.text);
    let screen = ui.ctx().content_rect();
    let size = galley.size() + vec2(12.0, 6.0);
    let corner = pos2(
        (pointer.x + 14.0).min(screen.right() - size.x).max(screen.left()),
        (pointer.y - 28.0).max(screen.top()),
    );
    let rect = Rect::from_min_size(corner, size);
    painter.rect_filled(rect, CornerRadius::same(4), theme.raised);
    painter.rect_stroke(rect, CornerRadius::same(4), Stroke::new(1.0, theme.line), StrokeKind::Inside);
    painter.galley(rect.min + vec2(6.0, 3.0), galley, theme.text);
}
