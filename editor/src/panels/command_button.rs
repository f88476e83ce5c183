//! Buttons that run a command of the table.

use super::commands::{self, Id};
use super::icons::Icon;
use super::request::Request;
use super::widgets::{hint_beside, icon_button, wary_icon_button};
use egui::{Response, Ui};

/// Draws a square button with an icon that runs a command; highlighted when `on`. Its tooltip contains the
/// shortcut, and where the button is disabled the reason.
pub(super) fn command_button(
    ui: &mut Ui,
    icon: Icon,
    id: Id,
    on: bool,
    requests: &mut Vec<Request>,
) -> Response {
    let hint = commands::tooltip(ui.ctx(), id);
    let why = format!("{hint}\n{}", commands::get(id).when.reason());
    command(ui, icon, id, on, requests).on_hover_text(hint).on_disabled_hover_text(why)
}

/// Draws [`command_button`] in a column of buttons: the tooltip is at the right and does not cover the next one.
pub(super) fn column_button(ui: &mut Ui, icon: Icon, id: Id, on: bool, requests: &mut Vec<Request>) {
    let hint = commands::tooltip(ui.ctx(), id);
    hint_beside(&command(ui, icon, id, on, requests), hint);
}

/// Draws a button with the title of a command, which runs it.
pub(super) fn text_button(ui: &mut Ui, id: Id, requests: &mut Vec<Request>) -> Response {
    let response = ui.button(commands::get(id).title).on_hover_text(commands::tooltip(ui.ctx(), id));
    if response.clicked() {
        requests.push(Request::Command(id));
    }
    response
}

fn command(ui: &mut Ui, icon: Icon, id: Id, on: bool, requests: &mut Vec<Request>) -> Response {
    let title = commands::get(id).title;
    // With auto-key on, every movement is recorded.
    let response = if id == Id::AutoKey {
        wary_icon_button(ui, icon, title, on)
    } else {
        icon_button(ui, icon, title, on)
    };
    if response.clicked() {
        requests.push(Request::Command(id));
    }
    response
}
