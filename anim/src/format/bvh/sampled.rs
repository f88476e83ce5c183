//! A take as a BVH file has it: at frames, relative to a rest pose without rotations.

use super::check as code;
use crate::animation::to_root;
use crate::data::{Skeleton, Take, Transform};
use crate::format::losses::Losses;
use crate::frames::{FramesError, MOST_POSES, frame_rate};
use crate::sample::sample_take;
use glam::{DQuat, DVec3, Mat4};

/// Share of a frame by which a key may be off its frame.
const OFF_FRAME: f64 = 0.02;

/// Rotations from the rest pose and positions of all bones in scene space, at every frame.
pub(super) struct FramePoses {
    rate: f32,
    parents: Vec<Option<usize>>,
    rest: Vec<DVec3>,
    /// Frame by frame.
    turned: Vec<DQuat>,
    positions: Vec<DVec3>,
    is_animated: Vec<bool>,
}

impl FramePoses {
    /// Samples a take at the lowest usual rate that has its keys; without a take, the rest pose once.
    pub(super) fn of(
        take: Option<&Take>,
        skeleton: &Skeleton,
        losses: &mut Losses,
    ) -> Result<Self, FramesError> {
        let bones = skeleton.len();
        let rate = take.map_or(30.0, frame_rate);
        let range = take.and_then(Take::range_of_keys).unwrap_or((0.0, 0.0));
        let start = f64::from(range.0);
        let last = (f64::from(range.1) - start) * f64::from(rate);
        let frames = ((last - OFF_FRAME).ceil().max(0.0) as usize).saturating_add(1);
        if frames.saturating_mul(bones) > MOST_POSES {
            return Err(FramesError::TooMany { frames, bones });
        }
        if let Some(take) = take {
            list_losses(take, start, rate, losses);
        }
        let parents = skeleton.bones.iter().map(|bone| bone.parent.map(|parent| parent as usize)).collect();
        let mut sampled = Self {
            rate,
            parents,
            rest: Vec::new(),
            turned: Vec::with_capacity(frames * bones),
            positions: Vec::with_capacity(frames * bones),
            is_animated: (0..bones)
                .map(|bone| {
                    take.and_then(|take| take.tracks.get(bone)).is_some_and(|track| !track.is_empty())
                })
                .collect(),
        };
        let mut locals = vec![Transform::IDENTITY; bones];
        let mut matrices = vec![Mat4::IDENTITY; bones];
        sample_take(None, skeleton, 0.0, &mut locals);
        let rest_turns = sampled.rotations(&locals);
        to_root(skeleton, &locals, &mut matrices);
        sampled.rest = matrices.iter().map(origin).collect();
        for frame in 0..frames {
            let time = (start + frame as f64 / f64::from(rate)) as f32;
            sample_take(take, skeleton, time, &mut locals);
            let turns = sampled.rotations(&locals);
            sampled.turned.extend(
                turns.iter().zip(&rest_turns).map(|(turn, rest)| (*turn * rest.conjugate()).normalize()),
            );
            to_root(skeleton, &locals, &mut matrices);
            sampled.positions.extend(matrices.iter().map(origin));
        }
        Ok(sampled)
    }

    /// Returns the rotations of bones in scene space.
    fn rotations(&self, locals: &[Transform]) -> Vec<DQuat> {
        let mut rotations: Vec<DQuat> = Vec::with_capacity(locals.len());
        for (local, parent) in locals.iter().zip(&self.parents) {
            let own = local.rotation.as_dquat().normalize();
            rotations.push(parent.map_or(own, |parent| rotations[parent] * own));
        }
        rotations
    }

    pub(super) fn frames(&self) -> usize {
        self.positions.len() / self.rest.len().max(1)
    }

    /// Returns the frames per second.
    pub(super) fn rate(&self) -> f32 {
        self.rate
    }

    /// Returns whether a take has keys for a bone.
    pub(super) fn is_animated(&self, bone: usize) -> bool {
        self.is_animated[bone]
    }

    /// Returns the position of a bone relative to its parent in the rest pose, in meters along the axes of the scene.
    pub(super) fn offset(&self, bone: usize) -> DVec3 {
        self.rest[bone] - self.parents[bone].map_or(DVec3::ZERO, |parent| self.rest[parent])
    }

    /// Returns whether a bone moves in its parent by more than `distance` in any frame.
    pub(super) fn moves(&self, bone: usize, distance: f64) -> bool {
        let offset = self.offset(bone);
        (0..self.frames()).any(|frame| self.local(frame, bone).1.distance(offset) > distance)
    }

    /// Returns the rotation and the position of a bone relative to its parent in a frame.
    pub(super) fn local(&self, frame: usize, bone: usize) -> (DQuat, DVec3) {
        let row = frame * self.rest.len();
        let (turn, position) = (self.turned[row + bone], self.positions[row + bone]);
        match self.parents[bone] {
            None => (turn, position),
            Some(parent) => {
                let back = self.turned[row + parent].conjugate();
                ((back * turn).normalize(), back * (position - self.positions[row + parent]))
            }
        }
    }
}

fn origin(matrix: &Mat4) -> DVec3 {
    matrix.w_axis.truncate().as_dvec3()
}

/// Lists keys that are not at a frame, and a start that is not zero.
fn list_losses(take: &Take, start: f64, rate: f32, losses: &mut Losses) {
    let off = |&&time: &&f32| {
        let frame = (f64::from(time) - start) * f64::from(rate);
        (frame - frame.round()).abs() > OFF_FRAME
    };
    let times = take
        .tracks
        .iter()
        .flat_map(|track| [&track.translation.times, &track.rotation.times, &track.scale.times]);
    let count: usize = times.map(|times| times.iter().filter(off).count()).sum();
    if count > 0 {
        let text = format!(
            "{count} keys are not at one of {rate} frames per second; the frames have the values of the curves"
        );
        losses.add("/animation/takes/0/tracks".to_owned(), code::KEYS_BETWEEN_FRAMES, text);
    }
    if start != 0.0 {
        let text = format!("the take starts at {start} s, a BVH file always at 0 s");
        losses.add("/animation/takes/0/start".to_owned(), code::START_NOT_STORED, text);
    }
}
