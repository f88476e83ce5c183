//! Replaces keys by keys on whole frames.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::kind::{ChannelKind, with_kind};
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::{Transaction, arrange::insert_keys_overwriting, keys::current, list};
use crate::adapter::slot::KeyContent;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Replaces the selected keys of each channel by keys on every frame, or every few frames, from the first of them to the last, with
/// the values that the curve has there; both ends stay. With one frame this bakes the curve. Keys between them that are not selected
/// stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResampleKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<KeySet>,
    /// Frames per second, 1 to 1000; frame 0 is at 0 s.
    pub rate: f32,
    /// Number of frames from one key to the next, 1 to 1000.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub every: u32,
}

fn one() -> u32 {
    1
}

fn is_one(number: &u32) -> bool {
    *number == 1
}

map_references!(ResampleKeys { take, keys, rate, every });

impl EditKind for ResampleKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"resample_keys","take":"Walk","keys":[{"bones":["Head"]}],"rate":24,"every":2}"#,
        description: "Gives the head a key on every second frame of 24 per second.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    const SHOWS_DIFFERENCE: bool = true;

    fn label(&self) -> &'static str {
        if self.every == 1 { "Bake keys to frames" } else { "Resample keys" }
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
        if !(1.0..=1000.0).contains(&self.rate) {
            return Err(EditError::Number { what: "the frame rate", value: self.rate });
        }
        if !(1..=1000).contains(&self.every) {
            return Err(EditError::Number { what: "the number of frames", value: self.every as f32 });
        }
        let take = work.take(&self.take)?;
        let step = f64::from(self.every) / f64::from(self.rate);
        for (address, keys) in work.keys(take, &self.keys)? {
            with_kind!(address.property, resample::<K>(work, address, keys, step))?;
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (take, keys) = (from.take(), from.keys());
        Self { take, keys, rate: from.choice([8.0, 24.0, 30.0]), every: from.choice([1, 2, 5]) }
    }
}

/// Replaces keys of a channel by keys at multiples of `step` seconds.
fn resample<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    keys: Vec<u32>,
    step: f64,
) -> Result<(), EditError> {
    let [first, .., last] = keys[..] else { return Ok(()) };
    let slot = Arc::clone(work.slot(address.take));
    let times = slot.times(address.bone, address.property);
    let [start, end] = [first, last].map(|key| f64::from(times[key as usize]));
    // The frames strictly between both ends.
    let tolerance = f64::from(SAME_TIME);
    let from = ((start + tolerance) / step).floor() as i64 + 1;
    let to = ((end - tolerance) / step).ceil() as i64;
    let count = usize::try_from(to - from).unwrap_or_default();
    work.room_for(address, count)?;
    let mut new: Vec<KeyContent> = list(count)?;
    for frame in from..to {
        let time = (frame as f64 * step) as f32;
        // A key that is already there keeps its tangents.
        let near = times.partition_point(|&key| key < time - SAME_TIME);
        let there = times.get(near).is_some_and(|&key| (key - time).abs() <= SAME_TIME);
        if !there {
            new.push(current::<K>(work, &slot, address, time));
        }
    }
    let on_frame = |time: f32| {
        let frame = (f64::from(time) / step).round();
        (f64::from(time) - frame * step).abs() <= tolerance
    };
    let inner = keys[1..keys.len() - 1].iter().copied();
    let remove: Vec<u32> = inner.filter(|&key| !on_frame(times[key as usize])).collect();
    if new.is_empty() && remove.is_empty() {
        return Ok(());
    }
    insert_keys_overwriting(work, address, new, remove)
}
