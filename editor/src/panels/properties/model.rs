//! Statistics of a model.

use super::super::context::PanelContext;
use super::super::number_text::Digits;
use super::super::prompts::Overlay;
use super::super::request::Request;
use super::super::theme::Theme;
use super::super::widgets;
use dragonfly_anim::format::Conversion;
use egui::{RichText, Sense, TextStyle, Ui, vec2};

pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(view) = context.view else { return };
    let (loaded, file) = (&view.loaded, &view.file);
    let theme = Theme::of(ui);
    let model = &loaded.model;
    ui.add(egui::Label::new(RichText::new(&file.title).heading()).truncate());
    // The built-in model may have been saved as a file.
    let kind = match (file.path.as_ref().or(loaded.path.as_ref()), loaded.format) {
        (Some(_), Some(format)) => format.title,
        (None, _) | (_, None) => "Built-in model",
    };
    let kind = ui.label(RichText::new(kind).color(theme.weak));
    if let Some(path) = &file.path {
        kind.on_hover_text(path.display().to_string());
    }
    widgets::caption(ui, "Animation");
    fact(ui, "Bones", &widgets::grouped(model.animation.skeleton.len()));
    fact(ui, "Takes", &widgets::grouped(context.digest.takes.len()));
    fact(ui, "Keys", &widgets::grouped(context.digest.takes.iter().map(|take| take.keys).sum()));
    // A skeleton without a mesh needs no six lines of zeros.
    if !(model.meshes.is_empty() && model.materials.is_empty() && model.images.is_empty()) {
        widgets::caption(ui, "Surface");
        fact(ui, "Meshes", &widgets::grouped(model.meshes.len()));
        fact(ui, "Vertices", &widgets::grouped(context.digest.totals.vertices));
        fact(ui, "Triangles", &widgets::grouped(context.digest.totals.triangles));
        fact(ui, "Morph targets", &widgets::grouped(context.digest.totals.morph_targets));
        fact(ui, "Materials", &widgets::grouped(model.materials.len()));
        fact(ui, "Images", &widgets::grouped(model.images.len()));
    }
    let size = loaded.bounds.max - loaded.bounds.min;
    widgets::caption(ui, "Size");
    for (axis, size) in ["X", "Y", "Z"].into_iter().zip(size.to_array()) {
        fact(ui, axis, &format!("{} m", Digits::Fitting.text(f64::from(size))));
    }
    // Formats that prescribe the units and axes of this program need no words about them.
    if loaded.conversion != Conversion::default() {
        widgets::caption(ui, "Read as");
        for part in loaded.conversion.to_string().split(", ") {
            ui.label(RichText::new(part).small().color(theme.weak));
        }
        if ui.small_button("Import options…").clicked() {
            requests.push(Request::Overlay(Some(Overlay::ImportOptions)));
        }
    }
    if !loaded.warnings.is_empty() {
        widgets::caption(ui, &widgets::count(loaded.warnings.len(), "warning", "warnings"));
        for warning in &loaded.warnings {
            ui.label(RichText::new(warning).small().color(theme.warning));
        }
    }
    if !loaded.notes.is_empty() {
        widgets::caption(ui, &widgets::count(loaded.notes.len(), "note", "notes"));
        for note in &loaded.notes {
            ui.label(RichText::new(note).small().color(theme.weak));
        }
    }
}

/// Draws a name and a value on one line.
pub(super) fn fact(ui: &mut Ui, name: &str, value: &str) {
    let theme = Theme::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 20.0), Sense::hover());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::Label, true, format!("{name}: {value}"))
    });
    widgets::text_in(ui, rect, name, &TextStyle::Body, theme.weak);
    widgets::number_at(ui, rect.right(), rect.center().y, value, theme.text);
}
