//! Foot slide: the way that a bone moves while it is in contact.
//!
//! ```text
//! mm of a contact  = Σ |p(f+1) − p(f)|       over the frames of the contact, in the plane of the ground
//! mm/s of a take   = Σ mm / Σ seconds        over all contacts
//! ```
//!
//! The height is left out: a foot that rolls from the heel to the toes does not slide.

use super::Contact;
use crate::frames::TakeFrames;
use crate::motion::Axis;

/// The slide of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSlide {
    /// The contact.
    pub contact: Contact,
    /// Length of the way on the ground, millimeters.
    pub millimeters: f32,
    /// Largest distance on the ground from the position at the start of the contact, millimeters.
    pub drift: f32,
}

/// The slide of all contacts of a take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TakeSlide {
    /// Length of the ways of all contacts, millimeters.
    pub millimeters: f32,
    /// Duration of all contacts, seconds.
    pub seconds: f32,
}

impl TakeSlide {
    /// Returns the mean speed in contacts in millimeters per second; 0 without contacts.
    pub fn millimeters_per_second(&self) -> f32 {
        if self.seconds > 0.0 { self.millimeters / self.seconds } else { 0.0 }
    }
}

/// Returns the slide of `contact`; that of a bone that does not exist is 0.
pub fn contact_slide(frames: &TakeFrames, contact: &Contact, up: Axis, meters_per_unit: f32) -> ContactSlide {
    let mut slide = ContactSlide { contact: *contact, millimeters: 0.0, drift: 0.0 };
    if contact.bone as usize >= frames.bones() {
        return slide;
    }
    let up = up.to_vec3();
    let on_ground = |frame: usize| {
        let position = frames.position(frame, contact.bone);
        position - up * position.dot(up)
    };
    let (first, last) = (frames.frame_at(contact.from), frames.frame_at(contact.to));
    let unit = 1000.0 * meters_per_unit;
    for frame in first..last {
        slide.millimeters += on_ground(frame + 1).distance(on_ground(frame)) * unit;
        slide.drift = slide.drift.max(on_ground(frame + 1).distance(on_ground(first)) * unit);
    }
    slide
}

/// Returns the slide of all `contacts` together.
pub fn take_slide(frames: &TakeFrames, contacts: &[Contact], up: Axis, meters_per_unit: f32) -> TakeSlide {
    let mut sum = TakeSlide::default();
    for contact in contacts {
        sum.millimeters += contact_slide(frames, contact, up, meters_per_unit).millimeters;
        sum.seconds += contact.to - contact.from;
    }
    sum
}
