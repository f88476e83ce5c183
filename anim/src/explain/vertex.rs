//! The last steps of a vertex: morph targets, then the skin or the bone that carries it.

use super::{ExplainError, SampledPose, Subject};
use crate::animation::final_poses;
use crate::data::{BoneIndex, Influence, Interpolation, MeshInstance, ModelData, Primitive};
use crate::sample::{find_keys, sample_morph_weights};
use crate::skin::{Movement, contribution, morphed, normal_matrix, skin_normal, skin_position};
use glam::{Mat3, Mat4, Vec3};

/// The last steps of a vertex.
#[derive(Clone, Debug, PartialEq)]
pub struct VertexResult {
    /// Position in [`ModelData::instances`].
    pub instance: u32,
    /// Position in the mesh's primitives.
    pub primitive: u32,
    /// Position in the primitive's columns.
    pub vertex: u32,
    /// Name of the mesh; may be empty.
    pub mesh: String,
    /// As stored, mesh space.
    pub position: Vec3,
    /// As stored, mesh space, unit length; `None` where the primitive has none.
    pub normal: Option<Vec3>,
    /// Keys of the morph weights; `None` when no track animates them.
    pub morph_keys: Option<MorphKeys>,
    /// Contribution of each morph target with a weight, in the targets' order.
    pub morphs: Vec<MorphStep>,
    /// `position + Σ weight * difference`, mesh space.
    pub morphed_position: Vec3,
    /// The morphed normal, not yet of unit length.
    pub morphed_normal: Option<Vec3>,
    /// The bones or the matrix that move the vertex.
    pub movement: MovementStep,
    /// The matrix that moves the surface around the vertex: `Σ final_i * weight_i`, or the single matrix of a mesh
    /// without skin.
    pub matrix: Mat4,
    /// Matrix that multiplies the normal before it is normalized: the transposed inverse of `matrix`, up to a factor.
    pub normal_matrix: Mat3,
    /// Scene space.
    pub final_position: Vec3,
    /// Scene space, unit length.
    pub final_normal: Option<Vec3>,
}

/// The keys of the track that animates morph weights; all targets share its key times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MorphKeys {
    /// Number of keys of the track.
    pub count: usize,
    /// How two keys are combined.
    pub interpolation: Interpolation,
    /// Number and time in seconds of the key before.
    pub before: (usize, f32),
    /// Number and time in seconds of the key after.
    pub after: (usize, f32),
    /// Fraction of the time from one to the other, 0..=1.
    pub mix: f32,
}

/// Contribution of one morph target.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphStep {
    /// Position in [`Primitive::morph_targets`].
    pub target: usize,
    /// As in the file; may be empty.
    pub name: String,
    /// Weight at the time; usually 0..1.
    pub weight: f32,
    /// The stored difference, mesh space; zero where the target does not move positions.
    pub difference: Vec3,
    /// `weight * difference`.
    pub contribution: Vec3,
}

/// The movement of a vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum MovementStep {
    /// The bones of a skin (§2.1.4).
    Skin {
        /// Position in [`ModelData::skins`].
        skin: u32,
        /// Influences with a weight, strongest first.
        influences: Vec<InfluenceStep>,
    },
    /// One matrix: `to_root * to_bone`.
    Rigid {
        /// The bone that carries the mesh; `None` when nothing moves it.
        bone: Option<BoneIndex>,
        /// Mesh space → bone space.
        to_bone: Mat4,
    },
}

/// Influence of one bone on a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InfluenceStep {
    /// Position in the skin's list of bones.
    pub joint: u16,
    /// The bone of that joint; `None` where the skin has no such joint, which counts as the identity.
    pub bone: Option<BoneIndex>,
    /// 0..1.
    pub weight: f32,
    /// The skin's own offset of the joint: bind space → bone space.
    pub offset: Mat4,
    /// `to_root * offset`: bind space → scene space.
    pub final_pose: Mat4,
    /// `final_pose * morphed position`, scene space: the position if this bone alone moved the vertex.
    pub moved: Vec3,
    /// `moved * weight`. The contributions sum to the final position.
    pub contribution: Vec3,
}

/// Returns the result of a vertex, and the bones that contribute to it.
pub(super) fn result(
    model: &ModelData,
    pose: &SampledPose<'_>,
    [instance, primitive, vertex]: [u32; 3],
) -> Result<(Vec<BoneIndex>, Subject), ExplainError> {
    let (placed, part) = find(model, [instance, primitive, vertex])?;
    let index = vertex as usize;
    let mut weights = vec![0.0; part.morph_targets.len()];
    sample_morph_weights(pose.take, instance, &placed.morph_weights, pose.time, &mut weights);
    let position = part.vertices.positions[index];
    let normal = part.vertices.normals.get(index).copied();
    let at = |targets: &[Vec3]| targets.get(index).copied();
    let morphed_position = morphed(part, &weights, position, |target| at(&target.positions));

    let finals = finals(model, placed, pose);
    let movement = Movement::of(placed, part, &pose.to_root, &finals);
    let (bones, step) = explain_movement(model, placed, part, movement, index, morphed_position);
    let matrix = movement.matrix(part, index);
    let result = VertexResult {
        instance,
        primitive,
        vertex,
        mesh: model.meshes[placed.mesh as usize].name.clone(),
        position,
        normal,
        morph_keys: morph_keys(pose, instance),
        morphs: morphs(part, &weights, index),
        morphed_position,
        morphed_normal: normal.map(|normal| morphed(part, &weights, normal, |target| at(&target.normals))),
        movement: step,
        matrix,
        normal_matrix: normal_matrix(matrix),
        final_position: skin_position(part, movement, &weights, index).unwrap_or(Vec3::ZERO),
        final_normal: skin_normal(part, movement, &weights, index),
    };
    Ok((bones, Subject::Vertex(Box::new(result))))
}

/// Returns the instance and its primitive, if they have the vertex.
fn find(
    model: &ModelData,
    [instance, primitive, vertex]: [u32; 3],
) -> Result<(&MeshInstance, &Primitive), ExplainError> {
    let instances = model.instances.len();
    let placed = model.instances.get(instance as usize);
    let placed = placed.ok_or(ExplainError::NoInstance { instance, instances })?;
    let parts = model.meshes.get(placed.mesh as usize).map_or(&[][..], |mesh| &mesh.primitives);
    let missing = ExplainError::NoPrimitive { instance, primitive, primitives: parts.len() };
    let part = parts.get(primitive as usize).ok_or(missing)?;
    let vertices = part.vertices.len();
    if vertex as usize >= vertices {
        return Err(ExplainError::NoVertex { instance, primitive, vertex, vertices });
    }
    Ok((placed, part))
}

/// Returns the final poses of the instance's skin; none without a skin.
fn finals(model: &ModelData, placed: &MeshInstance, pose: &SampledPose<'_>) -> Vec<Mat4> {
    let Some(skin) = placed.skin.and_then(|skin| model.skins.get(skin as usize)) else { return Vec::new() };
    let mut finals = vec![Mat4::IDENTITY; skin.bones.len()];
    final_poses(skin, &pose.to_root, &mut finals);
    finals
}

fn explain_movement(
    model: &ModelData,
    placed: &MeshInstance,
    part: &Primitive,
    movement: Movement<'_>,
    index: usize,
    position: Vec3,
) -> (Vec<BoneIndex>, MovementStep) {
    let (Movement::Skin(finals), Some(skin)) = (movement, placed.skin) else {
        let step = MovementStep::Rigid { bone: placed.bone, to_bone: placed.to_bone };
        return (placed.bone.into_iter().collect(), step);
    };
    let data = model.skins.get(skin as usize);
    let step = |&influence: &Influence| {
        let joint = usize::from(influence.joint);
        InfluenceStep {
            joint: influence.joint,
            bone: data.and_then(|skin| skin.bones.get(joint).copied()),
            weight: influence.weight,
            offset: data.and_then(|skin| skin.offsets.get(joint).copied()).unwrap_or(Mat4::IDENTITY),
            final_pose: finals.get(joint).copied().unwrap_or(Mat4::IDENTITY),
            moved: contribution(finals, Influence { weight: 1.0, ..influence }, position),
            contribution: contribution(finals, influence, position),
        }
    };
    let influences = part.vertices.influences_of(index).iter().filter(|influence| influence.weight != 0.0);
    let influences: Vec<InfluenceStep> = influences.map(step).collect();
    let bones = influences.iter().filter_map(|influence| influence.bone).collect();
    (bones, MovementStep::Skin { skin, influences })
}

fn morph_keys(pose: &SampledPose<'_>, instance: u32) -> Option<MorphKeys> {
    let track = pose.take?.morphs.iter().find(|track| track.instance == instance)?;
    let keys = find_keys(&track.times, pose.time)?;
    let key = |index: usize| (index, track.times[index]);
    Some(MorphKeys {
        count: track.times.len(),
        interpolation: track.interpolation,
        before: key(keys.before),
        after: key(keys.after),
        mix: keys.mix,
    })
}

fn morphs(part: &Primitive, weights: &[f32], index: usize) -> Vec<MorphStep> {
    let weighted =
        part.morph_targets.iter().zip(weights).enumerate().filter(|(_, (_, weight))| **weight != 0.0);
    let step = |(number, (target, &weight)): (usize, (&crate::data::MorphTarget, &f32))| {
        let difference = target.positions.get(index).copied().unwrap_or(Vec3::ZERO);
        MorphStep {
            target: number,
            name: target.name.clone(),
            weight,
            difference,
            contribution: difference * weight,
        }
    };
    weighted.map(step).collect()
}
