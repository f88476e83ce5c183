//! Poses of single bones.

use super::map_references::map_references;
use super::{BoneRef, Property};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parts of the pose of a bone; absent parts stay as they are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BonePose {
    /// The bone.
    pub bone: BoneRef,
    /// Meters, parent space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<[f32; 3]>,
    /// Quaternion x, y, z, w, parent space; it is normalized.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<[f32; 4]>,
    /// Factors per axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<[f32; 3]>,
}

map_references!(BonePose { bone, translation, rotation, scale });

impl BonePose {
    /// Returns whether the pose has this part.
    pub(crate) fn gives(&self, property: Property) -> bool {
        match property {
            Property::Translation => self.translation.is_some(),
            Property::Rotation => self.rotation.is_some(),
            Property::Scale => self.scale.is_some(),
        }
    }
}

/// Poses at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseAt {
    /// Seconds.
    pub time: f32,
    /// The wanted poses; one for each bone.
    pub poses: Vec<BonePose>,
}

map_references!(PoseAt { time, poses });
