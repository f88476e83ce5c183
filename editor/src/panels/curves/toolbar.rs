//! The bar above the curves: which are shown, how rotations are shown, and the interpolation.

use super::canvas::component_name;
use super::curve::Curve;
use super::form::RotationForm;
use super::id::{SHAPES, bit};
use super::paint::color;
use super::view_menu;
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::properties::PropertiesLook;
use crate::panels::request::Request;
use crate::panels::style::{CONTROL, GRID, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets::{self, icon_button};
use dragonfly_anim::data::Interpolation;
use dragonfly_document::edit::{KeyInterpolation, Property};
use egui::accesskit::Role;
use egui::{Align2, Button, Color32, CornerRadius, FontId, RichText, Sense, Ui, WidgetInfo, vec2};
use std::sync::Arc;

/// Channels, components and form that the user chose to see.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chosen {
    /// Set of properties, see [`bit`].
    pub(super) properties: u8,
    /// Set of components, X first.
    pub(super) components: u8,
    pub(super) form: RotationForm,
}

impl Default for Chosen {
    fn default() -> Self {
        Self { properties: bit(Property::Rotation), components: 15, form: RotationForm::default() }
    }
}

/// Height of the bar.
pub(super) const HEIGHT: f32 = 32.0;

/// Draws the bar, and what `rest` draws at its right end. Returns whether "Fit" was clicked.
pub(super) fn show(
    ui: &mut Ui,
    chosen: &mut Chosen,
    curves: &[Arc<Curve>],
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
    rest: impl FnOnce(&mut Ui, &Chosen, &mut Vec<Request>),
) -> bool {
    let mut fit = false;
    ui.horizontal(|ui| {
        ui.set_height(HEIGHT);
        ui.spacing_mut().item_spacing.x = 2.0;
        ui.add_space(2.0 * GRID);
        // The buttons show what is drawn: if the bones have no keys in the chosen properties, other properties are
        // drawn.
        let visible = curves.iter().fold(0, |all, curve| all | curve.id.bit());
        let has_shapes = context.take().is_some_and(|take| !take.morphs.is_empty());
        let kinds = [
            (bit(Property::Translation), "T", "Translation", ""),
            (bit(Property::Rotation), "R", "Rotation", ""),
            (bit(Property::Scale), "S", "Scale", ""),
            (
                SHAPES,
                "K",
                "Weights of shape keys",
                "All shape keys of a mesh share their keys and their interpolation\n",
            ),
        ];
        let kinds = kinds.into_iter().filter(|(bit, ..)| *bit != SHAPES || has_shapes);
        for (bit, letter, name, more) in kinds {
            let on = if visible == 0 { chosen.properties } else { visible } & bit != 0;
            let help = format!("Curves of {}\n{more}Shift adds", name.to_lowercase());
            if letter_button(ui, letter, name, on, None).on_hover_text(help).clicked() {
                let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
                chosen.properties = if !adds {
                    bit
                } else if chosen.properties == bit {
                    chosen.properties
                } else {
                    chosen.properties ^ bit
                };
            }
        }
        divider(ui);
        let axes = curves.iter().filter(|curve| !curve.id.is_shape());
        let width = axes.map(|curve| curve.width()).max().unwrap_or(if curves.is_empty() { 3 } else { 0 });
        for component in 0..width {
            let on = chosen.components & (1 << component) != 0;
            let name = component_name(component);
            // The curves of several bones have the colors of the bones.
            let is_one = curves.iter().all(|curve| curve.id.shares_color(curves[0].id));
            let tone = if is_one { color(Theme::of(ui), component) } else { Theme::of(ui).text };
            let label = format!("Component {name}");
            if letter_button(ui, name, &label, on, Some(tone))
                .on_hover_text(format!("Shows or hides {name}"))
                .clicked()
            {
                chosen.components ^= 1 << component;
            }
        }
        divider(ui);
        form(ui, chosen, context, requests);
        divider(ui);
        between(ui, curves, context, requests);
        view_menu::show(ui, context, requests);
        if icon_button(ui, Icon::Fit, "Fit the curves", false)
            .on_hover_text(
                "Fit the curves\nShows all values, and the selected keys or the whole take\n\
                 Wheel zooms the time, Shift + wheel pans, Ctrl + wheel zooms the values",
            )
            .clicked()
        {
            fit = true;
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.add_space(2.0 * GRID);
            rest(ui, chosen, requests);
        });
    });
    fit
}

/// Draws a square button with a letter.
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

fn form(ui: &mut Ui, chosen: &mut Chosen, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let text = RichText::new(chosen.form.name()).small().color(Theme::of(ui).weak);
    let button = ui.add(Button::new(text).frame(false)).on_hover_text("How rotations are shown");
    egui::Popup::menu(&button).show(|ui| {
        ui.set_width(110.0);
        for form in RotationForm::all() {
            if ui.add(Button::selectable(form == chosen.form, form.name())).clicked() {
                chosen.form = form;
                if let RotationForm::Euler(euler) = form {
                    let look = PropertiesLook { euler, ..context.settings.properties };
                    requests.push(Request::PropertiesLook(look));
                }
            }
        }
    });
}

/// Draws the buttons for the interpolation of the shown channels; one is pressed if all of them have it.
fn between(ui: &mut Ui, curves: &[Arc<Curve>], context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let able = !context.keys.selection().is_empty();
    for (icon, id, kind, _) in [
        (Icon::Step, Id::InterpolateStep, Interpolation::Step, KeyInterpolation::Step),
        (Icon::Linear, Id::InterpolateLinear, Interpolation::Linear, KeyInterpolation::Linear),
        (Icon::Spline, Id::InterpolateSpline, Interpolation::CubicSpline, KeyInterpolation::CubicSpline),
    ] {
        let on = !curves.is_empty() && curves.iter().all(|curve| curve.interpolation() == kind);
        ui.add_enabled_ui(able, |ui| {
            command_button(ui, icon, id, on, requests);
        });
    }
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), egui::Stroke::new(1.0, Theme::of(ui).line));
}
