//! Humanoid models: the bones of the parts of the body, and named facial expressions.

use super::BoneIndex;

/// The humanoid bones and facial expressions of a VRM file; empty for all other models.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias("VRM", "humanoid"))]
pub struct Avatar {
    /// Humanoid bones, each name and each bone once.
    pub bones: Vec<HumanBone>,
    /// Facial expressions, each name once.
    pub expressions: Vec<FaceExpression>,
    /// Whether the figure looks along -Z at rest (VRM 0.x), not along +Z. The data is not turned, so that a save keeps
    /// the bytes of the file.
    pub faces_minus_z: bool,
}

impl Avatar {
    /// Returns whether there are neither bones nor expressions.
    pub fn is_empty(&self) -> bool {
        self.bones.is_empty() && self.expressions.is_empty()
    }

    /// Returns the bone of a humanoid name, such as `leftUpperArm`.
    pub fn bone(&self, name: &str) -> Option<BoneIndex> {
        self.bones.iter().find(|bone| bone.name == name).map(|bone| bone.bone)
    }
}

/// A bone that is a part of the body.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HumanBone {
    /// Name of the part in VRM 1.0: `hips`, `leftUpperArm`, `rightThumbMetacarpal`. Those of VRM 0.x are converted.
    pub name: String,
    /// The bone.
    pub bone: BoneIndex,
}

/// A facial expression, which has a weight of 0..1.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias = "blend shape group")]
pub struct FaceExpression {
    /// Name: for those that VRM knows the one of VRM 1.0 (`happy`, `blinkLeft`, `aa`), else that of the file.
    pub name: String,
    /// Morph targets that the expression sets.
    pub binds: Vec<ExpressionBind>,
    /// Bone whose x translation is the weight over time, in an animation file without meshes; `None` for a model.
    pub weight_bone: Option<BoneIndex>,
}

/// A morph target of an expression.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpressionBind {
    /// Index of the mesh instance.
    pub instance: u32,
    /// Number of the morph target in the mesh.
    pub target: u32,
    /// Weight of the morph target where that of the expression is 1.
    pub weight: f32,
}
