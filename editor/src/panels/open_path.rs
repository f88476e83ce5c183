//! The field for the path of a model, with the import options.

use super::chosen_file;
use super::context::PanelContext;
use super::file_choice::FileChoice;
use super::request::{FileAction, Request};
use super::style::GRID;
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::format::dfm::DFM;
use dragonfly_anim::format::gltf::{GLB, GLTF, VRMA};
use dragonfly_anim::format::{Conventions, Handedness, UpAxis};
use dragonfly_document::{DocumentMessage, LoadedModel, Source};
use egui::{
    Align, Button, ComboBox, DragValue, Grid, Key, Layout, Margin, RichText, TextEdit, TextStyle, Ui,
};
use std::path::{Path, PathBuf};

/// Width of the dialog, points.
const WIDTH: f32 = 520.0;
/// Lengths of a unit that files have, in meters, with their names.
const UNITS: [(f32, &str); 5] =
    [(1.0, "Meter"), (0.01, "Centimeter"), (0.001, "Millimeter"), (0.0254, "Inch"), (0.3048, "Foot")];

/// What the path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathUse {
    /// A model is opened.
    Open,
    /// The open model is opened again with other import options.
    Again,
    /// The open model is compared with another one.
    Compare,
    /// A file or folder is chosen.
    Choice(FileChoice),
}

/// The path that was typed, and the import options.
#[derive(Debug, Default)]
pub(super) struct OpenPathDialog {
    path: String,
    chosen: Conventions,
}

impl OpenPathDialog {
    /// Draws the dialog; `fresh` where it was not shown in the frame before.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        fresh: bool,
        (used, context): (PathUse, &PanelContext<'_>),
        requests: &mut Vec<Request>,
    ) {
        if fresh {
            self.begin(used, context);
        }
        let [title, action] = match used {
            PathUse::Open => ["Open by path", "Open"],
            PathUse::Again => ["Import options", "Open again"],
            PathUse::Compare => ["Compare with another file", "Compare"],
            PathUse::Choice(choice) => [choice.title(), "Choose"],
        };
        ui.set_width(WIDTH);
        ui.label(RichText::new(title).heading());
        let name = match used {
            PathUse::Choice(_) => "Path",
            PathUse::Open | PathUse::Again | PathUse::Compare => "Path of the model",
        };
        let hint = match used {
            PathUse::Choice(choice) if choice.filter().is_none() => "/home/me/scenes",
            PathUse::Choice(_) | PathUse::Open | PathUse::Again | PathUse::Compare => {
                "/home/me/models/fox.glb"
            }
        };
        let is_begun = is_of_scene(used) && is_folder(&self.path);
        let entered = self.field(ui, [name, hint], fresh, is_begun);
        if matches!(used, PathUse::Open | PathUse::Again) {
            ui.add_space(GRID);
            let view = context.view.filter(|_| used == PathUse::Again);
            self.options(ui, view.map(|view| &*view.loaded));
        }
        ui.add_space(GRID);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let is_missing = self.path.trim().is_empty() || is_of_scene(used) && is_folder(&self.path);
            let able = !is_missing;
            let open = ui.add_enabled(able, Button::new(action)).clicked();
            if ui.button("Cancel").clicked() {
                requests.push(Request::Overlay(None));
            }
            if able && (open || entered) {
                requests.push(Request::Overlay(None));
                requests.push(self.request(used));
            }
        });
    }

    /// Starts with the open file and the options with which it was read, where its import options are shown, and with the folder of the scene for a
    /// new part of it.
    fn begin(&mut self, used: PathUse, context: &PanelContext<'_>) {
        if used != PathUse::Again {
            self.chosen = Conventions::default();
            let is_new = self.path.trim().is_empty() || is_folder(&self.path);
            let scene = context.view.filter(|view| view.scene.is_some() && is_new && is_of_scene(used));
            if let Some(folder) = scene.and_then(|view| view.file.path.as_deref()).and_then(Path::parent) {
                // With the separator at its end, after which a name is typed.
                self.path = folder.join("").display().to_string();
            }
            return;
        }
        if let Some(view) = context.view {
            let path = view.file.path.as_ref().or(view.loaded.path.as_ref());
            self.path = path.map_or_else(String::new, |path| path.display().to_string());
            self.chosen = view.loaded.conversion.chosen();
        }
    }

    fn request(&self, used: PathUse) -> Request {
        let path = PathBuf::from(self.path.trim().trim_matches('"'));
        match used {
            PathUse::Compare => {
                Request::Answer(FileAction::Send(DocumentMessage::ReadCompared(Source::File(path))))
            }
            PathUse::Choice(choice) => chosen_file::request(choice, path, Vec::new()),
            PathUse::Open | PathUse::Again => Request::Open(Source::of(path, self.chosen)),
        }
    }

    /// Draws the field, in which the name is still to be typed if `is_begun`. Returns whether the user pressed Enter in it.
    fn field(&mut self, ui: &mut Ui, [name, hint]: [&str; 2], fresh: bool, is_begun: bool) -> bool {
        let field = TextEdit::singleline(&mut self.path).hint_text(hint).desired_width(f32::INFINITY);
        let response = ui.add(field.font(TextStyle::Monospace).margin(Margin::symmetric(10, 7)));
        let response = response.accessible_name(name);
        if fresh {
            response.request_focus();
            // The last path is selected, so that it can be corrected or typed over. What is typed comes after a folder.
            let end = self.path.chars().count();
            let start = if is_begun { end } else { 0 };
            widgets::select_characters(ui.ctx(), response.id, start..end);
        }
        response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter))
    }

    /// Draws the options, and how the file was read that is opened again.
    fn options(&mut self, ui: &mut Ui, again: Option<&LoadedModel>) {
        let weak = Theme::of(ui).weak;
        let mut line = |text: &str| _ = ui.label(RichText::new(text).small().color(weak));
        if let Some(loaded) = again {
            line(&format!("Read as: {}", loaded.conversion));
        }
        let states_units = |loaded: &LoadedModel| {
            loaded.format.is_some_and(|format| [GLB, GLTF, VRMA, DFM].contains(&format))
        };
        if again.is_none_or(states_units) {
            line(
                "glTF and Dragonfly files state their units and axes; these options have no effect on them.",
            );
        }
        Grid::new("import options").num_columns(3).spacing([12.0, 8.0]).show(ui, |ui| {
            ui.label("Unit");
            self.unit(ui);
            ui.end_row();
            ui.label("Up axis");
            let axes = [(UpAxis::X, "X"), (UpAxis::Y, "Y"), (UpAxis::Z, "Z")];
            choice(ui, "Up axis", &mut self.chosen.up, &axes);
            ui.end_row();
            ui.label("Axes");
            let hands = [(Handedness::Right, "Right-handed"), (Handedness::Left, "Left-handed")];
            choice(ui, "Axes", &mut self.chosen.handedness, &hands);
            ui.end_row();
            ui.label("Frame rate");
            self.rate(ui);
            ui.end_row();
        });
    }

    fn unit(&mut self, ui: &mut Ui) {
        choice(ui, "Unit", &mut self.chosen.meters_per_unit, &UNITS);
        if let Some(meters) = &mut self.chosen.meters_per_unit {
            let field = DragValue::new(meters).range(1e-6..=1e6).speed(0.001).max_decimals(6).suffix(" m");
            ui.add(field).on_hover_text("Length of a unit of the file");
        }
    }

    fn rate(&mut self, ui: &mut Ui) {
        let rates = [(24.0, "24"), (25.0, "25"), (30.0, "30"), (60.0, "60"), (120.0, "120")];
        choice(ui, "Frame rate", &mut self.chosen.frame_rate, &rates);
        if let Some(rate) = &mut self.chosen.frame_rate {
            let field = DragValue::new(rate).range(0.01..=1e5).speed(0.5).suffix(" per second");
            ui.add(field).on_hover_text("Frames or ticks per second of the file");
        }
    }
}

/// Returns whether a path is that of a new part of the scene.
fn is_of_scene(used: PathUse) -> bool {
    matches!(used, PathUse::Choice(FileChoice::Role | FileChoice::Prop | FileChoice::SceneSound))
}

/// Returns whether a typed path ends after a folder.
fn is_folder(path: &str) -> bool {
    path.trim().ends_with(std::path::is_separator)
}

/// Draws a list with the entry “As in the file”, and these.
fn choice<T: Copy + PartialEq>(ui: &mut Ui, name: &str, chosen: &mut Option<T>, entries: &[(T, &str)]) {
    let named = |value: T| entries.iter().find(|(entry, _)| *entry == value).map(|(_, name)| *name);
    let text = chosen.map_or("As in the file", |value| named(value).unwrap_or("Other"));
    let response = ComboBox::from_id_salt(name).selected_text(text).width(150.0).show_ui(ui, |ui| {
        ui.selectable_value(chosen, None, "As in the file");
        for (value, text) in entries {
            ui.selectable_value(chosen, Some(*value), *text);
        }
    });
    response.response.accessible_name(name);
}
