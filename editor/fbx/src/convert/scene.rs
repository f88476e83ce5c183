//! The skeleton at rest, and the meshes placed in the scene.

use super::curves::blinking_elements;
use super::mesh::FbxMesh;
use super::nodes::{BoneLayout, is_top, node_name, place_of};
use super::skin::FbxSkin;
use super::space::{FbxSpace, Pose64, dmat4, warn_numbers};
use crate::code::{FBX_INVALID, FBX_NOT_SHOWN};
use dragonfly_anim::data::{Bone, BoneIndex, MeshInstance, Skeleton};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use glam::{DMat4, Mat4};
use ufbx::Node;

/// Returns the skeleton and the placed meshes.
pub(super) fn build(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    layout: &BoneLayout,
    skins: &[FbxSkin],
    meshes: &[FbxMesh],
    context: &ImportContext<'_>,
) -> Result<(Skeleton, Vec<MeshInstance>), ImportError> {
    let place = Place::Pointer("/nodes".to_owned());
    let mut bones: Vec<Bone> = context.vec(&place, layout.nodes.len())?;
    let mut globals: Vec<DMat4> = context.vec(&place, layout.nodes.len())?;
    for &index in &layout.nodes {
        context.work(1)?;
        let node = &scene.nodes[index as usize];
        let (pose, is_fixed) = Pose64::of(&node.local_transform);
        if is_fixed {
            warn_numbers(place_of(node), context);
        }
        let rest = space.local(&pose, is_top(node));
        let parent = node.parent.as_ref().and_then(|parent| layout.bone_of(parent));
        let to_root =
            parent.map_or(DMat4::IDENTITY, |parent| globals[parent as usize]) * rest.to_matrix().as_dmat4();
        if !to_root.as_mat4().is_finite() {
            let reason = "the product of the transforms of this node and its ancestors overflows".to_owned();
            return Err(ImportError::Invalid {
                place: Place::Pointer(place_of(node)),
                code: FBX_INVALID,
                reason,
            });
        }
        let name = node_name(node);
        context.charge(&place, name.len() as u64)?;
        bones.push(Bone { name, parent, rest, rest_matrix: None, offset: inverse(to_root), node: None });
        globals.push(to_root);
    }
    for skin in skins.iter().rev() {
        context.work(skin.skin.bones.len())?;
        // Iterated backwards, so that the first skin and joint are used.
        for (&bone, &offset) in skin.skin.bones.iter().zip(&skin.skin.offsets).rev() {
            bones[bone as usize].offset = offset;
        }
    }
    let skeleton = Skeleton { bones };
    let instances = instances(scene, space, layout, skins, meshes, context)?;
    Ok((skeleton, instances))
}

/// Returns the inverse; the identity if there is none.
fn inverse(matrix: DMat4) -> Mat4 {
    let determinant = matrix.determinant();
    let inverse = matrix.inverse().as_mat4();
    if determinant != 0.0 && determinant.is_finite() && inverse.is_finite() {
        inverse
    } else {
        Mat4::IDENTITY
    }
}

/// Returns one instance for each visible node with a mesh.
fn instances(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    layout: &BoneLayout,
    skins: &[FbxSkin],
    meshes: &[FbxMesh],
    context: &ImportContext<'_>,
) -> Result<Vec<MeshInstance>, ImportError> {
    let mut instances = Vec::new();
    let blinking = blinking_elements(scene, context)?;
    for &index in &layout.order {
        context.work(1)?;
        let node = &scene.nodes[index as usize];
        let Some(mesh) = &node.mesh else { continue };
        let mesh = mesh.element.typed_id;
        let Some(read) = meshes.get(mesh as usize) else { continue };
        if !node.visible && !blinking.contains(&node.element.element_id) {
            context.warn(
                Place::Pointer(place_of(node)),
                FBX_NOT_SHOWN,
                "the mesh is hidden in the file and left out",
            );
            continue;
        }
        let skin = skins.iter().position(|skin| skin.mesh == mesh).map(|skin| skin as u32);
        let (bone, carrier) = carrier(node, layout);
        let to_bone = match carrier {
            Some(carrier) => space.matrix(relative(node, carrier)),
            None => space.in_scene(dmat4(&node.geometry_to_world)),
        };
        let to_bone = if to_bone.is_finite() { to_bone } else { Mat4::IDENTITY };
        let morph_weights = read.mesh.morph_weights.clone();
        context.charge(
            &Place::Pointer(place_of(node)),
            (size_of::<MeshInstance>() + 4 * morph_weights.len()) as u64,
        )?;
        instances.push(MeshInstance { mesh, node: None, skin, bone, to_bone, morph_weights });
    }
    Ok(instances)
}

/// Returns the nearest bone above a node, itself included.
fn carrier<'a>(node: &'a Node, layout: &BoneLayout) -> (Option<BoneIndex>, Option<&'a Node>) {
    let mut at = Some(node);
    while let Some(node) = at {
        if let Some(bone) = layout.bone_of(node) {
            return (Some(bone), Some(node));
        }
        at = node.parent.as_deref();
    }
    (None, None)
}

/// Returns the matrix from the geometry of `node` to its ancestor `carrier`.
fn relative(node: &Node, carrier: &Node) -> DMat4 {
    if std::ptr::eq(node, carrier) {
        return dmat4(&node.geometry_to_node);
    }
    dmat4(&carrier.node_to_world).inverse() * dmat4(&node.geometry_to_world)
}
