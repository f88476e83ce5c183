//! Foot slide measured in steps, so that a program can measure a long take without a pause.
//!
//! A contact is sampled at even times from its start to its end, as near to the frame rate as possible:
//!
//! ```text
//! mm/s of a contact = Σ |p(k+1) − p(k)| / (to − from)       in the plane of the ground
//! ```
//!
//! Only the foot and the bones above it are sampled, so the time is in proportion to the frames in contact, not to the take.
//! Where contacts are on frames this is the slide of [`super::contact_slide`].

use super::Contact;
use crate::animation::to_parent;
use crate::data::{BoneIndex, Skeleton, Take};
use crate::motion::Axis;
use crate::sample::{rest_pose, sample_track};
use glam::{Mat4, Vec3};

/// Largest number of samples of one contact: half an hour at 60 frames per second. A longer one is sampled more coarsely.
const MOST_SAMPLES: usize = 108_000;

/// The speed at which a bone slides in a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlideSpeed {
    /// The contact.
    pub contact: Contact,
    /// Mean speed on the ground in millimeters per second.
    pub millimeters_per_second: f32,
}

/// A measurement of the worst slide of some contacts that is in progress.
#[derive(Clone, Debug)]
pub struct SlideMeter {
    /// The contacts that are not measured yet, the next one last.
    waiting: Vec<Contact>,
    rate: f32,
    up: Vec3,
    unit: f32,
    /// The sample after the last one taken in the current contact, and the sum of the ways so far.
    sample: usize,
    place: Vec3,
    way: f32,
    worst: Option<SlideSpeed>,
}

impl SlideMeter {
    /// Begins to measure `contacts` at `rate` frames per second; a rate that is none counts as 30.
    pub fn new(contacts: &[Contact], rate: f32, up: Axis, meters_per_unit: f32) -> Self {
        Self {
            waiting: contacts.iter().rev().copied().collect(),
            rate: if rate.is_finite() && rate > 0.0 { rate } else { 30.0 },
            up: up.to_vec3(),
            unit: 1000.0 * meters_per_unit,
            sample: 0,
            place: Vec3::ZERO,
            way: 0.0,
            worst: None,
        }
    }

    /// Takes at most `samples` samples of `take`, which must be the same in each step. Returns whether all contacts are measured.
    pub fn step(&mut self, take: &Take, skeleton: &Skeleton, samples: usize) -> bool {
        for _ in 0..samples {
            let Some(&contact) = self.waiting.last() else { return true };
            let seconds = contact.to - contact.from;
            let count = (seconds * self.rate).round().clamp(1.0, MOST_SAMPLES as f32) as usize;
            let time = contact.from + seconds * (self.sample as f32 / count as f32);
            let position = joint(take, skeleton, contact.bone, time);
            let place = position - self.up * position.dot(self.up);
            if self.sample > 0 {
                self.way += place.distance(self.place) * self.unit;
            }
            self.place = place;
            self.sample += 1;
            if self.sample > count {
                self.finish(contact);
            }
        }
        self.waiting.is_empty()
    }

    /// Returns the contact that slides fastest of those measured so far, the first of equal ones.
    pub fn worst(&self) -> Option<SlideSpeed> {
        self.worst
    }

    fn finish(&mut self, contact: Contact) {
        self.waiting.pop();
        let speed = self.way / (contact.to - contact.from);
        let is_worse = self.worst.is_none_or(|worst| speed > worst.millimeters_per_second);
        if speed.is_finite() && is_worse {
            self.worst = Some(SlideSpeed { contact, millimeters_per_second: speed });
        }
        (self.sample, self.way) = (0, 0.0);
    }
}

/// Returns the position of a bone in scene space; the origin for a bone that does not exist.
fn joint(take: &Take, skeleton: &Skeleton, bone: BoneIndex, time: f32) -> Vec3 {
    let mut to_root = Mat4::IDENTITY;
    // From the bone up: each parent is multiplied on the left.
    for index in std::iter::once(bone).chain(skeleton.ancestors(bone)) {
        let Some(data) = skeleton.bones.get(index as usize) else { break };
        let pose = match take.tracks.get(index as usize) {
            Some(track) => sample_track(track, data, time),
            None => rest_pose(data),
        };
        to_root = to_parent(data, pose) * to_root;
    }
    let position = to_root.w_axis.truncate();
    if position.is_finite() { position } else { Vec3::ZERO }
}
