//! Inserts or removes time.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, SAME_TIME, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{
    KeyMove, Transaction, contacts, finite, key_time, moments, morph, timing::move_positions,
};
use crate::adapter::{EditError, TakeId};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Inserts or removes time: moves every key at or after a time, in all channels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RippleKeys {
    /// The take.
    pub take: TakeRef,
    /// Seconds: the first time that moves.
    pub from: f32,
    /// Seconds; negative closes a gap and deletes the keys in it.
    pub by: f32,
}

map_references!(RippleKeys { take, from, by });

impl EditKind for RippleKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"ripple","take":"Walk","from":0.5,"by":0.25}"#,
        description: "Inserts a quarter of a second at 0.5 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Ripple"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, _skeleton: &Skeleton) -> EditedBones {
        EditedBones::All
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let (from, by) = (finite("the time", self.from)?, finite("the distance", self.by)?);
        let mut found = false;
        for address in work.channels(take, (&[], &[]))? {
            let slot = work.slot(take);
            let times = slot.times(address.bone, address.property);
            let first = times.partition_point(|&time| time < from - SAME_TIME) as u32;
            // Closing a gap deletes the keys in it.
            let gap = times.partition_point(|&time| time < from + by - SAME_TIME).min(first as usize) as u32;
            let moved = (first..times.len() as u32)
                .map(|key| Ok((key, key_time(times[key as usize] + by, slot)?)))
                .collect::<Result<Vec<_>, EditError>>()?;
            if moved.is_empty() {
                continue;
            }
            found = true;
            let deleted = first - gap;
            if deleted > 0 {
                work.perform(Op::Splice(address, (gap..first).collect(), Vec::new()));
            }
            let moved: Vec<(u32, f32)> = moved.into_iter().map(|(key, time)| (key - deleted, time)).collect();
            move_positions(work, address, &moved, KeyMove::PLAIN)?;
        }
        let to = |time: f32| rippled(time, from, by);
        for at in work.slot(take).pending() {
            key_time(to(at.time).unwrap_or_default(), work.slot(take))?;
        }
        moments::remap(work, take, to)?;
        found |= ripple_morphs(work, take, from, by)?;
        contacts::follow(work, take, |track| track.rippled(from - SAME_TIME, by))?;
        if found { Ok(()) } else { Err(EditError::Nothing("there is no key at that time or later")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), from: from.time(), by: from.between(-0.3, 0.3) }
    }
}

/// Returns the new time of a key: times from `from` on move, and times in a gap that is closed have none.
fn rippled(time: f32, from: f32, by: f32) -> Option<f32> {
    match time {
        _ if time >= from - SAME_TIME => Some(time + by),
        _ if time >= from + by - SAME_TIME => None,
        _ => Some(time),
    }
}

/// Does the same with morph weights, which are no channel of a bone. Returns whether there are any.
fn ripple_morphs(work: &mut Transaction, take: TakeId, from: f32, by: f32) -> Result<bool, EditError> {
    let slot = work.slot(take);
    let late = |times: &[f32]| times.last().is_some_and(|&last| last >= from - SAME_TIME);
    if !slot.original.morphs.iter().any(|morph| late(&morph.times)) {
        return Ok(false);
    }
    let times = slot.original.morphs.iter().flat_map(|morph| morph.times.iter());
    for &time in times.filter(|&&time| time >= from - SAME_TIME) {
        key_time(time + by, slot)?;
    }
    let to = |time: f32| rippled(time, from, by);
    let morphs = slot.original.morphs.iter().map(|track| morph::mapped(track, to, |_| [1.0; 2])).collect();
    work.perform(Op::Morphs(take, morphs));
    Ok(true)
}
