//! Nodes: their order, their names, and which of them are bones.

use super::curves::animated_elements;
use crate::code::FBX_INVALID;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::NODES;
use ufbx::Node;

/// The nodes in the order of bones, and the bone of each.
pub(super) struct BoneLayout {
    /// Nodes by their number, parents first, depth first; the root of the scene is not among them.
    pub(super) order: Vec<u32>,
    /// Bone of each node by its number.
    pub(super) bones: Vec<Option<BoneIndex>>,
    /// Node of each bone.
    pub(super) nodes: Vec<u32>,
}

impl BoneLayout {
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
) -> Result<BoneLayout, ImportError> {
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
    Ok(BoneLayout { order, bones, nodes })
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
