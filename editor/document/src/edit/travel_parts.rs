//! The parts of a figure's travel, as edits name them.

use super::Arbitrary;
use crate::adapter::EditError;
use crate::adapter::plan::finite;
use dragonfly_anim::data::Take;
use dragonfly_anim::frames::frame_rate;
use dragonfly_anim::motion::{Axis, RootMotionOptions, TravelOptions};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A part of the travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum TravelPart {
    /// The way along x.
    X,
    /// The height.
    Height,
    /// The way along z.
    Z,
    /// The turn about the vertical.
    Yaw,
}

impl TravelPart {
    /// All parts.
    pub const ALL: [Self; 4] = [Self::X, Self::Z, Self::Height, Self::Yaw];

    /// Returns the parts that an edit has where it names none: everything but the height.
    pub fn usual() -> Vec<Self> {
        vec![Self::X, Self::Z, Self::Yaw]
    }

    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Vec<Self> {
        Self::ALL.into_iter().filter(|_| from.flag()).collect()
    }
}

/// Returns the options of an edit for its take.
pub(super) fn travel_options(
    parts: &[TravelPart],
    smooth: f32,
    rate: Option<f32>,
    take: &Take,
) -> Result<TravelOptions, EditError> {
    let smooth = finite("the smoothing", smooth)?;
    if !(0.0..=1000.0).contains(&smooth) {
        return Err(EditError::Number { what: "the smoothing in frames", value: smooth });
    }
    if parts.is_empty() {
        return Err(EditError::Nothing("no part of the travel is chosen"));
    }
    let has = |part| parts.contains(&part);
    let translation = [has(TravelPart::X), has(TravelPart::Height), has(TravelPart::Z)];
    let motion = RootMotionOptions { up: Axis::Y, translation, yaw: has(TravelPart::Yaw) };
    Ok(TravelOptions { motion, smooth, rate: rate.unwrap_or_else(|| frame_rate(take)) })
}
