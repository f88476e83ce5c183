//! Deletes keys (thesis §2.2.2.4).

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, SAME_TIME, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, finite, layer, morph};
use crate::adapter::{EditError, TakeId};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Deletes keys. The last key of a take cannot be deleted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DeleteKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of morph targets are deleted. Each of their tracks keeps
    /// one key.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
}

map_references!(DeleteKeys { take, shapes }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for DeleteKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"delete_keys","take":"Walk","keys":[{"bones":["Head"],"from":0.2,"to":0.4}]}"#,
        description: "Deletes the head's keys from 0.2 s to 0.4 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    const SHOWS_DIFFERENCE: bool = true;

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
        if self.keys.is_empty() && !self.shapes.is_empty() {
            let deletes = self.delete_shapes(work, take)?;
            return if deletes { Ok(()) } else { Err(EditError::Nothing("no key is selected")) };
        }
        let found = work.keys(take, &self.keys)?;
        let deleted: usize = found.iter().map(|(_, keys)| keys.len()).sum();
        // Keys of morph targets do not count: they belong to no bone.
        let all: usize = work.slot(take).original.tracks.iter().map(|track| track.keys()).sum();
        // A layer without keys changes nothing; a take without keys would be none.
        if deleted >= all && layer::mode(work, take).is_none() {
            return Err(EditError::LastKey);
        }
        for (address, keys) in found {
            work.perform(Op::Splice(address, keys, Vec::new()));
        }
        self.delete_shapes(work, take).map(drop)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), keys: from.keys(), shapes: from.shapes() }
    }
}

impl DeleteKeys {
    /// Deletes keys of morph targets. Returns whether there were any.
    fn delete_shapes(&self, work: &mut Transaction, take: TakeId) -> Result<bool, EditError> {
        for time in self.shapes.iter().flatten() {
            finite("the time", *time)?;
        }
        let gone = |time: f32| {
            self.shapes.iter().any(|[from, to]| time >= from - SAME_TIME && time <= to + SAME_TIME)
        };
        let tracks = &work.slot(take).original.morphs;
        if !tracks.iter().any(|track| track.times.iter().any(|&time| gone(time))) {
            return Ok(false);
        }
        if tracks.iter().any(|track| !track.times.is_empty() && track.times.iter().all(|&time| gone(time))) {
            return Err(EditError::LastKey);
        }
        let kept = |time: f32| (!gone(time)).then_some(time);
        let tracks = tracks.iter().map(|track| morph::mapped(track, kept, |_| [1.0; 2])).collect();
        work.perform(Op::Morphs(take, tracks));
        Ok(true)
    }
}
