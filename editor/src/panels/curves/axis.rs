//! The vertical axis of values.

use crate::panels::theme::Theme;
use egui::{Align2, FontId, Painter, Rect, Stroke, pos2};

/// The range of values that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueWindow {
    /// Value at the lower edge.
    pub(super) low: f64,
    /// Difference between the upper and the lower edge; greater than zero.
    pub(super) span: f64,
}

const SMALLEST: f64 = 1e-6;
const LARGEST: f64 = 1e9;

impl Default for ValueWindow {
    fn default() -> Self {
        Self { low: -1.0, span: 2.0 }
    }
}

impl ValueWindow {
    /// Returns a range that contains `low..=high` with a margin, also if that is a single value.
    pub(super) fn around(low: f32, high: f32) -> Self {
        if !(low.is_finite() && high.is_finite() && low <= high) {
            return Self::default();
        }
        let (low, high) = (f64::from(low), f64::from(high));
        let span = (high - low).max((low.abs().max(high.abs()) * 0.02).max(0.02));
        let middle = (low + high) / 2.0;
        Self { low: middle - span * 0.58, span: span * 1.16 }.sanitized()
    }

    /// Whether all of `low..=high` is visible.
    pub(super) fn holds(self, low: f32, high: f32) -> bool {
        f64::from(low) >= self.low && f64::from(high) <= self.low + self.span
    }

    fn sanitized(self) -> Self {
        let span = if self.span.is_finite() { self.span.clamp(SMALLEST, LARGEST) } else { 2.0 };
        let low = if self.low.is_finite() { self.low.clamp(-LARGEST, LARGEST) } else { -1.0 };
        Self { low, span }
    }

    pub(super) fn zoomed(self, about: f64, factor: f64) -> Self {
        let span = (self.span * factor).clamp(SMALLEST, LARGEST);
        let part = (about - self.low) / self.span;
        Self { low: about - part * span, span }.sanitized()
    }

    pub(super) fn panned(self, by: f64) -> Self {
        Self { low: self.low + by, ..self }.sanitized()
    }
}

/// The mapping between values and heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ValueScale {
    pub(super) rect: Rect,
    pub(super) window: ValueWindow,
}

impl ValueScale {
    /// Returns the number of points per unit.
    pub(super) fn per_unit(&self) -> f64 {
        f64::from(self.rect.height().max(1.0)) / self.window.span
    }

    pub(super) fn y_of(&self, value: f32) -> f32 {
        let y = f64::from(self.rect.bottom()) - (f64::from(value) - self.window.low) * self.per_unit();
        y.clamp(-1e6, 1e6) as f32
    }

    pub(super) fn value_at(&self, y: f32) -> f32 {
        (self.window.low + f64::from(self.rect.bottom() - y) / self.per_unit()) as f32
    }

    /// Returns the distance of labeled lines, units.
    pub(super) fn step(&self) -> f64 {
        let wanted = self.window.span * 28.0 / f64::from(self.rect.height().max(28.0));
        let ten = 10f64.powf(wanted.log10().floor());
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|part| part * ten).find(|&step| step >= wanted).unwrap_or(ten)
    }
}

/// Draws the lines over `rect`, with their numbers in `strip` on the left.
///
/// Where curves are normalized, `true_scale` is that of the curve whose numbers are written; without it none are.
pub(super) fn paint(
    painter: &Painter,
    strip: Rect,
    scale: &ValueScale,
    true_scale: Option<&ValueScale>,
    theme: &Theme,
) {
    let step = scale.step();
    let true_step = true_scale.map_or(step, |own| step * own.window.span / scale.window.span);
    let decimals = (-true_step.log10().floor()).clamp(0.0, 6.0) as usize;
    let first = (scale.window.low / step).ceil() as i64;
    let count = (scale.window.span / step).ceil().clamp(0.0, 200.0) as i64;
    for index in first..=first.saturating_add(count) {
        let value = index as f64 * step;
        let y = painter.round_to_pixel_center(scale.y_of(value as f32));
        if !scale.rect.y_range().contains(y) {
            continue;
        }
        let strong = if index == 0 { 1.0 } else { 0.45 };
        painter.hline(scale.rect.x_range(), y, Stroke::new(1.0, theme.line.gamma_multiply(strong)));
        if let Some(true_scale) = true_scale
            && y > strip.top() + 6.0
            && y < strip.bottom() - 6.0
        {
            let number = true_scale.window.low
                + (value - scale.window.low) / scale.window.span * true_scale.window.span;
            let text = format!("{number:.decimals$}");
            painter.text(
                pos2(strip.right() - 5.0, y),
                Align2::RIGHT_CENTER,
                text,
                FontId::monospace(9.5),
                theme.faint,
            );
        }
    }
}
