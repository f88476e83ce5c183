//! The list of errors and notes below the script; a click goes to the place.

use super::text_choice::ShownText;
use crate::panels::icons::Icon;
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::script::ScriptError;
use dragonfly_document::SceneView;
use egui::accesskit::Role;
use egui::{CornerRadius, Rect, ScrollArea, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// Height of an error in the list.
const ROW: f32 = 20.0;
/// Number of errors that are visible at once.
const MOST: usize = 4;

/// A row of the list.
struct ListedError<'a> {
    error: &'a ScriptError,
    /// Name of its file; `None` for the script.
    file: Option<&'a str>,
    /// The text that a click shows; `None` for drawn lines, which are no text here.
    text: Option<ShownText>,
    is_note: bool,
}

/// Returns the height of the list in a panel of a height, points.
pub(super) fn height(scene: &SceneView, panel: f32) -> f32 {
    let rows = all(scene).count().min(MOST) as f32;
    if rows == 0.0 { 0.0 } else { (rows * ROW + 6.0).min(panel * 0.5) }
}

/// Returns the errors of the script, then those of the project and of its lines with the names of their files, then the notes.
fn all(scene: &SceneView) -> impl Iterator<Item = ListedError<'_>> {
    let project = scene.texts.list().first().map(|file| &*file.name);
    let lines = scene.project.as_ref().and_then(|project| project.lines()).or(Some(""));
    let (script, of_project) = (Some(ShownText::Script), Some(ShownText::Project));
    listed(&scene.errors, None, script, false)
        .chain(listed(&scene.project_errors, project, of_project, false))
        .chain(listed(&scene.shared_errors, project, of_project, false))
        .chain(listed(&scene.line_errors, lines, None, false))
        .chain(listed(&scene.project_notes, project, of_project, true))
        .chain(listed(&scene.notes, None, script, true))
}

fn listed<'a>(
    list: &'a [ScriptError],
    file: Option<&'a str>,
    text: Option<ShownText>,
    is_note: bool,
) -> impl Iterator<Item = ListedError<'a>> {
    list.iter().map(move |error| ListedError { error, file, text, is_note })
}

/// Draws the list. Returns the text and the byte of the row that was clicked.
pub(super) fn show(ui: &mut Ui, rect: Rect, scene: &SceneView) -> Option<(ShownText, usize)> {
    let rows: Vec<ListedError<'_>> = all(scene).collect();
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
        for ListedError { error, file, text: shown, is_note } in &rows[range] {
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
            let place =
                Rect::from_min_max(pos2(row.left() + 28.0, row.top()), pos2(row.right() - 8.0, row.bottom()));
            widgets::text_in(ui, place, &text, &TextStyle::Small, theme.text);
            if response.clicked()
                && let Some(shown) = shown
            {
                clicked = Some((*shown, error.range.start));
            }
            response.on_hover_text(widgets::shortened(&text));
        }
    });
    clicked
}
