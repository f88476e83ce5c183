//! Turns nodes into bones and instances: what is animated, and what is shown.

use super::accessor::{GltfDocument, invalid, unresolved};
use super::check as code;
use super::graph::Graph;
use super::mesh::ReadMesh;
use super::morph::fitted;
use super::node::{LocalTransform, inverse};
use crate::data::{Bone, BoneIndex, MeshInstance, Skeleton, Skin};
use crate::format::{ImportError, Place};
use glam::Mat4;

/// Bones and instances, and the mapping from nodes to them.
pub(super) struct SceneLayout {
    pub(super) skeleton: Skeleton,
    pub(super) instances: Vec<MeshInstance>,
    /// Bone of each node.
    pub(super) bones: Vec<Option<BoneIndex>>,
    /// Number of morph targets of each mesh.
    morph_targets: Vec<usize>,
}

impl SceneLayout {
    /// Returns the instance of node `node`; `None` for one without mesh, or outside the scene.
    pub(super) fn instance_of(&self, node: usize) -> Option<u32> {
        // Instances are in the order of the nodes.
        let found = self.instances.binary_search_by_key(&Some(node as u32), |instance| instance.node);
        found.ok().map(|index| index as u32)
    }

    /// Returns the number of morph targets of the mesh of `node`.
    pub(super) fn morph_targets_of(&self, document: &GltfDocument<'_>, node: usize) -> usize {
        let mesh = document.root.nodes[node].mesh;
        mesh.and_then(|mesh| self.morph_targets.get(mesh.value()).copied()).unwrap_or(0)
    }
}

/// Numbers the bones: parents first, depth first from the roots. Also sets `is_bone` for the ancestors.
pub(super) fn number_bones(
    document: &GltfDocument<'_>,
    graph: &Graph,
    is_bone: &mut [bool],
) -> Result<Vec<Option<BoneIndex>>, ImportError> {
    for &node in graph.order.iter().rev() {
        if let Some(parent) = graph.parents[node as usize] {
            is_bone[parent as usize] |= is_bone[node as usize];
        }
    }
    let mut bones = document.context.filled(&Place::Pointer("/nodes".to_owned()), is_bone.len(), None)?;
    let moving = graph.order.iter().filter(|&&node| is_bone[node as usize]);
    for (bone, &node) in moving.enumerate() {
        bones[node as usize] = Some(bone as BoneIndex);
    }
    Ok(bones)
}

/// Returns the bones. A bone's offset is that of the first skin that uses it.
pub(super) fn skeleton(
    document: &GltfDocument<'_>,
    graph: &Graph,
    locals: &[LocalTransform],
    globals: &[Mat4],
    bones: &[Option<BoneIndex>],
    skins: &[Skin],
) -> Result<Skeleton, ImportError> {
    let place = Place::Pointer("/nodes".to_owned());
    let count = bones.iter().flatten().count();
    let mut list = document.context.vec(&place, count)?;
    for &node in graph.order.iter().filter(|&&node| bones[node as usize].is_some()) {
        document.context.work(1)?;
        let local = &locals[node as usize];
        list.push(Bone {
            name: document.root.nodes[node as usize].name.clone().unwrap_or_default(),
            parent: graph.parents[node as usize].and_then(|parent| bones[parent as usize]),
            rest: local.parts,
            rest_matrix: local.sheared,
            offset: inverse(globals[node as usize]).unwrap_or(Mat4::IDENTITY),
            node: Some(node),
        });
    }
    for skin in skins.iter().rev() {
        document.context.work(skin.bones.len())?;
        // Iterated backwards, so that the first joint is used where one is listed twice.
        for (&bone, &offset) in skin.bones.iter().zip(&skin.offsets).rev() {
            list[bone as usize].offset = offset;
        }
    }
    Ok(Skeleton { bones: list })
}

/// What nodes place.
pub(super) struct SceneParts<'a> {
    pub(super) meshes: &'a [ReadMesh],
    /// Number in the model for each skin of the file.
    pub(super) skins: &'a [u32],
    /// Whether each node is in the scene that is shown.
    pub(super) is_shown: &'a [bool],
}

/// Places every mesh of the scene that is shown: the default scene, otherwise the first one, otherwise all nodes.
pub(super) fn stage(
    document: &GltfDocument<'_>,
    graph: &Graph,
    locals: &[LocalTransform],
    skeleton: Skeleton,
    bones: Vec<Option<BoneIndex>>,
    parts: &SceneParts<'_>,
) -> Result<SceneLayout, ImportError> {
    let SceneParts { meshes, skins, is_shown } = *parts;
    let carriers = carriers(document, graph, locals, &bones)?;
    let mut instances = Vec::new();
    for (index, node) in document.root.nodes.iter().enumerate() {
        document.context.work(1)?;
        check_references(document, index)?;
        let Some(mesh) = node.mesh else { continue };
        let path = format!("/nodes/{index}");
        let read =
            meshes.get(mesh.value()).ok_or_else(|| unresolved(&format!("{path}/mesh"), mesh.value()))?;
        let skin = skin_of(document, index, read, skins)?;
        if !is_shown[index] {
            let text = "the mesh is not in the scene that is shown";
            document.context.warn(Place::Pointer(path), code::NODE_NOT_IN_SCENE, text);
            continue;
        }
        let place = Place::Pointer(format!("{path}/weights"));
        let defaults = &read.mesh.morph_weights;
        let weights = node.weights.as_deref();
        let morph_weights =
            fitted(weights, defaults.len(), defaults, place, code::NODE_WEIGHTS_INVALID, document)?;
        let (bone, to_bone) = carriers[index];
        let drawn = read.mesh.primitives.len() * PLACED_BYTES + 2 * size_of_val::<[f32]>(&morph_weights);
        let bytes = 2 * size_of::<MeshInstance>() + drawn;
        document.context.charge(&Place::Pointer(path), bytes as u64)?;
        let (mesh, node) = (mesh.value() as u32, Some(index as u32));
        instances.push(MeshInstance { mesh, node, skin, bone, to_bone, morph_weights });
    }
    let morph_targets = meshes.iter().map(|read| read.mesh.morph_weights.len()).collect();
    Ok(SceneLayout { skeleton, instances, bones, morph_targets })
}

/// Bytes that a program needs to draw one more primitive: charged here, because a file of some kilobytes can place a
/// mesh of many primitives in many nodes.
const PLACED_BYTES: usize = 256;

/// Returns the skin of a node in the model, by its number in the file in `skins`, if its mesh has joints; an error if a vertex refers to a joint that the skin lacks.
fn skin_of(
    document: &GltfDocument<'_>,
    index: usize,
    read: &ReadMesh,
    skins: &[u32],
) -> Result<Option<u32>, ImportError> {
    let Some(skin) = document.root.nodes[index].skin else { return Ok(None) };
    let path = format!("/nodes/{index}/skin");
    let joints =
        document.root.skins.get(skin.value()).ok_or_else(|| unresolved(&path, skin.value()))?.joints.len();
    match read.largest_joint {
        None => {
            let text = "the mesh has no joints; the skin is left out";
            document.context.warn(Place::Pointer(path), code::NODE_SKIN_WITH_NON_SKINNED_MESH, text);
            Ok(None)
        }
        Some(largest) if usize::from(largest) >= joints => {
            let reason = format!("a vertex refers to joint {largest}, the skin has {joints} joints");
            Err(invalid(Place::Pointer(path), code::ACCESSOR_JOINTS_INDEX_OOB, reason))
        }
        Some(_) => Ok(skins.get(skin.value()).copied()),
    }
}

/// Returns for each node the bone that carries it, and the transform to that bone: from the node up to the first bone,
/// or to the scene.
fn carriers(
    document: &GltfDocument<'_>,
    graph: &Graph,
    locals: &[LocalTransform],
    bones: &[Option<BoneIndex>],
) -> Result<Vec<(Option<BoneIndex>, Mat4)>, ImportError> {
    let place = Place::Pointer("/nodes".to_owned());
    let mut carriers = document.context.filled(&place, bones.len(), (None, Mat4::IDENTITY))?;
    for &node in &graph.order {
        document.context.work(1)?;
        let node = node as usize;
        carriers[node] = match (bones[node], graph.parents[node]) {
            (Some(bone), _) => (Some(bone), Mat4::IDENTITY),
            (None, None) => (None, locals[node].matrix()),
            (None, Some(parent)) => {
                let (bone, to_bone) = carriers[parent as usize];
                (bone, to_bone * locals[node].matrix())
            }
        };
    }
    Ok(carriers)
}

/// Returns for each node whether it is in the scene that is shown.
pub(super) fn shown(document: &GltfDocument<'_>, graph: &Graph) -> Result<Vec<bool>, ImportError> {
    let root = document.root;
    let place = Place::Pointer("/scenes".to_owned());
    let index = match root.scene {
        Some(scene) if scene.value() < root.scenes.len() => scene.value(),
        Some(scene) => {
            let text = format!("there is no scene {}; the first one is shown", scene.value());
            document.context.warn(Place::Pointer("/scene".to_owned()), code::UNRESOLVED_REFERENCE, text);
            0
        }
        None => 0,
    };
    for (number, scene) in root.scenes.iter().enumerate() {
        for (position, node) in scene.nodes.iter().enumerate() {
            document.context.work(1)?;
            let from = || format!("/scenes/{number}/nodes/{position}");
            match graph.parents.get(node.value()) {
                None => return Err(unresolved(&from(), node.value())),
                Some(Some(parent)) => {
                    let text = format!("node {} is a child of node {parent}", node.value());
                    document.context.warn(Place::Pointer(from()), code::SCENE_NON_ROOT_NODE, text);
                }
                Some(None) => {}
            }
        }
    }
    let Some(scene) = root.scenes.get(index) else {
        return document.context.filled(&place, root.nodes.len(), true);
    };
    let mut is_shown = document.context.filled(&place, root.nodes.len(), false)?;
    for node in &scene.nodes {
        is_shown[node.value()] = true;
    }
    for &node in &graph.order {
        if let Some(parent) = graph.parents[node as usize] {
            is_shown[node as usize] |= is_shown[parent as usize];
        }
    }
    Ok(is_shown)
}

/// Returns for each mesh whether a node in `is_shown` places it.
pub(super) fn shown_meshes(document: &GltfDocument<'_>, is_shown: &[bool]) -> Result<Vec<bool>, ImportError> {
    let count = document.root.meshes.len();
    shown_items(document, is_shown, "/meshes", count, |node| node.mesh.map(|mesh| mesh.value()))
}

/// Returns for each skin whether a node in `is_shown` places a mesh with it.
pub(super) fn shown_skins(document: &GltfDocument<'_>, is_shown: &[bool]) -> Result<Vec<bool>, ImportError> {
    let skin = |node: &gltf::json::Node| node.skin.filter(|_| node.mesh.is_some()).map(|skin| skin.value());
    shown_items(document, is_shown, "/skins", document.root.skins.len(), skin)
}

/// Returns for each of `count` items of a list whether a node in `is_shown` uses it; `used` returns its number.
fn shown_items(
    document: &GltfDocument<'_>,
    is_shown: &[bool],
    list: &str,
    count: usize,
    used: impl Fn(&gltf::json::Node) -> Option<usize>,
) -> Result<Vec<bool>, ImportError> {
    let root = document.root;
    let mut shown = document.context.filled(&Place::Pointer(list.to_owned()), count, false)?;
    document.context.work(root.nodes.len())?;
    for (node, _) in root.nodes.iter().zip(is_shown).filter(|(_, is_shown)| **is_shown) {
        if let Some(shown) = used(node).and_then(|number| shown.get_mut(number)) {
            *shown = true;
        }
    }
    Ok(shown)
}

/// Checks the references of a node that no other module uses.
fn check_references(document: &GltfDocument<'_>, index: usize) -> Result<(), ImportError> {
    let node = &document.root.nodes[index];
    if let Some(camera) = node.camera {
        let path = format!("/nodes/{index}/camera");
        if camera.value() >= document.root.cameras.len() {
            return Err(unresolved(&path, camera.value()));
        }
        document.context.warn(Place::Pointer(path), code::CAMERA_NOT_SHOWN, "the file's camera is not used");
    }
    match node.skin {
        Some(skin) if skin.value() >= document.root.skins.len() => {
            Err(unresolved(&format!("/nodes/{index}/skin"), skin.value()))
        }
        _ => Ok(()),
    }
}
