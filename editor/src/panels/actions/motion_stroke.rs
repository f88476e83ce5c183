//! The motion stroke: a stroke in the view becomes the path that a bone takes over time.

use super::pose_line::{begin, chain_of};
use super::{edit, locks};
use crate::control::line::{DrawnStroke, LineUse};
use crate::panels::keys::channel;
use crate::panels::request::Effect;
use crate::panels::ruler::{frame_of, time_of};
use crate::panels::status::MessageSeverity;
use crate::panels::tool_drag::moved;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take, Transform};
use dragonfly_anim::sample::sample_take;
use dragonfly_anim::stage::line::LineSamples;
use dragonfly_document::edit::{BonePose, BoneRef, Edit, PoseAt, SAME_TIME, SetPoses};
use dragonfly_document::posing::{Goal, IkMode, PoseDragState, poses_of_drag};
use dragonfly_picture::camera::{Camera, Projection};
use glam::{DVec3, Vec3};
use std::sync::Arc;

/// Maximum number of frames on which a bone is moved in one step.
const MOST: usize = 20_000;

/// Warning about a stroke that a bone cannot follow.
const LEAVES: &str = "The bone cannot follow this stroke: it leaves the view";

/// Largest distance between the stroke and the way from one key to the next, as a part of the length of the stroke.
const TOLERANCE: f64 = 0.005;

/// Length of a path, as a part of that of the stroke, below which a bone counts as not moving.
const STILL: f64 = 1e-3;

/// Begins to draw the motion path of the selected bone or chain; a second time ends it.
pub(in crate::panels) fn choose(workspace: &mut Workspace) {
    let is_on = workspace.tools.controls().line().use_of() == Some(LineUse::Motion);
    if is_on {
        return workspace.tools.controls_mut().line_mut().choose(None);
    }
    let Some((bone, _)) = driven(workspace) else { return };
    begin(
        workspace,
        bone,
        LineUse::Motion,
        "Draw the path of the bone over the selected keys or the play range; press Esc to stop",
    );
}

/// Moves the selected bone, or the end of the selected chain, along a stroke: at the selected keys, or over the play range. It keeps its timing, and its
/// distance from the camera.
pub(super) fn draw(workspace: &mut Workspace, stroke: &DrawnStroke) -> Option<Effect> {
    let (bone, mode) = driven(workspace)?;
    let panels = workspace.read();
    let (name, view) = (panels.take_ref()?, panels.view?);
    // The take as the viewport shows it.
    let take = Arc::clone(panels.posed.takes(view).get(panels.playback.take?)?);
    let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
    let (fixed, rate) = (panels.fixed_bones(), panels.frame_rate);
    let selected = selected_times(workspace, &take);
    let [from, to] = match selected[..] {
        [first, .., last] => [first, last],
        _ => {
            let (start, length) = panels.play_bounds();
            [start, start + length]
        }
    };
    let pins = workspace.bones.pins().to_vec();
    let mut poses = vec![Transform::IDENTITY; skeleton.len()];
    let mut hold_at = |time: f32| {
        sample_take(Some(&take), &skeleton, time, &mut poses);
        PoseDragState::new(Arc::clone(&skeleton), &poses, &pins, mode, None).with_fixed(&fixed)
    };
    let frames = frames_between([from, to], rate);
    if frames.len() < 2 || frames.len() > MOST {
        let text = match frames.len() {
            0 | 1 => "The path takes no time: select several keys, or set a play range".to_owned(),
            count => format!("Cannot move a bone on {count} frames at once: set a shorter play range"),
        };
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    let places: Vec<DVec3> =
        frames.iter().map(|&time| hold_at(time).place(bone).unwrap_or_default().as_dvec3()).collect();
    let samples = LineSamples::new(&stroke.control, false);
    let camera = *workspace.camera.camera();
    let timing = PathTiming::new(&frames, &places, samples.length());
    let target = |time: f32, place: DVec3| {
        let on_stroke = samples.at(timing.share(time) * samples.length())?;
        at_depth(&camera, on_stroke, place)
    };
    let reach = |hold: &mut PoseDragState, place: Vec3| match hold.moves_by_chain(bone) {
        true => Some(poses_of_drag(hold, &[], &[Goal { bone, place }])),
        false => {
            let to = hold.in_parent(bone, place)?;
            Some(poses_of_drag(hold, &[moved(bone, to)], &[]))
        }
    };
    let times = if selected.len() > 1 {
        selected
    } else {
        let targets: Option<Vec<DVec3>> =
            frames.iter().zip(&places).map(|(&time, &place)| target(time, place)).collect();
        let Some(targets) = targets else {
            workspace.say(MessageSeverity::Warning, LEAVES);
            return None;
        };
        let mut times = needed_times(&frames, &targets, TOLERANCE * samples.length());
        // Keys that the bones have already would pull them away from the stroke.
        let first = reach(&mut hold_at(from), places[0].as_vec3())?;
        let bones: Vec<BoneIndex> = first.iter().filter_map(bone_of).collect();
        let tracks = take.tracks.iter().filter(|track| bones.contains(&track.bone));
        let own = tracks.flat_map(|track| track.rotation.times.iter().chain(&*track.translation.times));
        times.splice(..0, own.copied().filter(|time| (from..=to).contains(time)));
        sorted(times)
    };
    let at: Option<Vec<PoseAt>> = times
        .into_iter()
        .map(|time| {
            let mut hold = hold_at(time);
            let place = target(time, hold.place(bone)?.as_dvec3())?.as_vec3();
            Some(PoseAt { time, poses: reach(&mut hold, place)? })
        })
        .collect();
    let Some(at) = at else {
        workspace.say(MessageSeverity::Warning, LEAVES);
        return None;
    };
    locks::unlocked(workspace, edit(Edit::SetPoses(SetPoses { take: name, at, unstep: true })))
}

/// Returns the bone that follows a stroke, and how those above it do; reports why there is none. A bone that is selected alone is moved as on its motion
/// path; of a chain, the end is moved, and the selected bones turn.
fn driven(workspace: &mut Workspace) -> Option<(BoneIndex, IkMode)> {
    let view = workspace.model.view()?;
    let skeleton = &view.loaded.model.animation.skeleton;
    let mode = workspace.read().ik;
    match *workspace.bones.selection().bones() {
        [bone] => return Some((bone, mode)),
        [] => workspace.say(MessageSeverity::Info, "Select the bone that is to follow the stroke first"),
        _ => match chain_of(skeleton, workspace.bones.selection().bones()) {
            Ok(chain) => {
                let length = joints_between(skeleton, chain.root, chain.end);
                return Some((chain.end, IkMode { on: true, length, ..mode }));
            }
            Err(reason) => workspace.say(MessageSeverity::Info, reason),
        },
    }
    None
}

/// Returns the number of bones from `root` to the parent of `end`.
fn joints_between(skeleton: &Skeleton, root: BoneIndex, end: BoneIndex) -> u32 {
    let above = std::iter::successors(skeleton.parent(end), |&bone| skeleton.parent(bone));
    above.take_while(|&bone| bone >= root).count() as u32
}

/// Returns the times of the selected keys of bones, ascending, each once.
fn selected_times(workspace: &Workspace, take: &Take) -> Vec<f32> {
    let mut times = Vec::new();
    for (channel, intervals) in workspace.keys.selection().channels() {
        let of_channel = channel::times(take, channel);
        times.extend(intervals.keys(of_channel).flat_map(|keys| of_channel[keys].iter().copied()));
    }
    sorted(times)
}

fn sorted(mut times: Vec<f32>) -> Vec<f32> {
    // Of two at almost the same time, the earlier one is kept.
    times.sort_by(f32::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier <= SAME_TIME);
    times
}

/// Returns the times of all frames between two times, and these. More than [`MOST`] are cut off a little later.
fn frames_between([from, to]: [f32; 2], rate: u32) -> Vec<f32> {
    let first = frame_of(from, rate);
    let last = frame_of(to, rate).min(first.saturating_add(2 * MOST as i64));
    let frames = (first..=last).map(|frame| time_of(frame, rate));
    sorted([from, to].into_iter().chain(frames.filter(|time| (from..=to).contains(time))).collect())
}

/// Distance of a bone along its path at each time.
struct PathTiming {
    times: Vec<f32>,
    /// Shares of the path from 0 to 1, ascending.
    shares: Vec<f64>,
}

impl PathTiming {
    /// Measures the path of a bone, of which `places` are at `times`. One that does not move goes along the stroke evenly.
    fn new(times: &[f32], places: &[DVec3], stroke: f64) -> Self {
        let mut length = 0.0;
        let mut lengths = vec![0.0];
        for pair in places.windows(2) {
            length += pair[0].distance(pair[1]);
            lengths.push(length);
        }
        let [first, last] = [times.first(), times.last()].map(|time| f64::from(*time.unwrap_or(&0.0)));
        let even = |time: &f32| (f64::from(*time) - first) / (last - first);
        let shares = match length > STILL * stroke {
            true => lengths.into_iter().map(|own| own / length).collect(),
            false => times.iter().map(even).collect(),
        };
        Self { times: times.to_vec(), shares }
    }

    fn share(&self, time: f32) -> f64 {
        let next = self.times.partition_point(|&own| own < time);
        let share = |at: usize| self.shares[at.min(self.shares.len() - 1)];
        let Some(before) = next.checked_sub(1).filter(|_| next < self.times.len()) else {
            return share(next);
        };
        let [from, to] = [before, next].map(|at| f64::from(self.times[at]));
        share(before) + (share(next) - share(before)) * (f64::from(time) - from) / (to - from)
    }
}

/// Returns the point that is seen where `seen` is, as far from the camera as `place`; `None` at the back of the camera.
fn at_depth(camera: &Camera, seen: DVec3, place: DVec3) -> Option<DVec3> {
    let (eye, back) = (camera.eye().as_dvec3(), camera.back().as_dvec3());
    let found = match camera.projection {
        Projection::Perspective => {
            let [of_place, of_seen] = [place, seen].map(|point| (point - eye).dot(back));
            (of_place < 0.0 && of_seen < 0.0).then(|| eye + (seen - eye) * (of_place / of_seen))?
        }
        Projection::Orthographic => seen + back * (place - seen).dot(back),
    };
    found.is_finite().then_some(found)
}

/// Returns the times at which keys are needed so that the way from one to the next is at most `tolerance` away from the targets at all times.
fn needed_times(times: &[f32], targets: &[DVec3], tolerance: f64) -> Vec<f32> {
    let last = times.len() - 1;
    let mut needed = vec![times[0], times[last]];
    let mut parts = vec![[0, last]];
    while let Some([from, to]) = parts.pop() {
        let away = |at: usize| {
            let share = f64::from(times[at] - times[from]) / f64::from(times[to] - times[from]);
            targets[from].lerp(targets[to], share).distance(targets[at])
        };
        let worst = (from + 1..to).max_by(|&a, &b| away(a).total_cmp(&away(b)));
        if let Some(worst) = worst.filter(|&worst| away(worst) > tolerance) {
            needed.push(times[worst]);
            parts.extend([[from, worst], [worst, to]]);
        }
    }
    needed
}

fn bone_of(pose: &BonePose) -> Option<BoneIndex> {
    if let BoneRef::Index(bone) = pose.bone { Some(bone) } else { None }
}
