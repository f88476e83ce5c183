//! The numbers of the lines, the marks of errors, and the background of what is selected.

use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_anim::stage::script::ScriptError;
use egui::accesskit::Role;
use egui::text::CCursor;
use egui::text_edit::TextEditOutput;
use egui::{Align, Align2, CornerRadius, FontId, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use std::ops::Range;

use super::coloring::SIZE;
use super::lines::{characters_before, line_of};

/// The editor in one frame, as the margin reads it.
pub(super) struct MarginSheet<'a> {
    pub(super) text: &'a str,
    /// The errors of this text.
    pub(super) errors: &'a [&'a ScriptError],
    pub(super) output: &'a TextEditOutput,
    /// Width of the margin.
    pub(super) width: f32,
    /// The lines of what is selected, from 0.
    pub(super) lines: Option<Range<usize>>,
}

/// Returns the width of the numbers of all lines of a text.
pub(super) fn width(ui: &Ui, text: &str) -> f32 {
    let lines = text.bytes().filter(|&byte| byte == b'\n').count() + 1;
    let digits = lines.to_string().len().max(2);
    let font = FontId::monospace(SIZE - 1.5);
    let digit = ui.painter().layout_no_wrap("0".to_owned(), font, Theme::of(ui).weak).size().x;
    digit * digits as f32 + 22.0
}

/// Draws the background of the selected lines under the text.
pub(super) fn background(ui: &Ui, place: egui::layers::ShapeIdx, sheet: &MarginSheet<'_>) {
    let Some(lines) = &sheet.lines else { return };
    let rows = &sheet.output.galley.rows;
    let Some((first, last)) =
        rows.get(lines.start).zip(rows.get(lines.end.saturating_sub(1)).or(rows.last()))
    else {
        return;
    };
    let top = sheet.output.galley_pos.y;
    let rect = Rect::from_min_max(
        pos2(ui.clip_rect().left(), top + first.min_y()),
        pos2(ui.clip_rect().right(), top + last.max_y()),
    );
    ui.painter().set(
        place,
        Shape::rect_filled(rect, CornerRadius::ZERO, Theme::of(ui).accent_soft.gamma_multiply(0.5)),
    );
}

/// Draws the numbers of the visible lines and the errors in them.
pub(super) fn show(ui: &Ui, sheet: &MarginSheet<'_>) {
    let theme = Theme::of(ui);
    let clip = ui.clip_rect();
    // The margin stays where it is while the text scrolls sideways.
    let area = Rect::from_min_max(clip.left_top(), pos2(clip.left() + sheet.width - 4.0, clip.bottom()));
    let painter = ui.painter().clone();
    painter.rect_filled(area, CornerRadius::ZERO, theme.sunken);
    painter.vline(area.right(), area.y_range(), Stroke::new(1.0, theme.line.gamma_multiply(0.7)));
    let top = sheet.output.galley_pos.y;
    let cursor = sheet.output.cursor_range.map(|range| range.primary);
    let cursor_line = cursor.map(|cursor| sheet.output.galley.pos_from_cursor(cursor).center().y + top);
    let font = FontId::monospace(SIZE - 1.5);
    let rows = &sheet.output.galley.rows;
    let first = rows.partition_point(|row| top + row.max_y() < clip.top());
    for (index, row) in rows.iter().enumerate().skip(first) {
        let (from, to) = (top + row.min_y(), top + row.max_y());
        if from > clip.bottom() {
            break;
        }
        let is_here = cursor_line.is_some_and(|y| (from..to).contains(&y));
        let color = if is_here { theme.text } else { theme.faint };
        let at = pos2(area.right() - 6.0, (from + to) / 2.0);
        painter.text(at, Align2::RIGHT_CENTER, (index + 1).to_string(), font.clone(), color);
    }
    for error in sheet.errors.iter().take(50) {
        mark(ui, sheet, error, area);
    }
}

/// Draws an error: a dot in the margin with its text, and a line under what is wrong.
fn mark(ui: &Ui, sheet: &MarginSheet<'_>, error: &ScriptError, area: Rect) {
    let theme = Theme::of(ui);
    let line = (error.place.line as usize).saturating_sub(1);
    let Some(row) = sheet.output.galley.rows.get(line) else { return };
    let top = sheet.output.galley_pos.y;
    let (from, to) = (top + row.min_y(), top + row.max_y());
    if to < ui.clip_rect().top() || from > ui.clip_rect().bottom() {
        return;
    }
    let dot = pos2(area.left() + 8.0, (from + to) / 2.0);
    ui.painter().circle_filled(dot, 3.5, theme.error);
    let place = Rect::from_center_size(dot, vec2(14.0, to - from));
    let response = ui.interact(place, ui.scope_id().with(("error", error.range.start, line)), Sense::hover());
    let name = format!("Error in line {}", line + 1);
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    response.on_hover_text(widgets::shortened(&error.text()));
    let corner = |at: usize| {
        let cursor = CCursor::new(characters_before(sheet.text, at));
        sheet.output.galley.pos_from_cursor(cursor).translate(sheet.output.galley_pos.to_vec2())
    };
    let start = corner(error.range.start);
    let end = corner(error.range.end.max(error.range.start + 1).min(sheet.text.len()));
    let right = if (end.top() - start.top()).abs() < 1.0 { end.left() } else { start.left() + 60.0 };
    let y = start.bottom() - 1.0;
    let left = start.left().max(area.right());
    if right > left {
        let steps = ((right - left) / 3.0).ceil().clamp(1.0, 200.0) as usize;
        let wave = (0..=steps).map(|step| {
            let x = (left + step as f32 * 3.0).min(right);
            pos2(x, y + if step % 2 == 0 { 0.0 } else { 2.0 })
        });
        ui.painter().add(Shape::line(wave.collect(), Stroke::new(1.0, theme.error)));
    }
}

/// Scrolls to a range of the text, unless its start is visible.
pub(super) fn scroll_to(ui: &Ui, sheet: &MarginSheet<'_>, range: &Range<usize>) {
    let line = line_of(sheet.text, range.start);
    let Some(row) = sheet.output.galley.rows.get(line) else { return };
    let top = sheet.output.galley_pos.y;
    let rect = Rect::from_min_max(
        pos2(ui.clip_rect().left(), top + row.min_y()),
        pos2(ui.clip_rect().left() + 1.0, top + row.max_y()),
    );
    if !ui.clip_rect().y_range().contains(rect.top()) || !ui.clip_rect().y_range().contains(rect.bottom()) {
        ui.scroll_to_rect(rect, Some(Align::Center));
    }
}

/// Scrolls sideways, as little as is needed, until the caret is next to the line numbers, which cover `width` points of the text.
pub(super) fn show_caret(ui: &Ui, caret: Rect, width: f32) {
    let clip = ui.clip_rect();
    // At the start of a line, the line is shown from its start.
    if caret.left() - width < clip.left() || caret.right() > clip.right() {
        ui.scroll_to_rect(
            caret.with_min_x(caret.left() - width - 12.0).with_max_x(caret.right() + 24.0),
            None,
        );
    }
}
