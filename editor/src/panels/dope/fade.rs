//! The falloff of edits: how much of an edit each time gets, as a shade under the keys and a curve in the ruler.

use super::sheet::Sheet;
use crate::panels::keys::intervals::Intervals;
use crate::panels::theme::Theme;
use dragonfly_anim::offset::Falloff;
use egui::{Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2};

/// Distance between the points of the curve, points of the screen.
const STEP: f32 = 3.0;
/// Height of the curve in the ruler.
const HEIGHT: f32 = 9.0;

/// Draws the falloff while it is on and applies to the scope of edits.
pub(super) fn paint(painter: &Painter, sheet: &Sheet<'_>) {
    let Sheet { areas, scale, context, theme, .. } = *sheet;
    let Some((parts, falloff)) = context.shown_falloff() else { return };
    let columns = (areas.canvas.width() / STEP).ceil().max(0.0) as usize;
    let point = |column: usize| {
        let x = (areas.canvas.left() + column as f32 * STEP).min(areas.canvas.right());
        (x, weight_at(scale.time_at(x), &parts, falloff))
    };
    let points: Vec<(f32, f32)> = (0..=columns).map(point).collect();
    shade(painter, areas.canvas, &points, theme);
    let line = |&(x, weight): &(f32, f32)| pos2(x, areas.head.bottom() - 1.0 - weight * HEIGHT);
    let line: Vec<Pos2> = points.iter().map(line).collect();
    painter
        .with_clip_rect(areas.head.intersect(painter.clip_rect()))
        .add(Shape::line(line, Stroke::new(1.3, theme.warning)));
}

/// Returns the part of an edit at a time: all of it in the parts of time that were chosen, less near them.
fn weight_at(time: f32, parts: &Intervals, falloff: Falloff) -> f32 {
    let parts = parts.stretches();
    let next = parts.partition_point(|[_, to]| *to < time);
    let around = [next.checked_sub(1), Some(next)].into_iter().flatten().filter_map(|at| parts.get(at));
    let distance = around.map(|[from, to]| (from - time).max(time - to).max(0.0));
    match distance.fold(f32::INFINITY, f32::min) {
        0.0 => 1.0,
        distance => falloff.weight(distance),
    }
}

/// Shades an area by the weights at some positions.
fn shade(painter: &Painter, area: Rect, points: &[(f32, f32)], theme: &Theme) {
    let mut mesh = Mesh::default();
    for &(x, weight) in points {
        let color = theme.warning.gamma_multiply(0.16 * weight);
        mesh.colored_vertex(pos2(x, area.top()), color);
        mesh.colored_vertex(pos2(x, area.bottom()), color);
    }
    for left in (0..points.len().saturating_sub(1) as u32).map(|column| column * 2) {
        mesh.add_triangle(left, left + 1, left + 2);
        mesh.add_triangle(left + 2, left + 1, left + 3);
    }
    painter.with_clip_rect(area.intersect(painter.clip_rect())).add(Shape::mesh(mesh));
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_anim::offset::FalloffShape;

    #[test]
    fn the_weight_is_whole_where_keys_were_chosen_and_that_of_the_nearest_elsewhere() {
        let parts = Intervals::of([[1.0, 2.0], [3.0, 3.0]]);
        let falloff = Falloff { seconds: 1.0, shape: FalloffShape::Linear };
        let at = |time| weight_at(time, &parts, falloff);
        let weights = [0.0, 0.75, 1.0, 1.5, 2.25, 2.75, 3.0, 3.5, 4.5].map(at);
        assert_eq!(weights, [0.0, 0.75, 1.0, 1.0, 0.75, 0.75, 1.0, 0.5, 0.0]);
        assert_eq!(weight_at(1.0, &Intervals::default(), falloff), 0.0);
    }
}
