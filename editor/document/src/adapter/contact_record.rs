//! The contacts of a take in its extras.
//!
//! ```json
//! {"version": 1, "bones": [{"bone": "Foot.L", "node": 12, "spans": [[0.2, 0.5], [1.1, 1.4]]}]}
//! ```
//!
//! Spans are start and end in seconds, on the clock of the take. A bone that the skeleton does not have is left out. A text that is
//! none of this, which another program may have written, counts as no contacts.

use super::record_bone::{RecordBone, RecordBones};
use dragonfly_anim::contact::{Contact, ContactTrack};
use dragonfly_anim::data::{Skeleton, TakeExtras};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Name of the contacts in the extras of a take.
pub const CONTACTS: &str = "contacts";

/// Version of the record. It grows when an older program could misunderstand a newer record.
const VERSION: u32 = 1;

/// Largest number of contacts of a take.
pub const MOST_CONTACTS: usize = 10_000;

#[derive(Serialize, Deserialize)]
struct ContactsRecord {
    version: u32,
    bones: Vec<BoneContacts>,
}

#[derive(Serialize, Deserialize)]
struct BoneContacts {
    #[serde(flatten)]
    bone: RecordBone,
    spans: Vec<(f32, f32)>,
}

/// Returns the contacts that are stored with a take, at most [`MOST_CONTACTS`].
pub fn stored_contacts(extras: &TakeExtras, skeleton: &Skeleton) -> ContactTrack {
    let Some(text) = extras.get(CONTACTS) else { return ContactTrack::default() };
    let record = serde_json::from_str::<ContactsRecord>(text).ok().filter(|record| record.version == VERSION);
    let Some(record) = record else { return ContactTrack::default() };
    let bones = RecordBones::of(skeleton);
    let of_bone = |entry: &BoneContacts| {
        let bone = bones.find(&entry.bone)?;
        let spans = entry.spans.iter().map(move |&(from, to)| Contact { bone, from, to });
        Some(spans.collect::<Vec<_>>())
    };
    ContactTrack::of(record.bones.iter().filter_map(of_bone).flatten().take(MOST_CONTACTS))
}

/// Returns the text for the extras; `None` for no contacts.
pub(crate) fn contacts_text(track: &ContactTrack, skeleton: &Skeleton) -> Option<Arc<str>> {
    if track.is_empty() {
        return None;
    }
    let of_bone = |bone| {
        let spans = track.of_bone(bone).iter().map(|contact| (contact.from, contact.to)).collect();
        Some(BoneContacts { bone: RecordBone::of(skeleton, bone)?, spans })
    };
    let bones = track.bones().into_iter().filter_map(of_bone).collect();
    serde_json::to_string(&ContactsRecord { version: VERSION, bones }).ok().map(Arc::from)
}
