//! How curves are shown; saved in the settings.

use serde::{Deserialize, Serialize};

/// How curves are shown, and to which values dragged keys go; saved in the settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct CurvesLook {
    /// Whether each curve is drawn from -1, its least value, to 1, its greatest.
    pub normalized: bool,
    /// Whether all curves but the one under the pointer are drawn faintly.
    pub solo: bool,
    /// Distance of the values to which dragged keys go; 0 for none.
    pub value_step: f32,
}

impl CurvesLook {
    /// Largest distance of values.
    const MOST: f32 = 1e6;

    /// Returns the nearest valid numbers.
    pub fn sanitized(mut self) -> Self {
        self.value_step =
            if self.value_step.is_finite() { self.value_step.clamp(0.0, Self::MOST) } else { 0.0 };
        self
    }

    /// Returns the amount by which a key with this value is moved so that it goes to a multiple of the step. Ctrl moves it freely;
    /// without a step it goes by multiples of `usual`.
    pub(in crate::panels) fn snapped(&self, value: f32, by: f32, ctrl: bool, usual: f32) -> f32 {
        if self.value_step > 0.0 {
            let to = ((value + by) / self.value_step).round() * self.value_step;
            if ctrl { by } else { to - value }
        } else if ctrl {
            (by / usual).round() * usual
        } else {
            by
        }
    }
}
