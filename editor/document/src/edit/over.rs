//! The keys that an offset is for, and how it fades out around them.

use super::{Arbitrary, KeySet};
use dragonfly_anim::offset::{Falloff, FalloffShape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The keys that an offset is for.
///
/// In JSON `"take"`, `{"range": {"from": 0.5, "to": 1}}` or `{"keys": [...]}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum OffsetScope {
    /// All keys of the take. A channel without keys gets one at the start of the take, with the offset value that is shown there.
    Take,
    /// The keys from one time to another. With a falloff, channels get keys at both ends, and at the ends of the falloff, so that nothing
    /// changes beyond it; without, only the keys inside change.
    Range(OffsetRange),
    /// These keys, of the bones that get an offset.
    Keys(Vec<KeySet>),
}

/// A range of time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetRange {
    /// Seconds: the first time that gets the whole offset.
    pub from: f32,
    /// Seconds: the last time that gets the whole offset.
    pub to: f32,
}

/// The keys of shape keys that an offset is for.
///
/// In JSON `"take"`, `{"range": {"from": 0.5, "to": 1}}` or `{"keys": [[0.5, 1]]}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShapeScope {
    /// All keys of the take. A mesh without keys gets one at the start of the take.
    Take,
    /// The keys from one time to another. With a falloff, meshes get keys at both ends, and at the ends of the falloff, so that nothing
    /// changes beyond it; without, only the keys inside change.
    Range(OffsetRange),
    /// The keys in these stretches of time, start and end in seconds.
    Keys(Vec<[f32; 2]>),
}

/// The distance and the curve by which an offset fades out around its keys.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OffsetFalloff {
    /// Seconds at which nothing of it is left.
    pub seconds: f32,
    /// The curve of the weights.
    #[serde(default)]
    pub shape: FadeShape,
}

/// The curve by which an offset fades out; `x` is 1 at its keys and 0 where it ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FadeShape {
    /// `x`
    Linear,
    /// `3 x² - 2 x³`
    #[default]
    Smooth,
    /// `√(2 x - x²)`
    Sphere,
    /// `x²`
    Sharp,
}

impl FadeShape {
    /// All shapes, in the order of menus.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Smooth, Self::Sphere, Self::Sharp];
}

impl From<FadeShape> for FalloffShape {
    fn from(shape: FadeShape) -> Self {
        match shape {
            FadeShape::Linear => Self::Linear,
            FadeShape::Smooth => Self::Smooth,
            FadeShape::Sphere => Self::Sphere,
            FadeShape::Sharp => Self::Sharp,
        }
    }
}

impl From<OffsetFalloff> for Falloff {
    fn from(falloff: OffsetFalloff) -> Self {
        Self { seconds: falloff.seconds, shape: falloff.shape.into() }
    }
}

impl OffsetScope {
    /// Returns its keys where their number is unknown: `keys in the whole take`.
    pub(crate) fn keys_text(&self) -> &'static str {
        match self {
            Self::Take => "keys in the whole take",
            Self::Range(_) => "keys in the range",
            Self::Keys(_) => "selected keys",
        }
    }

    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        match from.below(3) {
            0 => Self::Take,
            1 => {
                let start = from.time();
                Self::Range(OffsetRange { from: start, to: start + from.between(-0.1, 0.6) })
            }
            _ => Self::Keys(from.keys()),
        }
    }
}

impl ShapeScope {
    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        match OffsetScope::arbitrary(from) {
            OffsetScope::Take => Self::Take,
            OffsetScope::Range(range) => Self::Range(range),
            OffsetScope::Keys(_) => Self::Keys(from.shapes()),
        }
    }
}

impl OffsetFalloff {
    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { seconds: from.between(-0.05, 0.5), shape: from.choice(FadeShape::ALL) }
    }
}
