//! Accessibility of a number field.

use super::{FieldEvent, NumberField, Typing};
use egui::accesskit::{Action, ActionData, Role};
use egui::{Response, Ui, WidgetInfo};

impl NumberField<'_> {
    /// Returns the event that a screen reader requests.
    pub(super) fn asked_by_reader(&self, ui: &Ui) -> Option<FieldEvent> {
        let (steps, wanted) = ui.input(|input| {
            let steps = input.num_accesskit_action_requests(self.id, Action::Increment) as f64
                - input.num_accesskit_action_requests(self.id, Action::Decrement) as f64;
            let wanted = input.accesskit_action_requests(self.id, Action::SetValue).last();
            (steps, wanted.and_then(|request| request.data.clone()))
        });
        let typed = |value: f64| FieldEvent::Typed(value);
        let event = match wanted {
            Some(ActionData::NumericValue(value)) => {
                Some(value).filter(|value| self.range.contains(value)).map(typed)
            }
            Some(ActionData::Value(text)) => self.entry(&text).ok(),
            _ => {
                self.value.filter(|_| steps != 0.0).map(|value| typed(self.clamp(value + steps * self.snap)))
            }
        };
        if event.is_some() {
            ui.data_mut(|data| data.remove::<Typing>(self.id));
        }
        event
    }

    /// Describes the field to a screen reader.
    pub(super) fn describe(&self, ui: &Ui, response: &Response, refused: Option<&str>) {
        let enabled = self.locked.is_none() && ui.is_enabled();
        let has_focus = response.has_focus();
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::SpinButton, enabled, self.name);
            info.value = self.value;
            info
        });
        ui.ctx().accesskit_node_builder(response.id, |node| {
            node.set_role(Role::SpinButton);
            node.set_label(self.name);
            if let Some(value) = self.value {
                node.set_numeric_value(value);
            } else {
                node.clear_numeric_value();
            }
            if self.range.start().abs() < 1e30 {
                node.set_min_numeric_value(*self.range.start());
            }
            if self.range.end().abs() < 1e30 {
                node.set_max_numeric_value(*self.range.end());
            }
            node.set_numeric_value_step(self.snap);
            if let Some(why) = refused.or(self.locked) {
                node.set_description(why);
            }
            if refused.is_some() {
                node.set_invalid(egui::accesskit::Invalid::True);
            }
            if enabled {
                node.add_action(Action::SetValue);
                node.add_action(Action::Increment);
                node.add_action(Action::Decrement);
            } else {
                node.set_read_only();
            }
            if !has_focus {
                node.set_value(self.full());
            }
        });
    }
}
