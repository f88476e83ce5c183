//! The gap between the end of a take and its start.
//!
//! With `n` the last frame, `r` the frame rate and positions relative to the bone that travels (its place on the ground):
//!
//! ```text
//! position  |p(n) − p(0)|
//! velocity  |(p(1) − p(0)) − (p(n) − p(n−1))| · r
//! rotation  angle between the rotations relative to the parents
//! ```
//!
//! A take is *one frame short* if it repeats when its last frame is followed by one more step: the last frame is missing,
//! as exporters leave it out because it equals the first. The test compares the mean gap `g` with the mean gap `g'` after the
//! step `p(n) + (p(n) − p(n−1) + p(1) − p(0)) / 2`, and with the mean step `s`: `g' < g / 2` and `s / 2 < g < 2 s`.

use crate::data::BoneIndex;
use crate::frames::TakeFrames;
use crate::motion::Axis;
use glam::Vec3;

/// The gap of one bone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoneLoopGap {
    /// The bone.
    pub bone: BoneIndex,
    /// Distance between the last and the first position, in the model's unit.
    pub position: f32,
    /// Length of the difference between the last and the first velocity, units per second.
    pub velocity: f32,
    /// Angle between the last and the first rotation relative to the parent, radians.
    pub rotation: f32,
}

/// Returns the position of `bone` at `frame`, relative to the place on the ground of the bone that travels.
pub(super) fn relative(
    frames: &TakeFrames,
    frame: usize,
    bone: BoneIndex,
    travel: Option<BoneIndex>,
    up: Axis,
) -> Vec3 {
    let place = travel.map_or(Vec3::ZERO, |travel| {
        let (position, up) = (frames.position(frame, travel), up.to_vec3());
        position - up * position.dot(up)
    });
    frames.position(frame, bone) - place
}

/// Returns the gap of each bone, in bone order. A take with a single frame has none.
///
/// `travel` is the bone whose movement on the ground is left out.
pub fn loop_gaps(frames: &TakeFrames, travel: Option<BoneIndex>, up: Axis) -> Vec<BoneLoopGap> {
    let travel = travel.filter(|&travel| (travel as usize) < frames.bones());
    let last = frames.len() - 1;
    let gap = |bone: BoneIndex| {
        let at = |frame: usize| relative(frames, frame, bone, travel, up);
        let (first_step, last_step) =
            if last > 0 { (at(1) - at(0), at(last) - at(last - 1)) } else { (Vec3::ZERO, Vec3::ZERO) };
        let between = frames.pose(last, bone).rotation.conjugate() * frames.pose(0, bone).rotation;
        BoneLoopGap {
            bone,
            position: at(last).distance(at(0)),
            velocity: (first_step - last_step).length() * frames.rate(),
            rotation: 2.0 * libm::atan2f(between.xyz().length(), between.w.abs()),
        }
    };
    (0..frames.bones() as BoneIndex).map(gap).collect()
}

/// Returns whether the take lacks its last frame: it would repeat if it went on for one frame.
pub fn is_one_frame_short(frames: &TakeFrames, travel: Option<BoneIndex>, up: Axis) -> bool {
    let travel = travel.filter(|&travel| (travel as usize) < frames.bones());
    let last = frames.len() - 1;
    if last < 2 || frames.bones() == 0 {
        return false;
    }
    let (mut gap, mut gap_after, mut step) = (0.0_f64, 0.0_f64, 0.0_f64);
    for bone in 0..frames.bones() as BoneIndex {
        let at = |frame: usize| relative(frames, frame, bone, travel, up);
        let mean_step = ((at(last) - at(last - 1)) + (at(1) - at(0))) * 0.5;
        gap += f64::from(at(last).distance(at(0)));
        gap_after += f64::from((at(last) + mean_step).distance(at(0)));
        step += f64::from(mean_step.length());
    }
    gap_after < gap / 2.0 && gap > step / 2.0 && gap < 2.0 * step
}
