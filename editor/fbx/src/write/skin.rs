//! Skins: clusters of vertices, and the pose in which they are bound.

use super::bones::LocalPose;
use super::losses::FbxLosses;
use super::node::FbxNode;
use super::scene::{ObjectId, SceneWriter};
use super::space::FileSpace;
use dragonfly_anim::data::{Mesh, ModelData, Skin};
use glam::DMat4;
use std::collections::BTreeMap;

/// Largest difference between two matrices that are taken for the same, relative to their largest number or to 1.
const SAME: f64 = 1e-5;

/// A skin in the scene.
pub(super) struct BoundSkin {
    /// The node of its mesh.
    pub(super) node: LocalPose,
    /// The bones in the scene, in the pose in which the skin is bound; one for each joint.
    pub(super) bones: Vec<DMat4>,
}

fn is_same(a: DMat4, b: DMat4) -> bool {
    let (a, b) = (a.to_cols_array(), b.to_cols_array());
    let size = b.iter().fold(1.0_f64, |size, number| size.max(number.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * size)
}

/// Returns the inverse of a matrix; `None` where it has none.
fn inverse(matrix: DMat4) -> Option<DMat4> {
    let determinant = matrix.determinant();
    let inverse = matrix.inverse();
    (determinant != 0.0 && determinant.is_finite() && inverse.is_finite()).then_some(inverse)
}

/// Returns where a skin is bound: such that the topmost joint is bound where it rests. `rest` are the bones at rest.
pub(super) fn bind(skin: &Skin, rest: &[DMat4]) -> BoundSkin {
    let at_rest = |bone: u32| rest.get(bone as usize).copied().unwrap_or(DMat4::IDENTITY);
    let offset = |joint: usize| skin.offsets.get(joint).map_or(DMat4::IDENTITY, |offset| offset.as_dmat4());
    let top = (0..skin.bones.len()).min_by_key(|&joint| skin.bones[joint]);
    let mesh = top.map_or(DMat4::IDENTITY, |joint| at_rest(skin.bones[joint]) * offset(joint));
    let mesh = if is_same(mesh, DMat4::IDENTITY) { DMat4::IDENTITY } else { mesh };
    let none = LocalPose::of(&dragonfly_anim::data::Transform::IDENTITY);
    let node = LocalPose::of_matrix(mesh).unwrap_or(none);
    let mesh = node.matrix();
    let bound = |joint: usize, bone: u32| {
        let bound = inverse(offset(joint)).map(|inverse| mesh * inverse);
        match bound {
            Some(bound) if is_same(bound, at_rest(bone)) => at_rest(bone),
            Some(bound) => bound,
            None => at_rest(bone),
        }
    };
    let bones = skin.bones.iter().enumerate().map(|(joint, &bone)| bound(joint, bone)).collect();
    BoundSkin { node, bones }
}

/// A skin, and the objects that it needs.
pub(super) struct SkinSource<'a> {
    pub(super) skin: &'a Skin,
    pub(super) mesh: &'a Mesh,
    pub(super) bound: &'a BoundSkin,
    pub(super) space: &'a FileSpace,
    pub(super) bones: &'a [ObjectId],
}

impl SkinSource<'_> {
    /// Adds the skin of a geometry.
    pub(super) fn add(
        &self,
        scene: &mut SceneWriter,
        geometry: ObjectId,
        place: &str,
        losses: &mut FbxLosses,
    ) {
        let children = [
            FbxNode::new("Version").with(101),
            FbxNode::new("Link_DeformAcuracy").with(50.0),
            FbxNode::new("SkinningType").with("Linear"),
        ];
        let deformer = scene.object("Deformer", &self.skin.name, ("Deformer", "Skin"), children);
        scene.connect(deformer, geometry);
        let mut weights = self.weights();
        for (joint, &bone) in self.skin.bones.iter().enumerate() {
            let Some(&node) = self.bones.get(bone as usize) else { continue };
            let offset = self.skin.offsets.get(joint).map_or(DMat4::IDENTITY, |offset| offset.as_dmat4());
            if inverse(offset).is_none() {
                losses.add(place, "the bind pose of a joint cannot be computed; its rest pose is stored");
            }
            let bound = self.bound.bones.get(joint).copied().unwrap_or(DMat4::IDENTITY);
            let matrix = |matrix: DMat4| self.space.matrix(matrix).to_cols_array().to_vec();
            let mut children =
                vec![FbxNode::new("Version").with(100), FbxNode::new("UserData").with("").with("")];
            if let Some((vertices, weights)) = weights.remove(&joint) {
                children.push(FbxNode::new("Indexes").with(vertices));
                children.push(FbxNode::new("Weights").with(weights));
            }
            children.push(FbxNode::new("Transform").with(matrix(offset)));
            children.push(FbxNode::new("TransformLink").with(matrix(bound)));
            let cluster = scene.object("Deformer", "", ("SubDeformer", "Cluster"), children);
            scene.connect(cluster, deformer);
            scene.connect(node, cluster);
        }
    }

    /// Returns the vertices and weights of each joint.
    fn weights(&self) -> BTreeMap<usize, (Vec<i32>, Vec<f64>)> {
        let mut all: BTreeMap<usize, (Vec<i32>, Vec<f64>)> = BTreeMap::new();
        let mut number = 0;
        for primitive in &self.mesh.primitives {
            for vertex in 0..primitive.vertices.len() {
                for influence in primitive.vertices.influences_of(vertex) {
                    if influence.weight > 0.0 {
                        let (vertices, weights) = all.entry(usize::from(influence.joint)).or_default();
                        let weight = f64::from(influence.weight);
                        match (vertices.last(), weights.last_mut()) {
                            (Some(&last), Some(sum)) if last == number => *sum += weight,
                            _ => {
                                vertices.push(number);
                                weights.push(weight);
                            }
                        }
                    }
                }
                number += 1;
            }
        }
        all
    }
}

/// Adds the pose in which all skins are bound. `meshes` are the nodes of skinned meshes with their skins.
pub(super) fn add_bind_pose(
    scene: &mut SceneWriter,
    space: &FileSpace,
    model: &ModelData,
    (bones, rest): (&[ObjectId], &[DMat4]),
    meshes: &[(ObjectId, &Skin, &BoundSkin)],
) {
    if meshes.is_empty() {
        return;
    }
    let mut matrices: BTreeMap<ObjectId, DMat4> = BTreeMap::new();
    for (node, skin, bound) in meshes {
        matrices.insert(*node, bound.node.matrix());
        for (&bone, &matrix) in skin.bones.iter().zip(&bound.bones) {
            if let Some(&node) = bones.get(bone as usize) {
                matrices.entry(node).or_insert(matrix);
            }
        }
    }
    // Programs want the nodes above the joints too.
    let joints = meshes.iter().flat_map(|(_, skin, _)| &skin.bones);
    let mut is_needed = vec![false; bones.len()];
    for &joint in joints {
        if let Some(flag) = is_needed.get_mut(joint as usize) {
            *flag = true;
        }
    }
    for (index, bone) in model.animation.skeleton.bones.iter().enumerate().rev() {
        if is_needed[index]
            && let Some(flag) = bone.parent.and_then(|parent| is_needed.get_mut(parent as usize))
        {
            *flag = true;
        }
    }
    for ((&node, &matrix), _) in bones.iter().zip(rest).zip(&is_needed).filter(|(_, needed)| **needed) {
        matrices.entry(node).or_insert(matrix);
    }
    let nodes = matrices.iter().map(|(&node, &matrix)| {
        let matrix = space.matrix(matrix).to_cols_array().to_vec();
        FbxNode::new("PoseNode").value("Node", node).value("Matrix", matrix)
    });
    let nodes: Vec<FbxNode> = nodes.collect();
    let head = [
        FbxNode::new("Type").with("BindPose"),
        FbxNode::new("Version").with(100),
        FbxNode::new("NbPoseNodes").with(nodes.len() as i32),
    ];
    scene.object("Pose", "BIND_POSES", ("Pose", "BindPose"), head.into_iter().chain(nodes));
}
