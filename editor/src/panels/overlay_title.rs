//! The heading of an overlay, with the button that closes it.

use super::icons::Icon;
use super::request::Request;
use super::widgets;
use egui::{Align, Layout, RichText, Ui};

/// Draws the heading.
pub(super) fn show(ui: &mut Ui, text: &str, requests: &mut Vec<Request>) {
    ui.horizontal(|ui| {
        ui.label(RichText::new(text).heading());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if widgets::icon_button(ui, Icon::Close, "Close", false).clicked() {
                requests.push(Request::Overlay(None));
            }
        });
    });
}
