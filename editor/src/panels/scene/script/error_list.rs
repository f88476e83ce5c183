//! The list of errors and notes below the script; a click goes to the place, and a button finds a file that is missing.

use super::text_choice::ShownText;
use crate::panels::icons::Icon;
use crate::panels::scene::{SceneSound, SceneSounds};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::script::{ScriptElement, ScriptError};
use dragonfly_document::{MissingFile, SceneModel, SceneView};
use egui::accesskit::Role;
use egui::{CornerRadius, Rect, ScrollArea, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};
use std::borrow::Cow;

/// Height of an error in the list.
const ROW: f32 = 20.0;
/// Number of errors that are visible at once.
const MOST: usize = 4;

/// Width of the button that finds a missing file, points.
const FIND: f32 = 48.0;

/// A click on the list.
pub(super) enum ListClick {
    /// The text that is shown, and the byte of the place.
    Place(ShownText, usize),
    /// A missing file is to be found.
    Find(MissingFile),
}

/// A row of the list.
struct ListedError<'a> {
    error: Cow<'a, ScriptError>,
    /// Name of its file; `None` for the script.
    file: Option<&'a str>,
    /// The text that a click shows; `None` for drawn lines, which are no text here.
    text: Option<ShownText>,
    is_note: bool,
    /// The file that is missing, which the row is about.
    missing: Option<MissingFile>,
}

/// Returns the height of the list in a panel of a height, points.
pub(super) fn height(scene: &SceneView, sounds: &SceneSounds, panel: f32) -> f32 {
    let rows = all(scene, sounds).count().min(MOST) as f32;
    if rows == 0.0 { 0.0 } else { (rows * ROW + 6.0).min(panel * 0.5) }
}

/// Returns the errors of the script, then those of the project and of its lines with the names of their files, then the notes.
fn all<'a>(scene: &'a SceneView, sounds: &'a SceneSounds) -> impl Iterator<Item = ListedError<'a>> {
    let project = scene.texts.list().first().map(|file| &*file.name);
    let lines = scene.project.as_ref().and_then(|project| project.lines()).or(Some(""));
    let (script, of_project) = (Some(ShownText::Script), Some(ShownText::Project));
    listed(&scene.errors, None, script, false)
        .chain(listed(&scene.project_errors, project, of_project, false))
        .chain(listed(&scene.shared_errors, project, of_project, false))
        .chain(listed(&scene.line_errors, lines, None, false))
        .chain(listed(&scene.project_notes, project, of_project, true))
        .chain(listed(&scene.notes, None, script, true))
        .chain(missing_sounds(scene, sounds))
}

/// Returns the model that a note is about, if it is missing.
fn missing_model(scene: &SceneView, row: &ListedError<'_>) -> Option<MissingFile> {
    let script = scene.script.as_ref().filter(|_| row.is_note)?;
    let project = scene.project.as_ref().map(|project| project.tree());
    let tree = if row.text == Some(ShownText::Project) { project? } else { script.tree() };
    let is_meant = |element: &&ScriptElement| {
        element.attribute("model").is_some_and(|attribute| attribute.value_range == row.error.range)
    };
    let name = tree.elements().iter().find(is_meant)?.value("model")?;
    matches!(scene.models.get(name)?, SceneModel::Missing(_)).then(|| scene.missing_model(name))
}

/// Returns a row for each sound of the script that is missing.
fn missing_sounds<'a>(
    scene: &'a SceneView,
    sounds: &'a SceneSounds,
) -> impl Iterator<Item = ListedError<'a>> {
    let row = |missing: MissingFile| {
        let tree = scene.script.as_ref()?.tree();
        let is_meant = |element: &&ScriptElement| {
            element.row.name == "sound" && element.value("src") == Some(&*missing.name)
        };
        let element = tree.elements().iter().find(is_meant)?;
        let Some(SceneSound::Problem(reason)) = sounds.get(&missing.name) else { return None };
        let error = tree.error(element.value_range("src"), reason.to_string(), "");
        let text = Some(ShownText::Script);
        Some(ListedError {
            error: Cow::Owned(error),
            file: None,
            text,
            is_note: true,
            missing: Some(missing),
        })
    };
    sounds.missing().filter_map(row)
}

fn listed<'a>(
    list: &'a [ScriptError],
    file: Option<&'a str>,
    text: Option<ShownText>,
    is_note: bool,
) -> impl Iterator<Item = ListedError<'a>> {
    list.iter().map(move |error| {
        let error = Cow::Borrowed(error);
        ListedError { error, file, text, is_note, missing: None }
    })
}

/// Draws the list. Returns what was clicked.
pub(super) fn show(ui: &mut Ui, rect: Rect, scene: &SceneView, sounds: &SceneSounds) -> Option<ListClick> {
    let rows: Vec<ListedError<'_>> = all(scene, sounds).collect();
    if rows.is_empty() {
        return None;
    }
    let theme = Theme::of(ui);
    ui.painter().rect_filled(rect, CornerRadius::ZERO, theme.bar);
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, theme.line));
    let mut clicked = None;
    let mut list = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink2(vec2(0.0, 3.0))));
    list.set_clip_rect(rect.intersect(ui.clip_rect()));
    list.spacing_mut().item_spacing.y = 0.0;
    let area = ScrollArea::vertical().auto_shrink(false).id_salt("errors");
    area.show_rows(&mut list, ROW, rows.len(), |ui, range| {
        for listed in &rows[range] {
            let ListedError { error, file, text: shown, is_note, missing } = listed;
            let missing = missing.clone().or_else(|| missing_model(scene, listed));
            let (row, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
            let text = match file {
                None => format!("{}: {}", error.place, error.text()),
                Some(file) => format!("{file}, {}: {}", error.place, error.text()),
            };
            let (kind, icon, color) = match *is_note {
                true => ("Note", Icon::Warning, theme.warning),
                false => ("Error", Icon::Error, theme.error),
            };
            response.widget_info(|| WidgetInfo::labeled(Role::ListItem, true, format!("{kind} at {text}")));
            if response.hovered() {
                ui.painter().rect_filled(row, CornerRadius::ZERO, theme.hover);
            }
            let mark = Rect::from_center_size(pos2(row.left() + 14.0, row.center().y), vec2(16.0, 16.0));
            icon.paint(ui.painter(), mark, color);
            let right = if missing.is_some() { row.right() - 8.0 - FIND } else { row.right() - 8.0 };
            let place = Rect::from_min_max(pos2(row.left() + 28.0, row.top()), pos2(right, row.bottom()));
            widgets::text_in(ui, place, &text, &TextStyle::Small, theme.text);
            if response.clicked()
                && let Some(shown) = shown
            {
                clicked = Some(ListClick::Place(*shown, error.range.start));
            }
            if let Some(missing) = missing {
                let place = Rect::from_min_max(pos2(right, row.top()), pos2(right + FIND, row.bottom()));
                let button = ui.interact(place, response.id.with("find"), Sense::click());
                let label = format!("Find {}", missing.file);
                button.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
                let color = if button.hovered() { theme.text } else { theme.accent };
                widgets::text_in(ui, place.shrink2(vec2(4.0, 0.0)), "Find…", &TextStyle::Small, color);
                widgets::focus_ring(ui, &button, place);
                if button.clicked() {
                    clicked = Some(ListClick::Find(missing));
                }
            }
            response.on_hover_text(widgets::shortened(&text));
        }
    });
    clicked
}
