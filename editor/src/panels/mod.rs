//! Everything around the viewport: panels that read a [`PanelContext`] and push [`Request`]s, and never wait for an answer.
//!
//! ```text
//! panels ── Request ──► State ──► actions ──► Workspace: one owner for each part
//!    ▲                                            │
//!    └────────────── PanelContext ◄───────────────┘
//! ```
//!
//! A new panel is a file here and a line in [`all`]. A new command is a row in [`commands::TABLE`].

mod actions;
mod bone_choice;
mod bone_menu;
mod buttonless_keys;
mod camera_state;
mod change_summary;
pub(crate) mod chosen_file;
mod command_button;
pub mod commands;
pub mod compared;
pub mod context;
mod count_text;
pub mod curves;
pub mod dialog_preview;
pub mod dialogs;
mod difference_text;
pub mod differences;
pub mod digest;
mod dope;
mod drag;
pub mod dragging;
pub mod dropped_files;
pub mod echo;
pub mod edit_scope;
mod edit_scope_menu;
mod effects_menu;
pub mod export;
pub mod file_choice;
mod foot_contacts;
mod frame_rate;
mod hidden_pointer;
pub mod hierarchy;
pub mod history;
pub mod icons;
pub mod inbetween;
mod key_aim;
mod key_canvases;
pub mod keys;
mod keys_menu;
pub mod layer_choice;
pub mod layers;
pub mod layout;
mod length_unit;
mod looked_folder;
mod loop_dialog;
mod loop_search;
pub mod marks;
pub mod menu;
mod menu_entries;
mod mirror_pairs;
mod model_size;
pub mod motion_path;
mod name_field;
pub mod number_field;
pub mod number_slider;
pub mod number_text;
pub mod open_model;
mod open_path;
mod overlay;
mod overlay_title;
pub mod overlays;
mod palette;
pub mod panel;
mod plain_words;
mod player;
pub mod pose_library;
pub mod posed;
pub mod poses;
pub mod prompts;
pub mod properties;
mod recent_files;
pub mod reference;
pub mod request;
mod retarget;
pub mod retarget_source;
mod root_motion;
pub mod ruler;
pub mod scene;
mod scene_menu;
mod search_field;
mod selected_bones;
pub mod selection_sets;
mod selection_steps;
mod selection_trail;
mod set_chips;
pub mod settings;
pub mod shape_keys;
mod shortcuts;
mod shown_skeleton;
pub mod side_files;
pub mod sound;
mod source_place;
pub mod state;
pub mod status;
pub mod status_line;
mod step_remark;
mod step_text;
pub mod style;
mod submenu;
mod tab;
pub mod take_findings;
pub mod take_list;
pub mod takes;
pub mod theme;
pub mod timeline;
mod toast;
pub mod tool_drag;
pub mod tool_state;
mod transport;
pub mod viewport;
mod waveform;
mod widgets;
pub mod window_status;
mod workspace;

pub use context::PanelContext;
pub use file_choice::FileChoice;
pub use layout::Layout;
pub use panel::{Panel, PanelPlace, PanelSubject, VIEWPORT};
pub use request::{Effect, FileAction, Request};
pub use settings::Settings;
pub use state::State;

use egui::Ui;
use hidden_pointer::{HiddenPointer, ModalKind};

/// Every panel.
pub fn all() -> Vec<Box<dyn Panel>> {
    vec![
        Box::<hierarchy::Hierarchy>::default(),
        Box::<scene::outliner::Outliner>::default(),
        Box::<takes::Takes>::default(),
        Box::<layers::Layers>::default(),
        Box::<viewport::Viewport>::default(),
        Box::<properties::Properties>::default(),
        Box::<scene::attributes::SceneAttributes>::default(),
        Box::<history::History>::default(),
        Box::<timeline::TimelinePanel>::default(),
        Box::<scene::timeline::SceneTimeline>::default(),
        Box::<curves::Curves>::default(),
        Box::<scene::script::ScriptPanel>::default(),
        Box::<scene::shots::ShotsPanel>::default(),
        Box::<inbetween::InBetween>::default(),
        Box::<differences::DifferencesPanel>::default(),
        Box::<poses::PosesPanel>::default(),
        Box::<shape_keys::ShapeKeys>::default(),
    ]
}

/// Everything that is drawn in the window: panels, overlays, questions.
pub struct Desk {
    panels: Vec<Box<dyn Panel>>,
    layout: Layout,
    overlays: overlays::Overlays,
    dialogs: dialogs::Dialogs,
    toast: toast::Toast,
}

impl Desk {
    /// Creates the panels in the arrangement of `layout`, the text of a layout file; an empty text gives the default one.
    pub fn new(layout: &str) -> Self {
        let panels = all();
        let layout = Layout::parse(layout, &panels);
        let (overlays, dialogs) = (overlays::Overlays::default(), dialogs::Dialogs::default());
        Self { panels, layout, overlays, dialogs, toast: toast::Toast::default() }
    }

    /// Returns the layout as the text of a layout file, if it changed since the last call.
    pub fn changed_layout(&mut self) -> Option<String> {
        self.layout.take_changed().then(|| self.layout.to_text())
    }

    /// Resets the arrangement of the panels to the default one.
    pub fn reset_layout(&mut self) {
        self.layout = Layout::usual(&self.panels);
    }

    /// Shows or hides a panel.
    pub fn toggle_panel(&mut self, id: &str) {
        self.layout.toggle(id);
    }

    /// Shows a panel, in front of those in the same place.
    pub fn show_panel(&mut self, id: &str) {
        self.layout.bring_to_front(id);
    }

    /// Draws one frame.
    pub fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        commands::Keymap::install(&context.settings.keys, ui.ctx());
        close_menus_beside_a_drag(ui.ctx());
        let hidden = HiddenPointer::begin(ui.ctx(), context);
        let theme = theme::Theme::of(ui);
        let bar = egui::Frame::NONE.fill(theme.bar);
        egui::Panel::top("menu").exact_size(style::BAR).frame(bar).show_separator_line(false).show(
            ui,
            |ui| {
                let is_scene = context.scene().is_some();
                let shown: Vec<_> = self
                    .panels
                    .iter()
                    .filter(|panel| panel.subject().fits(is_scene))
                    .map(|panel| (panel.id(), panel.title(), self.layout.is_shown(panel.id())))
                    .collect();
                ui.centered_and_justified(|ui| menu::show(ui, context, &shown, requests));
            },
        );
        egui::Panel::bottom("status").exact_size(24.0).frame(bar).show_separator_line(false).show(ui, |ui| {
            status_line::show(ui, context, requests);
        });
        egui::CentralPanel::no_frame().show(ui, |ui| {
            self.layout.show(ui, &mut self.panels, context, requests);
        });
        drop_hint(ui);
        buttonless_keys::show(ui, context, requests);
        key_aim::show(ui, context, requests);
        let hidden = hidden.and_then(|hidden| hidden.show_above(ui.ctx(), ModalKind::Overlay));
        self.overlays.show(ui, context, requests);
        let hidden = hidden.and_then(|hidden| hidden.show_above(ui.ctx(), ModalKind::Question));
        debug_assert!(hidden.is_none(), "a question is above everything");
        self.dialogs.show(ui, context, requests);
        self.toast.show(ui, context);
    }
}

/// Closes menus when a drag starts outside of them. egui does so for clicks only; a selection box or an orbit in the
/// viewport would be drawn under the menu.
fn close_menus_beside_a_drag(context: &egui::Context) {
    let begun = context.input(|input| {
        let drags = input.pointer.is_decidedly_dragging();
        input.pointer.press_origin().filter(|_| drags)
    });
    let beside = |at| context.layer_id_at(at).is_none_or(|layer| layer.order < egui::Order::Foreground);
    if begun.is_some_and(beside) {
        egui::Popup::close_all(context);
    }
}

/// Shows that a file held over the window can be dropped.
fn drop_hint(ui: &Ui) {
    if ui.input(|input| input.raw.hovered_files.is_empty()) {
        return;
    }
    let theme = theme::Theme::of(ui);
    let layer = egui::LayerId::new(egui::Order::Foreground, egui::Id::unique("drop"));
    let painter = ui.ctx().layer_painter(layer);
    let rect = ui.ctx().content_rect();
    painter.rect_filled(rect, 0.0, theme.glass.gamma_multiply(0.7));
    let stroke = egui::Stroke::new(2.0, theme.accent);
    painter.rect_stroke(rect.shrink(12.0), f32::from(style::CARD_RADIUS), stroke, egui::StrokeKind::Inside);
    let font = egui::FontId::proportional(20.0);
    painter.text(rect.center(), egui::Align2::CENTER_CENTER, "Drop to open", font, theme.text);
}
