//! Small widgets that several panels share.

pub(super) use super::count_text::{count, grouped};
use super::icons::Icon;
use super::style::{self, GRID, RADIUS, ROW};
use super::theme::Theme;
use egui::accesskit::Role;
use egui::text::{CCursor, CCursorRange};
use egui::{
    Align2, Color32, Context, CornerRadius, FontId, Id as WidgetId, Rect, RectAlign, Response, RichText,
    Sense, TextEdit, TextStyle, Tooltip, Ui, WidgetInfo, WidgetText, pos2, vec2,
};
use std::ops::Range;

/// Shows a tooltip on the right of a widget.
pub(super) fn hint_beside(response: &Response, hint: impl Into<WidgetText>) {
    let mut tooltip = Tooltip::for_enabled(response);
    tooltip.popup = tooltip.popup.align(RectAlign::RIGHT);
    tooltip.show(|ui| ui.label(hint));
}

/// Shows a tooltip on the right of a disabled widget.
pub(super) fn disabled_hint_beside(response: &Response, hint: impl Into<WidgetText>) {
    let mut tooltip = Tooltip::for_disabled(response);
    tooltip.popup = tooltip.popup.align(RectAlign::RIGHT);
    tooltip.show(|ui| ui.label(hint));
}

/// Draws a square button with an icon; `name` is its accessible name.
pub(super) fn icon_button(ui: &mut Ui, icon: Icon, name: &str, on: bool) -> Response {
    let theme = Theme::of(ui);
    colored_icon_button(ui, icon, name, on, [theme.accent_soft, theme.accent])
}

/// Draws a square button of something dangerous while it is on, in red then; `name` is its accessible name.
pub(super) fn wary_icon_button(ui: &mut Ui, icon: Icon, name: &str, on: bool) -> Response {
    let theme = Theme::of(ui);
    colored_icon_button(ui, icon, name, on, [theme.error.gamma_multiply(0.22), theme.error])
}

/// Draws a square button with an icon, in these colors of background and icon while it is on.
fn colored_icon_button(ui: &mut Ui, icon: Icon, name: &str, on: bool, lit: [Color32; 2]) -> Response {
    let (rect, response) = ui.allocate_exact_size(style::icon_size(), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), on, name));
    if ui.is_rect_visible(rect) {
        let theme = Theme::of(ui);
        let (fill, color) = if response.is_pointer_button_down_on() {
            (theme.pressed, theme.text)
        } else if on {
            (lit[0], lit[1])
        } else if response.hovered() {
            (theme.hover, theme.text)
        } else {
            (Color32::TRANSPARENT, theme.weak)
        };
        let color = if ui.is_enabled() { color } else { color.gamma_multiply(0.4) };
        ui.painter().rect_filled(rect, CornerRadius::same(RADIUS), fill);
        icon.paint(ui.painter(), rect, color);
        focus_ring(ui, &response, rect);
    }
    response
}

/// Selects all of `text` in the text field `id`, so that typing replaces it.
pub(super) fn select_all(context: &Context, id: WidgetId, text: &str) {
    select_characters(context, id, 0..text.chars().count());
}

/// Selects a range of characters in the text field `id`, so that typing replaces them.
pub(super) fn select_characters(context: &Context, id: WidgetId, range: Range<usize>) {
    let mut state = TextEdit::load_state(context, id).unwrap_or_default();
    let [start, end] = [range.start, range.end].map(CCursor::new);
    state.cursor.set_char_range(Some(CCursorRange::two(start, end)));
    state.store(context, id);
}

/// Draws the keyboard focus.
pub(super) fn focus_ring(ui: &Ui, response: &Response, rect: Rect) {
    if response.has_focus() {
        let stroke = egui::Stroke::new(1.0, Theme::of(ui).accent);
        ui.painter().rect_stroke(rect, CornerRadius::same(RADIUS), stroke, egui::StrokeKind::Inside);
    }
}

/// Allocates a row of a list over the whole width and draws its background; the caller draws the rest.
///
/// Returns its area and the response; `name` is its accessible name.
pub(super) fn row(ui: &mut Ui, name: &str, selected: bool, hovered: bool) -> (Rect, Response) {
    let width = ui.available_width();
    let (rect, response) = ui.allocate_exact_size(vec2(width, ROW), Sense::click());
    response.widget_info(|| WidgetInfo::selected(Role::ListItem, ui.is_enabled(), selected, name));
    if ui.is_rect_visible(rect) {
        let theme = Theme::of(ui);
        let inside = rect.shrink2(vec2(GRID, 1.0));
        let fill = if selected {
            theme.accent_soft
        } else if hovered || response.hovered() {
            theme.hover
        } else {
            Color32::TRANSPARENT
        };
        ui.painter().rect_filled(inside, CornerRadius::same(RADIUS), fill);
        focus_ring(ui, &response, inside);
    }
    (rect, response)
}

/// Draws text in the middle of the height of `rect`, truncated at its right end. Returns the right end of the text.
pub(super) fn text_in(ui: &Ui, rect: Rect, text: &str, style: &TextStyle, color: Color32) -> f32 {
    let font = style.resolve(ui.style());
    let mut job = egui::text::LayoutJob::simple_singleline(text.to_owned(), font, color);
    job.wrap = egui::text::TextWrapping::truncate_at_width(rect.width().max(0.0));
    let galley = ui.painter().layout_job(job);
    let at = pos2(rect.left(), rect.center().y - galley.size().y / 2.0);
    let right = at.x + galley.size().x;
    ui.painter().galley(at, galley, color);
    right
}

/// Returns a text that is at most as wide as `width`: without its middle if it is wider, because names often differ at
/// both ends.
pub(super) fn cut_in_middle(ui: &Ui, text: &str, width: f32, style: &TextStyle) -> String {
    if text_width(ui, text, style) <= width {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let cut = |kept: usize| {
        let (first, last) = (kept.div_ceil(2), kept / 2);
        let start: String = letters[..first].iter().collect();
        let end: String = letters[letters.len() - last..].iter().collect();
        format!("{start}…{end}")
    };
    // The widest that fits, by bisection: it is wider with each letter.
    let (mut fits, mut too_many) = (0, letters.len());
    while too_many - fits > 1 {
        let middle = fits.midpoint(too_many);
        if text_width(ui, &cut(middle), style) <= width { fits = middle } else { too_many = middle }
    }
    cut(fits)
}

/// Returns the width of a text, points.
pub(super) fn text_width(ui: &Ui, text: &str, style: &TextStyle) -> f32 {
    let font = style.resolve(ui.style());
    ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER).size().x
}

/// Draws a number right-aligned at `right`, in digits of equal width. Returns its left end.
pub(super) fn number_at(ui: &Ui, right: f32, y: f32, text: &str, color: Color32) -> f32 {
    let rect = ui.painter().text(
        pos2(right, y),
        Align2::RIGHT_CENTER,
        text,
        FontId::monospace(style::NUMBER),
        color,
    );
    rect.left()
}

/// Draws a caption above a group of properties.
pub(super) fn caption(ui: &mut Ui, text: &str) {
    ui.add_space(GRID);
    ui.label(RichText::new(text).small().color(Theme::of(ui).weak));
}

/// Draws a sentence where there is nothing to show.
pub(super) fn empty(ui: &mut Ui, title: &str, hint: &str) {
    let theme = Theme::of(ui);
    ui.add_space((ui.available_height() * 0.3).min(72.0));
    ui.vertical_centered(|ui| {
        if !title.is_empty() {
            ui.label(RichText::new(title).color(theme.weak));
        }
        if !hint.is_empty() {
            ui.label(RichText::new(hint).small().color(theme.faint));
        }
    });
}

/// Joins facts on one line with dots.
pub(super) fn dot_separated(parts: &[String]) -> String {
    parts.join("  ·  ")
}

/// Shortens a text so that it fits into a tooltip or a menu.
pub(super) fn shortened(text: &str) -> String {
    const LONGEST: usize = 200;
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Draws a small button that opens a menu: the current choice, cut in the middle where there is no room, and an arrow.
pub(super) fn choice_button(ui: &mut Ui, text: &str) -> Response {
    let shown = cut_in_middle(ui, text, ui.available_width() - 24.0, &TextStyle::Small);
    quiet_button(ui, Icon::Down, false, &shown, text)
}

/// Draws a quiet button: a small icon before or after a small text. `name` is its accessible name.
pub(super) fn quiet_button(ui: &mut Ui, icon: Icon, before: bool, text: &str, name: &str) -> Response {
    let font = TextStyle::Small.resolve(ui.style());
    let theme = Theme::of(ui);
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::PLACEHOLDER);
    let (rect, response) = ui.allocate_exact_size(vec2(galley.size().x + 24.0, 20.0), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), name));
    let color = if response.hovered() { theme.text } else { theme.weak };
    let (mark, left) = if before { (rect.left() + 5.0, 16.0) } else { (rect.right() - 10.0, 6.0) };
    let mark = Rect::from_center_size(pos2(mark, rect.center().y), vec2(16.0, 16.0));
    icon.paint(ui.painter(), mark, color);
    let at = pos2(rect.left() + left, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, color);
    focus_ring(ui, &response, rect);
    response
}
