//! The parts drawn below and above the keys: rows, the range that does not play, the playhead.

use super::rows::RowKind;
use super::sheet::{ROW, Sheet};
use crate::panels::context::PanelContext;
use crate::panels::keys::TimeScale;
use crate::panels::theme::Theme;
use egui::{Align2, Color32, CornerRadius, FontId, Painter, Rect, Shape, Stroke, pos2, vec2};

/// Draws the backgrounds of the rows: selected bones highlighted, the summary row set apart, lines in between.
pub(super) fn rows(painter: &Painter, sheet: &Sheet<'_>) {
    let Sheet { areas, rows, scroll, context, theme, .. } = *sheet;
    let body = Rect::from_min_max(areas.names.min, areas.canvas.max);
    let painter = painter.with_clip_rect(body.intersect(painter.clip_rect()));
    let first = (scroll / ROW).floor().max(0.0) as usize;
    let last = ((scroll + body.height()) / ROW).ceil().max(0.0) as usize;
    for (at, row) in rows.list().iter().enumerate().take(last).skip(first) {
        let top = body.top() - scroll + at as f32 * ROW;
        let rect = Rect::from_min_max(pos2(body.left(), top), pos2(body.right(), top + ROW));
        let fill = match row.kind {
            RowKind::Summary => theme.bar,
            RowKind::Bone(bone) if context.selection.contains(bone) => theme.accent_soft.gamma_multiply(0.45),
            RowKind::Bone(_) | RowKind::Morphs => theme.bar.gamma_multiply(0.5),
            RowKind::Channel(..) => Color32::TRANSPARENT,
        };
        painter.rect_filled(rect, CornerRadius::ZERO, fill);
        painter.hline(rect.x_range(), rect.bottom() - 0.5, Stroke::new(1.0, theme.line.gamma_multiply(0.4)));
    }
}

/// Shades the time that does not play or is outside the take.
pub(in crate::panels) fn shade(
    painter: &Painter,
    rect: Rect,
    scale: &TimeScale,
    context: &PanelContext<'_>,
    theme: &Theme,
) {
    let (start, length) = context.take_bounds();
    let [from, to] = context.keys.range().unwrap_or([start, start + length]);
    let color = theme.gap.gamma_multiply(0.45);
    let (left, right) = (scale.x_of(from), scale.x_of(to));
    // On a dark background the shade alone is hard to see.
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

pub(super) fn outside_range(painter: &Painter, sheet: &Sheet<'_>) {
    shade(painter, sheet.areas.canvas, sheet.scale, sheet.context, sheet.theme);
}

pub(super) fn playhead(painter: &Painter, sheet: &Sheet<'_>) {
    let Sheet { areas, scale, context, theme, .. } = *sheet;
    line(painter, areas.head, areas.all.bottom(), scale, context, theme);
}

/// Draws the playhead: its line, and its flag in a ruler.
pub(in crate::panels) fn line(
    painter: &Painter,
    head: Rect,
    bottom: f32,
    scale: &TimeScale,
    context: &PanelContext<'_>,
    theme: &Theme,
) {
    let right = Rect::from_min_max(head.min, pos2(head.right(), bottom));
    let painter = painter.with_clip_rect(right.intersect(painter.clip_rect()));
    let x = painter.round_to_pixel_center(scale.x_of(context.time()));
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

/// Draws a small hollow diamond in the ruler at each time with pending poses.
pub(super) fn pending(painter: &Painter, sheet: &Sheet<'_>) {
    let Sheet { areas, scale, context, theme, .. } = *sheet;
    let painter = painter.with_clip_rect(areas.head.intersect(painter.clip_rect()));
    for time in context.pending_times() {
        let center = pos2(scale.x_of(time), areas.head.bottom() - 5.0);
        let points = [vec2(0.0, -4.0), vec2(4.0, 0.0), vec2(0.0, 4.0), vec2(-4.0, 0.0)];
        let points = points.into_iter().map(|offset| center + offset).collect();
        painter.add(Shape::convex_polygon(points, theme.bar, Stroke::new(1.3, theme.warning)));
    }
}

/// Draws the reason why there are no rows.
pub(super) fn nothing(painter: &Painter, sheet: &Sheet<'_>) {
    let Sheet { areas, context, theme, .. } = *sheet;
    let text = if !context.keys.filter().is_empty() {
        "No bone with keys matches the filter"
    } else if context.keys.only_changed() {
        "No bone in the list has other keys than the file"
    } else {
        match (context.lists_only_selected(), context.layer().is_some()) {
            (true, false) => "The selected bones have no keys in this take",
            (true, true) => "The selected bones have no keys in this layer: pose one to add a key",
            (false, false) => "This take has no keys",
            (false, true) => "This layer has no keys: pose a bone to add one",
        }
    };
    painter.text(areas.canvas.center(), Align2::CENTER_CENTER, text, FontId::proportional(12.0), theme.faint);
}
