//! What an edit can choose between.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a reset leads back to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ResetTo {
    /// The pose as it was read: the change is taken away, bit for bit.
    #[default]
    Original,
    /// The pose of the bone when nothing animates it.
    Rest,
}

/// What a new key holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NewKey {
    /// What the key before it holds, exactly (thesis §2.2.2.4); before the first key: what the first one holds.
    #[default]
    Predecessor,
    /// What the take shows at that time, so that the motion stays as it is.
    Current,
}

/// How a channel finds what lies between its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Between {
    /// The key before.
    Step,
    /// Mixed by distance.
    Linear,
    /// A spline with tangents; those of a channel that had none are chosen so that it runs smoothly through its keys.
    CubicSpline,
}

impl From<Between> for dragonfly_anim::data::Interpolation {
    fn from(between: Between) -> Self {
        match between {
            Between::Step => Self::Step,
            Between::Linear => Self::Linear,
            Between::CubicSpline => Self::CubicSpline,
        }
    }
}
