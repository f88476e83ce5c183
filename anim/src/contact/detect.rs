//! Detection of contacts from height and speed, with hysteresis.
//!
//! With `p(f)` the position of the bone at frame `f`, `up` the unit vector that points up, `r` the frame rate and `g` the
//! height of the bone when it stands, by default the 1st percentile of its heights:
//!
//! ```text
//! h(f) = p(f) · up − g                                height above the ground
//! v(f) = |p(f+1) − p(f−1)| · r / 2                    speed; one-sided at the ends
//! contact begins   where h < enter_height and v < enter_speed
//! contact continues while h < leave_height and v < leave_speed
//! ```
//!
//! The larger thresholds for leaving keep a contact whole where height or speed oscillates about a threshold. A contact is
//! then extended backward while the larger thresholds hold, so that reversing a take reverses its contacts. Contacts
//! shorter than `least` seconds are dropped. Thresholds on height and velocity are the usual criterion (Kovar, Schreiner,
//! Gleicher, "Footskate cleanup for motion capture editing", 2002, §2); the two levels are those of a Schmitt trigger.

use super::Contact;
use crate::data::BoneIndex;
use crate::frames::TakeFrames;
use crate::motion::Axis;

/// Thresholds of contacts, in meters and meters per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactThresholds {
    /// Height below which a contact begins, meters.
    pub enter_height: f32,
    /// Height above which a contact ends, meters; at least `enter_height`.
    pub leave_height: f32,
    /// Speed below which a contact begins, meters per second.
    pub enter_speed: f32,
    /// Speed above which a contact ends, meters per second; at least `enter_speed`.
    pub leave_speed: f32,
    /// Shortest contact, seconds.
    pub least: f32,
    /// Height of the ground in the model's unit. `None`: the lowest height of each bone in the take, without a hundredth of its frames, so
    /// that an ankle needs no height of its own.
    pub ground: Option<f32>,
    /// The axis that points up.
    pub up: Axis,
    /// Meters in one unit of length of the model: 1 for glTF, 0.01 for centimeters.
    pub meters_per_unit: f32,
}

impl Default for ContactThresholds {
    /// Returns thresholds for a figure of human size in meters: 3 and 5 cm, 0.15 and 0.3 m/s, a tenth of a second.
    fn default() -> Self {
        Self {
            enter_height: 0.03,
            leave_height: 0.05,
            enter_speed: 0.15,
            leave_speed: 0.3,
            least: 0.1,
            ground: None,
            up: Axis::Y,
            meters_per_unit: 1.0,
        }
    }
}

/// Returns the contacts of `bones`, bone by bone, in order of time. Bones that do not exist have none.
pub fn detect_contacts(
    frames: &TakeFrames,
    bones: &[BoneIndex],
    thresholds: &ContactThresholds,
) -> Vec<Contact> {
    let mut contacts = Vec::new();
    for &bone in bones.iter().filter(|&&bone| (bone as usize) < frames.bones()) {
        for (first, last) in runs(&levels(frames, bone, thresholds)) {
            let (from, to) = (frames.times()[first], frames.times()[last]);
            // Half a frame less than a whole number of frames, so that rounding of times does not matter.
            if to - from + 0.5 / frames.rate() >= thresholds.least {
                contacts.push(Contact { bone, from, to });
            }
        }
    }
    contacts
}

/// How well a frame meets the thresholds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ContactLevel {
    /// Above the thresholds for leaving.
    Free,
    /// Below the thresholds for leaving, not below those for entering.
    Held,
    /// Below the thresholds for entering.
    Touching,
}

fn levels(frames: &TakeFrames, bone: BoneIndex, thresholds: &ContactThresholds) -> Vec<ContactLevel> {
    let (up, unit) = (thresholds.up.to_vec3(), thresholds.meters_per_unit);
    let height = |frame: usize| frames.position(frame, bone).dot(up);
    let ground = thresholds.ground.unwrap_or_else(|| lowest((0..frames.len()).map(height)));
    let level = |frame: usize| {
        let height = (height(frame) - ground) * unit;
        let speed = frames.velocity(frame, bone).length() * unit;
        let leave_height = thresholds.leave_height.max(thresholds.enter_height);
        let leave_speed = thresholds.leave_speed.max(thresholds.enter_speed);
        if height < thresholds.enter_height && speed < thresholds.enter_speed {
            ContactLevel::Touching
        } else if height < leave_height && speed < leave_speed {
            ContactLevel::Held
        } else {
            ContactLevel::Free
        }
    };
    (0..frames.len()).map(level).collect()
}

/// Share of the frames that may be below the ground: a capture often begins with a frame in another pose.
const BELOW: f32 = 0.01;

/// Returns the height that all but a hundredth of `heights` reach; the lowest of fewer than a hundred.
fn lowest(heights: impl Iterator<Item = f32>) -> f32 {
    let mut heights: Vec<f32> = heights.collect();
    heights.sort_by(f32::total_cmp);
    heights.get((heights.len() as f32 * BELOW) as usize).copied().unwrap_or(0.0)
}

/// Returns the first and last frame of each run without a free frame that contains a touching one.
fn runs(levels: &[ContactLevel]) -> Vec<(usize, usize)> {
    let mut runs = Vec::new();
    let mut start = None;
    let mut touches = false;
    for frame in 0..=levels.len() {
        match levels.get(frame).copied().unwrap_or(ContactLevel::Free) {
            ContactLevel::Free => {
                if let Some(first) = start.take().filter(|_| touches) {
                    runs.push((first, frame - 1));
                }
                touches = false;
            }
            level @ (ContactLevel::Held | ContactLevel::Touching) => {
                start = start.or(Some(frame));
                touches |= level == ContactLevel::Touching;
            }
        }
    }
    runs
}
