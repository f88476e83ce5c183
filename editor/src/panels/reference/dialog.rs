//! The dialog of the reference picture.

use super::{ReferenceSettings, ReferenceView};
use crate::panels::context::PanelContext;
use crate::panels::file_choice::FileChoice;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::theme::Theme;
use crate::panels::{menu, overlay_title, widgets};
use egui::{Button, Checkbox, ComboBox, DragValue, Grid, Key, RichText, Slider, TextEdit, Ui};
use std::path::PathBuf;

/// The dialog, with the path that is being typed.
#[derive(Debug, Default)]
pub struct ReferenceDialog {
    path: Option<String>,
}

/// Width of the dialog, points.
const WIDTH: f32 = 340.0;

impl ReferenceDialog {
    /// Draws the dialog.
    pub(in crate::panels) fn show(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        ui.set_width(WIDTH);
        overlay_title::show(ui, "Reference", requests);
        menu::outline_fields(ui);
        let now = context.reference.settings();
        let mut new = now.clone();
        self.file(ui, context, &mut new, requests);
        state(ui, context);
        ui.add_space(GRID);
        ui.add_enabled_ui(now.is_chosen(), |ui| {
            Grid::new(ui.scope_id().with("reference")).num_columns(2).spacing([3.0 * GRID, GRID]).show(
                ui,
                |ui| {
                    place(ui, &mut new);
                    if context.reference.info().is_some_and(|info| info.frames > 1) {
                        frames(ui, context, &mut new);
                    }
                },
            );
        });
        if new != *now {
            requests.push(Request::Reference(new));
        }
    }

    /// Draws the path, the button that chooses a file, and whether it is shown.
    fn file(
        &mut self,
        ui: &mut Ui,
        context: &PanelContext<'_>,
        new: &mut ReferenceSettings,
        requests: &mut Vec<Request>,
    ) {
        let shown = new.file.display().to_string();
        ui.horizontal(|ui| {
            let text = self.path.get_or_insert_with(|| shown.clone());
            let field =
                TextEdit::singleline(text).hint_text("Picture, sequence or GIF").desired_width(WIDTH - 98.0);
            let field = ui.add(field).accessible_name("File of the reference");
            if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                let path = text.trim().trim_matches('"');
                new.file = PathBuf::from(path);
                new.shown = true;
            }
            if !field.has_focus() {
                self.path = None;
            }
            field
                .on_hover_text("A picture (PNG, JPEG, WebP), one of a numbered sequence, or an animated GIF");
            if ui.button("Choose…").on_hover_text("Shows the system's dialog for files").clicked() {
                let folder = new.file.parent().filter(|folder| !folder.as_os_str().is_empty());
                let folder = folder.map(std::path::Path::to_owned).or_else(|| context.model_folder());
                requests.push(Request::Choose(FileChoice::Reference, folder));
            }
        });
        ui.horizontal(|ui| {
            let able = new.is_chosen();
            ui.add_enabled(able, Checkbox::new(&mut new.shown, "Show"));
            let sequence = ui.add_enabled(able, Checkbox::new(&mut new.sequence, "Numbered sequence"));
            sequence.on_hover_text("Files with other numbers at the end of their names are the other frames");
            if ui.add_enabled(able, Button::new("Remove")).on_hover_text("Shows no reference").clicked() {
                new.file = PathBuf::new();
            }
        });
    }
}

/// Draws what was found in the files, or why nothing is shown.
fn state(ui: &mut Ui, context: &PanelContext<'_>) {
    let (reference, theme) = (context.reference, Theme::of(ui));
    if let Some(problem) = reference.problem() {
        ui.label(RichText::new(problem).small().color(theme.warning));
    } else if let Some(info) = reference.info() {
        let [width, height] = info.size;
        let mut text = format!("{width} × {height}");
        if info.frames > 1 {
            text += &format!(", {}", widgets::count(info.frames, "frame", "frames"));
        }
        if let Some(rate) = info.rate {
            text += &format!(" at {rate:.1} per second");
        }
        if let Some(frame) = context.reference_frame().filter(|_| info.frames > 1) {
            text += &format!("  ·  now {}", frame + 1);
        }
        ui.label(RichText::new(text).small().color(theme.weak));
    } else if reference.settings().is_chosen() {
        ui.label(RichText::new("Reading…").small().color(theme.weak));
    }
}

/// Draws a field with its name.
fn number(ui: &mut Ui, name: &str, field: DragValue<'_>, help: &str) {
    let label = ui.label(name);
    ui.add(field).labelled_by(label.id).on_hover_text(help);
    ui.end_row();
}

/// Draws the fields for the place of the picture.
fn place(ui: &mut Ui, new: &mut ReferenceSettings) {
    const MOST: f32 = ReferenceSettings::MOST;
    let label = ui.label("Place");
    ComboBox::from_id_salt("place of the reference")
        .selected_text(new.view.title())
        .show_ui(ui, |ui| {
            for view in ReferenceView::ALL {
                ui.selectable_value(&mut new.view, view, view.title());
            }
        })
        .response
        .labelled_by(label.id)
        .on_hover_text("Locked to the camera behind the model, or on an upright plane of the scene");
    ui.end_row();
    let label = ui.label("Opacity");
    ui.add(Slider::new(&mut new.opacity, 0.0..=1.0).fixed_decimals(2)).labelled_by(label.id);
    ui.end_row();
    let [x, y] = &mut new.offset;
    if new.view == ReferenceView::Camera {
        let scale = DragValue::new(&mut new.scale).range(0.01..=100.0).speed(0.01);
        number(ui, "Scale", scale, "1 just fits into the viewport");
        let help = "Distance from the middle, in widths and heights of the viewport";
        number(ui, "Right", DragValue::new(x).range(-MOST..=MOST).speed(0.005), help);
        number(ui, "Up", DragValue::new(y).range(-MOST..=MOST).speed(0.005), help);
    } else {
        let height = DragValue::new(&mut new.height).range(0.001..=MOST).speed(0.01).suffix(" m");
        number(ui, "Height", height, "Height of the picture");
        let distance = DragValue::new(&mut new.distance).range(-MOST..=MOST).speed(0.01).suffix(" m");
        number(ui, "Distance", distance, "Distance behind the middle of the scene");
        let help = "Distance of its lower edge from the middle of the ground";
        number(ui, "Right", DragValue::new(x).range(-MOST..=MOST).speed(0.01).suffix(" m"), help);
        number(ui, "Up", DragValue::new(y).range(-MOST..=MOST).speed(0.01).suffix(" m"), help);
    }
}

/// Draws the fields for the frames of a sequence.
fn frames(ui: &mut Ui, context: &PanelContext<'_>, new: &mut ReferenceSettings) {
    const LATEST: i32 = ReferenceSettings::LATEST;
    let first = DragValue::new(&mut new.first).range(-LATEST..=LATEST).speed(0.2);
    number(ui, "First frame at", first, "The frame of the take at which the first frame is shown");
    let rate = context.reference_rate();
    let field = DragValue::new(&mut new.rate).range(0.0..=1000.0).speed(0.1).max_decimals(3);
    let field = field.custom_formatter(move |own, _| {
        if own > 0.0 {
            format!("{own:.3}").trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            format!("auto ({rate:.0})")
        }
    });
    number(ui, "Frame rate", field, "Frames per second; 0 for the file's own, or that of the timeline");
    let label = ui.label("At the ends");
    ui.horizontal(|ui| {
        ui.selectable_value(&mut new.repeats, false, "Hold")
            .on_hover_text("The first and the last frame stay");
        ui.selectable_value(&mut new.repeats, true, "Loop").on_hover_text("The frames start again");
    })
    .response
    .labelled_by(label.id);
    ui.end_row();
}
