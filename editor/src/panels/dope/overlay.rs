//! What lies behind and over the keys: rows, the part that does not play, the playhead.

use super::ROW;
use super::place::Places;
use super::rows::{RowKind, Rows};
use crate::panels::context::PanelContext;
use crate::panels::keys::TimeScale;
use crate::panels::theme::Theme;
use egui::{Align2, Color32, CornerRadius, FontId, Painter, Rect, Shape, Stroke, pos2, vec2};

/// Selected bones are lit, summaries are a little apart, fine lines in between.
pub(super) fn rows(
    painter: &Painter,
    places: &Places,
    scroll: f32,
    rows: &Rows,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let body = Rect::from_min_max(places.names.min, places.canvas.max);
    let painter = painter.with_clip_rect(body.intersect(painter.clip_rect()));
    let first = (scroll / ROW).floor().max(0.0) as usize;
    let last = ((scroll + body.height()) / ROW).ceil().max(0.0) as usize;
    for (at, row) in rows.list().iter().enumerate().take(last).skip(first) {
        let top = body.top() - scroll + at as f32 * ROW;
        let rect = Rect::from_min_max(pos2(body.left(), top), pos2(body.right(), top + ROW));
        let fill = match row.kind {
            RowKind::Summary => theme.bar,
            RowKind::Bone(bone) if state.selection.contains(bone) => theme.accent_soft.gamma_multiply(0.45),
            RowKind::Bone(_) | RowKind::Morphs => theme.bar.gamma_multiply(0.5),
            RowKind::Channel(..) => Color32::TRANSPARENT,
        };
        painter.rect_filled(rect, CornerRadius::ZERO, fill);
        painter.hline(rect.x_range(), rect.bottom() - 0.5, Stroke::new(1.0, theme.line.gamma_multiply(0.4)));
    }
}

/// Shades what does not play, and what lies outside of the take.
pub(in crate::panels) fn shade(
    painter: &Painter,
    rect: Rect,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let (start, length) = state.take_bounds();
    let [from, to] = state.keys.range().unwrap_or([start, start + length]);
    let color = theme.gap.gamma_multiply(0.45);
    let (left, right) = (scale.x_of(from), scale.x_of(to));
    // On dark ground the shade alone is hard to see.
    let edge = Stroke::new(1.0, theme.line);
    if left > rect.left() {
        let outside = Rect::from_min_max(rect.min, pos2(left.min(rect.right()), rect.bottom()));
        painter.rect_filled(outside, CornerRadius::ZERO, color);
        painter.vline(outside.right(), rect.y_range(), edge);
    }
    if right < rect.right() {
        let outside = Rect::from_min_max(pos2(right.max(rect.left()), rect.top()), rect.max);
        painter.rect_filled(outside, CornerRadius::ZERO, color);
        painter.vline(outside.left(), rect.y_range(), edge);
    }
}

pub(super) fn outside_range(
    painter: &Painter,
    places: &Places,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    shade(painter, places.canvas, scale, state, theme);
}

pub(super) fn playhead(
    painter: &Painter,
    places: &Places,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    line(painter, places.head, places.all.bottom(), scale, state, theme);
}

/// The line of the playhead with its flag in a ruler.
pub(in crate::panels) fn line(
    painter: &Painter,
    head: Rect,
    bottom: f32,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let right = Rect::from_min_max(head.min, pos2(head.right(), bottom));
    let painter = painter.with_clip_rect(right.intersect(painter.clip_rect()));
    let x = painter.round_to_pixel_center(scale.x_of(state.time()));
    painter.vline(x, head.bottom() - 4.0..=bottom, Stroke::new(1.0, theme.accent));
    let y = head.bottom() - 1.0;
    let flag = vec![
        pos2(x - 5.0, y - 9.0),
        pos2(x + 5.0, y - 9.0),
        pos2(x + 5.0, y - 5.0),
        pos2(x, y),
        pos2(x - 5.0, y - 5.0),
    ];
    painter.add(Shape::convex_polygon(flag, theme.accent, Stroke::NONE));
}

/// A small hollow diamond in the ruler where poses wait to be keyed.
pub(super) fn pending(
    painter: &Painter,
    places: &Places,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let painter = painter.with_clip_rect(places.head.intersect(painter.clip_rect()));
    for time in state.pending_times() {
        let center = pos2(scale.x_of(time), places.head.bottom() - 5.0);
        let points = [vec2(0.0, -4.0), vec2(4.0, 0.0), vec2(0.0, 4.0), vec2(-4.0, 0.0)];
        let points = points.into_iter().map(|offset| center + offset).collect();
        painter.add(Shape::convex_polygon(points, theme.bar, Stroke::new(1.3, theme.warning)));
    }
}

/// Why no row is there.
pub(super) fn nothing(painter: &Painter, places: &Places, state: &PanelContext<'_>, theme: &Theme) {
    let text = if !state.keys.filter().is_empty() {
        "No bone with keys is called that"
    } else if state.lists_only_selected() {
        "The selected bones have no keys in this take"
    } else {
        "This take has no keys"
    };
    painter.text(
        places.canvas.center(),
        Align2::CENTER_CENTER,
        text,
        FontId::proportional(12.0),
        theme.faint,
    );
}
