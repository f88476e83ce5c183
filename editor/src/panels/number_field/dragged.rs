//! A number field without focus: dragged, or clicked to get the focus.

use super::{DraggedNumber, FieldEvent, NumberField, RefusedNumber, Typing};
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput};
use egui::{CursorIcon, Key, PointerButton, Rect, Response, Sense, Ui};

type NumberDrag = PanelDrag<(), DraggedNumber>;

impl NumberField<'_> {
    /// Draws the field without focus.
    pub(super) fn rest(&self, ui: &mut Ui, rect: Rect) -> (FieldEvent, Response) {
        let id = self.id;
        let mut event = FieldEvent::Nothing;
        // The focus moved elsewhere: the typed text counts, unless Escape was pressed.
        let left = ui.data_mut(|data| data.remove_temp::<Typing>(id));
        if let Some(typing) = left
            && !ui.input(|input| input.key_pressed(Key::Escape))
            && typing.text != typing.first
        {
            match self.entry(&typing.text) {
                Ok(entered) => event = entered,
                Err(reason) => {
                    let refused = RefusedNumber::new(ui, reason, self.value);
                    ui.data_mut(|data| data.insert_temp(id, refused));
                }
            }
        }
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let before = ui.data_mut(|data| data.remove_temp::<RefusedNumber>(id));
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
            // The tooltip would cover the fields below, which the user may be typing into.
            None if quiet => response.on_hover_ui(|ui| self.tooltip(ui)),
            None => response,
        };
        (dragged.unwrap_or(event), response)
    }

    fn drag(&self, ui: &Ui, response: &Response) -> Option<FieldEvent> {
        let id = self.id;
        if response.drag_started_by(PointerButton::Primary) {
            let mut number = DraggedNumber { start: self.value.unwrap_or(0.0), raw: 0.0, reported: 0.0 };
            self.advance(ui, response, &mut number);
            ui.data_mut(|data| data.insert_temp(id, NumberDrag::dragging(number)));
            ui.data_mut(|data| data.remove::<RefusedNumber>(id));
            ui.ctx().request_repaint();
            return Some(FieldEvent::Touched);
        }
        let mut drag = ui.data(|data| data.get_temp::<NumberDrag>(id))?;
        let input = PointerInput::of_widget(ui, response);
        let event = match drag.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(_) => {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
                let number = drag.drag_mut()?;
                let by = self.advance(ui, response, number);
                let changed = by != number.reported;
                number.reported = by;
                if changed { FieldEvent::Dragged(by) } else { FieldEvent::Nothing }
            }
            DragEvent::Dropped(_) => FieldEvent::Released,
            DragEvent::Cancelled(_) => FieldEvent::Cancelled,
            DragEvent::Nothing | DragEvent::Pressed | DragEvent::Started(_) | DragEvent::Clicked(_) => {
                FieldEvent::Nothing
            }
        };
        ui.data_mut(|data| {
            if drag.is_busy() {
                data.insert_temp(id, drag);
            } else {
                data.remove::<NumberDrag>(id);
            }
        });
        Some(event)
    }

    /// Adds the movement of this frame to the drag. Returns how far the number is from its start.
    fn advance(&self, ui: &Ui, response: &Response, number: &mut DraggedNumber) -> f64 {
        let modifiers = ui.input(|input| input.modifiers);
        let by = response.drag_delta();
        let fine = if modifiers.shift { 0.1 } else { 1.0 };
        number.raw += f64::from(by.x - by.y) * self.speed * fine;
        let mut to = number.start + number.raw;
        if modifiers.command && self.snap > 0.0 {
            to = (to / self.snap).round() * self.snap;
        }
        self.clamp(to) - number.start
    }
}
