//! Copied keys: their values, independent of where they were.

use super::map_references::map_references;
use super::{BoneRef, KeyInterpolation, MeshRef, Property, ShapeRef};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The copied keys of one channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedChannel {
    /// The bone.
    pub bone: BoneRef,
    /// The channel.
    pub property: Property,
    /// The interpolation of the copied channel. It is used only for a channel without keys; other channels keep
    /// theirs.
    pub interpolation: KeyInterpolation,
    /// The keys.
    pub keys: Vec<CopiedKey>,
}

map_references!(CopiedChannel { bone, property, interpolation, keys });

/// One key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedKey {
    /// Seconds after the time at which they are pasted. In double precision, so that keys pasted at their old time are
    /// there exactly.
    pub after: f64,
    /// The value: three numbers, for rotations four.
    pub value: Vec<f32>,
    /// In-tangent in units per second; chosen so that a spline is smooth where absent. Ignored for other
    /// interpolations.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<Vec<f32>>,
    /// Out-tangent.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<Vec<f32>>,
}

/// The copied keys of the shape keys of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedShapes {
    /// The mesh. Where the model does not have it, the first mesh that has a shape key of the name gets the keys of that.
    pub mesh: MeshRef,
    /// The shape keys, in the order of the weights.
    pub shapes: Vec<ShapeRef>,
    /// The interpolation of the copied keys, which is that of all shape keys of the mesh. It is used only for a mesh without keys.
    pub interpolation: KeyInterpolation,
    /// The keys.
    pub keys: Vec<CopiedShapeKey>,
}

/// One key of all copied shape keys of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CopiedShapeKey {
    /// Seconds after the time at which they are pasted.
    pub after: f64,
    /// A weight for each shape key.
    pub weights: Vec<f32>,
    /// In-tangents per second; chosen so that a spline is smooth where absent. Ignored for other interpolations.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<Vec<f32>>,
    /// Out-tangents.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<Vec<f32>>,
}
