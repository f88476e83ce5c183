//! Locks feet to the ground.

use super::contact_span::{detected, named, stored_of_limbs};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, ContactSpan, EditUnit, EditedBones, Example, TakeRef};
use crate::adapter::plan::{Transaction, rewrite};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::contact::{ContactThresholds, LockSettings, feet_by_name, limb_of, lock_contacts};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::frames::frame_rate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Locks feet to the ground: in each contact the foot stays at its mean position, by two-bone IK. The correction fades before and
/// after. Keys are added at every frame of the contacts and fades.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LockContacts {
    /// The take.
    pub take: TakeRef,
    /// The contacts. Where empty, those of bones whose names say that they are feet: as they are stored with the take, or else found
    /// from height and speed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub contacts: Vec<ContactSpan>,
    /// Number of frames over which the correction fades before and after a contact.
    #[serde(default = "four")]
    pub ease: u32,
    /// Frames per second of the new keys; by default the lowest usual rate that fits the keys of the take.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
    /// Meters in one unit of length of the model, for contacts that are to be found; `"guess"` for what the size of the figure suggests; 1
    /// if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub meters_per_unit: Option<EditUnit>,
}

fn four() -> u32 {
    4
}

map_references!(LockContacts { take, contacts, ease, rate, meters_per_unit });

impl EditKind for LockContacts {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"lock_contacts","take":"Walk","contacts":[{"bone":"Foot.L","from":0.2,"to":0.5}],"ease":4}"#,
        description: "Holds the left foot still from 0.2 s to 0.5 s, and fades over 4 frames.",
    };

    const LAYERS: LayerUse = LayerUse::NoLayers;

    fn label(&self) -> &'static str {
        "Lock contacts"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        let named = self.contacts.iter().filter_map(|span| span.bone.find_in(skeleton));
        let feet = if self.contacts.is_empty() { feet_by_name(skeleton) } else { named.collect() };
        let limbs = feet.into_iter().filter_map(|foot| limb_of(skeleton, foot));
        EditedBones::Named(limbs.flat_map(|limb| [limb.root, limb.middle, limb.end]).collect())
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let take = Arc::clone(&work.slot(id).result);
        let rate = self.rate.unwrap_or_else(|| frame_rate(&take));
        let meters_per_unit = EditUnit::length(self.meters_per_unit, 1.0, work.skeleton())?;
        let mut contacts = named(work, &self.contacts)?;
        let feet = feet_by_name(work.skeleton());
        if contacts.is_empty() {
            // Locks of bones ask the edit, which knows no others than feet.
            contacts = stored_of_limbs(work, id);
            contacts.retain(|contact| feet.contains(&contact.bone));
        }
        if contacts.is_empty() {
            let thresholds = ContactThresholds { meters_per_unit, ..ContactThresholds::default() };
            contacts = detected(work, &take, &feet, rate, &thresholds)?;
        }
        if contacts.is_empty() {
            return Err(EditError::Nothing("no foot is in contact with the ground"));
        }
        let settings = LockSettings { rate, ease: self.ease };
        let locked = lock_contacts(&take, work.skeleton(), &contacts, &settings)?;
        if rewrite::channels(work, id, &locked.take)? {
            Ok(())
        } else {
            Err(EditError::Nothing("the feet stand still already"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let contacts = (0..from.below(3)).map(|_| ContactSpan::arbitrary(from)).collect();
        let rate = from.optional(|from| from.between(5.0, 60.0));
        let meters_per_unit = from.choice([None, Some(1.0.into()), Some(0.01.into()), Some(EditUnit::GUESS)]);
        Self { take: from.take(), contacts, ease: from.below(8) as u32, rate, meters_per_unit }
    }
}
