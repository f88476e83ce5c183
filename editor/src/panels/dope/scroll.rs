//! Zooming and panning by wheel, middle button and scroll bars.

use super::areas::{DopeAreas, SCROLL};
use crate::panels::commands::Id;
use crate::panels::keys::{KeysRequest, TimeScale};
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use dragonfly_anim::data::Take;
use dragonfly_picture::between;
use egui::{CornerRadius, PointerButton, Rect, Response, Sense, Ui, WidgetInfo, pos2};

/// Handles the wheel over an area with a time axis: zooms about the pointer, pans with Shift, steps by frames with Alt.
/// A pinch zooms, two fingers sideways pan.
pub(in crate::panels) fn wheel(ui: &Ui, response: &Response, scale: &TimeScale, requests: &mut Vec<Request>) {
    // Checks the position only, so that the wheel works during a drag of another widget.
    if !response.contains_pointer() {
        return;
    }
    let (delta, pinch, alt, pointer) = ui.input(|input| {
        (input.smooth_scroll_delta(), input.zoom_delta(), input.modifiers.alt, input.pointer.hover_pos())
    });
    let Some(pointer) = pointer else { return };
    if alt {
        let turned = delta.x + delta.y;
        if turned.abs() > 1.0 {
            requests.push(Request::Command(if turned > 0.0 { Id::PreviousFrame } else { Id::NextFrame }));
        }
        return;
    }
    let factor = f64::from((-delta.y * 0.005).exp() / pinch.max(1e-3));
    let by = -f64::from(scale.seconds(delta.x));
    if (factor - 1.0).abs() > 1e-6 || by != 0.0 {
        let about = f64::from(scale.time_at(pointer.x));
        let window = scale.window.zoomed(about, factor).panned(by);
        requests.push(Request::Timeline(KeysRequest::Window(Some(window))));
    }
}

/// Pans while the middle button drags. Returns by how many points the content moves down.
pub(in crate::panels) fn pan(
    ui: &Ui,
    response: &Response,
    scale: &TimeScale,
    requests: &mut Vec<Request>,
) -> f32 {
    let space = ui.input(|input| input.modifiers.alt && input.modifiers.shift);
    let pans =
        response.dragged_by(PointerButton::Middle) || (space && response.dragged_by(PointerButton::Primary));
    let delta = response.drag_delta();
    if !pans || delta == egui::Vec2::ZERO {
        return 0.0;
    }
    ui.ctx().set_cursor_icon(egui::CursorIcon::Grabbing);
    if delta.x != 0.0 {
        let window = scale.window.panned(-f64::from(scale.seconds(delta.x)));
        requests.push(Request::Timeline(KeysRequest::Window(Some(window))));
    }
    delta.y
}

/// Draws both scroll bars, where something is out of view.
pub(super) fn show(
    ui: &Ui,
    areas: &DopeAreas,
    scroll: &mut f32,
    content: f32,
    scale: &TimeScale,
    take: &Take,
    requests: &mut Vec<Request>,
) {
    let canvas = areas.canvas;
    if content > canvas.height() + 0.5 && canvas.height() > 24.0 {
        let track = Rect::from_min_max(pos2(canvas.right() - SCROLL, canvas.top()), canvas.max);
        let part = canvas.height() / content;
        let moved = bar(ui, track, true, *scroll / content, part, "Scroll through bones");
        *scroll = between(*scroll + moved * content, 0.0, content - canvas.height());
        let over = ui.rect_contains_pointer(areas.names);
        if over {
            *scroll -= ui.input(|input| input.smooth_scroll_delta().y);
            *scroll = between(*scroll, 0.0, content - canvas.height());
        }
    }
    time_bar(ui, canvas, scale, take, requests);
}

/// Draws the scroll bar of time at the lower edge of `canvas`, where not all of the take is visible.
pub(in crate::panels) fn time_bar(
    ui: &Ui,
    canvas: Rect,
    scale: &TimeScale,
    take: &Take,
    requests: &mut Vec<Request>,
) {
    let (first, last) = (f64::from(take.start), f64::from(take.end()));
    let window = scale.window;
    let all = (first.min(window.start), last.max(window.start + window.length));
    let whole = all.1 - all.0;
    if window.length >= whole * 0.999 || canvas.height() < 24.0 || !whole.is_finite() || whole <= 0.0 {
        return;
    }
    let track = Rect::from_min_max(
        pos2(canvas.left(), canvas.bottom() - SCROLL),
        pos2(canvas.right() - SCROLL, canvas.bottom()),
    );
    let at = ((window.start - all.0) / whole) as f32;
    let moved = bar(ui, track, false, at, (window.length / whole) as f32, "Scroll through time");
    if moved != 0.0 {
        let panned = window.panned(f64::from(moved) * whole);
        requests.push(Request::Timeline(KeysRequest::Window(Some(panned))));
    }
}

/// Draws a scroll bar that shows the fraction `part` of a whole from `at` on, both 0..1. Returns by which fraction it
/// was dragged.
fn bar(ui: &Ui, track: Rect, vertical: bool, at: f32, part: f32, name: &'static str) -> f32 {
    let theme = Theme::of(ui);
    let length = if vertical { track.height() } else { track.width() };
    let size = between(part * length, 16.0_f32.min(length), length);
    let start = at.clamp(0.0, 1.0) * (length - size) / (1.0 - part).max(1e-3);
    let start = between(start, 0.0, length - size);
    let handle = if vertical {
        Rect::from_min_max(
            pos2(track.left() + 2.0, track.top() + start),
            pos2(track.right() - 2.0, track.top() + start + size),
        )
    } else {
        Rect::from_min_max(
            pos2(track.left() + start, track.top() + 2.0),
            pos2(track.left() + start + size, track.bottom() - 2.0),
        )
    };
    let response = ui.interact(handle.expand(2.0), ui.scope_id().with(name), Sense::drag());
    response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::ScrollBar, true, name));
    let lit = response.hovered() || response.dragged();
    let color = if lit { theme.weak } else { theme.faint.gamma_multiply(0.6) };
    ui.painter().rect_filled(handle, CornerRadius::same(2), color);
    let delta = response.drag_delta();
    let moved = if vertical { delta.y } else { delta.x };
    if response.dragged_by(PointerButton::Primary) && moved != 0.0 { moved / length.max(1.0) } else { 0.0 }
}
