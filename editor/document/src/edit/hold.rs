//! Feet that an edit holds where they were, in the contacts stored with the take.

use super::contact_span::stored_of_limbs;
use super::{BoneRef, EditedBones, TakeRef};
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, TakeId};
use dragonfly_anim::contact::{LockSettings, hold_contacts, limb_of};
use dragonfly_anim::data::{BoneIndex, Skeleton, Take};
use dragonfly_anim::frames::frame_rate;
use std::sync::Arc;

/// Number of frames over which the correction fades before and after a contact.
const EASE: u32 = 4;

/// Name of the option in messages.
const TITLE: &str = "Hold feet";

/// The feet that are held, and the take before the edit.
pub(super) struct HeldFeet {
    take: TakeId,
    before: Arc<Take>,
    feet: Vec<BoneIndex>,
}

impl HeldFeet {
    /// Returns the feet that are held, before the edit changes the take; `None` where the list is empty.
    pub(super) fn before(
        work: &Transaction,
        take: &TakeRef,
        feet: &[BoneRef],
    ) -> Result<Option<Self>, EditError> {
        if feet.is_empty() {
            return Ok(None);
        }
        if matches!(take, TakeRef::Layer { .. }) {
            return Err(EditError::OnLayer(TITLE));
        }
        let id = work.take(take)?;
        if !work.slot(id).layers().is_empty() {
            return Err(EditError::HasLayers(TITLE));
        }
        let feet = feet.iter().map(|foot| work.bone(foot)).collect::<Result<_, _>>()?;
        Ok(Some(Self { take: id, before: Arc::clone(&work.slot(id).result), feet }))
    }

    /// Moves the feet back in the contacts in which the edit moved them.
    pub(super) fn hold(self, work: &mut Transaction) -> Result<(), EditError> {
        let after = Arc::clone(&work.slot(self.take).result);
        let mut contacts = stored_of_limbs(work, self.take);
        contacts.retain(|contact| self.feet.contains(&contact.bone));
        let settings = LockSettings { rate: frame_rate(&self.before), ease: EASE };
        let held = hold_contacts(&after, &self.before, work.skeleton(), &contacts, &settings)?;
        if !held.bones.is_empty() {
            rewrite::channels(work, self.take, &held.take)?;
        }
        Ok(())
    }
}

/// Adds the bones that hold the feet to those of an edit.
pub(super) fn with_limbs(bones: EditedBones, feet: &[BoneRef], skeleton: &Skeleton) -> EditedBones {
    let EditedBones::Named(mut named) = bones else { return bones };
    let limbs = feet.iter().filter_map(|foot| limb_of(skeleton, foot.find_in(skeleton)?));
    named.extend(limbs.flat_map(|limb| [limb.root, limb.middle, limb.end]));
    EditedBones::Named(named)
}
