//! The contacts of a take as a track: bone by bone, in order of time, without overlaps.
//!
//! All functions return another track and take time in proportion to the number of contacts, except for sorting. Times are
//! seconds on the clock of the take. Contacts without a duration, or with times that are not finite, are left out;
//! contacts of a bone that overlap or touch become one.

use super::Contact;
use crate::data::BoneIndex;

/// The contacts of all bones of a take, ascending by bone, then by time. Those of one bone do not overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactTrack {
    contacts: Vec<Contact>,
}

impl ContactTrack {
    /// Returns the track of these contacts, which may be in any order.
    pub fn of(contacts: impl IntoIterator<Item = Contact>) -> Self {
        let is_contact = |contact: &Contact| {
            contact.from.is_finite() && contact.to.is_finite() && contact.from < contact.to
        };
        let mut sorted: Vec<Contact> = contacts.into_iter().filter(is_contact).collect();
        sorted.sort_by(|a, b| a.bone.cmp(&b.bone).then(a.from.total_cmp(&b.from)));
        let mut joined: Vec<Contact> = Vec::with_capacity(sorted.len());
        for contact in sorted {
            match joined.last_mut().filter(|last| last.bone == contact.bone && contact.from <= last.to) {
                Some(last) => last.to = last.to.max(contact.to),
                None => joined.push(contact),
            }
        }
        Self { contacts: joined }
    }

    /// Returns all contacts, in order.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// Returns whether there are none.
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Returns the bones that have contacts, ascending.
    pub fn bones(&self) -> Vec<BoneIndex> {
        self.contacts.chunk_by(|a, b| a.bone == b.bone).map(|chunk| chunk[0].bone).collect()
    }

    /// Returns the contacts of one bone, in order of time.
    pub fn of_bone(&self, bone: BoneIndex) -> &[Contact] {
        let from = self.contacts.partition_point(|contact| contact.bone < bone);
        let to = self.contacts.partition_point(|contact| contact.bone <= bone);
        &self.contacts[from..to]
    }

    /// Returns the track with the contacts of `bones` replaced by `contacts`.
    pub fn replaced(&self, bones: &[BoneIndex], contacts: impl IntoIterator<Item = Contact>) -> Self {
        let others = self.contacts.iter().filter(|contact| !bones.contains(&contact.bone)).copied();
        Self::of(others.chain(contacts))
    }

    /// Returns the track with both ends of each contact moved to the times that `to` returns. Where the order of the ends is
    /// reversed, the start becomes the end.
    pub fn remapped(&self, to: impl Fn(f32) -> f32) -> Self {
        Self::of(self.contacts.iter().map(|contact| {
            let (from, to) = (to(contact.from), to(contact.to));
            Contact { from: from.min(to), to: from.max(to), ..*contact }
        }))
    }

    /// Returns the parts of the contacts between two times.
    pub fn between(&self, from: f32, to: f32) -> Self {
        Self::of(self.contacts.iter().map(|contact| Contact {
            from: contact.from.max(from),
            to: contact.to.min(to),
            ..*contact
        }))
    }

    /// Returns the track after `by` seconds were inserted at the time `at`; a negative `by` removes the seconds before `at`. A
    /// contact over that time becomes longer or shorter.
    pub fn rippled(&self, at: f32, by: f32) -> Self {
        let moved = |time: f32| if time >= at { time + by } else { time.min(at + by.min(0.0)) };
        self.remapped(moved)
    }

    /// Returns the track with each contact given to the bone that `other` returns; `None` leaves it where it is.
    pub fn mirrored(&self, other: impl Fn(BoneIndex) -> Option<BoneIndex>) -> Self {
        Self::of(
            self.contacts
                .iter()
                .map(|contact| Contact { bone: other(contact.bone).unwrap_or(contact.bone), ..*contact }),
        )
    }

    /// Returns the track of a take that repeats from `start` over `length` seconds, after its keys moved around the loop by `by`
    /// seconds. A contact that crosses the end continues at the start.
    pub fn shifted(&self, start: f32, length: f32, by: f32) -> Self {
        if !(length.is_finite() && length > 0.0 && by.is_finite() && start.is_finite()) {
            return self.clone();
        }
        let end = start + length;
        Self::of(self.between(start, end).contacts.iter().flat_map(|contact| {
            let from = start + (contact.from - start + by).rem_euclid(length);
            let to = from + (contact.to - contact.from);
            let first = Contact { from, to: to.min(end), ..*contact };
            [first, Contact { from: start, to: start + (to - end), ..*contact }]
        }))
    }
}
