//! The menu of how curves are shown.

use super::look::CurvesLook;
use crate::control::expression::Quantity;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::number_field::{FieldEvent, NumberField};
use crate::panels::number_text::Digits;
use crate::panels::request::Request;
use crate::panels::style::{CONTROL, GRID};
use crate::panels::theme::Theme;
use crate::panels::widgets::{self, icon_button};
use egui::{Button, Id, Popup, PopupCloseBehavior, Rect, Sense, TextStyle, Ui, pos2, vec2};

/// Steps that are offered, units or degrees.
const STEPS: [f32; 6] = [0.01, 0.1, 1.0, 5.0, 15.0, 45.0];

/// Draws the button that opens the menu.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let look = context.settings.curves;
    let is_usual = look == CurvesLook::default();
    let button = icon_button(ui, Icon::Adjust, "View of the curves", !is_usual)
        .on_hover_text("View of the curves\nNormalize, dim others, snap values");
    Popup::menu(&button).close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        ui.set_width(200.0);
        let mut next = look;
        ui.checkbox(&mut next.normalized, "Normalize")
            .on_hover_text("Draws each curve from its least to its greatest value; numbers stay true");
        ui.checkbox(&mut next.solo, "Dim others")
            .on_hover_text("Draws all curves but the one under the pointer faintly");
        ui.separator();
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), CONTROL), Sense::hover());
        widgets::text_in(ui, rect, "Snap values to", &TextStyle::Body, Theme::of(ui).text);
        let field = NumberField {
            id: Id::unique("step of the values of keys"),
            name: "Snap values to",
            value: Some(f64::from(look.value_step)),
            quantity: Quantity::Number,
            unit: "",
            speed: 0.1,
            snap: 1.0,
            grain: 1e-6,
            digits: Digits::Fitting,
            range: 0.0..=1e6,
            locked: None,
            help: "Keys dragged up and down go to multiples of this; 0 for none. Ctrl inverts",
            quiet: look.value_step == 0.0,
            relative: false,
        };
        let place = Rect::from_min_max(pos2(rect.right() - 80.0, rect.top()), rect.max);
        match field.show(ui, place).0 {
            FieldEvent::Typed(step) => next.value_step = step as f32,
            FieldEvent::Nothing
            | FieldEvent::Touched
            | FieldEvent::Dragged(_)
            | FieldEvent::Released
            | FieldEvent::Cancelled
            | FieldEvent::Changed(_) => {}
        }
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing = vec2(GRID, GRID);
            for step in [0.0].into_iter().chain(STEPS) {
                let name = if step == 0.0 { "Off".to_owned() } else { step.to_string() };
                if ui.add(Button::selectable(look.value_step == step, name)).clicked() {
                    next.value_step = step;
                }
            }
        });
        if next != look {
            requests.push(Request::CurvesLook(CurvesLook::sanitized(next)));
        }
    });
}
