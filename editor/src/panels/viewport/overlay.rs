//! Mouse feedback in the viewport that the panels draw: cursor, box, lasso.

use crate::control::ViewportControl;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use dragonfly_picture::pick::Region;
use egui::{CursorIcon, Pos2, Rect, Response, Shape, Stroke, StrokeKind, Ui, pos2};
use glam::Vec2;

/// Requests picking and zooming at the pointer, and sets the cursor.
pub(super) fn pointer(ui: &Ui, response: &Response, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let (at, held, focused, wheel, pinch) = ui.input(|input| {
        let pointer = &input.pointer;
        let wheel = input.smooth_scroll_delta().y;
        (pointer.latest_pos(), pointer.any_down(), input.focused, wheel, input.zoom_delta())
    });
    let tools = context.tools.controls();
    let rests = response.hovered() && !held && focused && !tools.is_busy() && !tools.over_handle();
    requests.push(Request::Point(at.filter(|_| rests)));
    if context.stage.hovered().is_some() && !held && !response.contains_pointer() {
        requests.push(Request::PointElsewhere);
    }
    if response.hovered() {
        let by = wheel + ViewportControl::wheel_of_pinch(pinch);
        if by.is_finite() && by != 0.0 {
            requests.push(Request::Wheel(by));
        }
    }
    let picture = tools.picture();
    let icon = if tools.edits() || picture.moves_camera() {
        Some(CursorIcon::Grabbing)
    } else if tools.line().use_of().is_some()
        || context.stage.focused_camera().is_some()
        || picture.armed().is_some()
        || picture.catching().is_some()
    {
        Some(CursorIcon::Crosshair)
    } else if response.hovered() && tools.over_handle() {
        Some(CursorIcon::Grab)
    } else {
        None
    };
    if let Some(icon) = icon.filter(|_| response.hovered() || tools.is_busy()) {
        ui.ctx().set_cursor_icon(icon);
    }
}

/// Draws the box or lasso selection in progress.
pub(super) fn drawn(ui: &Ui, rect: Rect, context: &PanelContext<'_>) {
    let Some(region) = context.tools.controls().picture().catching() else { return };
    let theme = Theme::of(ui);
    let painter = ui.painter().with_clip_rect(rect);
    let (line, fill) = (Stroke::new(1.0, theme.accent), theme.accent.gamma_multiply(0.12));
    let there = |at: Vec2| pos2(rect.left() + at.x, rect.top() + at.y);
    match region {
        Region::Box(a, b) => {
            let frame = Rect::from_two_pos(there(a), there(b));
            painter.rect(frame, 0.0, fill, line, StrokeKind::Inside);
        }
        Region::Lasso(points) => {
            let points: Vec<Pos2> = points.iter().map(|&at| there(at)).collect();
            painter.add(Shape::closed_line(points, line));
        }
    }
}
