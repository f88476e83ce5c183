//! The axes of the scene in the corner of the viewport.

use crate::control;
use crate::panels::commands::{self, Id};
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use egui::accesskit::Role;
use egui::{Align2, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use glam::{Vec2, Vec3};

/// Draws the axes of the scene as seen from the camera. Dragging them orbits; a click on an end looks from there.
/// Returns their area.
pub(super) fn axes(
    ui: &mut Ui,
    rect: Rect,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> Option<Rect> {
    let radius = 30.0;
    let center = pos2(rect.left() + radius + 18.0, rect.bottom() - radius - 18.0);
    if rect.height() < 200.0 || rect.width() < 200.0 {
        return None;
    }
    let theme = Theme::of(ui);
    let area = Rect::from_center_size(center, egui::Vec2::splat(2.0 * radius + 16.0));
    let response = ui.interact(area, ui.scope_id().with("axes"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, "Axes: drag to orbit"));
    if response.hovered() || response.dragged() {
        ui.painter().circle_filled(center, radius + 8.0, theme.glass.gamma_multiply(0.6));
    }
    let camera = &context.camera;
    let place = |axis: Vec3| {
        let (right, up) = (axis.dot(camera.right()), axis.dot(camera.up()));
        center + vec2(right, -up) * radius * 0.86
    };
    let mut ends: Vec<(f32, egui::Pos2, egui::Color32, &str, Id)> = Vec::with_capacity(6);
    for (axis, color, name, towards, away) in [
        (Vec3::X, theme.axes[0], "X", Id::ViewRight, Id::ViewLeft),
        (Vec3::Y, theme.axes[1], "Y", Id::ViewTop, Id::ViewBottom),
        (Vec3::Z, theme.axes[2], "Z", Id::ViewFront, Id::ViewBack),
    ] {
        ends.push((axis.dot(camera.back()), place(axis), color, name, towards));
        ends.push((-axis.dot(camera.back()), place(-axis), color, "", away));
    }
    // Nearer ends are drawn later.
    ends.sort_by(|one, other| one.0.total_cmp(&other.0));
    let pointer = response.hover_pos();
    let mut under = None;
    for &(depth, at, color, name, id) in &ends {
        let tone = if depth < -0.05 { color.gamma_multiply(0.55) } else { color };
        if name.is_empty() {
            ui.painter().circle(at, 3.5, theme.glass, Stroke::new(1.0, tone));
        } else {
            ui.painter().line_segment([center, at], Stroke::new(1.5, tone));
            ui.painter().circle_filled(at, 7.5, tone);
            ui.painter().text(at, Align2::CENTER_CENTER, name, FontId::proportional(9.5), theme.on_axis());
        }
        if pointer.is_some_and(|pointer| pointer.distance(at) < 9.0) {
            under = Some(id);
        }
    }
    if response.dragged() {
        let mut camera = context.camera;
        control::orbit(Vec2::new(response.drag_delta().x, response.drag_delta().y), &mut camera);
        requests.push(Request::Camera(camera));
    }
    if let Some(id) = under {
        if response.clicked() {
            requests.push(Request::Command(id));
        }
        response.on_hover_text(commands::tooltip(ui.ctx(), id));
    }
    Some(area)
}
