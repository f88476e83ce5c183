//! The mapping between values and heights of each curve: the same for all, or each curve from its least to its greatest value.

use super::axis::{ValueScale, ValueWindow};
use super::id::CurveId;
use super::shown::ShownCurves;
use std::sync::Arc;

/// The least and the greatest value of each component of curves. Empty unless curves are normalized.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CurveRanges(Arc<[CurveRange]>);

/// The values of one curve.
#[derive(Clone, Copy, Debug, PartialEq)]
struct CurveRange {
    id: CurveId,
    low: [f32; 4],
    high: [f32; 4],
}

/// The mapping between values and heights, for each curve.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct CurveScales {
    /// The mapping of values as they are shown: between -1 and 1 where curves are normalized.
    pub(super) view: ValueScale,
    pub(super) ranges: CurveRanges,
}

impl CurveRanges {
    /// Returns the ranges of all curves.
    pub(super) fn of(shown: &ShownCurves) -> Self {
        let ranges = shown.curves().map(|curve| {
            let extent = curve.full_extent();
            CurveRange { id: curve.id, low: extent.low, high: extent.high }
        });
        Self(ranges.collect())
    }

    /// Whether curves are normalized.
    pub(super) fn is_normalized(&self) -> bool {
        !self.0.is_empty()
    }

    /// Returns the values of a component of a curve that are visible where `view` is shown. The least value of the curve is at -1, the
    /// greatest at 1; a curve that does not move is at 0.
    pub(super) fn window(&self, view: ValueWindow, id: CurveId, component: usize) -> ValueWindow {
        let Some(range) = self.0.iter().find(|range| range.id == id) else { return view };
        let [low, high] = [range.low, range.high].map(|side| f64::from(side[component.min(3)]));
        let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0);
        let half = if half > 1e-6 * middle.abs().max(1e-3) { half } else { 1.0 };
        ValueWindow { low: middle + half * view.low, span: half * view.span }
    }
}

impl CurveScales {
    /// Returns the mapping of a component of a curve.
    pub(super) fn of(&self, id: CurveId, component: usize) -> ValueScale {
        ValueScale { window: self.ranges.window(self.view.window, id, component), ..self.view }
    }

    /// Returns the mappings of all components of a curve.
    pub(super) fn all(&self, id: CurveId) -> [ValueScale; 4] {
        std::array::from_fn(|component| self.of(id, component))
    }
}
