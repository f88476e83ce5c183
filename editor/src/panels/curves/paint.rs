//! The curves as triangles, rebuilt only when something that they depend on changed.

use super::axis::ValueScale;
use super::curve::{Curve, CurveNumbers, Extent};
use super::hues::CurveHues;
use super::id::CurveId;
use super::scales::CurveScales;
use super::shown::ShownCurves;
use crate::panels::dope::Pen;
use crate::panels::keys::columns::gallop;
use crate::panels::keys::intervals::{Intervals, keys_between};
use crate::panels::keys::{Drawn, TimeScale};
use crate::panels::theme::Theme;
use dragonfly_anim::data::Interpolation;
use egui::epaint::{PathShape, TessellationOptions, Tessellator};
use egui::{Color32, Mesh, Painter, Pos2, Rect, Shape, Stroke, pos2};
use std::sync::Arc;

/// The triangles of all visible curves.
#[derive(Debug, Default)]
pub(super) struct CurveMesh {
    made_of: Option<CurveMeshKey>,
    mesh: Arc<Mesh>,
    /// Memory for the samples of a curve, by component.
    points: [Vec<Pos2>; 4],
    /// The curves as they are drawn.
    pub(super) drawn: Vec<Arc<Curve>>,
}

#[derive(Debug)]
struct CurveMeshKey {
    drawn: Drawn,
    version: u64,
    scales: (TimeScale, CurveScales),
    hues: CurveHues,
    solo: Option<(CurveId, usize)>,
    components: u8,
    pixels_per_point: f32,
    dark: bool,
}

/// Average distance of keys below which they have no dots, points.
const APART: f32 = 5.0;
/// Distance of the samples of a curve, points: of one of a few curves, and of one of many.
const SAMPLES: [f32; 2] = [3.0, 6.0];
/// Number of curves above which they are many.
const FEW: usize = 24;
/// Distance from the center of a key to its corners, points.
const RADIUS: f32 = 4.0;

/// Everything that the triangles of the curves depend on.
#[derive(Clone, Copy)]
pub(super) struct CurveLook<'a> {
    pub(super) shown: &'a ShownCurves,
    pub(super) drawn: &'a Drawn,
    pub(super) time: &'a TimeScale,
    pub(super) scales: &'a CurveScales,
    pub(super) hues: &'a CurveHues,
    /// The curve and the component that is drawn strongly, while all others are faint.
    pub(super) solo: Option<(CurveId, usize)>,
    /// A bit for each component that is shown.
    pub(super) components: u8,
    pub(super) theme: &'a Theme,
}

/// The target that curves are drawn into.
struct Canvas<'a> {
    time: &'a TimeScale,
    /// The area of all curves.
    rect: Rect,
    /// The mappings of the curve that is drawn.
    scales: [ValueScale; 4],
    hues: &'a CurveHues,
    solo: Option<(CurveId, usize)>,
    mesh: Mesh,
    tessellator: Tessellator,
    points: [Vec<Pos2>; 4],
    /// Distance of the samples of a curve, points.
    sample: f32,
}

/// Returns the color of a component.
pub(super) fn color(theme: &Theme, component: usize) -> Color32 {
    theme.axes.get(component).copied().unwrap_or(theme.weak)
}

impl CurveMesh {
    /// Draws the curves.
    pub(super) fn paint(&mut self, painter: &Painter, look: &CurveLook<'_>) {
        let CurveLook { shown, drawn, time, scales, hues, solo, components, theme } = *look;
        let made_of = CurveMeshKey {
            drawn: drawn.clone(),
            version: shown.version(),
            scales: (*time, scales.clone()),
            hues: hues.clone(),
            solo,
            components,
            pixels_per_point: painter.pixels_per_point(),
            dark: theme.dark,
        };
        if !self.made_of.as_ref().is_some_and(|old| old.same(&made_of)) {
            self.made_of = Some(made_of);
            self.rebuild(look, painter.pixels_per_point());
        }
        painter.add(Shape::Mesh(Arc::clone(&self.mesh)));
    }

    fn rebuild(&mut self, look: &CurveLook<'_>, pixels_per_point: f32) {
        let CurveLook { shown, drawn, time, scales, hues, solo, components, theme } = *look;
        self.drawn.clear();
        let options = TessellationOptions::default();
        let count = shown.curves().count();
        let mut canvas = Canvas {
            time,
            rect: scales.view.rect,
            scales: [scales.view; 4],
            hues,
            solo,
            sample: SAMPLES[usize::from(count > FEW)],
            // Overwritten in its memory, unless the last frame is still drawn.
            mesh: Arc::try_unwrap(std::mem::take(&mut self.mesh)).unwrap_or_default(),
            tessellator: Tessellator::new(pixels_per_point, options, [1, 1], Vec::new()),
            points: std::mem::take(&mut self.points),
        };
        canvas.mesh.indices.clear();
        canvas.mesh.vertices.clear();
        for curve in shown.curves() {
            let chosen = curve.id.selected(&drawn.selection);
            canvas.scales = scales.all(curve.id);
            let strength = if count > 6 { 0.7 } else { 1.0 };
            canvas.curve(curve, components, theme, strength);
            canvas.dots(curve, components, chosen, theme, 1.0 / pixels_per_point);
            self.drawn.push(Arc::clone(curve));
        }
        (self.mesh, self.points) = (Arc::new(canvas.mesh), canvas.points);
    }
}

impl CurveMeshKey {
    fn same(&self, other: &Self) -> bool {
        let (a, b) = (&self.drawn, &other.drawn);
        Arc::ptr_eq(&a.take, &b.take)
            && a.selection.same(&b.selection)
            && (self.version, self.components, self.dark, self.solo)
                == (other.version, other.components, other.dark, other.solo)
            && (&self.scales, &self.hues) == (&other.scales, &other.hues)
            && self.pixels_per_point == other.pixels_per_point
    }
}

impl Canvas<'_> {
    fn rect(&self) -> Rect {
        self.rect
    }

    /// Returns the color of a component of a curve.
    fn color(&self, curve: &Curve, component: usize, theme: &Theme) -> Color32 {
        /// Strength of curves that are not under the pointer.
        const FAINT: f32 = 0.22;
        let is_faint = self.solo.is_some_and(|solo| solo != (curve.id, component));
        let color = self.hues.color(theme, curve.id, component);
        if is_faint { color.gamma_multiply(FAINT) } else { color }
    }

    /// Returns the visible keys, and one more on each side.
    fn in_sight(&self, curve: &Curve) -> std::ops::Range<usize> {
        let times = curve.times();
        let keys = keys_between(
            times,
            [self.time.time_at(self.rect().left()), self.time.time_at(self.rect().right())],
        );
        keys.start.saturating_sub(1)..(keys.end + 1).min(times.len())
    }

    fn curve(&mut self, curve: &Curve, components: u8, theme: &Theme, strength: f32) {
        let keys = self.in_sight(curve);
        if keys.is_empty() {
            return;
        }
        let dense = keys.len() as f32 > self.rect().width() / 2.0;
        if dense {
            return self.bands(curve, components, theme, strength);
        }
        self.sample(curve, keys.clone());
        self.dashes(curve, keys, components, theme, strength);
        for at in curve.shown(components) {
            let color = self.color(curve, at, theme).gamma_multiply(strength);
            let points = std::mem::take(&mut self.points[at]);
            let line = PathShape::line(points, Stroke::new(1.4, color));
            self.tessellator.tessellate_path(&line, &mut self.mesh);
            self.points[at] = line.points;
        }
    }

    /// Draws the values before the first key and after the last one: they are no part of the curve, and a game may repeat it instead.
    fn dashes(
        &mut self,
        curve: &Curve,
        keys: std::ops::Range<usize>,
        components: u8,
        theme: &Theme,
        strength: f32,
    ) {
        /// Length of a dash and of the gap after it, points.
        const DASH: f32 = 4.0;
        let (rect, times) = (self.rect(), curve.times());
        let before = (keys.start == 0).then(|| (rect.left(), self.time.x_of(times[0]), 0));
        let last = times.len() - 1;
        let after = (keys.end > last).then(|| (self.time.x_of(times[last]), rect.right(), last));
        for (from, to, key) in before.into_iter().chain(after) {
            let numbers = curve.key(key);
            for at in curve.shown(components) {
                let color = self.color(curve, at, theme).gamma_multiply(strength * 0.8);
                let y = self.scales[at].y_of(numbers[at]);
                let mut x = from.max(rect.left());
                while x < to {
                    let end = (x + DASH).min(to);
                    let dash = Rect::from_min_max(pos2(x, y - 0.6), pos2(end, y + 0.6));
                    if rect.y_range().contains(y) {
                        self.mesh.add_colored_rect(dash, color);
                    }
                    x += 2.0 * DASH;
                }
            }
        }
    }

    /// Samples all components from the first to the last of these keys.
    fn sample(&mut self, curve: &Curve, keys: std::ops::Range<usize>) {
        let (rect, width) = (self.rect(), curve.width());
        self.points.iter_mut().for_each(Vec::clear);
        let times = curve.times();
        for key in keys.clone() {
            let (x, numbers) = (self.time.x_of(times[key]), curve.key(key));
            self.push(x, numbers, width);
            let Some(&next) = times.get(key + 1).filter(|_| key + 1 < keys.end) else {
                break;
            };
            let end = self.time.x_of(next);
            match curve.interpolation() {
                Interpolation::Step => self.push(end, numbers, width),
                Interpolation::Closest => {
                    self.push((x + end) / 2.0, numbers, width);
                    self.push((x + end) / 2.0, curve.key(key + 1), width);
                }
                _ if curve.is_straight() => {}
                _ => {
                    let mut near = numbers;
                    let mut at = (x + self.sample).max(rect.left() - self.sample);
                    while at < end.min(rect.right() + self.sample) {
                        near = curve.at(self.time.time_at(at), near);
                        self.push(at, near, width);
                        at += self.sample;
                    }
                }
            }
        }
    }

    fn push(&mut self, x: f32, numbers: CurveNumbers, width: usize) {
        for (at, points) in self.points.iter_mut().enumerate().take(width) {
            points.push(pos2(x, self.scales[at].y_of(numbers[at])));
        }
    }

    /// Draws a bar from the least to the greatest value in every column of pixels.
    fn bands(&mut self, curve: &Curve, components: u8, theme: &Theme, strength: f32) {
        let rect = self.rect();
        let mut last: Option<Extent> = None;
        let mut x = rect.left();
        let mut key = keys_between(curve.times(), [self.time.time_at(x), f32::INFINITY]).start;
        while x < rect.right() {
            // Each column begins where the previous one ended.
            let end = gallop(curve.times(), key, self.time.time_at(x + 1.0));
            let extent = curve.extent(key..end);
            key = end;
            if extent.low[0] <= extent.high[0] {
                let joined = last.map_or(extent, |last| joined(&extent, &last));
                for at in curve.shown(components) {
                    let color = self.color(curve, at, theme).gamma_multiply(strength * 0.85);
                    self.column(x, at, [joined.low[at], joined.high[at]], color);
                }
                last = Some(extent);
            }
            x += 1.0;
        }
    }

    fn column(&mut self, x: f32, component: usize, [low, high]: [f32; 2], color: Color32) {
        let scale = &self.scales[component];
        let (top, bottom) = (scale.y_of(high), scale.y_of(low));
        let thin = (1.2 - (bottom - top)).max(0.0) / 2.0;
        let rect = Rect::from_min_max(pos2(x, top - thin), pos2(x + 1.0, bottom + thin));
        if rect.intersects(self.rect()) {
            self.mesh.add_colored_rect(rect.intersect(self.rect()), color);
        }
    }

    /// Draws keys as diamonds, where they are not too dense.
    fn dots(&mut self, curve: &Curve, components: u8, chosen: &Intervals, theme: &Theme, feather: f32) {
        let keys = self.in_sight(curve);
        if keys.len() as f32 * APART > self.rect().width() {
            return;
        }
        let pen = Pen { feather };
        let bounds = self.rect().expand(RADIUS);
        for key in keys {
            let (x, numbers) = (self.time.x_of(curve.times()[key]), curve.key(key));
            let selected = curve.is_chosen(key, chosen);
            for at in curve.shown(components) {
                let center = pos2(x, self.scales[at].y_of(numbers[at]));
                if bounds.contains(center) {
                    // A selected key keeps the color of its axis: several may be side by side.
                    let (edge, rim) = if selected { (theme.text, 2.0) } else { (theme.sunken, 1.0) };
                    pen.diamond(&mut self.mesh, center, RADIUS + rim, edge);
                    let color = self.color(curve, at, theme);
                    pen.diamond(&mut self.mesh, center, RADIUS, color);
                }
            }
        }
    }
}

/// Returns an extent that touches the previous one, so that steep parts have no gaps.
fn joined(extent: &Extent, last: &Extent) -> Extent {
    let mut joined = *extent;
    for at in 0..4 {
        if last.high[at] < extent.low[at] {
            joined.low[at] = last.high[at];
        } else if last.low[at] > extent.high[at] {
            joined.high[at] = last.low[at];
        }
    }
    joined
}
