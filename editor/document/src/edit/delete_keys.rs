//! Deletes keys (thesis §2.2.2.4).

use super::kind::EditKind;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef};
use crate::adapter::EditError;
use crate::adapter::op::Op;
use crate::adapter::plan::Transaction;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deletes keys. The last key of a take cannot be deleted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeleteKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<KeySet>,
}

impl EditKind for DeleteKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"delete_keys","take":"Walk","keys":[{"bones":["Head"],"from":0.2,"to":0.4}]}"#,
        description: "Deletes the head's keys from 0.2 s to 0.4 s.",
    };

    fn label(&self) -> &'static str {
        "Delete keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::of_keys(&self.keys, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let found = work.keys(take, &self.keys)?;
        let deleted: usize = found.iter().map(|(_, keys)| keys.len()).sum();
        // Keys of morph targets do not count: they belong to no bone.
        let all: usize = work.slot(take).original.tracks.iter().map(|track| track.keys()).sum();
        if deleted >= all {
            return Err(EditError::LastKey);
        }
        for (address, keys) in found {
            work.perform(Op::Splice(address, keys, Vec::new()));
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), keys: from.keys() }
    }
}
