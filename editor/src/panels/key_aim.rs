//! Commands that wait for the pointer over keys: the cursor of a selection box, and the menus at the pointer.

use super::commands::Id;
use super::context::PanelContext;
use super::keys::{KeyAim, KeysRequest};
use super::menu::item;
use super::request::Request;
use egui::{Area, CursorIcon, Frame, Order, Pos2, Ui};

/// The commands for tangents.
pub(super) const TANGENTS: [Id; 5] =
    [Id::TangentsAuto, Id::TangentsClamped, Id::TangentsFlat, Id::TangentsLinear, Id::TangentsUnified];
/// The commands for interpolation.
pub(super) const INTERPOLATIONS: [Id; 3] =
    [Id::InterpolateStep, Id::InterpolateLinear, Id::InterpolateSpline];

/// Draws the menu, if one is open, and ends what is over.
pub(super) fn show(ui: &Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let place = egui::Id::unique("place of the menu of keys");
    let end = || Request::Timeline(KeysRequest::Aim(None));
    let commands: &[Id] = match context.keys.aim() {
        Some(KeyAim::InterpolationMenu) => &INTERPOLATIONS,
        Some(KeyAim::TangentMenu) => &TANGENTS,
        Some(KeyAim::Box) => {
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
            if ui.input(|input| input.pointer.any_released()) {
                requests.push(end());
            }
            return;
        }
        None => {
            ui.data_mut(|data| data.remove::<Pos2>(place));
            return;
        }
    };
    let pointer = ui.input(|input| input.pointer.latest_pos());
    let middle = ui.ctx().content_rect().center();
    let at = ui.data_mut(|data| *data.get_temp_mut_or_insert_with(place, || pointer.unwrap_or(middle)));
    let before = requests.len();
    let area = Area::new(egui::Id::unique("menu of keys")).order(Order::Foreground).fixed_pos(at);
    let shown = area.constrain(true).show(ui.ctx(), |ui| {
        Frame::menu(ui.style()).show(ui, |ui| {
            ui.set_width(180.0);
            for &id in commands {
                item(ui, context, id, false, requests);
            }
        });
    });
    let is_outside = ui.input(|input| {
        input.pointer.any_pressed()
            && input.pointer.interact_pos().is_some_and(|at| !shown.response.rect.contains(at))
    });
    if requests.len() > before || is_outside {
        requests.push(end());
    }
}

/// Returns what to do now, for the status line.
pub(super) fn hint(aim: KeyAim) -> &'static str {
    match aim {
        KeyAim::Box => "Drag a box over keys; Shift adds, Esc cancels",
        KeyAim::InterpolationMenu => "Choose the interpolation of the selected keys; Esc cancels",
        KeyAim::TangentMenu => "Choose the tangents of the selected keys; Esc cancels",
    }
}
