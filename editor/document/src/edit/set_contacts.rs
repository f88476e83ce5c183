//! Stores contacts with a take.

use super::contact_span::named;
use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, ContactSpan, EditedBones, Example, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, contacts};
use dragonfly_anim::contact::ContactTrack;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Stores contacts with a take in place of those that it has. Contacts of a bone that overlap become one. The motion stays as it is;
/// `lock_contacts`, `close_loop` and `reduce_keys` use the contacts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetContacts {
    /// The take.
    pub take: TakeRef,
    /// The bones whose contacts are replaced; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// The new contacts.
    #[serde(default)]
    pub contacts: Vec<ContactSpan>,
}

map_references!(SetContacts { take, bones, contacts });

impl EditKind for SetContacts {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_contacts","take":"Walk","bones":["Foot.L"],"contacts":[{"bone":"Foot.L","from":0.2,"to":0.5}]}"#,
        description: "Lets the left foot be on the ground from 0.2 s to 0.5 s only.",
    };

    fn label(&self) -> &'static str {
        if self.contacts.is_empty() { "Delete contacts" } else { "Set contacts" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let id = work.take(&self.take)?;
        let bones: Vec<BoneIndex> =
            self.bones.iter().map(|bone| work.bone(bone)).collect::<Result<_, _>>()?;
        let given = named(work, &self.contacts)?;
        let track = if bones.is_empty() {
            ContactTrack::of(given)
        } else {
            contacts::stored(work, id).replaced(&bones, given)
        };
        if contacts::store(work, id, &track)? {
            Ok(())
        } else {
            Err(EditError::Nothing("the take has these contacts already"))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let contacts = (0..from.below(4)).map(|_| ContactSpan::arbitrary(from)).collect();
        Self { take: from.take(), bones: from.bones(), contacts }
    }
}
