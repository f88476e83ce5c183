//! The list of errors below the script; a click goes to the place.

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

/// Returns the height of the list in a panel of a height, points.
pub(super) fn height(scene: &SceneView, panel: f32) -> f32 {
    let rows = all(scene).count().min(MOST) as f32;
    if rows == 0.0 { 0.0 } else { (rows * ROW + 6.0).min(panel * 0.5) }
}

/// Returns the errors of the script, then those of the project and of its lines with the names of their files.
fn all(scene: &SceneView) -> impl Iterator<Item = (Option<&str>, &ScriptError)> {
    let own = scene.errors.iter().map(|error| (None, error));
    let project = scene.texts.list().first().map_or("", |file| &*file.name);
    let of_project = scene.project_errors.iter().chain(&*scene.shared_errors);
    let of_project = of_project.map(move |error| (Some(project), error));
    let lines = scene.project.as_ref().and_then(|project| project.lines()).unwrap_or_default();
    let of_lines = scene.line_errors.iter().map(move |error| (Some(lines), error));
    own.chain(of_project).chain(of_lines)
}

/// Draws the list. Returns the byte of the error of the script that was clicked.
pub(super) fn show(ui: &mut Ui, rect: Rect, scene: &SceneView) -> Option<usize> {
    let count = all(scene).count();
    if count == 0 {
        return None;
    }
    let theme = Theme::of(ui);
    ui.painter().rect_filled(rect, CornerRadius::ZERO, theme.bar);
    ui.painter().hline(rect.x_range(), rect.top(), Stroke::new(1.0, theme.line));
    let mut clicked = None;
    let mut list = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink2(vec2(0.0, 3.0))));
    list.set_clip_rect(rect.intersect(ui.clip_rect()));
    list.spacing_mut().item_spacing.y = 0.0;
    ScrollArea::vertical().auto_shrink(false).id_salt("errors").show_rows(
        &mut list,
        ROW,
        count,
        |ui, range| {
            for (file, error) in all(scene).skip(range.start).take(range.len()) {
                let (row, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW), Sense::click());
                let text = match file {
                    None => format!("{}: {}", error.place, error.text()),
                    Some(file) => format!("{file}, {}: {}", error.place, error.text()),
                };
                response
                    .widget_info(|| WidgetInfo::labeled(Role::ListItem, true, format!("Error at {text}")));
                if response.hovered() {
                    ui.painter().rect_filled(row, CornerRadius::ZERO, theme.hover);
                }
                let mark = Rect::from_center_size(pos2(row.left() + 14.0, row.center().y), vec2(16.0, 16.0));
                Icon::Error.paint(ui.painter(), mark, theme.error);
                let place = Rect::from_min_max(
                    pos2(row.left() + 28.0, row.top()),
                    pos2(row.right() - 8.0, row.bottom()),
                );
                widgets::text_in(ui, place, &text, &TextStyle::Small, theme.text);
                if response.clicked() && file.is_none() {
                    clicked = Some(error.range.start);
                }
                response.on_hover_text(widgets::shortened(&text));
            }
        },
    );
    clicked
}
