//! Adds a root bone.

use super::kept_travel::{TRAVEL, kept_travel, travel_text};
use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::root_bone::{BoneShift, skeleton_with_root};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Adds a bone above all root bones, for example so that it travels instead of the hips. It is the first bone and rests at the
/// origin; all other bones stay where they are, and their indices grow by one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddRootBone {
    /// Its name, which no other bone has.
    pub name: String,
}

map_references!(AddRootBone { name });

impl EditKind for AddRootBone {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"add_root_bone","name":"Root"}"#,
        description: "Adds a bone above the hips, to which their travel can be moved.",
    };

    fn label(&self) -> &'static str {
        "Add root bone"
    }

    fn take(&self) -> Option<&TakeRef> {
        None
    }

    /// It changes the keys of no bone, so locks do not apply.
    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::WholeTake
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let skeleton = Arc::new(skeleton_with_root(work.skeleton(), &self.name)?);
        let shift = BoneShift::ROOT_ADDED;
        let slots =
            work.adapter().slots().iter().map(|slot| Arc::new(slot.shifted(shift))).collect::<Vec<_>>();
        work.perform(Op::Skeleton(skeleton, slots.clone()));
        for slot in &slots {
            let mut kept = kept_travel(&slot.original.extras);
            kept.iter_mut().for_each(|motion| motion.bone = shift.bone(motion.bone).unwrap_or(motion.bone));
            if !kept.is_empty() {
                work.perform(Op::Extras(slot.id, TRAVEL.to_owned(), travel_text(&kept)));
            }
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { name: from.name() }
    }

    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        Some(crate::about::shortened(&self.name))
    }
}
