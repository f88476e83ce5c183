//! The size of the figure in a listing of a file.

use dragonfly_anim::data::Skeleton;
use dragonfly_anim::model_unit::ModelUnit;
use serde::Serialize;

/// The size of the figure, and how many meters a unit is for thresholds of motion.
#[derive(Serialize)]
pub(super) struct InfoFigure {
    /// Longest way between two joints at rest, units.
    size: f32,
    meters_per_unit: f32,
    #[serde(skip)]
    remark: Option<String>,
}

impl InfoFigure {
    /// Guesses the unit from the size of a skeleton.
    pub(super) fn of(skeleton: &Skeleton) -> Self {
        let unit = ModelUnit::of(skeleton);
        Self { size: unit.size, meters_per_unit: unit.meters, remark: unit.remark() }
    }

    /// Returns the sentence for a unit that is not that of the file.
    pub(super) fn remark(&self) -> Option<&str> {
        self.remark.as_deref()
    }
}
