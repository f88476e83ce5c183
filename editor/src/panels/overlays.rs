//! Overlays drawn over the panels: command palette, shortcut sheet, about, path field.

use super::context::PanelContext;
use super::export::ExportDialog;
use super::loop_dialog::LoopDialog;
use super::mirror_pairs::MirrorDialog;
use super::model_size;
use super::open_path::{OpenPathDialog, PathUse};
use super::overlay_title;
use super::palette::Palette;
use super::prompts::Overlay;
use super::reference::dialog::ReferenceDialog;
use super::request::Request;
use super::retarget::RetargetDialog;
use super::root_motion::RootMotionDialog;
use super::shortcuts::ShortcutSheet;
use super::style::GRID;
use super::theme::Theme;
use egui::{Align2, Id as WidgetId, Modal, RichText, Ui, vec2};

/// The states of the overlays.
#[derive(Debug, Default)]
pub struct Overlays {
    palette: Palette,
    path: OpenPathDialog,
    export: ExportDialog,
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
            Overlay::Retarget => self.retarget.show(ui, fresh, context, requests),
            Overlay::RootMotion => self.root_motion.show(ui, context, requests),
            Overlay::Loop => self.loops.show(ui, context, requests),
            Overlay::ModelSize => model_size::show(ui, context, requests),
            Overlay::Reference => self.reference.show(ui, context, requests),
            Overlay::Export => self.export.show(ui, fresh, context, requests),
            Overlay::OpenPath => self.path.show(ui, fresh, (PathUse::Open, context), requests),
            Overlay::ImportOptions => self.path.show(ui, fresh, (PathUse::Again, context), requests),
            Overlay::ComparePath => self.path.show(ui, fresh, (PathUse::Compare, context), requests),
            Overlay::FilePath(choice) => {
                self.path.show(ui, fresh, (PathUse::Choice(choice), context), requests)
            }
        });
        if response.should_close() {
            requests.push(Request::Overlay(None));
        }
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
