//! Options of edits.

use dragonfly_anim::data::Interpolation;
use dragonfly_anim::layers::LayerMode;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The pose to which a reset returns.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ResetTo {
    /// The original pose: the change is removed, exact to the bit.
    #[default]
    Original,
    /// The rest pose of the bone.
    Rest,
}

/// The value of a new key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NewKey {
    /// The value of the key before, exactly (thesis §2.2.2.4); before the first key, the value of that one.
    #[default]
    Predecessor,
    /// The present value at that time, so that the motion stays as it is.
    Current,
}

/// The interpolation of a channel between its keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KeyInterpolation {
    /// The value of the key before.
    Step,
    /// Linear interpolation.
    Linear,
    /// A cubic spline with tangents. A channel without tangents gets ones that make it smooth.
    CubicSpline,
}

/// How a layer changes the values below it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LayerKind {
    /// Its keys are offsets in parent space.
    #[default]
    Additive,
    /// Its keys are poses, which replace the values below.
    Override,
}

impl From<LayerKind> for LayerMode {
    fn from(kind: LayerKind) -> Self {
        match kind {
            LayerKind::Additive => Self::Additive,
            LayerKind::Override => Self::Override,
        }
    }
}

impl From<LayerMode> for LayerKind {
    fn from(mode: LayerMode) -> Self {
        match mode {
            LayerMode::Additive => Self::Additive,
            LayerMode::Override => Self::Override,
        }
    }
}

impl KeyInterpolation {
    /// Returns the interpolation as edits name it. The nearest key, which only some formats have, becomes the key before.
    pub(crate) fn of(interpolation: Interpolation) -> Self {
        match interpolation {
            Interpolation::Step | Interpolation::Closest => Self::Step,
            Interpolation::Linear => Self::Linear,
            Interpolation::CubicSpline => Self::CubicSpline,
        }
    }
}

impl From<KeyInterpolation> for dragonfly_anim::data::Interpolation {
    fn from(between: KeyInterpolation) -> Self {
        match between {
            KeyInterpolation::Step => Self::Step,
            KeyInterpolation::Linear => Self::Linear,
            KeyInterpolation::CubicSpline => Self::CubicSpline,
        }
    }
}
