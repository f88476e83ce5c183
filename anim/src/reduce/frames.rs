//! The original take sampled on every frame: the matrices of every bone, and its tolerance there.

use super::contact::find_contacts;
use super::settings::Lengths;
use super::{Contact, ReduceError, ReduceSettings};
use crate::animation::to_root;
use crate::data::{Channel, Interpolation, Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::Mat4;

/// Largest number of bones × frames of a take: about 1.5 GiB of working memory.
pub const SAMPLES: usize = 8 << 20;

/// Poses and matrices of every bone of the original on every frame.
pub(super) struct SampledTake {
    /// Seconds, ascending.
    pub(super) times: Vec<f32>,
    /// Relative to the parents; at position `frame * bones + bone`.
    pub(super) poses: Vec<Transform>,
    /// Bone space → scene space; at position `frame * bones + bone`.
    pub(super) to_root: Vec<Mat4>,
    /// Whether the bone is in contact; at position `frame * bones + bone`.
    in_contact: Vec<bool>,
    /// The contacts that are considered.
    pub(super) contacts: Vec<Contact>,
}

impl SampledTake {
    pub(super) fn new(
        take: &Take,
        skeleton: &Skeleton,
        settings: &ReduceSettings,
    ) -> Result<Self, ReduceError> {
        let bones = skeleton.len();
        let times = frame_times(take, bones, settings.frames_per_second)?;
        let samples = times.len() * bones;
        let mut poses = vec![Transform::IDENTITY; samples];
        let mut matrices = vec![Mat4::IDENTITY; samples];
        for (frame, &time) in times.iter().enumerate() {
            let row = frame * bones..(frame + 1) * bones;
            sample_take(Some(take), skeleton, time, &mut poses[row.clone()]);
            to_root(skeleton, &poses[row.clone()], &mut matrices[row]);
        }
        let mut contacts = settings.contacts.given.clone();
        contacts.retain(|contact| (contact.bone as usize) < bones);
        if let Some(search) = &settings.contacts.search {
            let unit = Lengths::of(settings).millimeters_per_unit;
            contacts.extend(find_contacts(&times, &matrices, bones, unit, search));
        }
        let mut in_contact = vec![false; samples];
        for contact in &contacts {
            for (frame, time) in times.iter().enumerate() {
                if (contact.from..=contact.to).contains(time) {
                    in_contact[frame * bones + contact.bone as usize] = true;
                }
            }
        }
        Ok(Self { times, poses, to_root: matrices, in_contact, contacts })
    }

    /// Returns the tolerance of the bone at position `at`, in the model's unit.
    pub(super) fn tolerance(&self, at: usize, lengths: Lengths) -> f64 {
        if self.in_contact[at] { lengths.contact } else { lengths.tolerance }
    }
}

/// Returns every key time of the take, the last time before each key of a step channel, and `per_second` frames per
/// second between; ascending, each once.
fn frame_times(take: &Take, bones: usize, per_second: f32) -> Result<Vec<f32>, ReduceError> {
    let limit = SAMPLES / bones.max(1);
    let too_many = |frames: usize| ReduceError::TooLarge { frames, bones, limit: SAMPLES };
    let mut times: Vec<f32> = Vec::new();
    for track in take.tracks.iter().take(bones) {
        times.extend(track.key_times().into_iter().filter(|time| time.is_finite()));
        before_steps(&track.translation, &mut times);
        before_steps(&track.rotation, &mut times);
        before_steps(&track.scale, &mut times);
        // Removes duplicates early: the tracks of a take mostly share their key times.
        if times.len() > 2 * limit {
            sort(&mut times);
            if times.len() > limit {
                return Err(too_many(times.len()));
            }
        }
    }
    sort(&mut times);
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Ok(vec![if take.start.is_finite() { take.start } else { 0.0 }]);
    };
    let step = 1.0 / f64::from(per_second);
    if step.is_finite() && step > 0.0 {
        let count = (f64::from(last) - f64::from(first)) / step;
        if times.len() as f64 + count > limit as f64 {
            return Err(too_many(times.len().saturating_add(count as usize)));
        }
        between(&mut times, first, step, count as usize);
    }
    if times.len() > limit { Err(too_many(times.len())) } else { Ok(times) }
}

/// Adds the time just before each step, where the values of other channels up to it are visible.
fn before_steps<T: Copy>(channel: &Channel<T>, times: &mut Vec<f32>) {
    if channel.interpolation == Interpolation::Step {
        let before = channel.times.iter().skip(1).map(|time| time.next_down());
        times.extend(before.filter(|time| time.is_finite()));
    }
}

/// Adds `count` frames to the sorted `times`, except where a key differs only by rounding.
fn between(times: &mut Vec<f32>, first: f32, step: f64, count: usize) {
    let keys = times.len();
    for frame in 1..=count {
        let time = (f64::from(first) + frame as f64 * step) as f32;
        let after = times[..keys].partition_point(|&key| key <= time);
        let beside = |key: Option<&f32>| {
            key.is_some_and(|&key| (f64::from(key) - f64::from(time)).abs() < 1e-3 * step)
        };
        let before = after.checked_sub(1).and_then(|before| times.get(before));
        if !beside(before) && !beside(times[..keys].get(after)) {
            times.push(time);
        }
    }
    sort(times);
}

fn sort(times: &mut Vec<f32>) {
    times.sort_by(f32::total_cmp);
    times.dedup();
}
