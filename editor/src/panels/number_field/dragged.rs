//! A number field that has no focus: a number to be dragged or clicked.

use super::{Drag, Heard, NumberField, Refused, Typing};
use egui::{CursorIcon, Key, PointerButton, Rect, Response, Sense, Ui};

impl NumberField<'_> {
    /// While it has no focus: a number to be dragged or clicked.
    pub(super) fn rest(&self, ui: &mut Ui, rect: Rect) -> (Heard, Response) {
        let id = self.id;
        let mut heard = Heard::Nothing;
        // The focus went elsewhere: what is typed counts, unless Escape was pressed.
        let left = ui.data_mut(|data| data.remove_temp::<Typing>(id));
        if let Some(typing) = left
            && !ui.input(|input| input.key_pressed(Key::Escape))
            && typing.text != typing.first
        {
            match self.read(&typing.text) {
                Ok(value) => heard = Heard::Typed(value),
                Err(reason) => {
                    let refused = Refused::new(ui, reason, self.value);
                    ui.data_mut(|data| data.insert_temp(id, refused));
                }
            }
        }
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let before = ui.data_mut(|data| data.remove_temp::<Refused>(id));
        let refused = before.and_then(|refused| refused.next(ui, self.value));
        if let Some(refused) = &refused {
            ui.data_mut(|data| data.insert_temp(id, refused.clone()));
        }
        self.paint(ui, rect, &response, refused.as_ref());
        self.describe(ui, &response, refused.as_ref().map(|refused| refused.reason.as_str()));
        if response.clicked() {
            response.request_focus();
        }
        let dragged = self.drag(ui, &response);
        let quiet = ui.ctx().dragged_id().is_none() && ui.memory(|memory| memory.focused().is_none());
        let response = match refused {
            Some(refused) => response.on_hover_text(refused.reason),
            // It would lie over the fields below, one of which somebody may be typing into.
            None if quiet => response.on_hover_ui(|ui| self.tooltip(ui)),
            None => response,
        };
        (dragged.unwrap_or(heard), response)
    }

    pub(super) fn drag(&self, ui: &Ui, response: &Response) -> Option<Heard> {
        let id = self.id;
        if response.drag_started_by(PointerButton::Primary) {
            let start = self.value.unwrap_or(0.0);
            let mut drag = Drag { start, raw: 0.0, told: 0.0 };
            self.pull(ui, response, &mut drag);
            ui.data_mut(|data| data.insert_temp(id, drag));
            ui.data_mut(|data| data.remove::<Refused>(id));
            ui.ctx().request_repaint();
            return Some(Heard::Touched);
        }
        let mut drag = ui.data(|data| data.get_temp::<Drag>(id))?;
        if !response.dragged_by(PointerButton::Primary) {
            ui.data_mut(|data| data.remove::<Drag>(id));
            // Escape ends a drag.
            let escape = ui.input(|input| input.key_pressed(Key::Escape));
            return Some(if escape { Heard::Cancelled } else { Heard::Released });
        }
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        let by = self.pull(ui, response, &mut drag);
        let news = by != drag.told;
        drag.told = by;
        ui.data_mut(|data| data.insert_temp(id, drag));
        Some(if news { Heard::Dragged(by) } else { Heard::Nothing })
    }

    /// Moves the drag on by what the hand did in this frame; how far it is from its start.
    pub(super) fn pull(&self, ui: &Ui, response: &Response, drag: &mut Drag) -> f64 {
        let modifiers = ui.input(|input| input.modifiers);
        let by = response.drag_delta();
        let fine = if modifiers.shift { 0.1 } else { 1.0 };
        drag.raw += f64::from(by.x - by.y) * self.speed * fine;
        let mut to = drag.start + drag.raw;
        if modifiers.command && self.snap > 0.0 {
            to = (to / self.snap).round() * self.snap;
        }
        self.clamp(to) - drag.start
    }
}
