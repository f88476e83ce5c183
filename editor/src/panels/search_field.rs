//! A search field: a magnifying glass, the text, and a button that clears the text.

use super::icons::Icon;
use super::style::GRID;
use super::theme::Theme;
use egui::accesskit::Role;
use egui::{Key, Margin, Rect, Sense, TextEdit, Ui, WidgetInfo, pos2, vec2};

/// Draws the field over the whole width, with `name` as hint and accessible name. Returns whether Enter was pressed
/// in it.
pub(super) fn show(ui: &mut Ui, query: &mut String, name: &str, focus: bool) -> bool {
    let theme = Theme::of(ui);
    ui.add_space(GRID);
    let mut entered = false;
    ui.horizontal(|ui| {
        ui.add_space(2.0 * GRID);
        let width = ui.available_width() - 2.0 * GRID;
        let field = TextEdit::singleline(query).hint_text(name).desired_width(width).margin(Margin {
            left: 26,
            right: 24,
            top: 4,
            bottom: 4,
        });
        let response = ui.add(field).accessible_name(name);
        let rect = response.rect;
        let lens = Rect::from_center_size(pos2(rect.left() + 13.0, rect.center().y), vec2(16.0, 16.0));
        Icon::Search.paint(ui.painter(), lens, theme.faint);
        if focus {
            response.request_focus();
        }
        entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        if !query.is_empty() {
            let cross = Rect::from_center_size(pos2(rect.right() - 13.0, rect.center().y), vec2(20.0, 20.0));
            let clear = ui.interact(cross, response.id.with("clear"), Sense::click());
            clear.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Clear search"));
            let color = if clear.hovered() { theme.text } else { theme.weak };
            Icon::Close.paint(ui.painter(), cross, color);
            if clear.clicked() {
                query.clear();
            }
        }
    });
    ui.add_space(GRID);
    entered
}
