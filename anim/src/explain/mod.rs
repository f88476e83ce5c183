//! Every value on the way from keys to a bone or a vertex, as plain data, to look at and to check by hand.
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
//! [`crate::skin`] that play the model, and writes down what they take and what they give. So the numbers are those
//! that are played, bit for bit.
//!
//! An [`Explanation`] prints itself (`println!("{explanation}")`) as a worked example.

mod bone;
mod text;
mod vertex;

pub use bone::{BoneResult, BoneStep, ChannelStep, KeyStep, KeysStep};
pub use vertex::{InfluenceStep, MorphKeys, MorphStep, MovementStep, VertexResult};

use crate::animation::to_root;
use crate::data::{BoneIndex, ModelData, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::Mat4;

/// What is to be explained.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum What {
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
    /// The take that was asked for; `None` for the rest pose.
    pub take: Option<TakeStep>,
    /// Seconds, as asked for. Keys clamp it: before the first key the first holds, after the last the last.
    pub time: f32,
    /// Every bone that has a part in the result and all its ancestors, parents before children, each once.
    pub bones: Vec<BoneStep>,
    /// What comes out.
    pub subject: Subject,
}

impl Explanation {
    /// The steps of bone number `bone`; `None` when it has no part in the result.
    pub fn bone(&self, bone: BoneIndex) -> Option<&BoneStep> {
        self.bones.iter().find(|step| step.bone == bone)
    }
}

/// Which take is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct TakeStep {
    /// Position in [`crate::data::AnimationData::takes`].
    pub index: usize,
    /// As in the file; may be empty.
    pub name: String,
    /// Seconds: the first key.
    pub start: f32,
    /// Seconds: the last key.
    pub end: f32,
}

/// The last steps, which differ for a bone and for a vertex.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// Of a bone.
    Bone(BoneResult),
    /// Of a vertex.
    Vertex(Box<VertexResult>),
}

/// Why there is nothing to explain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExplainError {
    /// There are fewer takes.
    #[error("there is no take {take}; the model has {takes}")]
    NoTake {
        /// The number asked for, from 0.
        take: usize,
        /// How many there are.
        takes: usize,
    },
    /// There are fewer bones.
    #[error("there is no bone {bone}; the model has {bones}")]
    NoBone {
        /// The number asked for, from 0.
        bone: BoneIndex,
        /// How many there are.
        bones: usize,
    },
    /// There are fewer mesh instances.
    #[error("there is no instance {instance}; the model has {instances}")]
    NoInstance {
        /// The number asked for, from 0.
        instance: u32,
        /// How many there are.
        instances: usize,
    },
    /// The instance's mesh has fewer primitives.
    #[error("instance {instance} has no primitive {primitive}; it has {primitives}")]
    NoPrimitive {
        /// The instance.
        instance: u32,
        /// The number asked for, from 0.
        primitive: u32,
        /// How many there are; 0 also where the instance names no mesh.
        primitives: usize,
    },
    /// The primitive has fewer vertices.
    #[error("primitive {primitive} of instance {instance} has no vertex {vertex}; it has {vertices}")]
    NoVertex {
        /// The instance.
        instance: u32,
        /// The primitive.
        primitive: u32,
        /// The number asked for, from 0.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
}

/// Every value on the way to `what`, in take number `take` at `time` seconds; `None` is the rest pose.
///
/// Total for every time: NaN counts as before the first key. Costs one pose of the whole skeleton. An error says which
/// number is out of range; a take that was asked for must be there.
///
/// ```
/// use dragonfly_anim::explain::{What, explain};
/// # let mut model = dragonfly_anim::data::ModelData::default();
/// # let bone = dragonfly_anim::data::Bone {
/// #     name: "hip".into(), parent: None, rest: Default::default(), rest_matrix: None,
/// #     offset: glam::Mat4::IDENTITY, node: None };
/// # std::sync::Arc::make_mut(&mut model.animation.skeleton).bones.push(bone);
/// let explanation = explain(&model, None, 0.0, What::Bone(0))?;
/// println!("{explanation}");
/// # Ok::<(), dragonfly_anim::explain::ExplainError>(())
/// ```
pub fn explain(
    model: &ModelData,
    take: Option<usize>,
    time: f32,
    what: What,
) -> Result<Explanation, ExplainError> {
    let takes = &model.animation.takes;
    let chosen = match take {
        None => None,
        Some(take) => {
            Some(takes.get(take).ok_or(ExplainError::NoTake { take, takes: takes.len() })?.as_ref())
        }
    };
    let pose = Posed::new(&model.animation.skeleton, chosen, time);
    let (ends, subject) = match what {
        What::Bone(bone) => bone::result(&pose, bone)?,
        What::Vertex { instance, primitive, vertex } => {
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
struct Posed<'a> {
    skeleton: &'a Skeleton,
    take: Option<&'a Take>,
    time: f32,
    poses: Vec<Transform>,
    to_root: Vec<Mat4>,
}

impl<'a> Posed<'a> {
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
