//! Skins: joints, bind matrices, and the influences of vertices.

use super::nodes::BoneLayout;
use super::space::{FbxSpace, dmat4};
use crate::code::{FBX_FOUND, FBX_NOT_SHOWN};
use dragonfly_anim::data::{Influence, MAX_INFLUENCES, Skin};
use dragonfly_anim::format::{ImportContext, ImportError, Place};
use dragonfly_anim::limits::JOINTS_PER_SKIN;
use glam::Mat4;
use ufbx::{Mesh, SkinDeformer};

/// A skin, and the number of the mesh that it moves.
pub(super) struct FbxSkin {
    pub(super) mesh: u32,
    pub(super) skin: Skin,
}

/// The joints of a mesh.
pub(super) struct MeshJoints {
    /// Joint of each cluster of the file; `None` for one without a node.
    clusters: Vec<Option<u16>>,
    /// Joint of vertices without a weight: the node of the mesh.
    unweighted: Option<u16>,
}

/// Vertices whose weights were corrected.
#[derive(Default)]
pub(super) struct FixedWeights {
    /// Vertices with more influences than are kept.
    pub(super) dropped: usize,
}

/// Returns the place of a mesh in messages.
pub(super) fn place_of(mesh: &Mesh) -> Place {
    Place::Pointer(format!("/meshes/{}", mesh.element.typed_id))
}

/// Returns the skin of a mesh: as in the parser's own evaluation, the first one.
fn skin_of(mesh: &Mesh) -> Option<&SkinDeformer> {
    mesh.skin_deformers.into_iter().next()
}

/// Returns the weights of a vertex that count, with their clusters.
fn weights(skin: &SkinDeformer, vertex: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
    let range = skin.vertices.get(vertex).map_or(0..0, |vertex| {
        let begin = vertex.weight_begin as usize;
        begin..begin + vertex.num_weights as usize
    });
    let weights = skin.weights.get(range).unwrap_or(&[]);
    let counts = |weight: &f64| *weight > 0.0 && weight.is_finite();
    weights.iter().map(|weight| (weight.cluster_index as usize, weight.weight)).filter(
        move |(cluster, weight)| {
            counts(weight) && skin.clusters.get(*cluster).is_some_and(|cluster| cluster.bone_node.is_some())
        },
    )
}

/// Returns, for each mesh, whether it has a skin and vertices that no joint moves: they stay with the node of the mesh.
pub(super) fn unweighted_meshes(
    scene: &ufbx::Scene,
    context: &ImportContext<'_>,
) -> Result<Vec<bool>, ImportError> {
    let mut unweighted = context.filled(&Place::Pointer("/meshes".to_owned()), scene.meshes.len(), false)?;
    for (flag, mesh) in unweighted.iter_mut().zip(&scene.meshes) {
        let Some(skin) = skin_of(mesh) else { continue };
        context.work(mesh.num_vertices)?;
        *flag = (0..mesh.num_vertices).any(|vertex| weights(skin, vertex).next().is_none());
    }
    Ok(unweighted)
}

/// Returns the skins, and the joints of each mesh.
pub(super) fn skins(
    scene: &ufbx::Scene,
    space: &FbxSpace,
    layout: &BoneLayout,
    unweighted: &[bool],
    context: &ImportContext<'_>,
) -> Result<(Vec<FbxSkin>, Vec<Option<MeshJoints>>), ImportError> {
    let mut skins = Vec::new();
    let mut joints = context.vec(&Place::Pointer("/meshes".to_owned()), scene.meshes.len())?;
    for (mesh, &unweighted) in scene.meshes.into_iter().zip(unweighted) {
        let Some(deformer) = skin_of(mesh) else {
            joints.push(None);
            continue;
        };
        report(mesh, deformer, context);
        let (skin, of_mesh) = skin(mesh, deformer, space, layout, unweighted, context)?;
        if skin.bones.is_empty() {
            joints.push(None);
            continue;
        }
        skins.push(FbxSkin { mesh: mesh.element.typed_id, skin });
        joints.push(Some(of_mesh));
    }
    Ok((skins, joints))
}

/// Warns about deformation that is not shown as in the file.
fn report(mesh: &Mesh, deformer: &SkinDeformer, context: &ImportContext<'_>) {
    if mesh.skin_deformers.len() > 1 {
        context.warn(place_of(mesh), FBX_NOT_SHOWN, "the mesh has several skins; the first one is used");
    }
    if matches!(
        deformer.skinning_method,
        ufbx::SkinningMethod::DualQuaternion | ufbx::SkinningMethod::BlendedDqLinear
    ) {
        let text = "the skin is made for dual quaternions; it is deformed linearly";
        context.warn(place_of(mesh), FBX_FOUND, text);
    }
}

fn skin(
    mesh: &Mesh,
    deformer: &SkinDeformer,
    space: &FbxSpace,
    layout: &BoneLayout,
    unweighted: bool,
    context: &ImportContext<'_>,
) -> Result<(Skin, MeshJoints), ImportError> {
    let place = place_of(mesh);
    let count = deformer.clusters.len() + 1;
    if count > JOINTS_PER_SKIN {
        let (size, limit) = (count as u64, JOINTS_PER_SKIN as u64);
        return Err(ImportError::TooLarge { place, what: "joints", size, limit });
    }
    let mut bones = context.vec(&place, count)?;
    let mut offsets = context.vec(&place, count)?;
    let mut clusters = context.vec(&place, count)?;
    for cluster in &deformer.clusters {
        context.work(1)?;
        let bone = cluster.bone_node.as_ref().and_then(|node| layout.bone_of(node));
        clusters.push(bone.map(|bone| {
            bones.push(bone);
            let offset = space.matrix(dmat4(&cluster.geometry_to_bone));
            offsets.push(if offset.is_finite() { offset } else { Mat4::IDENTITY });
            (bones.len() - 1) as u16
        }));
    }
    let node = mesh.element.instances.into_iter().next();
    let own = node.filter(|_| unweighted).and_then(|node| Some((node, layout.bone_of(node)?)));
    let unweighted = own.map(|(node, bone)| {
        bones.push(bone);
        let offset = space.matrix(dmat4(&node.geometry_to_node));
        offsets.push(if offset.is_finite() { offset } else { Mat4::IDENTITY });
        (bones.len() - 1) as u16
    });
    let name = deformer.element.name.to_string();
    Ok((Skin { name, bones, offsets }, MeshJoints { clusters, unweighted }))
}

/// Appends the influences of a vertex to `list`: [`MAX_INFLUENCES`] of them, strongest first. Returns how many have a weight.
pub(super) fn influences(
    mesh: &Mesh,
    joints: &MeshJoints,
    vertex: usize,
    list: &mut Vec<Influence>,
    fixed: &mut FixedWeights,
) -> usize {
    let mut found: Vec<(u16, f64)> = Vec::new();
    if let Some(skin) = skin_of(mesh) {
        for (cluster, weight) in weights(skin, vertex) {
            let Some(joint) = joints.clusters.get(cluster).copied().flatten() else { continue };
            match found.iter_mut().find(|(known, _)| *known == joint) {
                Some((_, sum)) => *sum += weight,
                None => found.push((joint, weight)),
            }
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    fixed.dropped += usize::from(found.len() > MAX_INFLUENCES);
    found.truncate(MAX_INFLUENCES);
    if found.is_empty() {
        found.push((joints.unweighted.unwrap_or(0), 1.0));
    }
    let sum: f64 = found.iter().map(|(_, weight)| weight).sum();
    let count = found.len();
    list.extend(found.into_iter().map(|(joint, weight)| Influence { joint, weight: (weight / sum) as f32 }));
    list.resize(list.len() + MAX_INFLUENCES - count, Influence::default());
    count
}
