//! The motion path of the active bone: the position of its joint, frame by frame.

use super::keys::BoneFlags;
use super::posed::PoseCache;
use crate::control::path_point::PathKey;
use dragonfly_anim::animation::to_parent;
use dragonfly_anim::data::{BoneIndex, Take, Track};
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::View;
use dragonfly_document::edit::BonePose;
use dragonfly_picture::PathLook;
use dragonfly_picture::gizmo::GizmoTarget;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Maximum number of points of a path: a longer take is shown more coarsely.
const MOST: usize = 2000;

/// The bone of a path, and where the path is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathOf {
    /// The bone.
    pub bone: BoneIndex,
    /// Whether the path is on the ground below the bone, without keys that could be dragged.
    pub ground: bool,
}

/// The inputs of a path: generation of the view, take, bone, frame rate, version of the flags of bones.
type PathSource = (u64, usize, PathOf, u32, u64);

/// The path, its keys, and poses at the times of its keys.
#[derive(Debug, Default)]
pub struct MotionPath {
    /// Poses at other times than the one shown.
    posed: PoseCache,
    source: Option<PathSource>,
    look: Option<Arc<PathLook>>,
    keys: Vec<PathKey>,
}

impl MotionPath {
    /// Returns the path to be drawn, if there is one.
    pub fn look(&self) -> Option<&Arc<PathLook>> {
        self.look.as_ref()
    }

    /// Returns the keys on the path.
    pub(super) fn keys(&self) -> &[PathKey] {
        &self.keys
    }

    /// Shows muted bones at rest, as the viewport does.
    pub(super) fn hold_still(&mut self, flags: &BoneFlags, view: &View) {
        self.posed.hold_still(flags, view);
    }

    /// Returns the poses at another time than the one shown.
    pub(super) fn posed(&mut self) -> &mut PoseCache {
        &mut self.posed
    }

    /// Removes the path. Returns whether there was one.
    pub(super) fn clear(&mut self) -> bool {
        self.look = None;
        self.keys.clear();
        self.source.take().is_some()
    }

    /// Computes the path of a bone where something changed. Returns whether it did.
    pub(super) fn update(
        &mut self,
        view: &View,
        take: usize,
        of: PathOf,
        frame_rate: u32,
        flags: &BoneFlags,
    ) -> bool {
        let source = (view.generation, take, of, frame_rate, flags.version());
        let PathOf { bone, ground } = of;
        if self.source == Some(source) {
            return false;
        }
        let takes = self.posed.takes(view);
        let Some(shown) = takes.get(take) else { return false };
        let chain = JointChain::of(view, take, shown, bone);
        let joint = |time: f32| {
            let place = chain.joint(time);
            if ground { Vec3::new(place.x, 0.0, place.z) } else { place }
        };
        let rate = frame_rate.max(1) as f32;
        let frames = (shown.length * rate).max(0.0);
        let step = (frames / MOST as f32).ceil().max(1.0) / rate;
        // If the length is a whole number of frames except for rounding, the last frame is included.
        let count = (shown.length / step + 1e-3).max(0.0) as usize + 1;
        let times = (0..count.min(MOST + 1)).map(|index| shown.start + index as f32 * step);
        let points = times.map(|time| (time, joint(time))).filter(|point| point.1.is_finite()).collect();
        let key_times = shown.tracks.iter().find(|track| track.bone == bone).map(Track::key_times);
        let times = key_times.filter(|_| !ground).unwrap_or_default();
        self.keys.clear();
        // More keys would overlap on the screen.
        self.keys.extend(times.iter().take(MOST).map(|&time| PathKey { time, place: chain.joint(time) }));
        self.keys.retain(|key| key.place.is_finite());
        let keys = self.keys.iter().map(|key| (key.time, key.place)).collect();
        self.look = Some(Arc::new(PathLook { points, keys }));
        self.source = Some(source);
        true
    }

    /// Returns the pose that moves the joint of `bone` to the position of a key; no other bone moves.
    pub(super) fn pose_at(
        &mut self,
        view: &View,
        take: Option<usize>,
        bone: BoneIndex,
        key: PathKey,
    ) -> Option<BonePose> {
        let skeleton = &view.loaded.model.animation.skeleton;
        let animation = self.posed.update(view, take, key.time);
        let target = GizmoTarget::of(skeleton, animation.poses(), animation.to_root(), bone)?;
        let to_parent = target.parent_to_root.as_dmat4();
        let place = to_parent.inverse().transform_point3(key.place.as_dvec3()).as_vec3();
        place.is_finite().then(|| super::tool_drag::moved(bone, place))
    }
}

/// A bone and all above it, with their tracks: what the position of its joint is computed from.
struct JointChain<'a> {
    view: &'a View,
    take: usize,
    /// The bones with their tracks, from the root down.
    bones: Vec<(BoneIndex, Option<&'a Track>)>,
}

impl<'a> JointChain<'a> {
    fn of(view: &'a View, number: usize, take: &'a Take, bone: BoneIndex) -> Self {
        let skeleton = &view.loaded.model.animation.skeleton;
        let track = |bone: BoneIndex| take.tracks.iter().find(|track| track.bone == bone);
        let mut bones: Vec<_> = skeleton.with_ancestors(bone).map(|bone| (bone, track(bone))).collect();
        bones.reverse();
        Self { view, take: number, bones }
    }

    /// Returns the position of the joint at a time, with pending poses applied, scene space.
    fn joint(&self, time: f32) -> Vec3 {
        let skeleton = &self.view.loaded.model.animation.skeleton.bones;
        let pending = self.view.pending(Some(self.take), time);
        let mut to_root = Mat4::IDENTITY;
        for &(index, track) in &self.bones {
            let Some(bone) = skeleton.get(index as usize) else { continue };
            let mut pose = track.map_or_else(|| rest_pose(bone), |track| sample_track(track, bone, time));
            if let Some(pending) = pending.and_then(|pending| pending.of(index)) {
                pending.put_on(&mut pose);
            }
            to_root *= to_parent(bone, pose);
        }
        to_root.w_axis.truncate()
    }
}
