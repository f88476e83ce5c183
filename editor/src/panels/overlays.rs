//! Overlays drawn over the panels: command palette, shortcut sheet, about, path field.

use super::context::PanelContext;
use super::loop_dialog::LoopDialog;
use super::mirror_pairs::MirrorDialog;
use super::overlay_title;
use super::palette::Palette;
use super::prompts::Overlay;
use super::reference::dialog::ReferenceDialog;
use super::request::{FileAction, Request};
use super::retarget::RetargetDialog;
use super::root_motion::RootMotionDialog;
use super::shortcuts::ShortcutSheet;
use super::style::GRID;
use super::theme::Theme;
use super::widgets;
use dragonfly_document::{DocumentMessage, Source};
use egui::{Align2, Id as WidgetId, Key, Modal, RichText, TextEdit, TextStyle, Ui, vec2};
use std::path::PathBuf;

/// The text typed into overlays.
#[derive(Debug, Default)]
pub struct Overlays {
    palette: Palette,
    path: String,
    shortcuts: ShortcutSheet,
    shown: Option<Overlay>,
    root_motion: RootMotionDialog,
    mirror: MirrorDialog,
    loops: LoopDialog,
    retarget: RetargetDialog,
    reference: ReferenceDialog,
}

impl Overlays {
    /// Draws the overlay that `context` names.
    pub fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let fresh = self.shown != context.overlay;
        if fresh {
            self.shown = context.overlay;
            self.palette = Palette::default();
            self.shortcuts.begin(ui);
        }
        let Some(overlay) = context.overlay else { return };
        let id = WidgetId::unique(("overlay", format!("{overlay:?}")));
        let mut modal = Modal::new(id).backdrop_color(Theme::of(ui).backdrop);
        let margin = if overlay == Overlay::Palette { 8 } else { 20 };
        modal = modal.frame(egui::Frame::popup(ui.style()).inner_margin(margin));
        if overlay == Overlay::Palette {
            modal = modal.area(Modal::default_area(id).anchor(Align2::CENTER_TOP, vec2(0.0, 72.0)));
        }
        if matches!(overlay, Overlay::RootMotion | Overlay::Loop | Overlay::Retarget | Overlay::Reference) {
            // Beside the figure in the viewport, which nothing dims.
            modal = modal.backdrop_color(egui::Color32::TRANSPARENT);
            modal = modal.area(Modal::default_area(id).anchor(Align2::RIGHT_CENTER, vec2(-24.0, 0.0)));
        }
        let response = modal.show(ui.ctx(), |ui| match overlay {
            Overlay::Palette => self.palette.show(ui, fresh, context, requests),
            Overlay::Shortcuts => self.shortcuts.show(ui, context, requests),
            Overlay::About => about(ui, context, requests),
            Overlay::MirrorPairs => self.mirror.show(ui, context, requests),
            Overlay::Retarget => self.retarget.show(ui, context, requests),
            Overlay::RootMotion => self.root_motion.show(ui, context, requests),
            Overlay::Loop => self.loops.show(ui, context, requests),
            Overlay::Reference => self.reference.show(ui, context, requests),
            Overlay::OpenPath | Overlay::ComparePath => self.path(ui, fresh, overlay, requests),
        });
        if response.should_close() {
            requests.push(Request::Overlay(None));
        }
    }

    /// Draws a field for the path of a model that is opened or compared.
    fn path(&mut self, ui: &mut Ui, fresh: bool, overlay: Overlay, requests: &mut Vec<Request>) {
        let compares = overlay == Overlay::ComparePath;
        let [title, action] =
            if compares { ["Compare with another file", "Compare"] } else { ["Open by path", "Open"] };
        ui.set_width(520.0);
        ui.label(RichText::new(title).heading());
        let field = TextEdit::singleline(&mut self.path)
            .hint_text("/home/me/models/fox.glb")
            .desired_width(f32::INFINITY);
        let response = ui.add(field.font(TextStyle::Monospace).margin(egui::Margin::symmetric(10, 7)));
        let response = response.accessible_name("Path of the model");
        if fresh {
            response.request_focus();
            // The last path is selected, so that it can be corrected or typed over.
            widgets::select_all(ui.ctx(), response.id, &self.path);
        }
        let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        ui.add_space(GRID);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let able = !self.path.trim().is_empty();
            let open = ui.add_enabled(able, egui::Button::new(action)).clicked();
            if ui.button("Cancel").clicked() {
                requests.push(Request::Overlay(None));
            }
            if able && (open || entered) {
                let path = PathBuf::from(self.path.trim().trim_matches('"'));
                requests.push(Request::Overlay(None));
                let source = Source::File(path);
                requests.push(if compares {
                    Request::Answer(FileAction::Send(DocumentMessage::ReadCompared(source)))
                } else {
                    Request::Open(source)
                });
            }
        });
    }
}

fn about(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_width(420.0);
    overlay_title::show(ui, "Dragonfly", requests);
    let theme = Theme::of(ui);
    ui.label(RichText::new(concat!("Version ", env!("CARGO_PKG_VERSION"))).color(theme.weak));
    ui.add_space(2.0 * GRID);
    ui.label("An editor for skeletal animation, built on messages between threads.");
    ui.add_space(2.0 * GRID);
    ui.label(
        RichText::new("MIT or Apache 2.0. Typeface Inter: SIL Open Font License 1.1.")
            .small()
            .color(theme.weak),
    );
    if let super::window_status::DeviceStatus::Ready { adapter } = context.window.device() {
        ui.label(RichText::new(adapter).small().color(theme.faint));
        if let Some(time) = context.window.frame_time() {
            let text = format!("The last frame took {time:.1} ms");
            ui.label(RichText::new(text).small().color(theme.faint));
        }
    }
}
