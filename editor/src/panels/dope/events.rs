//! The lane of events: each is stored with the take, and games act on it.

use super::event_text::{parsed, text_of};
use super::lane_drag::MarkDrag;
use super::sheet::Sheet;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_document::Change;
use dragonfly_document::adapter::{EVENTS, stored_events};
use dragonfly_document::edit::{Edit, SetEvents, TakeEvent};
use dragonfly_picture::between;
use egui::{
    Button, CornerRadius, CursorIcon, PointerButton, Rect, Sense, Stroke, TextEdit, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

/// The events of the take that is shown, and the one that is dragged or edited.
#[derive(Debug, Default)]
pub(super) struct EventLane {
    /// The stored text that the events were read from.
    of: Option<Arc<str>>,
    events: Vec<TakeEvent>,
    /// Each event as text.
    texts: Vec<String>,
    drag: MarkDrag,
    /// Index and text of the event that is edited, and whether the field has had the focus.
    editing: Option<(usize, String, bool)>,
}

/// A change of the events.
enum EventAction {
    Move(usize, f32),
    Replace(usize, TakeEvent),
    Delete(usize),
}

impl EventLane {
    /// Draws the lane. A click goes to an event, a drag moves it, a double click edits its name and payload.
    pub(super) fn show(&mut self, ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, context, .. } = *sheet;
        let lane = areas.events;
        let stored = context.slot().and_then(|slot| slot.result.extras.get(EVENTS));
        let is_read = match (stored, &self.of) {
            (Some(stored), Some(of)) => Arc::ptr_eq(stored, of),
            (None, None) => true,
            (Some(_), None) | (None, Some(_)) => false,
        };
        if !is_read {
            let events = context.slot().map_or(Vec::new(), |slot| stored_events(&slot.result.extras));
            let texts = events.iter().map(text_of).collect();
            *self = Self { of: stored.cloned(), events, texts, ..Self::default() };
        }
        if lane.height() < 4.0 {
            return;
        }
        ui.painter().rect_filled(lane, CornerRadius::ZERO, Theme::of(ui).bar);
        let mut action = None;
        for index in 0..self.events.len() {
            action = self.event(ui, sheet, index, requests).or(action);
        }
        if let Some(action) = self.edit(ui, sheet).or(action)
            && let Some(edit) = self.changed(action, context)
        {
            requests.push(Request::Change(Change::Edit(edit, None)));
        }
    }

    fn event(
        &mut self,
        ui: &mut Ui,
        sheet: &Sheet<'_>,
        index: usize,
        requests: &mut Vec<Request>,
    ) -> Option<EventAction> {
        let Sheet { areas, scale, .. } = *sheet;
        let (lane, theme) = (areas.events, Theme::of(ui));
        let (event, text) = (self.events.get(index)?, self.texts.get(index)?);
        let time = self.drag.time_of(index, event.time);
        let x = scale.x_of(time);
        let end = self.events.get(index + 1).map_or(f32::INFINITY, |next| scale.x_of(next.time));
        let right = (x + 64.0).min(end - 5.0).max(x + 6.0);
        let grip = Rect::from_min_max(pos2(x - 5.0, lane.top()), pos2(right, lane.bottom()));
        if grip.right() < lane.left() || grip.left() > lane.right() {
            return None;
        }
        let id = ui.scope_id().with(("event", index));
        let response = ui.interact(grip.intersect(lane), id, Sense::click_and_drag());
        response.widget_info(|| {
            let name = format!("Event {}", event.name);
            WidgetInfo::labeled(egui::accesskit::Role::Button, true, name)
        });
        let lit = response.hovered() || response.dragged();
        let color = if lit { theme.text } else { theme.accent };
        let painter = ui.painter().with_clip_rect(lane);
        painter.vline(x, lane.y_range(), Stroke::new(1.0, color));
        painter.circle_filled(pos2(x, lane.top() + 5.0), 3.5, color);
        let left = pos2(x + 9.0, lane.top());
        let place = Rect::from_min_max(left, pos2((end - 6.0).min(lane.right()), lane.bottom()));
        if place.width() > 12.0 {
            widgets::text_in(ui, place, &widgets::shortened(text), &TextStyle::Small, theme.weak);
        }
        let response = response.on_hover_cursor(CursorIcon::PointingHand).on_hover_ui(|ui| {
            let use_it =
                "Click to move the playhead here, drag to move, double-click to edit name and payload";
            ui.label(format!("{}\n{time:.3} s\n{use_it}", widgets::shortened(text)));
        });
        if response.clicked_by(PointerButton::Primary) {
            requests.push(Request::Seek(event.time));
        }
        if response.double_clicked() {
            self.editing = Some((index, text.clone(), false));
        }
        let mut action = None;
        if let Some(time) = self.drag.step_mark(ui, sheet, (index, event.time), &response) {
            action = Some(EventAction::Move(index, time));
        }
        response.context_menu(|ui| {
            if ui.add(Button::new("Edit event").frame_when_inactive(false)).clicked() {
                self.editing = Some((index, text.clone(), false));
                ui.close();
            }
            if ui.add(Button::new("Delete event").frame_when_inactive(false)).clicked() {
                action = Some(EventAction::Delete(index));
                ui.close();
            }
        });
        action
    }

    /// Draws the field for name and payload. Returns the action when a valid text is entered.
    fn edit(&mut self, ui: &mut Ui, sheet: &Sheet<'_>) -> Option<EventAction> {
        let (index, text, had_focus) = self.editing.as_mut()?;
        let event = self.events.get(*index)?;
        let (lane, theme) = (sheet.areas.events, Theme::of(ui));
        let left = between(sheet.scale.x_of(event.time), lane.left(), lane.right() - 220.0);
        let rect = Rect::from_min_size(pos2(left, lane.top() - 3.0), vec2(220.0, lane.height() + 6.0));
        let valid = parsed(text).is_some();
        let field = TextEdit::singleline(text)
            .font(TextStyle::Small)
            .text_color(if valid { theme.text } else { theme.error })
            .hint_text(r#"step {"foot": "left"}"#);
        let response = ui.put(rect, field);
        response.widget_info(|| {
            WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "Name and payload of the event")
        });
        if !*had_focus {
            *had_focus = true;
            response.request_focus();
            return None;
        }
        let response = response.on_hover_text("A name, then a JSON object if the event has a payload");
        if !response.lost_focus() {
            return None;
        }
        let (index, text, _) = self.editing.take()?;
        let kept = !ui.input(|input| input.key_down(egui::Key::Escape));
        let (name, payload) = parsed(&text).filter(|_| kept)?;
        Some(EventAction::Replace(index, TakeEvent { time: self.events.get(index)?.time, name, payload }))
    }

    fn changed(&self, action: EventAction, context: &PanelContext<'_>) -> Option<Edit> {
        let mut events = self.events.clone();
        match action {
            EventAction::Move(index, time) => events.get_mut(index)?.time = time,
            EventAction::Replace(index, event) => *events.get_mut(index)? = event,
            EventAction::Delete(index) => {
                events.remove(index);
            }
        }
        let take = context.shown_take_ref().filter(|_| events != self.events)?;
        Some(SetEvents { take, events }.into())
    }
}
