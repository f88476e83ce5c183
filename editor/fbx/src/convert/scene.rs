//! Nodes: which of them are bones, and where the meshes are.

use super::mesh::ReadMesh;
use super::skin::ReadSkin;
use super::space::{FbxSpace, Pose64, dmat4, warn_numbers};
use super::take::animated_elements;
use crate::code::{FBX_INVALID, FBX_NOT_SHOWN};
use dragonfly_anim::data::{Bone, BoneIndex, MeshInstance, Skeleton};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::NODES;
use glam::{DMat4, Mat4};
use ufbx::Node;

/// The nodes in the order of bones, and the bone of each.
pub(super) struct SceneLayout {
    /// Nodes by their number, parents first, depth first; the root of the scene is not among them.
    pub(super) order: Vec<u32>,
    /// Bone of each node by its number.
    pub(super) bones: Vec<Option<BoneIndex>>,
    /// Node of each bone.
    pub(super) nodes: Vec<u32>,
}

impl SceneLayout {
    /// Returns the bone of a node.
    pub(super) fn bone_of(&self, node: &Node) -> Option<BoneIndex> {
        self.bones.get(node.element.typed_id as usize).copied().flatten()
    }
}

/// Returns the name of a node; helpers that the parser added are named after the node that they help.
pub(super) fn node_name(node: &Node) -> String {
    let parent = || node.parent.as_ref().map_or("", |parent| &*parent.element.name);
    if node.is_scale_helper {
        format!("{} scale", parent())
    } else if node.is_geometry_transform_helper {
        format!("{} geometry", parent())
    } else {
        node.element.name.to_string()
    }
}

/// Returns the place of a node in messages.
pub(super) fn place_of(node: &Node) -> String {
    format!("/nodes/{}", node_name(node))
}

/// Returns whether the parent of a node is the scene itself.
pub(super) fn is_top(node: &Node) -> bool {
    node.parent.as_ref().is_none_or(|parent| parent.is_root)
}

/// Orders the nodes and numbers the bones: joints of skins, nodes marked as bones, animated nodes, and the ancestors of all
/// of them. `unweighted` contains, for each mesh, whether its own node must carry some of its vertices.
pub(super) fn layout(
    scene: &ufbx::Scene,
    unweighted: &[bool],
    context: &ImportContext<'_>,
) -> Result<SceneLayout, ImportError> {
    let count = scene.nodes.len();
    let place = Place::Pointer("/nodes".to_owned());
    if count > NODES {
        return Err(ImportError::TooLarge { place, what: "nodes", size: count as u64, limit: NODES as u64 });
    }
    let order = order(scene, count, context)?;
    let mut is_bone = context.filled(&place, count, false)?;
    let mut mark = |node: &Node| {
        if let Some(flag) = is_bone.get_mut(node.element.typed_id as usize) {
            *flag = true;
        }
    };
    let animated = animated_elements(scene, context)?;
    for node in &scene.nodes {
        context.work(1)?;
        let helper = node.parent.as_ref().and_then(|parent| parent.scale_helper.as_ref());
        let moves = |node: &Node| animated.contains(&node.element.element_id);
        let carries = node
            .mesh
            .as_ref()
            .is_some_and(|mesh| unweighted.get(mesh.element.typed_id as usize).copied().unwrap_or_default());
        // The translation of a node is scaled by the helper of its parent.
        if node.bone.is_some() || moves(node) || helper.is_some_and(|helper| moves(helper)) || carries {
            mark(node);
        }
    }
    for cluster in &scene.skin_clusters {
        context.work(1)?;
        if let Some(bone) = &cluster.bone_node {
            mark(bone);
        }
    }
    let node = |index: u32| &scene.nodes[index as usize];
    for &index in order.iter().rev() {
        if is_bone[index as usize]
            && let Some(parent) = &node(index).parent
        {
            is_bone[parent.element.typed_id as usize] = true;
        }
    }
    let mut bones = context.filled(&place, count, None)?;
    let mut nodes = Vec::new();
    for &index in order.iter().filter(|&&index| is_bone[index as usize]) {
        bones[index as usize] = Some(nodes.len() as BoneIndex);
        nodes.push(index);
    }
    context.charge(&place, 4 * nodes.len() as u64)?;
    Ok(SceneLayout { order, bones, nodes })
}

/// Returns the numbers of all nodes except the root, depth first.
fn order(scene: &ufbx::Scene, count: usize, context: &ImportContext<'_>) -> Result<Vec<u32>, ImportError> {
    let place = Place::Pointer("/nodes".to_owned());
    let mut order = context.vec(&place, count)?;
    let mut waiting: Vec<&Node> = scene.root_node.children.into_iter().collect();
    waiting.reverse();
    while let Some(node) = waiting.pop() {
        context.work(1)?;
        if order.len() >= count || node.element.typed_id as usize >= count {
            let reason = "the nodes are not a tree".to_owned();
            return Err(ImportError::Invalid { place, code: FBX_INVALID, reason });
        }
        order.push(node.element.typed_id);
        let first = waiting.len();
        waiting.extend(&node.children);
        waiting[first..].reverse();
    }
    Ok(order)
}

/// Returns the skeleton and the placed meshes.
pub(super) fn build(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    layout: &SceneLayout,
    skins: &[ReadSkin],
    meshes: &[ReadMesh],
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
    layout: &SceneLayout,
    skins: &[ReadSkin],
    meshes: &[ReadMesh],
    context: &ImportContext<'_>,
) -> Result<Vec<MeshInstance>, ImportError> {
    let mut instances = Vec::new();
    for &index in &layout.order {
        context.work(1)?;
        let node = &scene.nodes[index as usize];
        let Some(mesh) = &node.mesh else { continue };
        let mesh = mesh.element.typed_id;
        let Some(read) = meshes.get(mesh as usize) else { continue };
        if !node.visible {
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
fn carrier<'a>(node: &'a Node, layout: &SceneLayout) -> (Option<BoneIndex>, Option<&'a Node>) {
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
