//! A number field with focus: a text field.

use super::{FieldEvent, LONGEST, NumberField, RefusedNumber, Typing};
use crate::panels::number_text::exact;
use crate::panels::style::{self, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets::select_all;
use egui::{
    Align2, CornerRadius, FocusDirection, FontId, Frame, Key, Margin, Modifiers, Rect, Response, Stroke,
    StrokeKind, TextEdit, Ui,
};

/// Margin between the border and the text, points.
const MARGIN: i8 = 5;

impl NumberField<'_> {
    /// Handles Enter and Tab. Enter accepts and returns the keyboard to the commands, Tab moves on to the next field.
    /// If the text is not a number, the focus stays and the reason is shown.
    pub(super) fn keys(&self, ui: &Ui) -> Option<FieldEvent> {
        if !ui.memory(|memory| memory.has_focus(self.id)) {
            return None;
        }
        let mut typing = ui.data(|data| data.get_temp::<Typing>(self.id))?;
        let (enter, tab) = ui.input_mut(|input| {
            let enter = input.consume_key(Modifiers::NONE, Key::Enter);
            (enter, input.key_pressed(Key::Tab))
        });
        if !enter && !tab {
            return None;
        }
        let read = self.entry(&typing.text);
        if let Err(reason) = read {
            typing.refused = Some(reason);
            ui.memory_mut(|memory| memory.move_focus(FocusDirection::None));
            ui.data_mut(|data| data.insert_temp(self.id, typing));
            return None;
        }
        if enter {
            ui.memory_mut(|memory| memory.surrender_focus(self.id));
        }
        ui.data_mut(|data| data.remove::<Typing>(self.id));
        read.ok().filter(|_| typing.text != typing.first)
    }

    /// Draws the field with focus.
    pub(super) fn edit(&self, ui: &mut Ui, rect: Rect) -> (FieldEvent, Response) {
        let known = ui.data_mut(|data| data.remove_temp::<Typing>(self.id));
        ui.data_mut(|data| data.remove::<RefusedNumber>(self.id));
        let fresh = known.is_none();
        let mut typing = known.unwrap_or_else(|| {
            let text = self.value.map_or(String::new(), |value| exact(value, self.grain));
            Typing { first: text.clone(), text, refused: None }
        });
        let mut event = if fresh { FieldEvent::Touched } else { FieldEvent::Nothing };
        if fresh {
            select_all(ui.ctx(), self.id, &typing.text);
        }
        let steps = ui.input_mut(|input| {
            input.count_and_consume_key(Modifiers::NONE, Key::ArrowUp) as f64
                - input.count_and_consume_key(Modifiers::NONE, Key::ArrowDown) as f64
        });
        if steps != 0.0
            && let Some(value) = self.read(&typing.text).ok().or(self.value)
        {
            let value = self.clamp(value + steps * self.snap);
            let text = exact(value, self.grain);
            typing = Typing { first: text.clone(), text, refused: None };
            event = FieldEvent::Typed(value);
        }
        let theme = Theme::of(ui);
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.sunken);
        let field = TextEdit::singleline(&mut typing.text)
            .id(self.id)
            // A margin set next to a frame has no effect.
            .frame(Frame::NONE.inner_margin(Margin::symmetric(MARGIN, 0)))
            .font(FontId::monospace(style::NUMBER))
            .align(Align2::RIGHT_CENTER)
            .char_limit(LONGEST)
            .desired_width(rect.width());
        let response = ui.place(rect, field);
        if response.changed() {
            typing.refused = None;
        }
        // The first click opened the field; the second would put the cursor into the text, but a double-click means all
        // of it.
        if response.double_clicked() {
            select_all(ui.ctx(), self.id, &typing.text);
        }
        let edge = if typing.refused.is_some() { theme.error } else { theme.accent };
        let stroke = Stroke::new(1.0, edge);
        ui.painter().rect_stroke(rect, CornerRadius::same(RADIUS), stroke, StrokeKind::Inside);
        self.hint(ui, &response, &typing);
        self.describe(ui, &response, typing.refused.as_deref());
        ui.data_mut(|data| data.insert_temp(self.id, typing));
        (event, response)
    }

    /// Shows why the text is not accepted, or the result of an expression.
    pub(super) fn hint(&self, ui: &Ui, response: &Response, typing: &Typing) {
        let theme = Theme::of(ui);
        let (text, color) = match &typing.refused {
            Some(reason) => (reason.clone(), theme.error),
            None if typing.text == typing.first || self.is_plain(&typing.text) => return,
            None => match self.entry_text(&typing.text) {
                Some(text) => (text, theme.weak),
                None => return,
            },
        };
        egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), self.id.with("hint"), response.rect)
            .show(|ui| ui.colored_label(color, text));
    }
}
