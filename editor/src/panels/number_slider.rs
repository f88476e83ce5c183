//! A slider for the number of a field: a position on a line, starting from the middle.

use super::drag::{DragEvent, PanelDrag, PointerInput};
use super::number_field::FieldEvent;
use super::number_text::exact;
use super::theme::Theme;
use dragonfly_picture::between;
use egui::accesskit::{Action, ActionData, Role};
use egui::{
    Color32, CursorIcon, Id, Key, Modifiers, PointerButton, Rect, Sense, Stroke, Ui, WidgetInfo, pos2,
};

/// The number that a slider edits, and its display.
#[derive(Clone, Debug)]
pub struct NumberSlider<'a> {
    /// Identifies the slider between frames.
    pub id: Id,
    /// Accessible name.
    pub name: &'a str,
    /// Number that is shown; `None` if several bones differ, or there is none.
    pub value: Option<f64>,
    /// Mapping between numbers and positions.
    pub scale: SliderScale,
    /// With Ctrl, a drag snaps to multiples of this.
    pub snap: f64,
    /// Color of the line from its start to the number.
    pub color: Color32,
    /// Whether it can be moved.
    pub enabled: bool,
}

/// The mapping between numbers and positions on the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderScale {
    /// From minus this to this, with 0 in the middle.
    Linear(f64),
    /// From 1 over this to this, with 1 in the middle: equal distances are equal factors.
    Factor(f64),
    /// From 0 at the left to this.
    Upward(f64),
    /// A number in the middle, divided by a factor at the left and multiplied by it at the right: equal distances are equal factors.
    Around {
        /// The number in the middle.
        middle: f64,
        /// The factor, more than 1.
        factor: f64,
    },
}

impl SliderScale {
    /// Returns the position of a number, −1 to 1.
    fn place(self, value: f64) -> f64 {
        let place = match self {
            Self::Linear(end) => value / end,
            Self::Factor(end) => value.max(f64::MIN_POSITIVE).ln() / end.ln(),
            Self::Upward(end) => 2.0 * value / end - 1.0,
            Self::Around { middle, factor } => (value / middle).max(f64::MIN_POSITIVE).ln() / factor.ln(),
        };
        if place.is_finite() { place.clamp(-1.0, 1.0) } else { 0.0 }
    }

    fn value(self, place: f64) -> f64 {
        let place = place.clamp(-1.0, 1.0);
        match self {
            Self::Linear(end) => place * end,
            Self::Factor(end) => end.powf(place),
            Self::Upward(end) => (place + 1.0) / 2.0 * end,
            Self::Around { middle, factor } => middle * factor.powf(place),
        }
    }

    /// Returns the number at which the line starts.
    fn origin(self) -> f64 {
        match self {
            Self::Linear(_) | Self::Factor(_) | Self::Around { .. } => self.value(0.0),
            Self::Upward(_) => 0.0,
        }
    }

    fn ends(self) -> [f64; 2] {
        [self.value(-1.0), self.value(1.0)]
    }
}

/// The knob of a slider, while it is dragged.
#[derive(Clone, Copy, Debug)]
struct KnobDrag {
    /// Number when the drag began.
    start: f64,
    /// Position of the knob, −1 to 1.
    place: f64,
    /// Distance of the press from the knob, in the same unit.
    beside: f64,
}

type GripDrag = PanelDrag<(), KnobDrag>;

impl NumberSlider<'_> {
    /// Draws the slider into `rect`; the line is as long as `rect` is wide.
    pub fn show(self, ui: &mut Ui, rect: Rect) -> FieldEvent {
        let enabled = self.enabled && ui.is_enabled();
        let sense = if enabled { Sense::click_and_drag() } else { Sense::hover() };
        let response = ui.interact(rect, self.id, sense);
        let event = if enabled { self.event(ui, rect, &response) } else { FieldEvent::Nothing };
        self.paint(ui, rect, &response, enabled);
        response.widget_info(|| WidgetInfo::slider(enabled, self.value.unwrap_or(0.0), self.name));
        ui.ctx().accesskit_node_builder(response.id, |node| {
            let [first, last] = self.scale.ends();
            node.set_role(Role::Slider);
            node.set_min_numeric_value(first);
            node.set_max_numeric_value(last);
            node.set_numeric_value_step(self.snap);
            if enabled {
                node.add_action(Action::SetValue);
                node.add_action(Action::Increment);
                node.add_action(Action::Decrement);
            }
        });
        if enabled {
            response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_ui(|ui| {
                let value = self.value.map_or("different values".to_owned(), |value| exact(value, 1e-3));
                ui.label(format!("{}: {value}", self.name));
                ui.colored_label(
                    Theme::of(ui).faint,
                    "Drag. Shift is finer, Ctrl snaps. Double-click to reset.",
                );
            });
        }
        event
    }

    fn event(&self, ui: &Ui, rect: Rect, response: &egui::Response) -> FieldEvent {
        if let Some(event) = self.keys(ui, response) {
            return event;
        }
        if response.double_clicked() {
            return FieldEvent::Typed(self.scale.origin());
        }
        let id = self.id;
        let pointer = response.interact_pointer_pos();
        let at = |x: f32| f64::from(((x - rect.center().x) / (rect.width() / 2.0).max(1.0)).clamp(-1.5, 1.5));
        if response.drag_started_by(PointerButton::Primary)
            && let Some(pointer) = pointer
        {
            let start = self.value.unwrap_or(self.scale.origin());
            let place = self.scale.place(start);
            let grip = KnobDrag { start, place, beside: at(pointer.x) - place };
            ui.data_mut(|data| data.insert_temp(id, GripDrag::dragging(grip)));
            return FieldEvent::Touched;
        }
        let Some(mut drag) = ui.data(|data| data.get_temp::<GripDrag>(id)) else {
            return FieldEvent::Nothing;
        };
        let input = PointerInput::of_widget(ui, response);
        let event = match drag.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(_) => match drag.drag_mut() {
                Some(grip) => {
                    let by = f64::from(response.drag_delta().x / (rect.width() / 2.0).max(1.0));
                    grip.place = match pointer {
                        // A knob far from the press jumps to the pointer; a knob near it keeps its distance from
                        // the pointer.
                        Some(pointer) if !input.modifiers.shift => {
                            at(pointer.x) - if grip.beside.abs() < 0.1 { grip.beside } else { 0.0 }
                        }
                        _ => grip.place + by * 0.1,
                    };
                    let mut to = self.scale.value(grip.place);
                    if input.modifiers.command && self.snap > 0.0 {
                        to = (to / self.snap).round() * self.snap;
                    }
                    FieldEvent::Dragged(to - grip.start)
                }
                None => FieldEvent::Nothing,
            },
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
                data.remove::<GripDrag>(id);
            }
        });
        event
    }

    /// Handles arrow keys and the requests of a screen reader.
    fn keys(&self, ui: &Ui, response: &egui::Response) -> Option<FieldEvent> {
        let value = self.value?;
        let has_focus = response.has_focus();
        if has_focus {
            let filter = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
            ui.memory_mut(|memory| memory.set_focus_lock_filter(self.id, filter));
        }
        let (steps, wanted) = ui.input_mut(|input| {
            let mut steps = input.num_accesskit_action_requests(self.id, Action::Increment) as f64
                - input.num_accesskit_action_requests(self.id, Action::Decrement) as f64;
            if has_focus {
                steps += input.count_and_consume_key(Modifiers::NONE, Key::ArrowRight) as f64
                    - input.count_and_consume_key(Modifiers::NONE, Key::ArrowLeft) as f64;
            }
            let wanted = input.accesskit_action_requests(self.id, Action::SetValue).last();
            (steps, wanted.and_then(|request| request.data.clone()))
        });
        let [first, last] = self.scale.ends();
        match wanted {
            Some(ActionData::NumericValue(value)) if value.is_finite() => {
                Some(FieldEvent::Typed(between(value, first, last)))
            }
            _ => (steps != 0.0).then(|| FieldEvent::Typed(between(value + steps * self.snap, first, last))),
        }
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &egui::Response, enabled: bool) {
        let theme = Theme::of(ui);
        let painter = ui.painter();
        let y = painter.round_to_pixel_center(rect.center().y);
        let x_of = |value: f64| rect.center().x + self.scale.place(value) as f32 * rect.width() / 2.0;
        let middle = x_of(self.scale.origin());
        painter.hline(rect.x_range(), y, Stroke::new(2.0, theme.line));
        painter.vline(middle, y - 3.0..=y + 3.0, Stroke::new(1.0, theme.faint));
        let Some(value) = self.value else { return };
        let x = x_of(value);
        let color = if enabled { self.color } else { theme.faint };
        painter.hline(middle.min(x)..=middle.max(x), y, Stroke::new(2.0, color));
        let held = response.hovered() || response.dragged() || response.has_focus();
        painter.circle_filled(
            pos2(x, y),
            if held { 5.0 } else { 4.0 },
            if held { theme.text } else { color },
        );
    }
}
