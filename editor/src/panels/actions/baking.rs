//! Bakes pins: adds keys that keep pinned bones where they are now, at every frame of the play range.

use super::{edit, ik};
use crate::panels::request::Effect;
use crate::panels::ruler::{frame_of, time_of};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, PoseAt, SAME_TIME, SetPoses};
use dragonfly_document::posing::{PoseDragState, poses_of_pins};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Maximum number of times at which pins are baked in one step.
const MOST: usize = 20_000;

/// Rotates the chains above the pins at every frame of the play range, or of the take, so that pinned bones keep their
/// position and rotation. The bones of the chains get keys at all frames, and at the keys that they have between the
/// frames.
pub(in crate::panels) fn bake_pins(workspace: &mut Workspace) -> Option<Effect> {
    let here = ik::hold(workspace)?;
    let panels = workspace.read();
    let (name, view) = (panels.take_ref()?, panels.view?);
    // The take as the viewport shows it: muted bones are in the rest pose.
    let take = Arc::clone(panels.posed.takes(view).get(panels.playback.take?)?);
    let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
    let (fixed, mode) = (panels.fixed_bones(), panels.ik);
    let (play, rate) = (panels.play_bounds(), panels.frame_rate);
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    let mut at_time = |time: f32| {
        sample_take(Some(&take), &skeleton, time, &mut poses);
        let hold = PoseDragState::new(Arc::clone(&skeleton), &poses, &[], mode, None);
        poses_of_pins(&mut hold.with_fixed(&fixed).with_pins_of(&here))
    };
    let chains: BTreeSet<BoneIndex> = at_time(take.start).iter().filter_map(bone_of).collect();
    if chains.is_empty() {
        workspace
            .say(MessageSeverity::Info, "No parent of the pinned bones can rotate to keep them in place");
        return None;
    }
    let times = times_to_bake(&take, &chains, play, rate);
    if times.len() > MOST {
        let text = format!("Cannot bake {} frames at once: set a shorter play range", times.len());
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    let at = times.into_iter().map(|time| PoseAt { time, poses: at_time(time) }).collect();
    Some(edit(Edit::SetPoses(SetPoses { take: name, at, unstep: true })))
}

/// Returns the times of all frames of the play range, including both ends, and of the keys of `bones` between them;
/// ascending.
fn times_to_bake(
    take: &Take,
    bones: &BTreeSet<BoneIndex>,
    (from, length): (f32, f32),
    rate: u32,
) -> Vec<f32> {
    let to = from + length;
    let inside = |time: &f32| (from..=to).contains(time);
    // The number of frames is limited, but to more than [`MOST`], so that the caller can report an error.
    let last = frame_of(to, rate).min(frame_of(from, rate).saturating_add(2 * MOST as i64));
    let frames = (frame_of(from, rate)..=last).map(|frame| time_of(frame, rate));
    let tracks = take.tracks.iter().filter(|track| bones.contains(&track.bone));
    let keys = tracks.flat_map(|track| track.rotation.times.iter().copied());
    // Keys before frames: of two at the same time, the key's exact time is kept.
    let mut times: Vec<f32> = keys.chain(frames).chain([from, to]).filter(inside).collect();
    times.sort_by(f32::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier <= SAME_TIME);
    times
}

fn bone_of(pose: &BonePose) -> Option<BoneIndex> {
    if let BoneRef::Index(bone) = pose.bone { Some(bone) } else { None }
}
