//! A field that holds a number: dragged, typed as an expression, stepped by a screen reader.
//!
//! The field knows nothing of what its number is about. It says what a person does to it ([`Heard`]), and its owner
//! makes edits of that. While it has the focus it is a text field; a text that is no number stays in it with a red edge
//! and the reason, until it is mended or taken back with Escape.

use super::number_text::{Digits, exact};
use super::style::{self, RADIUS};
use super::theme::Theme;
use crate::control::expression::{Quantity, evaluate};
use egui::accesskit::{Action, ActionData, Role};
use egui::{
    Align2, Color32, CornerRadius, CursorIcon, FocusDirection, FontId, Frame, Id, Key, Margin, Modifiers,
    PointerButton, Rect, Response, Sense, Stroke, StrokeKind, TextEdit, Ui, WidgetInfo, pos2, vec2,
};
use std::ops::RangeInclusive;

/// Longest text that a field takes, letters.
const LONGEST: usize = 1000;

/// What a field is and shows.
#[derive(Clone, Debug)]
pub struct NumberField<'a> {
    /// Stays the same as long as the field is about the same thing.
    pub id: Id,
    /// What a screen reader says: `Rotation change X`.
    pub name: &'a str,
    /// `None` where there are several, or none.
    pub value: Option<f64>,
    /// Which units can be typed.
    pub quantity: Quantity,
    /// Behind the number, where there is room; empty for none.
    pub unit: &'a str,
    /// Per point of a drag.
    pub speed: f64,
    /// With Ctrl, a drag stops at whole multiples of this; also what a screen reader steps by.
    pub snap: f64,
    /// Smaller differences are what arithmetic leaves over.
    pub grain: f64,
    /// How it is shown.
    pub digits: Digits,
    /// What can be typed and dragged to.
    pub range: RangeInclusive<f64>,
    /// Why it cannot be changed; `None` where it can.
    pub locked: Option<&'a str>,
    /// A sentence for the tooltip; empty for none.
    pub help: &'a str,
    /// Shown weaker: it is what it is where nobody did anything.
    pub quiet: bool,
}

/// What a person does to a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heard {
    /// Nothing.
    Nothing,
    /// Takes hold of it, or puts the cursor into it: what it shows should stand still.
    Touched,
    /// Drags: so much is added to what it was when the drag began.
    Dragged(f64),
    /// Lets go.
    Released,
    /// Takes a drag back.
    Cancelled,
    /// This number is wanted.
    Typed(f64),
}

/// A text that is being typed.
#[derive(Clone, Debug, Default)]
struct Typing {
    text: String,
    /// As it was at the begin.
    first: String,
    /// Why it is not taken.
    refused: Option<String>,
}

/// A drag.
#[derive(Clone, Copy, Debug)]
struct Drag {
    start: f64,
    /// What the hand has added, before it is snapped.
    raw: f64,
    /// What was told last.
    told: f64,
}

/// What was refused when the cursor left the field, as long as the number stays the same.
#[derive(Clone, Debug, Default)]
struct Refused {
    reason: String,
    value: Option<f64>,
    /// Frames in which the number may still become another one without anybody having changed it: fields that belong
    /// together show what was typed until the cursor has left them, as the parts of a quaternion do.
    settles: u8,
}

impl Refused {
    fn new(reason: String, value: Option<f64>) -> Self {
        Self { reason, value, settles: 2 }
    }

    /// What is left of it in the next frame, in which the field shows `value`.
    fn next(self, value: Option<f64>) -> Option<Self> {
        match self.settles {
            0 => Some(self).filter(|refused| refused.value == value),
            settles => Some(Self { value, settles: settles - 1, ..self }),
        }
    }
}

/// Shows at a field why the number typed last was not taken, as long as its number stays the same.
pub fn refuse(ui: &Ui, id: Id, value: Option<f64>, reason: &str) {
    let refused = Refused::new(reason.to_owned(), value);
    ui.data_mut(|data| data.insert_temp(id, refused));
}

impl NumberField<'_> {
    /// Draws the field into `rect`.
    pub fn show(self, ui: &mut Ui, rect: Rect) -> (Heard, Response) {
        let id = self.id;
        if self.locked.is_some() || !ui.is_enabled() {
            let response = ui.interact(rect, id, Sense::hover());
            self.paint(ui, rect, &response, None);
            self.describe(ui, &response, None);
            let response = match self.locked {
                Some(why) => response.on_hover_text(format!("{}{}\n{why}", self.title(), self.full())),
                None => response,
            };
            return (Heard::Nothing, response);
        }
        let early = self.keys(ui);
        let has_focus = ui.memory_mut(|memory| {
            memory.interested_in_focus(id, ui.layer_id());
            memory.has_focus(id)
        });
        let (late, response) = if has_focus { self.edit(ui, rect) } else { self.rest(ui, rect) };
        let stepped = self.asked_by_reader(ui);
        (early.or(stepped).unwrap_or(late), response)
    }

    /// Enter accepts and gives the keys back to the commands, Tab goes on to the next field; where there is no number they
    /// stay and say why.
    fn keys(&self, ui: &Ui) -> Option<Heard> {
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
        let read = self.read(&typing.text);
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
        read.ok().filter(|_| typing.text != typing.first).map(Heard::Typed)
    }

    /// While it has the focus: a text field.
    fn edit(&self, ui: &mut Ui, rect: Rect) -> (Heard, Response) {
        let known = ui.data_mut(|data| data.remove_temp::<Typing>(self.id));
        ui.data_mut(|data| data.remove::<Refused>(self.id));
        let fresh = known.is_none();
        let mut typing = known.unwrap_or_else(|| {
            let text = self.value.map_or(String::new(), |value| exact(value, self.grain));
            Typing { first: text.clone(), text, refused: None }
        });
        let mut heard = if fresh { Heard::Touched } else { Heard::Nothing };
        if fresh {
            self.select_all(ui, &typing.text);
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
            heard = Heard::Typed(value);
        }
        let theme = Theme::of(ui);
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), theme.sunken);
        let field = TextEdit::singleline(&mut typing.text)
            .id(self.id)
            .frame(Frame::NONE)
            .margin(Margin::symmetric(5, 0))
            .font(FontId::monospace(style::NUMBER))
            .align(Align2::RIGHT_CENTER)
            .char_limit(LONGEST)
            .desired_width(rect.width());
        let response = ui.place(rect, field);
        if response.changed() {
            typing.refused = None;
        }
        // The first click opened the field and the second would put the cursor somewhere in it; all is meant.
        if response.double_clicked() {
            self.select_all(ui, &typing.text);
        }
        let edge = if typing.refused.is_some() { theme.error } else { theme.accent };
        let stroke = Stroke::new(1.0, edge);
        ui.painter().rect_stroke(rect, CornerRadius::same(RADIUS), stroke, StrokeKind::Inside);
        self.hint(ui, &response, &typing);
        self.describe(ui, &response, typing.refused.as_deref());
        ui.data_mut(|data| data.insert_temp(self.id, typing));
        (heard, response)
    }

    /// So that what is typed next takes the place of `text`.
    fn select_all(&self, ui: &Ui, text: &str) {
        let mut state = TextEdit::load_state(ui.ctx(), self.id).unwrap_or_default();
        state.cursor.set_char_range(Some(egui::text::CCursorRange::select_all_str(text)));
        state.store(ui.ctx(), self.id);
    }

    /// Why the text is not taken, or what an expression comes to.
    fn hint(&self, ui: &Ui, response: &Response, typing: &Typing) {
        let theme = Theme::of(ui);
        let (text, color) = match &typing.refused {
            Some(reason) => (reason.clone(), theme.error),
            None if typing.text == typing.first || typing.text.trim().parse::<f64>().is_ok() => return,
            None => match self.read(&typing.text) {
                Ok(value) => {
                    (format!("= {}{}", exact(value, self.grain.max(1e-6)), self.suffix()), theme.weak)
                }
                Err(_) => return,
            },
        };
        egui::Tooltip::always_open(ui.ctx().clone(), ui.layer_id(), self.id.with("hint"), response.rect)
            .show(|ui| ui.colored_label(color, text));
    }

    /// While it has no focus: a number to be dragged or clicked.
    fn rest(&self, ui: &mut Ui, rect: Rect) -> (Heard, Response) {
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
                    let refused = Refused::new(reason, self.value);
                    ui.data_mut(|data| data.insert_temp(id, refused));
                }
            }
        }
        let response = ui.interact(rect, id, Sense::click_and_drag());
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let refused = ui.data_mut(|data| {
            let refused = data.remove_temp::<Refused>(id)?.next(self.value)?;
            data.insert_temp(id, refused.clone());
            Some(refused)
        });
        self.paint(ui, rect, &response, refused.as_ref());
        self.describe(ui, &response, refused.as_ref().map(|refused| refused.reason.as_str()));
        if response.clicked() {
            response.request_focus();
        }
        let dragged = self.drag(ui, &response);
        let response = match refused {
            Some(refused) => response.on_hover_text(refused.reason),
            None if ui.ctx().dragged_id().is_none() => response.on_hover_ui(|ui| self.tooltip(ui)),
            None => response,
        };
        (dragged.unwrap_or(heard), response)
    }

    fn drag(&self, ui: &Ui, response: &Response) -> Option<Heard> {
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
    fn pull(&self, ui: &Ui, response: &Response, drag: &mut Drag) -> f64 {
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

    /// What a screen reader asks for.
    fn asked_by_reader(&self, ui: &Ui) -> Option<Heard> {
        let (steps, wanted) = ui.input(|input| {
            let steps = input.num_accesskit_action_requests(self.id, Action::Increment) as f64
                - input.num_accesskit_action_requests(self.id, Action::Decrement) as f64;
            let wanted = input.accesskit_action_requests(self.id, Action::SetValue).last();
            (steps, wanted.and_then(|request| request.data.clone()))
        });
        let value = match wanted {
            Some(ActionData::NumericValue(value)) => Some(value).filter(|value| self.range.contains(value)),
            Some(ActionData::Value(text)) => self.read(&text).ok(),
            _ => self.value.filter(|_| steps != 0.0).map(|value| self.clamp(value + steps * self.snap)),
        };
        value.map(|value| {
            ui.data_mut(|data| data.remove::<Typing>(self.id));
            Heard::Typed(value)
        })
    }

    /// The number that a text says, or why it is none.
    fn read(&self, text: &str) -> Result<f64, String> {
        let value = evaluate(text, self.quantity).map_err(|error| sentence(&error.to_string()))?;
        if !self.range.contains(&value) || !(value as f32).is_finite() {
            let edge = |edge: &f64| Digits::Fitting.text(*edge);
            return Err(format!(
                "A number from {} to {} is wanted",
                edge(self.range.start()),
                edge(self.range.end())
            ));
        }
        Ok(value)
    }

    fn clamp(&self, value: f64) -> f64 {
        value.max(*self.range.start()).min(*self.range.end())
    }

    fn paint(&self, ui: &Ui, rect: Rect, response: &Response, refused: Option<&Refused>) {
        let theme = Theme::of(ui);
        let open = self.locked.is_none() && ui.is_enabled();
        let radius = CornerRadius::same(RADIUS);
        let held = ui.ctx().is_being_dragged(self.id);
        let fill = match () {
            () if !open => Color32::TRANSPARENT,
            () if response.hovered() || held => theme.hover,
            () => theme.sunken,
        };
        ui.painter().rect_filled(rect, radius, fill);
        let edge = match () {
            () if refused.is_some() => Some(theme.error),
            () if held => Some(theme.accent),
            // White on nearly white needs an edge to be seen as a field.
            () if open && !theme.dark => Some(theme.line),
            () => None,
        };
        if let Some(edge) = edge {
            ui.painter().rect_stroke(rect, radius, Stroke::new(1.0, edge), StrokeKind::Inside);
        }
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        let color = if open && !self.quiet { theme.text } else { theme.weak };
        let text = self.value.map_or("–".to_owned(), |value| self.digits.text(value));
        let mut right = rect.right() - 5.0;
        if !self.unit.is_empty() && rect.width() > 64.0 + 7.0 * self.unit.chars().count() as f32 {
            let unit = FontId::proportional(style::SMALL);
            let at = pos2(right, rect.center().y);
            right = painter.text(at, Align2::RIGHT_CENTER, self.unit, unit, theme.faint).left() - 3.0;
        }
        let at = pos2(right, rect.center().y);
        painter.text(at, Align2::RIGHT_CENTER, text, FontId::monospace(style::NUMBER), color);
    }

    fn tooltip(&self, ui: &mut Ui) {
        let theme = Theme::of(ui);
        ui.set_max_width(260.0);
        ui.spacing_mut().item_spacing = vec2(4.0, 2.0);
        ui.label(format!("{}{}", self.title(), self.full()));
        if !self.help.is_empty() {
            ui.colored_label(theme.weak, self.help);
        }
        let how = "Drag, or click and type: 45/2, pi/4 rad. Shift is finer, Ctrl snaps.";
        ui.colored_label(theme.faint, how);
    }

    fn title(&self) -> String {
        format!("{}: ", self.name)
    }

    fn full(&self) -> String {
        match self.value {
            Some(value) => format!("{}{}", exact(value, self.grain), self.suffix()),
            None => "different values".to_owned(),
        }
    }

    fn suffix(&self) -> String {
        match self.unit {
            "" => String::new(),
            "°" => "°".to_owned(),
            unit => format!(" {unit}"),
        }
    }

    /// What a screen reader says.
    fn describe(&self, ui: &Ui, response: &Response, refused: Option<&str>) {
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

/// With a capital letter.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
