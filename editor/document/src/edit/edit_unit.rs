//! The unit of length of a model, as edits state it.

use super::map_references::refer_to_nothing;
use crate::adapter::EditError;
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::model_unit::ModelUnit;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Length of a unit of the model: a number, or `"guess"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum EditUnit {
    /// The length.
    Stated(f32),
    /// The one that the size of the figure suggests.
    BySize(UnitGuess),
}

/// The word for a unit that is to be guessed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum UnitGuess {
    /// From the size of the figure.
    Guess,
}

impl EditUnit {
    /// The unit that the size of the figure suggests.
    pub const GUESS: Self = Self::BySize(UnitGuess::Guess);

    /// Returns the length in parts of a meter, of which a meter has `parts`. Where an edit states none, a unit is a meter.
    ///
    /// # Errors
    ///
    /// It is not a finite number above 0.
    pub(super) fn length(unit: Option<Self>, parts: f32, skeleton: &Skeleton) -> Result<f32, EditError> {
        match unit {
            None => Ok(parts),
            Some(Self::BySize(UnitGuess::Guess)) => Ok(parts * ModelUnit::of(skeleton).meters),
            Some(Self::Stated(value)) if value.is_finite() && value > 0.0 => Ok(value),
            Some(Self::Stated(value)) => Err(EditError::Number { what: "the unit", value }),
        }
    }
}

impl From<f32> for EditUnit {
    fn from(length: f32) -> Self {
        Self::Stated(length)
    }
}

refer_to_nothing!(EditUnit);
