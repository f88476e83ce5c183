//! The motion path of the selected bone: where its joint is, frame by frame; and the times of ghosts.

use super::follow::Following;
use crate::control::path::PathKey;
use crate::panels::keys::BoneFlags;
use crate::panels::state::{Posed, State};
use dragonfly_anim::animation::to_parent;
use dragonfly_anim::data::{BoneIndex, Take, Track};
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::View;
use dragonfly_document::edit::{BonePose, BoneRef, Edit};
use dragonfly_document::posing::{self, Goal, poses_of_drag};
use dragonfly_picture::PathLook;
use dragonfly_picture::gizmo::GizmoTarget;
use glam::{Mat4, Vec3};
use std::sync::Arc;

/// Points of a path at most: a longer take is shown more coarsely.
const MOST: usize = 2000;

/// What a path follows from: generation of the view, take, bone, frame rate, version of the marks of bones.
type Of = (u64, usize, BoneIndex, u32, u64);

/// What is known of the path.
#[derive(Debug, Default)]
pub struct Trail {
    /// Poses at other times than the one shown.
    posed: Posed,
    of: Option<Of>,
    look: Option<Arc<PathLook>>,
    keys: Vec<PathKey>,
}

impl Trail {
    /// The path to be drawn, where one is.
    pub fn look(&self) -> Option<&Arc<PathLook>> {
        self.look.as_ref()
    }

    /// Shows bones at rest that the picture shows so.
    pub(in crate::panels) fn hold_still(&mut self, flags: &BoneFlags, view: &View) {
        self.posed.hold_still(flags, view);
    }
}

impl State {
    /// Computes the path anew where something changed that it follows from.
    pub(in crate::panels) fn follow_path(&mut self) {
        let of = self.view.as_ref().zip(self.playback.take).zip(self.selection.active());
        let of = of.filter(|_| self.settings.hand.path);
        let Some(((view, take), bone)) = of else {
            if self.trail.of.take().is_some() {
                self.trail.look = None;
                self.hands.path_mut().show(&[]);
            }
            return;
        };
        let key = (view.generation, take, bone, self.settings.frame_rate, self.keys.flags.version());
        if self.trail.of == Some(key) {
            return;
        }
        let takes = self.trail.posed.takes(view);
        let Some(shown) = takes.get(take) else { return };
        let chain = Chain::of(view, take, shown, bone);
        let rate = self.settings.frame_rate.max(1) as f32;
        let frames = (shown.length * rate).max(0.0);
        let step = (frames / MOST as f32).ceil().max(1.0) / rate;
        // A length that is whole frames but for rounding has its last one.
        let count = (shown.length / step + 1e-3).max(0.0) as usize + 1;
        let times = (0..count.min(MOST + 1)).map(|index| shown.start + index as f32 * step);
        let points =
            times.map(|time| (time, chain.joint(time))).filter(|point| point.1.is_finite()).collect();
        let key_times = shown.tracks.iter().find(|track| track.bone == bone).map(Track::key_times);
        let keys = key_times.unwrap_or_default();
        self.trail.keys.clear();
        // No more than can be told from each other.
        self.trail
            .keys
            .extend(keys.iter().take(MOST).map(|&time| PathKey { time, place: chain.joint(time) }));
        self.trail.keys.retain(|key| key.place.is_finite());
        let keys = self.trail.keys.iter().map(|key| (key.time, key.place)).collect();
        self.trail.look = Some(Arc::new(PathLook { points, keys }));
        self.trail.of = Some(key);
        self.hands.path_mut().show(&self.trail.keys);
    }

    /// When the skeleton is shown as a ghost: seconds, and how far from now, counted in ghosts; before now is negative.
    /// None while time passes.
    pub fn ghost_times(&self, out: &mut Vec<(f32, i32)>) {
        out.clear();
        let ghosts = &self.settings.hand.ghosts;
        let Some(take) = self.take().filter(|_| ghosts.shown && !self.playback.playing) else { return };
        let (start, end) = (take.start, take.start + take.length);
        for (direction, count) in [(-1, ghosts.count[0]), (1, ghosts.count[1])] {
            let mut time = self.time();
            for index in 1..=count as i32 {
                time = if ghosts.keys {
                    match self.key_beside_of(time, direction > 0) {
                        Some(next) if (next - time) * direction as f32 > 0.0 => next,
                        _ => break,
                    }
                } else {
                    time + (direction * ghosts.step as i32) as f32 / self.settings.frame_rate.max(1) as f32
                };
                if time < start - 1e-4 || time > end + 1e-4 {
                    break;
                }
                out.push((time, direction * index));
            }
        }
    }

    /// The edit that puts the joint of the selected bone there at a key. As with the gizmo, the bones above follow with IK
    /// on, and pinned bones stay where they are at that time; without either the bone moves alone.
    pub(super) fn path_edit(&mut self, key: PathKey) -> Option<Edit> {
        let (bone, take) = (self.selection.active()?, self.take_ref()?);
        self.begin_following_path(key.time);
        if let Following::From(hold) = &mut self.hold.following {
            let (mut poses, mut goals) = (Vec::new(), Vec::new());
            if hold.moves_by_chain(bone) {
                goals.push(Goal { bone, place: key.place });
            } else {
                poses.push(moved(bone, hold.in_parent(bone, key.place)?));
            }
            let poses = poses_of_drag(hold, &poses, &goals);
            return Some(self.edit_of(take, key.time, poses));
        }
        let view = self.view.as_ref()?;
        let skeleton = &view.loaded.model.animation.skeleton;
        let animation = self.trail.posed.update(view, self.playback.take, key.time);
        let target = GizmoTarget::of(skeleton, animation.poses(), animation.to_root(), bone)?;
        let to_parent = target.parent_to_root.as_dmat4();
        let place = to_parent.inverse().transform_point3(key.place.as_dvec3()).as_vec3();
        let place = Some(place).filter(|place| place.is_finite())?;
        Some(self.edit_of(take, key.time, vec![moved(bone, place)]))
    }

    /// Notes how everything stands at a time, at the begin of a drag of the path.
    fn begin_following_path(&mut self, time: f32) {
        if !matches!(self.hold.following, Following::Undecided) {
            return;
        }
        self.hold.following = Following::Nothing;
        let Some(view) = self.view.clone().filter(|_| self.follows()) else { return };
        let (take, fixed) = (self.playback.take, self.fixed_bones());
        let poses = self.trail.posed.update(&view, take, time).poses();
        let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
        let hold = posing::PoseDragState::new(skeleton, poses, &self.pins, self.ik, None).with_fixed(&fixed);
        self.hold.following = Following::From(Box::new(hold));
    }
}

fn moved(bone: BoneIndex, to: Vec3) -> BonePose {
    let translation = Some(to.to_array());
    BonePose { bone: BoneRef::Index(bone), translation, rotation: None, scale: None }
}

/// A bone and all above it, with their tracks: enough to know where its joint is.
struct Chain<'a> {
    view: &'a View,
    number: usize,
    /// From the root down.
    bones: Vec<(BoneIndex, Option<&'a Track>)>,
}

impl<'a> Chain<'a> {
    fn of(view: &'a View, number: usize, take: &'a Take, bone: BoneIndex) -> Self {
        let skeleton = &view.loaded.model.animation.skeleton.bones;
        let parent = |bone: &BoneIndex| {
            let parent = skeleton.get(*bone as usize)?.parent;
            // Above means before: so there is an end, whatever the numbers say.
            parent.filter(|parent| parent < bone)
        };
        let track = |bone: BoneIndex| take.tracks.iter().find(|track| track.bone == bone);
        let mut bones: Vec<_> =
            std::iter::successors(Some(bone), parent).map(|bone| (bone, track(bone))).collect();
        bones.reverse();
        Self { view, number, bones }
    }

    /// Where the joint is at a time, with what is pending there, scene space.
    fn joint(&self, time: f32) -> Vec3 {
        let skeleton = &self.view.loaded.model.animation.skeleton.bones;
        let pending = self.view.pending(Some(self.number), time);
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
