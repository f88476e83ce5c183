//! Parts of poses, as edits name them.

use super::BoneRef;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parts of a bone's pose; what is left out stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BonePose {
    /// Which bone.
    pub bone: BoneRef,
    /// Metres, parent space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<[f32; 3]>,
    /// Quaternion x, y, z, w, parent space; made unit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f32; 4]>,
    /// Factors per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f32; 3]>,
}

/// Poses at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseAt {
    /// Seconds.
    pub time: f32,
    /// The poses wanted; one for each bone.
    pub poses: Vec<BonePose>,
}
