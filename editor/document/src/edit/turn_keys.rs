//! Turns between rotation keys: the shortest way, and full turns.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, EditedBones, Example, KeySet, Property, TakeRef};
use crate::adapter::EditError;
use crate::adapter::plan::{Transaction, rewrite};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::turns::{full_turns, shortest_way};
use glam::Vec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Changes the way in which bones turn from rotation key to rotation key. The rotations of the keys stay.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TurnKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys; keys of translations and scales are left alone.
    pub keys: Vec<KeySet>,
    /// The way.
    pub way: TurnWay,
}

/// The way in which a bone turns from one key to the next.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TurnWay {
    /// The short way: each quaternion gets the sign nearer to the one before, so that splines do not flip.
    Shortest,
    /// Full turns in addition, from each selected key to the next. Keys are inserted, because two keys cannot hold half a turn or more.
    Full {
        /// Number of turns, -100 to 100 without 0; negative numbers turn the other way.
        turns: i32,
        /// The axis, in the space of the bone, where two keys have the same rotation.
        #[serde(default = "up", skip_serializing_if = "is_up")]
        axis: [f32; 3],
    },
}

fn up() -> [f32; 3] {
    [0.0, 1.0, 0.0]
}

fn is_up(axis: &[f32; 3]) -> bool {
    *axis == up()
}

/// Largest number of turns between two keys.
const MOST_TURNS: i32 = 100;

map_references!(TurnKeys { take, keys, way });

impl EditKind for TurnKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"turn_keys","take":"Walk","keys":[{"bones":["Head"],"from":0,"to":1}],"way":{"full":{"turns":2}}}"#,
        description: "Turns the head twice around between its keys of the first second.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match self.way {
            TurnWay::Shortest => "Turn the short way",
            TurnWay::Full { .. } => "Add full turns",
        }
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
        if let TurnWay::Full { turns, axis } = self.way {
            if turns == 0 || turns.abs() > MOST_TURNS {
                return Err(EditError::Number { what: "the number of turns", value: turns as f32 });
            }
            let length = Vec3::from(axis).length();
            if !(1e-6..1e6).contains(&length) {
                return Err(EditError::Number { what: "the length of the axis", value: length });
            }
        }
        let take = work.take(&self.take)?;
        let mut wanted = Take::default();
        for (address, keys) in work.keys(take, &self.keys)? {
            if address.property != Property::Rotation {
                continue;
            }
            let slot = work.slot(take);
            let Some(mut track) = slot.result.tracks.get(address.bone as usize).cloned() else { continue };
            let chosen: Vec<usize> = keys.iter().map(|&key| key as usize).collect();
            track.rotation = match self.way {
                TurnWay::Shortest => shortest_way(&track.rotation, |key| chosen.binary_search(&key).is_ok()),
                TurnWay::Full { turns, axis } => {
                    full_turns(&track.rotation, &chosen, turns, Vec3::from(axis))
                }
            };
            wanted.tracks.push(track);
        }
        if rewrite::channels(work, take, &wanted)? {
            return Ok(());
        }
        Err(EditError::Nothing(match self.way {
            TurnWay::Shortest => "the keys turn the short way already",
            TurnWay::Full { .. } => {
                "full turns need two selected rotation keys next to each other that are no step keys"
            }
        }))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let way = if from.flag() {
            TurnWay::Shortest
        } else {
            let axis = from.choice([up(), [1.0, 0.0, 0.0], [0.0; 3]]);
            TurnWay::Full { turns: from.choice([-2, -1, 0, 1, 3]), axis }
        };
        let mut keys = from.keys();
        keys.iter_mut().for_each(|set| (set.from, set.to) = (None, None));
        Self { take: from.take(), keys, way }
    }
}
