//! Repeats keys before and after.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, Property, SAME_TIME, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, rewrite};
use dragonfly_anim::cycle::{CycleMode, CycleRange, Cycles, ScaleValue, cycled, value_and_slope};
use dragonfly_anim::data::{Channel, Skeleton, Take};
use dragonfly_anim::turns::shortest_way;
use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Repeats the selected keys of each channel before the first and after the last of them, as keys. Other keys there are removed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<KeySet>,
    /// How the cycles follow each other.
    pub mode: RepeatMode,
    /// Number of cycles before the keys.
    #[serde(default, skip_serializing_if = "is_none")]
    pub before: RepeatCount,
    /// Number of cycles after the keys.
    #[serde(default, skip_serializing_if = "is_none")]
    pub after: RepeatCount,
}

/// How cycles follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RepeatMode {
    /// The same values again.
    Repeat,
    /// Each cycle starts where the one before ends: a walk continues.
    Offset,
    /// Every other cycle runs backwards.
    Mirror,
}

/// The number of cycles on one side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RepeatCount {
    /// This many, 0 to 10,000.
    Times(u32),
    /// Until the start or the end of the take.
    Take,
}

impl Default for RepeatCount {
    fn default() -> Self {
        Self::Times(0)
    }
}

fn is_none(count: &RepeatCount) -> bool {
    *count == RepeatCount::Times(0)
}

/// Largest number of cycles on one side.
const MOST: u32 = 10_000;
/// Largest number of keys that a channel gets.
const MOST_KEYS: usize = 1_000_000;

impl From<RepeatMode> for CycleMode {
    fn from(mode: RepeatMode) -> Self {
        match mode {
            RepeatMode::Repeat => Self::Repeat,
            RepeatMode::Offset => Self::Offset,
            RepeatMode::Mirror => Self::Mirror,
        }
    }
}

map_references!(RepeatKeys { take, keys, mode, before, after });

impl EditKind for RepeatKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"repeat_keys","take":"Walk","keys":[{"bones":["Hips"],"to":1}],"mode":"offset","after":{"times":3}}"#,
        description: "Lets the hips walk on three times as in the first second.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Repeat keys"
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

    fn cost(&self, _adapter: &crate::adapter::ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        for count in [self.before, self.after] {
            if let RepeatCount::Times(count) = count
                && count > MOST
            {
                return Err(EditError::Number { what: "the number of cycles", value: count as f32 });
            }
        }
        let take = work.take(&self.take)?;
        let (mut wanted, mut any) = (Take::default(), false);
        for (address, keys) in work.keys(take, &self.keys)? {
            let [first, .., last] = keys[..] else { continue };
            let range = [first, last].map(|key| key as usize);
            let result = &work.slot(take).result;
            let [start, end] = [result.start, result.start + result.length];
            let side = |count, edge| match count {
                RepeatCount::Times(count) => CycleRange::Count(count),
                RepeatCount::Take => CycleRange::Until(edge),
            };
            let cycles = Cycles {
                mode: self.mode.into(),
                before: side(self.before, start),
                after: side(self.after, end),
                most_keys: MOST_KEYS,
                same_time: SAME_TIME,
            };
            let bone = address.bone;
            let Some(track) = result.tracks.get(bone as usize) else { continue };
            if wanted.tracks.last().is_none_or(|last| last.bone != bone) {
                wanted.tracks.push(track.clone());
            }
            let Some(track) = wanted.tracks.last_mut() else { continue };
            let changed = match address.property {
                Property::Translation => repeat(&mut track.translation, range, &cycles),
                Property::Rotation => repeat_rotation(&mut track.rotation, range, &cycles),
                Property::Scale => repeat_scale(&mut track.scale, range, &cycles),
            };
            any |= changed;
        }
        if any && rewrite::channels(work, take, &wanted)? {
            Ok(())
        } else {
            Err(EditError::Nothing(
                "cycles need two selected keys of a channel, and room before or after them",
            ))
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let mode = from.choice([RepeatMode::Repeat, RepeatMode::Offset, RepeatMode::Mirror]);
        let count = |from: &mut Arbitrary<'_>| {
            from.choice([RepeatCount::Times(0), RepeatCount::Times(2), RepeatCount::Take])
        };
        let (before, after) = (count(from), count(from));
        let mut keys = from.keys();
        keys.iter_mut().for_each(|set| set.from = None);
        Self { take: from.take(), keys, mode, before, after }
    }
}

/// Replaces a channel of vectors by its cycles. Returns whether there are any.
fn repeat(channel: &mut Channel<Vec3>, range: [usize; 2], cycles: &Cycles) -> bool {
    let next = cycled(channel, range, cycles, |channel, time| value_and_slope(channel, Vec3::ZERO, time));
    let Some(next) = next else { return false };
    *channel = next;
    true
}

fn repeat_rotation(channel: &mut Channel<Quat>, range: [usize; 2], cycles: &Cycles) -> bool {
    let next = cycled(channel, range, cycles, |channel, time| value_and_slope(channel, Quat::IDENTITY, time));
    let Some(next) = next else { return false };
    // Cycles that turn on and on change their sign.
    *channel = shortest_way(&next, |_| true);
    true
}

fn repeat_scale(channel: &mut Channel<Vec3>, range: [usize; 2], cycles: &Cycles) -> bool {
    let values = channel.values.iter().map(|&value| ScaleValue(value)).collect();
    let scales = Channel { times: channel.times.clone(), values, interpolation: channel.interpolation };
    let next = cycled(&scales, range, cycles, |scales, time| {
        let values = scales.values.iter().map(|value| value.0).collect();
        let plain = Channel { times: scales.times.clone(), values, interpolation: scales.interpolation };
        value_and_slope(&plain, Vec3::ONE, time).map(ScaleValue)
    });
    let Some(next) = next else { return false };
    let values = next.values.iter().map(|value| value.0).collect();
    *channel = Channel { times: next.times, values, interpolation: next.interpolation };
    true
}
