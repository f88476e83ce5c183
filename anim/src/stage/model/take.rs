//! A take prepared for the stage: in place, with its travel, its stride and the contacts of its feet.

use super::contacts::{FootContact, foot_contacts};
use super::foot::StageFoot;
use super::stride::{Stride, stride_of};
use crate::data::{BoneIndex, Channel, Interpolation, Skeleton, Take, Transform};
use crate::fast::KeyedTake;
use crate::motion::{Axis, RootMotion, RootMotionOptions, extract, guess_hips, guess_root, put_back};
use crate::stage::time::StageTime;
use glam::Vec3;

/// A take, its movement through the scene, and its contacts.
#[derive(Clone, Debug)]
pub struct StageTake {
    name: String,
    start: f32,
    length: StageTime,
    /// The take in place.
    pub(in crate::stage) keyed: KeyedTake,
    /// The movement that was extracted; `None` where the take stays where it is.
    pub(in crate::stage) motion: Option<RootMotion>,
    stride: Option<Stride>,
    contacts: Vec<FootContact>,
}

/// Part of the length of a leg by which the hips have to end elsewhere than they start to move the role.
const LEAST_TRAVEL: f32 = 0.05;

/// Cosine of half the angle by which they have to turn: 5 degrees.
const LEAST_TURN: f32 = 0.999_048;

impl StageTake {
    pub(super) fn new(skeleton: &Skeleton, take: &Take, feet: &[StageFoot], leg: f32) -> Self {
        let own = traveled(skeleton, take, leg);
        let (motion, in_place) = match own {
            Some((motion, in_place)) => (Some(motion), in_place),
            None => (None, take.clone()),
        };
        let stride = match &motion {
            Some(motion) => Stride::of_motion(motion),
            None => stride_of(skeleton, take, feet, leg),
        };
        // The take as it moves through the scene: only there are feet still.
        let moving = match (&motion, &stride) {
            (None, Some(stride)) => put_back(take, skeleton, &stride.motion(hips(skeleton), take)).ok(),
            (Some(_), _) | (None, None) => None,
        };
        let contacts =
            foot_contacts(skeleton, moving.as_ref().unwrap_or(take), &in_place, feet, leg, stride.as_ref());
        Self {
            name: take.name.clone(),
            start: take.start,
            length: StageTime::from_seconds(f64::from(take.length.max(0.0))),
            keyed: KeyedTake::new(skeleton, &in_place),
            motion,
            stride,
            contacts,
        }
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the length.
    pub fn length(&self) -> StageTime {
        self.length
    }

    /// Returns whether the take moves the role through the scene by itself.
    pub fn travels(&self) -> bool {
        self.motion.is_some()
    }

    /// Returns the speed of its stride in lengths of the model per second; `None` for a take that neither travels nor walks.
    pub fn stride_speed(&self) -> Option<f64> {
        let stride = self.stride.as_ref()?;
        let length = self.length.seconds();
        (length > 0.0).then(|| stride.distance / length)
    }

    /// Returns when its feet are on the ground.
    pub fn contacts(&self) -> &[FootContact] {
        &self.contacts
    }

    pub(in crate::stage) fn stride(&self) -> Option<&Stride> {
        self.stride.as_ref()
    }

    /// Returns a time of the take as its keys count it, from one after its start.
    pub(in crate::stage) fn clock(&self, time: StageTime) -> f32 {
        (f64::from(self.start) + time.seconds()) as f32
    }

    /// Returns the movement from the start of the take to a time after it; the identity where it stays.
    pub(in crate::stage) fn movement(&self, time: StageTime) -> Transform {
        self.motion.as_ref().map_or(Transform::IDENTITY, |motion| motion.at(self.clock(time)))
    }
}

/// Returns the bone that represents the place of the figure.
fn hips(skeleton: &Skeleton) -> BoneIndex {
    guess_hips(skeleton).unwrap_or(0)
}

/// Extracts the movement of a take that ends elsewhere than it starts.
fn traveled(skeleton: &Skeleton, take: &Take, leg: f32) -> Option<(RootMotion, Take)> {
    if skeleton.is_empty() {
        return None;
    }
    let hips = hips(skeleton);
    let both = RootMotionOptions { up: Axis::Y, translation: [true, false, true], yaw: true };
    let moved = |bone: BoneIndex| {
        let (motion, _) = extract(take, skeleton, bone, both).ok()?;
        let end = motion.at(take.end());
        Some((Vec3::new(end.translation.x, 0.0, end.translation.z).length(), end.rotation.w.abs()))
    };
    let (distance, turn) = moved(hips)?;
    let yaw = turn < LEAST_TURN;
    if distance < LEAST_TRAVEL * leg && !yaw {
        return None;
    }
    // A root bone that has the movement is smoother than the hips.
    let root = guess_root(skeleton, hips).filter(|&root| {
        moved(root).is_some_and(|(far, _)| far > 0.5 * distance && far >= LEAST_TRAVEL * leg)
    });
    extract(take, skeleton, root.unwrap_or(hips), RootMotionOptions { yaw, ..both }).ok()
}

impl Stride {
    /// Returns the movement of a take that walks on the spot.
    fn motion(&self, bone: BoneIndex, take: &Take) -> RootMotion {
        let way = (self.direction * self.distance).as_vec3();
        let last = (self.shares.len().max(2) - 1) as f64;
        let share = |at: usize| (at as f64 / last, self.share(at as f64 / last));
        let keys = (0..=last as usize).map(share);
        let (times, values): (Vec<f32>, Vec<Vec3>) =
            keys.map(|(x, share)| (take.start + take.length * x as f32, way * share as f32)).unzip();
        RootMotion {
            bone,
            translation: Channel::new(times, values, Interpolation::Linear),
            start: take.start,
            length: take.length,
            ..RootMotion::default()
        }
    }
}
