//! The dialog for exports: format, preset, content, the path, and what the file cannot contain.

use super::context::PanelContext;
use super::overlay_title;
use super::request::{FileAction, Request};
use super::style::{GRID, ROW};
use super::theme::Theme;
use super::widgets;
use dragonfly_anim::format::Format;
use dragonfly_anim::format::obj::OBJ;
use dragonfly_document::{
    DocumentMessage, ExportContent, ExportOrder, ExportReport, View, export_presets, places_textures,
    written_format, written_formats,
};
use dragonfly_fbx::TexturePlacement;
use egui::{Align, Button, ComboBox, Grid, Layout, Margin, RichText, ScrollArea, TextEdit, TextStyle, Ui};
use std::path::{Path, PathBuf};

/// Width of the dialog, points.
const WIDTH: f32 = 520.0;
/// The contents that can be chosen, with their names.
const CONTENTS: [(ExportContent, &str); 3] = [
    (ExportContent::Everything, "Model and takes"),
    (ExportContent::Model, "Model only"),
    (ExportContent::Takes, "Skeleton and takes only"),
];

/// The export that the document answered last: the order, and its result.
#[derive(Clone, Debug, PartialEq)]
pub struct AnsweredExport {
    /// The order.
    pub order: ExportOrder,
    /// The files, or the reason why there are none.
    pub done: Result<ExportReport, String>,
}

/// State of the dialog.
#[derive(Debug, Default)]
pub(super) struct ExportDialog {
    path: String,
    preset: Option<&'static str>,
    textures: TexturePlacement,
    content: ExportContent,
    /// Whether only the take that is shown is written.
    shown_take: bool,
    each: bool,
    /// Whether each frame becomes a key, or a file where a file has one pose.
    frames: bool,
    /// The order for which the losses were asked.
    asked: Option<(u64, ExportOrder)>,
}

impl ExportDialog {
    /// Draws the dialog; `fresh` where it was not shown in the frame before.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        fresh: bool,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        ui.set_width(WIDTH);
        overlay_title::show(ui, "Export", requests);
        let Some(view) = context.view else {
            ui.label(RichText::new("Open a model first").color(Theme::of(ui).weak));
            return;
        };
        if fresh {
            self.begin(view);
        }
        let field = TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY);
        let field = ui.add(field.font(TextStyle::Monospace).margin(Margin::symmetric(10, 7)));
        field.accessible_name("Path of the exported file");
        ui.add_space(GRID);
        let format = self.format();
        self.choices(ui, format, context);
        let order = self.order(context);
        if format.is_some() {
            self.ask(view, &order, requests);
        }
        self.losses(ui, format.is_some(), context, &order);
        ui.add_space(GRID);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let done = self.answer(context, &order);
            let able = done.is_some_and(Result::is_ok);
            let text = match done {
                Some(Ok(report)) if report.files.iter().any(|file| file.replaces) => "Replace",
                _ => "Export",
            };
            if ui.add_enabled(able, Button::new(text)).clicked() {
                self.asked = None;
                let order = ExportOrder { is_written: true, ..order };
                requests.push(Request::Answer(FileAction::Send(DocumentMessage::Export(order))));
            }
            if ui.button("Cancel").clicked() {
                requests.push(Request::Overlay(None));
            }
        });
    }

    /// Starts with a file next to the model, in the format that was written last.
    fn begin(&mut self, view: &View) {
        self.asked = None;
        let extension = self.format().map_or("glb", |format| format.extension());
        let own = view.file.path.as_ref().or(view.loaded.path.as_ref());
        let path = own.map_or_else(|| PathBuf::from(&view.file.title), Clone::clone);
        let mut path = path.with_extension(extension);
        // The open file is saved, not exported.
        if own == Some(&path) {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            path.set_file_name(format!("{stem} export.{extension}"));
        }
        self.path = path.display().to_string();
    }

    /// Returns the format that the path names.
    fn format(&self) -> Option<Format> {
        let extension = Path::new(self.path.trim()).extension()?.to_str()?.to_owned();
        written_format(&extension)
    }

    fn choices(&mut self, ui: &mut Ui, format: Option<Format>, context: &PanelContext<'_>) {
        Grid::new("export").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            ui.label("Format");
            self.choose_format(ui, format);
            ui.end_row();
            let presets = format.as_ref().map_or(&[][..], |format| export_presets(format));
            self.preset = self.preset.filter(|name| presets.iter().any(|preset| preset.name() == *name));
            ui.label("Preset");
            ui.add_enabled_ui(!presets.is_empty(), |ui| {
                let chosen = presets.iter().find(|preset| Some(preset.name()) == self.preset);
                let text = chosen.map_or("None", |preset| preset.title());
                let list = ComboBox::from_id_salt("preset").selected_text(text).width(220.0);
                let list = list.show_ui(ui, |ui| {
                    ui.selectable_value(&mut self.preset, None, "None");
                    for preset in presets {
                        ui.selectable_value(&mut self.preset, Some(preset.name()), preset.title())
                            .on_hover_text(preset.explanation());
                    }
                });
                list.response.accessible_name("Preset");
            });
            ui.end_row();
            ui.label("Textures");
            ui.add_enabled_ui(format.as_ref().is_some_and(places_textures), |ui| {
                let list =
                    ComboBox::from_id_salt("textures").selected_text(self.textures.title()).width(220.0);
                let list = list.show_ui(ui, |ui| {
                    for placement in TexturePlacement::ALL {
                        ui.selectable_value(&mut self.textures, placement, placement.title());
                    }
                });
                list.response.accessible_name("Textures");
            });
            ui.end_row();
            ui.label("Keys");
            ui.add_enabled_ui(self.content != ExportContent::Model, |ui| self.keys(ui, format));
            ui.end_row();
            ui.label("Content");
            let text =
                CONTENTS.iter().find(|(content, _)| *content == self.content).map_or("", |(_, text)| text);
            let list = ComboBox::from_id_salt("content").selected_text(text).width(220.0);
            let list = list.show_ui(ui, |ui| {
                for (content, text) in CONTENTS {
                    ui.selectable_value(&mut self.content, content, text);
                }
            });
            list.response.accessible_name("Content");
            ui.end_row();
            ui.label("Takes");
            ui.add_enabled_ui(self.content != ExportContent::Model, |ui| self.takes(ui, context));
            ui.end_row();
        });
    }

    fn choose_format(&mut self, ui: &mut Ui, format: Option<Format>) {
        let text = format.map_or("Not a format that is written", |format| format.title);
        let list = ComboBox::from_id_salt("format").selected_text(text).width(220.0);
        let list = list.show_ui(ui, |ui| {
            for other in written_formats() {
                if ui.selectable_label(format == Some(other), other.title).clicked() {
                    let path = Path::new(self.path.trim()).with_extension(other.extension());
                    self.path = path.display().to_string();
                }
            }
        });
        list.response.accessible_name("Format");
    }

    /// Draws the choice between keys and frames.
    fn keys(&mut self, ui: &mut Ui, format: Option<Format>) {
        let texts = match format {
            // A file has one pose.
            Some(format) if format == OBJ => ["The first pose", "A file for each frame of the first take"],
            _ => ["As they are", "One at each frame"],
        };
        let list = ComboBox::from_id_salt("keys").selected_text(texts[usize::from(self.frames)]).width(220.0);
        let list = list.show_ui(ui, |ui| {
            for (frames, text) in [false, true].into_iter().zip(texts) {
                ui.selectable_value(&mut self.frames, frames, text);
            }
        });
        list.response.accessible_name("Keys");
    }

    fn takes(&mut self, ui: &mut Ui, context: &PanelContext<'_>) {
        ui.horizontal(|ui| {
            ui.radio_value(&mut self.shown_take, false, "All");
            let name = context.shown_take().map_or("The take that is shown", |take| &take.name);
            ui.radio_value(&mut self.shown_take, true, widgets::shortened(name));
            let each = ui.checkbox(&mut self.each, "Each a file");
            widgets::hint_beside(&each, "Writes each take to a file of its own, named Model@Take");
        });
    }

    fn order(&self, context: &PanelContext<'_>) -> ExportOrder {
        let shown = context.playback.take.filter(|_| self.shown_take);
        ExportOrder {
            output: PathBuf::from(self.path.trim().trim_matches('"')),
            preset: self.preset.map(str::to_owned),
            textures: self.format().as_ref().is_some_and(places_textures).then_some(self.textures),
            content: self.content,
            takes: shown.map(|take| vec![take]),
            each: self.each && self.content != ExportContent::Model,
            bake: (self.frames && self.content != ExportContent::Model).then_some(context.frame_rate),
            is_written: false,
        }
    }

    /// Asks the document what an order would lose, once for each order and state of the model.
    fn ask(&mut self, view: &View, order: &ExportOrder, requests: &mut Vec<Request>) {
        let asked = (view.generation, order.clone());
        if self.asked.as_ref() != Some(&asked) {
            requests.push(Request::Answer(FileAction::Send(DocumentMessage::Export(order.clone()))));
            self.asked = Some(asked);
        }
    }

    /// Returns the answer to the order.
    fn answer<'a>(
        &self,
        context: &PanelContext<'a>,
        order: &ExportOrder,
    ) -> Option<&'a Result<ExportReport, String>> {
        let answered = context.export?;
        (answered.order == *order).then_some(&answered.done)
    }

    /// Lists what the files cannot contain, or why they cannot be written; `is_written` is whether the path names a format.
    fn losses(&self, ui: &mut Ui, is_written: bool, context: &PanelContext<'_>, order: &ExportOrder) {
        let theme = Theme::of(ui);
        widgets::caption(ui, "What will be lost");
        let line = |ui: &mut Ui, text: &str, color| {
            ui.label(RichText::new(text).small().color(color));
        };
        let area = ScrollArea::vertical().max_height(6.0 * ROW).min_scrolled_height(6.0 * ROW);
        area.auto_shrink([false, false]).show(ui, |ui| match self.answer(context, order) {
            None if !is_written => line(ui, "The path has no extension of a format", theme.weak),
            None => line(ui, "…", theme.weak),
            Some(Err(reason)) => line(ui, reason, theme.warning),
            Some(Ok(report)) => {
                let files = widgets::count(report.files.len(), "file", "files");
                let bytes: usize = report.files.iter().map(|file| file.bytes).sum();
                line(ui, &format!("{files}, {} KB", widgets::grouped(bytes.div_ceil(1000))), theme.text);
                for name in report.files.iter().flat_map(|file| &file.beside) {
                    line(ui, &format!("With {name} beside it"), theme.weak);
                }
                if report.lost.is_empty() {
                    line(ui, "Nothing is lost", theme.weak);
                }
                for lost in &report.lost {
                    line(ui, lost, theme.warning);
                }
            }
        });
    }
}
