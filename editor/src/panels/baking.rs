//! Pins held over time: what keeps pinned bones where they are now, at every frame that plays.

use super::ruler::{frame_of, time_of};
use super::state::{Effect, State};
use super::status::Level;
use dragonfly_anim::data::{BoneIndex, Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, PoseAt, SAME_TIME, SetPoses};
use dragonfly_document::posing::{PoseDragState, poses_of_pins};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Most times at which poses are made in one step.
const MOST: usize = 20_000;

impl State {
    /// Turns the rows of bones above the pins at every frame of what plays, so that pinned bones stay where and how they are
    /// now. The rows get keys at all frames, and at the keys that they have between them.
    pub(super) fn bake_pins(&mut self) -> Option<Effect> {
        let here = self.hold()?;
        let (name, view) = (self.take_ref()?, self.view.as_ref()?);
        // As it is seen: muted bones rest.
        let take = Arc::clone(self.posed.takes(view).get(self.playback.take?)?);
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let (fixed, mode) = (self.fixed_bones(), self.ik);
        let mut poses = vec![Transform::IDENTITY; skeleton.len()];
        let mut at_time = |time: f32| {
            sample_take(Some(&take), &skeleton, time, &mut poses);
            let hold = PoseDragState::new(Arc::clone(&skeleton), &poses, &[], mode, None);
            poses_of_pins(&mut hold.with_fixed(&fixed).with_pins_of(&here))
        };
        let rows: BTreeSet<BoneIndex> = at_time(take.start).iter().filter_map(bone_of).collect();
        if rows.is_empty() {
            self.status.say(Level::Info, "Nothing above the pinned bones can turn to hold them");
            return None;
        }
        let times = self.times_to_bake(&take, &rows);
        if times.len() > MOST {
            let text = format!("{} frames are too many at once: set a play range", times.len());
            self.status.say(Level::Info, text);
            return None;
        }
        let at = times.into_iter().map(|time| PoseAt { time, poses: at_time(time) }).collect();
        let edit = Edit::SetPoses(SetPoses { take: name, at, unstep: true });
        Some(Effect::Change(Change::Edit(edit, None)))
    }

    /// The frames that play, with both ends, and the keys of the bones between them; ascending.
    fn times_to_bake(&self, take: &Take, bones: &BTreeSet<BoneIndex>) -> Vec<f32> {
        let (from, length) = self.play_bounds();
        let (to, rate) = (from + length, self.settings.frame_rate);
        let inside = |time: &f32| (from..=to).contains(time);
        // More than enough to be told that it is too many.
        let last = frame_of(to, rate).min(frame_of(from, rate).saturating_add(2 * MOST as i64));
        let frames = (frame_of(from, rate)..=last).map(|frame| time_of(frame, rate));
        let tracks = take.tracks.iter().filter(|track| bones.contains(&track.bone));
        let keys = tracks.flat_map(|track| track.rotation.times.iter().copied());
        // Keys before frames: of two that are at the same time, the key is there already.
        let mut times: Vec<f32> = keys.chain(frames).chain([from, to]).filter(inside).collect();
        times.sort_by(f32::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier <= SAME_TIME);
        times
    }
}

fn bone_of(pose: &BonePose) -> Option<BoneIndex> {
    if let BoneRef::Index(bone) = pose.bone { Some(bone) } else { None }
}
