//! Contacts as edits name them.

use super::{Arbitrary, BoneRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, finite};
use dragonfly_anim::contact::{Contact, ContactThresholds, detect_contacts, feet_by_name};
use dragonfly_anim::data::Take;
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

/// Returns the contacts of the feet of a take, found with the usual thresholds.
pub(super) fn detected(work: &Transaction, take: &Take, rate: f32) -> Result<Vec<Contact>, EditError> {
    let frames = TakeFrames::of(take, work.skeleton(), rate)?;
    let feet = feet_by_name(work.skeleton());
    Ok(detect_contacts(&frames, &feet, &ContactThresholds::default()))
}
