//! A scene at one time: what [`crate::stage::StagePlan::scene_at`] writes.

use super::model::StageModel;
use super::time::StageTime;
use crate::data::Transform;
use crate::fast::{MAX_LAYERS, Pose, PoseBlock, RootPoses};
use glam::{Mat4, Quat, Vec3};

/// A scene. Made by [`crate::stage::StagePlan::new_scene`] for one plan, then written as often as wanted without an allocation.
#[derive(Clone, Debug)]
pub struct StageScene {
    /// The time.
    pub time: StageTime,
    /// The things of the cast, in the order of the script.
    pub things: Vec<ThingState>,
    /// The camera that is seen; `None` for a cast without cameras.
    pub camera: Option<StageCamera>,
    /// The titles that are shown.
    pub titles: Vec<ShownTitle>,
    /// The sounds that play.
    pub sounds: Vec<PlayingSound>,
    pub(super) scratch: StageScratch,
}

/// A thing at one time.
#[derive(Clone, Debug)]
pub struct ThingState {
    /// From the thing's own space to the scene.
    pub transform: Transform,
    /// The pose of a thing with a model.
    pub pose: Option<ThingPose>,
    /// The light; `None` for other things.
    pub light: Option<LightState>,
    /// The effect; `None` for other things.
    pub effect: Option<EffectState>,
}

/// The pose of a role or a prop.
#[derive(Clone, Debug)]
pub struct ThingPose {
    /// Poses relative to the parents.
    pub pose: Pose,
    /// Bone space → the thing's own space.
    pub to_root: RootPoses,
    /// Weights of the shape keys, in the order of [`StageModel::shapes`]; empty for a model without any.
    pub shapes: Vec<f32>,
}

impl ThingPose {
    pub(super) fn new(model: &StageModel) -> Self {
        let rig = model.rig();
        Self {
            pose: rig.rest().clone(),
            to_root: RootPoses::new(rig),
            shapes: model.shapes().rest().to_vec(),
        }
    }
}

/// What a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageCamera {
    /// The thing; during a blend, the one that it moves to.
    pub thing: usize,
    /// Meters.
    pub position: Vec3,
    /// From the camera's space, which looks along -z with y up, to the scene.
    pub rotation: Quat,
    /// Focal length in millimeters, for an image 36 mm wide.
    pub lens: f32,
    /// Distance of what is in focus, meters; `None`: everything.
    pub focus: Option<f32>,
    /// F-number.
    pub aperture: f32,
}

/// A light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightState {
    /// Linear light, red, green and blue.
    pub color: Vec3,
    /// Brightness.
    pub strength: f32,
}

/// An effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EffectState {
    /// 0 where it is off, 1 where it is on, between while it fades.
    pub weight: f32,
    /// Seconds since it was turned on; 0 while it is off.
    pub seconds: f64,
    /// Start of its random numbers: depends on the script's seed and on the run.
    pub seed: u32,
    /// Particles per second.
    pub rate: f32,
}

/// A title.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownTitle {
    /// The title: a position in [`crate::stage::StagePlan::titles`].
    pub title: usize,
    /// From 0 to 1.
    pub weight: f32,
}

/// A sound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlayingSound {
    /// The sound: a position in [`crate::stage::StagePlan::sounds`].
    pub sound: usize,
    /// Seconds in the sound.
    pub seconds: f64,
    /// Loudness, fades included.
    pub gain: f32,
}

/// Memory for steps between, of the size of the largest model.
#[derive(Clone, Debug)]
pub(super) struct StageScratch {
    pub(super) poses: [Vec<PoseBlock>; MAX_LAYERS],
    pub(super) base: Vec<PoseBlock>,
    pub(super) transforms: Vec<Transform>,
    pub(super) matrices: Vec<Mat4>,
    pub(super) shapes: Vec<f32>,
}

impl StageScratch {
    pub(super) fn new(bones: usize, shapes: usize) -> Self {
        let blocks = vec![PoseBlock::IDENTITY; bones.div_ceil(8)];
        Self {
            poses: std::array::from_fn(|_| blocks.clone()),
            base: blocks,
            transforms: vec![Transform::IDENTITY; bones],
            matrices: vec![Mat4::IDENTITY; bones],
            shapes: vec![0.0; shapes],
        }
    }
}
