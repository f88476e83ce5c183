//! Every intermediate value from keys to a bone or a vertex, as plain data, to inspect and to check by hand.
//!
//! | step | formula | thesis |
//! |---|---|---|
//! | keys around the time | `mix = (time - before) / (after - before)` | §2.1.5.2 |
//! | temporary key-frame | `(1 - mix) * before + mix * after` | §2.1.5.2 |
//! | to-parent | `translation * rotation * scale` | §2.1.5.1 |
//! | to-root | `to_root = to_root of the parent * to_parent` | §2.1.5.1 |
//! | final pose | `final = to_root * offset` | §2.1.5.1 |
//! | skin | `position = Σ final_i * stored * weight_i` | §2.1.4 |
//!
//! Nothing is computed here: [`explain`] calls the functions of [`crate::sample`], [`crate::animation`] and
//! [`crate::skin`] that play the model, and records their inputs and outputs. So the numbers are those that are played,
//! bit for bit.
//!
//! An [`Explanation`] displays itself (`println!("{explanation}")`) as a worked example.

mod bone;
mod text;
mod vertex;

pub use bone::{BoneResult, BoneStep, ChannelStep, KeyStep, KeysStep};
pub use vertex::{InfluenceStep, MorphKeys, MorphStep, MovementStep, VertexResult};

use crate::animation::to_root;
use crate::data::{BoneIndex, ModelData, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::Mat4;

/// The bone or vertex to explain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExplainTarget {
    /// A bone, by its position in [`Skeleton::bones`].
    Bone(BoneIndex),
    /// A vertex of a placed mesh.
    Vertex {
        /// Position in [`ModelData::instances`].
        instance: u32,
        /// Position in the mesh's [`crate::data::Mesh::primitives`].
        primitive: u32,
        /// Position in the primitive's columns.
        vertex: u32,
    },
}

/// All the steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Explanation {
    /// The requested take; `None` for the rest pose.
    pub take: Option<TakeStep>,
    /// The requested time in seconds. It is clamped to the keys.
    pub time: f32,
    /// Every bone that contributes to the result and all its ancestors, parents before children, each once.
    pub bones: Vec<BoneStep>,
    /// The result.
    pub subject: Subject,
}

impl Explanation {
    /// Returns the steps of bone number `bone`; `None` when it does not contribute to the result.
    pub fn bone(&self, bone: BoneIndex) -> Option<&BoneStep> {
        self.bones.iter().find(|step| step.bone == bone)
    }
}

/// The take that is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeStep {
    /// Position in [`crate::data::AnimationData::takes`].
    pub index: usize,
    /// As in the file; may be empty.
    pub name: String,
    /// Time of the first key, in seconds.
    pub start: f32,
    /// Time of the last key, in seconds.
    pub end: f32,
}

/// The last steps, which differ for a bone and for a vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// Result of a bone.
    Bone(BoneResult),
    /// Result of a vertex.
    Vertex(Box<VertexResult>),
}

/// Reasons why there is nothing to explain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExplainError {
    /// The model has no such take.
    #[error("there is no take {take}; the model has {takes}")]
    NoTake {
        /// The requested number, from 0.
        take: usize,
        /// Number of takes.
        takes: usize,
    },
    /// The model has no such bone.
    #[error("there is no bone {bone}; the model has {bones}")]
    NoBone {
        /// The requested number, from 0.
        bone: BoneIndex,
        /// Number of bones.
        bones: usize,
    },
    /// The model has no such mesh instance.
    #[error("there is no instance {instance}; the model has {instances}")]
    NoInstance {
        /// The requested number, from 0.
        instance: u32,
        /// Number of instances.
        instances: usize,
    },
    /// The instance's mesh has no such primitive.
    #[error("instance {instance} has no primitive {primitive}; it has {primitives}")]
    NoPrimitive {
        /// The requested instance.
        instance: u32,
        /// The requested number, from 0.
        primitive: u32,
        /// Number of primitives; 0 also where the instance has no mesh.
        primitives: usize,
    },
    /// The primitive has no such vertex.
    #[error("primitive {primitive} of instance {instance} has no vertex {vertex}; it has {vertices}")]
    NoVertex {
        /// The requested instance.
        instance: u32,
        /// The requested primitive.
        primitive: u32,
        /// The requested number, from 0.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
}

/// Returns every intermediate value of `target`, in take number `take` at `time` seconds; `None` is the rest pose.
///
/// Total for every time: NaN counts as before the first key. Costs one pose of the whole skeleton. An error contains
/// the number that is out of range; a requested take has to exist.
///
/// ```
/// use dragonfly_anim::explain::{ExplainTarget, explain};
/// # let mut model = dragonfly_anim::data::ModelData::default();
/// # let bone = dragonfly_anim::data::Bone {
/// #     name: "hip".into(), parent: None, rest: Default::default(), rest_matrix: None,
/// #     offset: glam::Mat4::IDENTITY, node: None };
/// # std::sync::Arc::make_mut(&mut model.animation.skeleton).bones.push(bone);
/// let explanation = explain(&model, None, 0.0, ExplainTarget::Bone(0))?;
/// println!("{explanation}");
/// # Ok::<(), dragonfly_anim::explain::ExplainError>(())
/// ```
pub fn explain(
    model: &ModelData,
    take: Option<usize>,
    time: f32,
    target: ExplainTarget,
) -> Result<Explanation, ExplainError> {
    let takes = &model.animation.takes;
    let chosen = match take {
        None => None,
        Some(take) => {
            Some(takes.get(take).ok_or(ExplainError::NoTake { take, takes: takes.len() })?.as_ref())
        }
    };
    let pose = SampledPose::new(&model.animation.skeleton, chosen, time);
    let (ends, subject) = match target {
        ExplainTarget::Bone(bone) => bone::result(&pose, bone)?,
        ExplainTarget::Vertex { instance, primitive, vertex } => {
            vertex::result(model, &pose, [instance, primitive, vertex])?
        }
    };
    let step = |index| TakeStep {
        index,
        name: takes[index].name.clone(),
        start: takes[index].start,
        end: takes[index].end(),
    };
    Ok(Explanation { take: take.map(step), time, bones: bone::chain(&pose, &ends), subject })
}

/// The skeleton at one time.
struct SampledPose<'a> {
    skeleton: &'a Skeleton,
    take: Option<&'a Take>,
    time: f32,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl<'a> SampledPose<'a> {
    fn new(skeleton: &'a Skeleton, take: Option<&'a Take>, time: f32) -> Self {
        let mut posed = Self {
            skeleton,
            take,
            time,
            poses: vec![Transform::IDENTITY; skeleton.len()],
            to_root: vec![Mat4::IDENTITY; skeleton.len()],
        };
        sample_take(take, skeleton, time, &mut posed.poses);
        to_root(skeleton, &posed.poses, &mut posed.to_root);
        posed
    }
}
