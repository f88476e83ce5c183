//! Bones: a node for each, as a limb of a skeleton or as a group.

use super::euler::EulerAngles;
use super::node::{FbxNode, setting};
use super::scene::{ObjectId, SCENE, SceneWriter};
use super::space::FileSpace;
use dragonfly_anim::data::{ModelData, Skeleton};
use glam::{DMat4, DQuat, DVec3};

/// A transform in double precision and in the units of the model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalPose {
    pub(super) translation: DVec3,
    pub(super) rotation: DQuat,
    pub(super) scale: DVec3,
}

/// Largest difference, relative to the largest number, between a matrix and its translation, rotation and scale.
const SHEAR: f64 = 1e-5;

impl LocalPose {
    /// Returns the transform of a matrix; `None` where it has none: it is sheared or an axis has no length.
    pub(super) fn of_matrix(matrix: DMat4) -> Option<Self> {
        let determinant = matrix.determinant();
        if !matrix.is_finite() || determinant == 0.0 || !determinant.is_finite() {
            return None;
        }
        let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
        let again = DMat4::from_scale_rotation_translation(scale, rotation, translation);
        let size = matrix.x_axis.length().max(matrix.y_axis.length()).max(matrix.z_axis.length());
        let is_exact = [0, 1, 2]
            .iter()
            .all(|&axis| (matrix.col(axis) - again.col(axis)).abs().max_element() <= SHEAR * size);
        (is_exact && rotation.is_finite()).then_some(Self { translation, rotation, scale })
    }

    /// Returns the transform of a bone or an object.
    pub(super) fn of(transform: &dragonfly_anim::data::Transform) -> Self {
        Self {
            translation: transform.translation.as_dvec3(),
            rotation: super::euler::settled(transform.rotation.as_dquat()),
            scale: transform.scale.as_dvec3(),
        }
    }

    /// Returns the matrix.
    pub(super) fn matrix(&self) -> DMat4 {
        DMat4::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

/// Returns the matrices of all bones in the scene at rest.
pub(super) fn rest_matrices(skeleton: &Skeleton) -> Vec<DMat4> {
    let poses: Vec<LocalPose> = skeleton.bones.iter().map(|bone| LocalPose::of(&bone.rest)).collect();
    bone_matrices(skeleton, &poses)
}

/// Returns the matrices of all bones in the scene in these poses.
pub(super) fn bone_matrices(skeleton: &Skeleton, poses: &[LocalPose]) -> Vec<DMat4> {
    let mut matrices: Vec<DMat4> = Vec::with_capacity(poses.len());
    for (bone, pose) in skeleton.bones.iter().zip(poses) {
        let parent = bone.parent.and_then(|parent| matrices.get(parent as usize).copied());
        matrices.push(parent.unwrap_or(DMat4::IDENTITY) * pose.matrix());
    }
    matrices
}

/// Adds a node of the scene.
pub(super) fn add_node(
    scene: &mut SceneWriter,
    space: &FileSpace,
    name: &str,
    kind: &str,
    pose: &LocalPose,
) -> ObjectId {
    let vector =
        |name: &str, value: DVec3| setting(name, name, "", "A").with(value.x).with(value.y).with(value.z);
    let angles = EulerAngles::of(space.rotation(pose.rotation)).degrees();
    let properties = FbxNode::new("Properties70").containing([
        setting("RotationActive", "bool", "", "").with(1),
        // The matrix of a node is the product of those above it.
        setting("InheritType", "enum", "", "").with(1),
        setting("ScalingMax", "Vector3D", "Vector", "").with(0.0).with(0.0).with(0.0),
        setting("DefaultAttributeIndex", "int", "Integer", "").with(0),
        vector("Lcl Translation", space.position(pose.translation)),
        vector("Lcl Rotation", angles),
        vector("Lcl Scaling", space.factors(pose.scale)),
    ]);
    let children = [FbxNode::new("Version").with(232), properties, FbxNode::new("Shading").with(true)];
    let children = children.into_iter().chain([FbxNode::new("Culling").with("CullingOff")]);
    scene.object("Model", name, ("Model", kind), children)
}

/// Returns whether each bone is a limb of a skeleton. The others are groups: the nodes above a skeleton, and animated objects of a
/// model whose bones deform nothing.
fn limbs(model: &ModelData) -> Vec<bool> {
    let bones = &model.animation.skeleton.bones;
    let mut is_limb = vec![model.meshes.is_empty(); bones.len()];
    for joint in model.skins.iter().flat_map(|skin| &skin.bones) {
        if let Some(flag) = is_limb.get_mut(*joint as usize) {
            *flag = true;
        }
    }
    let mut has_bones = vec![false; bones.len()];
    for (index, bone) in bones.iter().enumerate() {
        if let Some(parent) = bone.parent.map(|parent| parent as usize).filter(|&parent| parent < index) {
            is_limb[index] |= is_limb[parent];
            has_bones[parent] = true;
        }
    }
    let moves = |bone: usize| {
        let mut takes = model.animation.takes.iter();
        takes.any(|take| take.tracks.get(bone).is_some_and(|track| !track.is_empty()))
    };
    // A group that nothing moves would not be a bone when it is read again.
    (0..bones.len()).map(|bone| is_limb[bone] || !(has_bones[bone] || moves(bone))).collect()
}

/// Adds all bones under these names. Returns their nodes.
pub(super) fn add_bones(
    scene: &mut SceneWriter,
    space: &FileSpace,
    model: &ModelData,
    names: &[String],
    all_limbs: bool,
) -> Vec<ObjectId> {
    let bones = &model.animation.skeleton.bones;
    let mut nodes: Vec<ObjectId> = Vec::with_capacity(bones.len());
    for ((bone, name), is_limb) in bones.iter().zip(names).zip(limbs(model)) {
        let (kind, flags) = if is_limb || all_limbs { ("LimbNode", "Skeleton") } else { ("Null", "Null") };
        let properties = match kind {
            "Null" => FbxNode::new("Properties70"),
            _ => FbxNode::new("Properties70")
                .containing([setting("Size", "double", "Number", "").with(0.05 * space.units())]),
        };
        let attribute = [properties, FbxNode::new("TypeFlags").with(flags)];
        let attribute = scene.object("NodeAttribute", name, ("NodeAttribute", kind), attribute);
        let node = add_node(scene, space, name, kind, &LocalPose::of(&bone.rest));
        scene.connect(attribute, node);
        let parent = bone.parent.and_then(|parent| nodes.get(parent as usize).copied());
        scene.connect(node, parent.unwrap_or(SCENE));
        nodes.push(node);
    }
    nodes
}
