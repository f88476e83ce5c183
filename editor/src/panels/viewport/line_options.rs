//! The options of the tool that draws lines, paths and poses, in a bar at the top of the viewport: on what it draws, in which color, its keys.

use super::glass::{divider, glass};
use crate::control::line::{LineSurface, LineUse};
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::request::Request;
use crate::panels::scene::{LINE_COLORS, LineColor, LineRequest, SceneRequest};
use crate::panels::style::{self, GRID};
use crate::panels::theme::Theme;
use crate::panels::widgets::focus_ring;
use egui::accesskit::Role;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Color32, FontId, Layout, Pos2, Rect, RichText, Sense, Stroke, Ui, UiBuilder, WidgetInfo, vec2,
};

/// Heights of the row of options and of the keys below it, points.
const ROW: f32 = 24.0;
const KEYS: f32 = 16.0;
/// Widths of the row of options for lines, and of the row without options, points.
const OF_LINES: f32 = 364.0;
const OF_PATHS: f32 = 160.0;
/// Least width of the bar; a narrower viewport has none, points.
const LEAST: f32 = 160.0;

/// Surfaces that lines are drawn on, with the commands that choose them.
const SURFACES: [(Icon, Id, LineSurface); 4] = [
    (Icon::Grid, Id::LinesOnGround, LineSurface::Ground),
    (Icon::View, Id::LinesInView, LineSurface::View),
    (Icon::Surface, Id::LinesOnSurface, LineSurface::Surface),
    (Icon::Bone, Id::LinesOnBone, LineSurface::Bone),
];

/// Draws the bar with its top left at `place`, while the tool is used. Returns its area.
pub(super) fn show(
    ui: &mut Ui,
    rect: Rect,
    place: Pos2,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> Option<Rect> {
    let use_of = context.tools.controls().line().use_of()?;
    let (title, row) = match use_of {
        LineUse::Note => ("Line", OF_LINES),
        LineUse::Path => ("Path on the ground", OF_PATHS),
        LineUse::Pose => ("Pose line", OF_PATHS),
        LineUse::Motion => ("Motion path", OF_PATHS),
    };
    let keys = keys(context, use_of);
    let room = rect.right() - place.x - 10.0;
    if room < LEAST {
        return None;
    }
    let theme = Theme::of(ui);
    let mut job =
        LayoutJob::simple_singleline(keys.to_owned(), FontId::proportional(style::SMALL), theme.weak);
    job.wrap = TextWrapping::truncate_at_width(room - 4.0 * GRID);
    let hint = ui.painter().layout_job(job);
    let width = (row.max(hint.size().x) + 4.0 * GRID).min(room);
    let at = Rect::from_min_size(place, vec2(width, ROW + KEYS + 3.0 * GRID));
    glass(ui, at);
    let below = at.min + vec2(2.0 * GRID, ROW + 2.0 * GRID);
    let keys_place = Rect::from_min_size(below, hint.size());
    ui.painter().galley(below, hint, theme.weak);
    let response = ui.interact(keys_place, ui.scope_id().with("keys of lines"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, keys));
    let inside = Rect::from_min_size(at.min + vec2(2.0 * GRID, GRID), vec2(at.width() - 4.0 * GRID, ROW));
    let layout = Layout::left_to_right(Align::Center);
    let mut ui = ui.new_child(UiBuilder::new().max_rect(inside).layout(layout).id_salt("options of lines"));
    ui.set_clip_rect(ui.clip_rect().intersect(at));
    ui.spacing_mut().item_spacing.x = 2.0;
    ui.label(RichText::new(title).color(theme.text));
    if row == OF_LINES {
        options(&mut ui, context, requests);
    }
    Some(at)
}

/// Draws the options of lines of a project.
fn options(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    divider(ui);
    for (icon, id, surface) in SURFACES {
        command_button(ui, icon, id, context.tools.controls().line().note_surface() == surface, requests);
    }
    divider(ui);
    for color in LINE_COLORS {
        swatch(ui, color, context.settings.tools.line_color == color.rgb, requests);
    }
    divider(ui);
    command_button(
        ui,
        Icon::Clock,
        Id::ToggleLinesFrom,
        context.settings.tools.lines_from_playhead,
        requests,
    );
}

/// Draws a button that chooses the color of new lines.
fn swatch(ui: &mut Ui, color: LineColor, on: bool, requests: &mut Vec<Request>) {
    let (rect, response) = ui.allocate_exact_size(vec2(20.0, ROW), Sense::click());
    let name = format!("New lines: {}", color.title);
    response.widget_info(|| WidgetInfo::selected(Role::Button, ui.is_enabled(), on, &name));
    let [red, green, blue] = color.rgb;
    ui.painter().circle_filled(rect.center(), 6.0, Color32::from_rgb(red, green, blue));
    if on || response.hovered() {
        let theme = Theme::of(ui);
        let edge = if on { theme.text } else { theme.faint };
        ui.painter().circle_stroke(rect.center(), 8.5, Stroke::new(1.5, edge));
    }
    focus_ring(ui, &response, rect);
    if response.clicked() {
        requests.push(Request::Scene(SceneRequest::Line(LineRequest::NewColor(color.rgb))));
    }
    response.on_hover_text(name);
}

/// Returns what mouse and keys do now.
fn keys(context: &PanelContext<'_>, use_of: LineUse) -> &'static str {
    if context.tools.controls().is_modal() {
        return "Click: next corner. Double-click or Enter ends the line, Backspace takes a corner back, Esc cancels";
    }
    match use_of {
        LineUse::Note => "Drag: freehand, with Shift straight. Click: corners. Ctrl + drag erases. Esc ends",
        LineUse::Path => "Drag: freehand, with Shift straight. Click: corners. Esc ends",
        LineUse::Pose => "Draw the line of action. With Alt: motion path. Click: corners. Esc cancels",
        LineUse::Motion => "Draw the path of the bone over time. Click: corners. Esc cancels",
    }
}
