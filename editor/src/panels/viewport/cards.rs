//! Cards in the middle of the viewport: no model is open, a model is loading, the graphics device failed, everything is hidden.

use crate::panels::commands::{self, Id};
use crate::panels::context::PanelContext;
use crate::panels::recent_files::recent_names;
use crate::panels::request::Request;
use crate::panels::style::{CARD_RADIUS, GRID};
use crate::panels::theme::Theme;
use crate::panels::window_status::DeviceStatus;
use dragonfly_document::{LoadStage, Source};
use egui::{Align2, CornerRadius, Frame, Margin, Rect, RichText, Stroke, Ui, vec2};

/// Draws the card for the present state, if there is one.
pub(super) fn show(ui: &mut Ui, rect: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if let Some(loading) = context.loading {
        card(ui, rect, |ui| {
            let what = match loading.progress.stage {
                LoadStage::Copying => "Saving",
                LoadStage::Reading | LoadStage::Understanding | LoadStage::Decoding => "Opening",
            };
            ui.label(RichText::new(format!("{what} {}", loading.title)).heading());
            ui.label(RichText::new(loading.progress.stage.title()).color(Theme::of(ui).weak));
            ui.add_space(GRID);
            let bar = egui::ProgressBar::new(loading.progress.done).desired_width(260.0).desired_height(6.0);
            ui.add(bar.fill(Theme::of(ui).accent));
            ui.add_space(GRID);
            if ui.button("Stop").clicked() {
                requests.push(Request::Command(Id::CancelLoading));
            }
        });
    } else if let DeviceStatus::Paused { reason } = context.window.device() {
        card(ui, rect, |ui| {
            ui.label(RichText::new("The viewport is paused").heading());
            let text = "The graphics device failed several times. Everything else works.";
            ui.label(RichText::new(text).color(Theme::of(ui).weak));
            ui.label(RichText::new(reason).small().color(Theme::of(ui).faint));
            ui.add_space(GRID);
            if ui.button("Try again").clicked() {
                requests.push(Request::Command(Id::RetryDevice));
            }
        });
    } else if context.view.is_none() {
        welcome(ui, rect, context, requests);
    } else if !context.settings.look.surface && !context.shows_skeleton() {
        card(ui, rect, |ui| {
            ui.label(RichText::new("Surface and skeleton are hidden").heading());
            ui.add_space(GRID);
            for (title, id) in
                [("Show the surface", Id::ToggleSurface), ("Show the skeleton", Id::ToggleSkeleton)]
            {
                let button = ui.add_sized(vec2(260.0, 28.0), egui::Button::new(title));
                if button.on_hover_text(commands::tooltip(ui.ctx(), id)).clicked() {
                    requests.push(Request::Command(id));
                }
            }
        });
    }
}

/// Draws the card when no model is open.
fn welcome(ui: &mut Ui, rect: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    card(ui, rect, |ui| {
        ui.label(RichText::new("Nothing is open").heading());
        ui.label(RichText::new("Drop a model here, or").color(Theme::of(ui).weak));
        ui.add_space(GRID);
        let open = ui.add_sized(vec2(260.0, 28.0), egui::Button::new("Open a model…"));
        if open.on_hover_text(commands::tooltip(ui.ctx(), Id::Open)).clicked() {
            requests.push(Request::Command(Id::Open));
        }
        if ui.add_sized(vec2(260.0, 28.0), egui::Button::new("Built-in dragonfly")).clicked() {
            requests.push(Request::Command(Id::OpenBuiltIn));
        }
        let scene = ui.add_sized(vec2(260.0, 28.0), egui::Button::new("New scene of two built-in figures…"));
        if scene.on_hover_text(commands::tooltip(ui.ctx(), Id::DemoScene)).clicked() {
            requests.push(Request::Command(Id::DemoScene));
        }
        let recent = &context.settings.recent;
        for (path, name) in recent.iter().zip(recent_names(recent)).take(4) {
            if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                requests.push(Request::Open(Source::File(path.clone())));
            }
        }
    });
}

/// Draws a card in the middle of the viewport.
fn card(ui: &mut Ui, rect: Rect, add: impl FnOnce(&mut Ui)) {
    let theme = Theme::of(ui);
    let id = ui.scope_id().with("card");
    egui::Area::new(id)
        .order(egui::Order::Middle)
        .pivot(Align2::CENTER_CENTER)
        .fixed_pos(rect.center())
        .constrain_to(rect)
        .show(ui.ctx(), |ui| {
            Frame::NONE
                .fill(theme.glass)
                .stroke(Stroke::new(1.0, theme.glass_line))
                .corner_radius(CornerRadius::same(CARD_RADIUS))
                .inner_margin(Margin::symmetric(28, 22))
                .show(ui, |ui| {
                    ui.set_max_width((rect.width() - 80.0).clamp(120.0, 320.0));
                    ui.vertical_centered(add);
                });
        });
}
