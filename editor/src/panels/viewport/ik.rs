//! The buttons for IK on the left of the viewport: on and off, chain length, pins.

use crate::panels::command_button::column_button;
use crate::panels::commands::{self, Id};
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::style::{self, RADIUS};
use crate::panels::theme::Theme;
use crate::panels::widgets::{count, focus_ring, hint_beside};
use egui::accesskit::Role;
use egui::{Align2, Color32, CornerRadius, FontId, Response, Sense, Ui, WidgetInfo};

/// Draws two buttons, one above the other, and between them the length of the chain while IK is on.
pub(super) fn tools(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    column_button(ui, Icon::Ik, Id::ToggleIk, context.ik.on, requests);
    // The length means nothing while bones do not follow.
    if context.ik.on {
        length(ui, context, requests);
    }
    let pinned = context.selected().is_some_and(|bone| context.is_pinned(bone));
    column_button(ui, Icon::Pin, Id::Pin, pinned, requests);
}

/// Draws the button for the chain length, which opens a menu for IK and pins.
fn length(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let bones = count(context.ik.length as usize, "bone", "bones");
    let name = format!("IK chain: {bones}");
    let response = number_button(ui, context.ik.length, &name, context.ik.on);
    egui::Popup::menu(&response).align(egui::RectAlign::RIGHT_START).show(|ui| {
        ui.set_width(230.0);
        for id in [Id::ToggleIk, Id::LongerIk, Id::ShorterIk] {
            menu::item(ui, context, id, id == Id::ToggleIk && context.ik.on, requests);
        }
        let pole = context.ik.pole.is_some() && context.ik.pole == context.selected();
        menu::item(ui, context, Id::IkPole, pole, requests);
        ui.separator();
        menu::item(ui, context, Id::Pin, false, requests);
        menu::item(ui, context, Id::FreePins, false, requests);
        menu::item(ui, context, Id::BakePins, false, requests);
    });
    let [longer, shorter] = [Id::LongerIk, Id::ShorterIk].map(|id| commands::shortcut_text(ui.ctx(), id));
    let pole =
        context.ik.pole.map_or(String::new(), |pole| format!("\nPole target: {}", context.bone_name(pole)));
    let pins = match context.pins.len() {
        0 => String::new(),
        pins => format!("\n{} pinned", count(pins, "bone is", "bones are")),
    };
    let help =
        format!("IK moves {bones} above the moved one ({longer} for one more, {shorter} for one less)");
    hint_beside(&response, format!("{help}{pole}{pins}"));
}

/// Draws a square button that shows a number.
fn number_button(ui: &mut Ui, number: u32, name: &str, on: bool) -> Response {
    let (rect, response) = ui.allocate_exact_size(style::icon_size(), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let theme = Theme::of(ui);
        let fill = match (response.is_pointer_button_down_on(), response.hovered()) {
            (true, _) => theme.pressed,
            (false, true) => theme.hover,
            (false, false) => Color32::TRANSPARENT,
        };
        let color = if on { theme.accent } else { theme.weak };
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), fill);
        let font = FontId::monospace(style::NUMBER);
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, number, font, color);
        focus_ring(ui, &response, rect);
    }
    response
}
