//! Contacts as edits name them.

use super::map_references::map_references;
use super::{Arbitrary, BoneRef};
use crate::adapter::plan::{Transaction, contacts, finite};
use crate::adapter::{EditError, TakeId};
use dragonfly_anim::contact::{Contact, ContactThresholds, detect_contacts, limb_of};
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_anim::frames::TakeFrames;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The contact of a bone with the ground.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpan {
    /// The bone.
    pub bone: BoneRef,
    /// Start of the contact in seconds.
    pub from: f32,
    /// End of the contact in seconds, not before `from`.
    pub to: f32,
}

map_references!(ContactSpan { bone, from, to });

impl ContactSpan {
    pub(super) fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let time = from.time();
        Self { bone: from.bone(), from: time * 0.5, to: time }
    }
}

/// Returns the contacts that an edit names.
pub(super) fn named(work: &Transaction, spans: &[ContactSpan]) -> Result<Vec<Contact>, EditError> {
    let contact = |span: &ContactSpan| {
        let (from, to) = (finite("the time", span.from)?, finite("the time", span.to)?);
        if to < from {
            return Err(EditError::Number { what: "an end before the start", value: to });
        }
        Ok(Contact { bone: work.bone(&span.bone)?, from, to })
    };
    spans.iter().map(contact).collect()
}

/// Returns the contacts of bones of a take, found from height and speed.
pub(super) fn detected(
    work: &Transaction,
    take: &Take,
    bones: &[BoneIndex],
    rate: f32,
    thresholds: &ContactThresholds,
) -> Result<Vec<Contact>, EditError> {
    let frames = TakeFrames::of(take, work.skeleton(), rate)?;
    Ok(detect_contacts(&frames, bones, thresholds))
}

/// Returns the contacts stored with a take of bones that have a limb, which can be held.
pub(super) fn stored_of_limbs(work: &Transaction, take: TakeId) -> Vec<Contact> {
    let track = contacts::stored(work, take);
    let has_limb = |contact: &&Contact| limb_of(work.skeleton(), contact.bone).is_some();
    track.contacts().iter().filter(has_limb).copied().collect()
}
