//! Over the curves: which of them, how rotations are read, what lies between keys, the numbers of the selected key.

use super::curve::Curve;
use super::form::Form;
use super::hand::component_name;
use super::paint::color;
use super::shown::bit;
use super::values::{ValueKey, value_edit};
use crate::control::expression::{Quantity, evaluate};
use crate::document::Change;
use crate::document::edit::{Between, Property};
use crate::panels::commands::{self, Id};
use crate::panels::icons::Icon;
use crate::panels::keys::{Deed, Drawn, KeysRequest};
use crate::panels::state::{Request, State};
use crate::panels::style::{CONTROL, GRID, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets::{self, icon_button};
use dragonfly_anim::data::Interpolation;
use egui::accesskit::Role;
use egui::{Align2, Button, Color32, CornerRadius, DragValue, FontId, RichText, Sense, Ui, WidgetInfo, vec2};
use std::sync::Arc;

/// What the person chose to see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    /// A set of properties, see [`bit`].
    pub(super) properties: u8,
    /// A set of components, x first.
    pub(super) components: u8,
    pub(super) form: Form,
}

impl Default for Chosen {
    fn default() -> Self {
        Self { properties: bit(Property::Rotation), components: 15, form: Form::default() }
    }
}

/// Height of the bar.
pub(super) const HEIGHT: f32 = 32.0;

/// Draws the bar; was "fit" asked for?
pub(super) fn show(
    ui: &mut Ui,
    chosen: &mut Chosen,
    curves: &[Arc<Curve>],
    drawn: Option<&Drawn>,
    state: &State,
    requests: &mut Vec<Request>,
) -> bool {
    let mut fit = false;
    ui.horizontal(|ui| {
        ui.set_height(HEIGHT);
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.add_space(2.0 * GRID);
        // What is drawn is lit: where the bones lack what was chosen, something else is.
        let visible = curves.iter().fold(0, |all, curve| all | bit(curve.id.1));
        for (property, letter, name) in [
            (Property::Translation, "T", "Translation"),
            (Property::Rotation, "R", "Rotation"),
            (Property::Scale, "S", "Scale"),
        ] {
            let on = if visible == 0 { chosen.properties } else { visible } & bit(property) != 0;
            let help = format!("Curves of {}\nShift adds", name.to_lowercase());
            if letter_button(ui, letter, name, on, None).on_hover_text(help).clicked() {
                let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
                chosen.properties = if !adds {
                    bit(property)
                } else if chosen.properties == bit(property) {
                    chosen.properties
                } else {
                    chosen.properties ^ bit(property)
                };
            }
        }
        divider(ui);
        let width = curves.iter().map(|curve| curve.width()).max().unwrap_or(3);
        for component in 0..width {
            let on = chosen.components & (1 << component) != 0;
            let name = component_name(component);
            let tone = color(Theme::of(ui), component);
            let label = format!("Component {name}");
            if letter_button(ui, name, &label, on, Some(tone))
                .on_hover_text(format!("Shows or hides {name}"))
                .clicked()
            {
                chosen.components ^= 1 << component;
            }
        }
        divider(ui);
        form(ui, chosen);
        divider(ui);
        between(ui, curves, state, requests);
        if icon_button(ui, Icon::Fit, "Fit the curves", false)
            .on_hover_text("Fit the curves\nShows all values, and the selected keys or the whole take")
            .clicked()
        {
            fit = true;
        }
        if let Some(drawn) = drawn {
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.add_space(2.0 * GRID);
                ui.spacing_mut().item_spacing.x = GRID;
                fields(ui, chosen, curves, drawn, state, requests);
            });
        }
    });
    fit
}

/// A square button with a letter.
fn letter_button(ui: &mut Ui, letter: &str, name: &str, on: bool, tone: Option<Color32>) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(vec2(20.0, CONTROL), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, on, name));
    let theme = Theme::of(ui);
    let fill = match (response.hovered(), on) {
        (_, true) if tone.is_none() => theme.accent_soft,
        (true, _) => theme.hover,
        _ => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), fill);
    let color = if on { tone.unwrap_or(theme.accent) } else { theme.faint };
    ui.painter().text(rect.center(), Align2::CENTER_CENTER, letter, FontId::proportional(12.0), color);
    widgets::focus_ring(ui, &response, rect);
    response
}

fn form(ui: &mut Ui, chosen: &mut Chosen) {
    let text = RichText::new(chosen.form.name()).small().color(Theme::of(ui).weak);
    let button = ui.add(Button::new(text).frame(false)).on_hover_text("How rotations are shown");
    egui::Popup::menu(&button).show(|ui| {
        ui.set_width(110.0);
        for form in Form::all() {
            if ui.add(Button::selectable(form == chosen.form, form.name())).clicked() {
                chosen.form = form;
            }
        }
    });
}

/// What lies between the keys of the channels that are shown; lit where all of them have it.
fn between(ui: &mut Ui, curves: &[Arc<Curve>], state: &State, requests: &mut Vec<Request>) {
    let able = !state.keys.selection.is_empty();
    for (icon, id, kind, _) in [
        (Icon::Step, Id::InterpolateStep, Interpolation::Step, Between::Step),
        (Icon::Linear, Id::InterpolateLinear, Interpolation::Linear, Between::Linear),
        (Icon::Spline, Id::InterpolateSpline, Interpolation::CubicSpline, Between::CubicSpline),
    ] {
        let on = !curves.is_empty() && curves.iter().all(|curve| curve.interpolation() == kind);
        ui.add_enabled_ui(able, |ui| {
            let reason = commands::get(id).when.reason();
            let button = icon_button(ui, icon, commands::get(id).title, on)
                .on_hover_text(commands::tooltip(ui.ctx(), id))
                .on_disabled_hover_text(reason);
            if button.clicked() {
                requests.push(Request::Command(id));
            }
        });
    }
}

/// Right to left: value and time of the one key that is selected.
fn fields(
    ui: &mut Ui,
    chosen: &Chosen,
    curves: &[Arc<Curve>],
    drawn: &Drawn,
    state: &State,
    requests: &mut Vec<Request>,
) {
    if ui.available_width() < 148.0 {
        return;
    }
    let Some((curve, key)) = only_key(curves, drawn) else { return };
    let angle = curve.id.1 == Property::Rotation && curve.form() != Form::Quaternion;
    let mut shown = (0..curve.width()).filter(|at| chosen.components & (1 << at) != 0);
    let component = shown.next().unwrap_or(0);
    let single = shown.next().is_none();
    let numbers = curve.key(key);
    if single {
        let mut value = f64::from(numbers[component]);
        let quantity = if angle { Quantity::Angle } else { Quantity::Number };
        let field = DragValue::new(&mut value)
            .speed(0.0)
            .max_decimals(4)
            .update_while_editing(false)
            .custom_parser(move |text| evaluate(text, quantity).ok());
        let name = format!("Value {}", component_name(component));
        let response = ui.add_sized(vec2(68.0, CONTROL), field).accessible_name(name);
        if response.on_hover_text("Value of the selected key\nClick to type; 45/2 is fine").changed()
            && let (Some(take), Some(was)) = (state.take_ref(), ValueKey::of(curve, key))
            && let Some(edit) = value_edit(take, &[was], component, value as f32 - numbers[component])
        {
            requests.push(Request::Change(Change::Edit(edit, None)));
        }
    }
    let mut time = f64::from(curve.times()[key]);
    let was = time;
    let field = DragValue::new(&mut time)
        .speed(0.0)
        .max_decimals(4)
        .suffix(" s")
        .update_while_editing(false)
        .custom_parser(|text| evaluate(text.trim_end_matches('s').trim(), Quantity::Number).ok());
    let response = ui.add_sized(vec2(72.0, CONTROL), field).accessible_name("Time of the key");
    if response.on_hover_text("Time of the selected key, seconds\nClick to type").changed() {
        requests.push(Request::Timeline(KeysRequest::Drag(Deed::Move((time - was) as f32))));
        requests.push(Request::Timeline(KeysRequest::Release));
    }
}

/// The key that is selected, where it is one alone among the curves shown.
fn only_key<'a>(curves: &'a [Arc<Curve>], drawn: &Drawn) -> Option<(&'a Arc<Curve>, usize)> {
    let mut found = None;
    for curve in curves {
        let chosen = drawn.selection.of(curve.id);
        if chosen.is_empty() {
            continue;
        }
        let keys = chosen.keys(curve.times()).next()?;
        if found.is_some() || keys.len() != 1 || chosen.stretches().len() > 1 {
            return None;
        }
        found = Some((curve, keys.start));
    }
    found.filter(|(curve, key)| *key < curve.times().len())
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), egui::Stroke::new(1.0, Theme::of(ui).line));
}
