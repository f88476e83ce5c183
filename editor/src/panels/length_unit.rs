//! The unit of length of the model that is open: guessed from its size until the user sets one. It is remembered with the marks of the
//! file, and holds for all distances that are compared with thresholds or shown in millimeters.

use dragonfly_anim::data::Skeleton;
use dragonfly_anim::model_unit::ModelUnit;
use std::ops::RangeInclusive;

/// Units that can be set, meters.
pub(super) const METERS: RangeInclusive<f32> = 1e-6..=1e6;

/// The unit of length of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LengthUnit {
    by_size: ModelUnit,
    chosen: Option<f32>,
}

impl LengthUnit {
    /// Returns meters in one unit of the model.
    pub fn meters(self) -> f32 {
        self.chosen.unwrap_or(self.by_size.meters)
    }

    /// Returns millimeters in one unit of the model.
    pub fn millimeters(self) -> f32 {
        1000.0 * self.meters()
    }

    /// Returns the unit that the user set, meters; `None` where it is guessed.
    pub fn chosen(self) -> Option<f32> {
        self.chosen
    }

    /// Returns the unit that is guessed from the size of the model.
    pub fn by_size(self) -> ModelUnit {
        self.by_size
    }

    /// Sets the unit, meters, or uses the guess again. A number outside of [`METERS`] is not taken.
    pub(super) fn choose(&mut self, meters: Option<f32>) {
        match meters {
            Some(meters) if METERS.contains(&meters) => self.chosen = Some(meters),
            Some(_) => {}
            None => self.chosen = None,
        }
    }

    /// Guesses the unit from the size of a model.
    pub(super) fn guess(&mut self, skeleton: &Skeleton) {
        *self = Self { by_size: ModelUnit::of(skeleton), chosen: None };
    }
}
