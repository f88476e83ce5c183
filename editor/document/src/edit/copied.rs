//! Keys as they were copied: by what they hold, not by where they lay.

use super::{Between, BoneRef, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keys of one channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedChannel {
    /// Which bone.
    pub bone: BoneRef,
    /// Which channel.
    pub property: Property,
    /// How the channel found what lay between them. Counts where the channel they come into has no keys; one with keys
    /// keeps its own way.
    pub interpolation: Between,
    /// The keys.
    pub keys: Vec<CopiedKey>,
}

/// One key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedKey {
    /// Seconds after the time at which all are put in; in double precision, so that keys put back where they were lie
    /// there to the bit.
    pub after: f64,
    /// Three numbers, for rotations four.
    pub value: Vec<f32>,
    /// Tangent arriving, in units a second; none: chosen so that a spline runs smoothly. Without a spline it says nothing.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<Vec<f32>>,
    /// Tangent leaving.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<Vec<f32>>,
}
