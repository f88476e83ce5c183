//! The second view of a scene next to the viewport: through the camera of the shot, while the viewport has the free one.

use super::image_frame;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::style;
use crate::panels::theme::Theme;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Least width of either view, points.
const LEAST: f32 = 120.0;
/// Width of the line between them that can be dragged, points.
const GRIP: f32 = 6.0;

/// Draws what is over the second view, on the right, and returns the rectangle of the viewport, which is the rest. Without a scene and without room there is none.
pub(super) fn show(ui: &Ui, rect: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) -> Rect {
    let is_shown = context.settings.look.second_view && context.scene().is_some();
    if !is_shown || rect.width() < 2.0 * LEAST + GRIP {
        if context.second_view.is_some() {
            requests.push(Request::SecondView(None));
        }
        return rect;
    }
    let place = ui.scope_id().with("share of the second view");
    let share = ui.data(|data| data.get_temp::<f32>(place)).unwrap_or(0.5);
    let middle =
        between(rect.left() + rect.width() * (1.0 - share), rect.left() + LEAST, rect.right() - LEAST);
    let grip = Rect::from_center_size(pos2(middle, rect.center().y), vec2(GRIP, rect.height()));
    let response = ui.interact(grip, place, Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, "Width of the second view"));
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        let share = ((rect.right() - at.x) / rect.width()).clamp(0.0, 1.0);
        ui.data_mut(|data| data.insert_temp(place, share));
    }
    let second = Rect::from_min_max(pos2(grip.right(), rect.top()), rect.max);
    if context.second_view != Some(second) {
        requests.push(Request::SecondView(Some(second)));
    }
    let theme = Theme::of(ui);
    let color = if response.hovered() || response.dragged() { theme.accent } else { theme.line };
    ui.painter().rect_filled(grip, 0.0, theme.bar);
    ui.painter().vline(middle, rect.y_range(), Stroke::new(1.0, color));
    image_frame::frame(ui, second, context);
    let camera = context.shot_camera().unwrap_or("no camera");
    let font = FontId::proportional(style::BODY);
    let text = format!("shot: {camera}");
    ui.painter().text(second.left_top() + vec2(14.0, 12.0), Align2::LEFT_TOP, &text, font, theme.text);
    let picture = ui.interact(second, ui.scope_id().with("second view"), Sense::click());
    picture.widget_info(|| WidgetInfo::labeled(Role::Image, true, format!("Second view, {text}")));
    if picture.double_clicked() {
        requests.push(Request::Scene(crate::panels::scene::SceneRequest::Through(ThroughCamera::Shot)));
    }
    picture.on_hover_text("The camera of the shot\nDouble-click: look through it in the viewport");
    Rect::from_min_max(rect.min, pos2(grip.left(), rect.bottom()))
}
