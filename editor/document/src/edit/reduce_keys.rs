//! Removes keys that the motion hardly needs.

use super::kind::EditKind;
use super::map_references::map_references;
use super::{Arbitrary, EditUnit, EditedBones, Example, KeySet, Property, TakeRef};
use crate::adapter::op::Op;
use crate::adapter::plan::{Transaction, contacts};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::reduce::{Contacts, ReduceSettings, reduce};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Removes those of the selected keys without which no point near any bone moves further than a tolerance, in the space of the scene.
/// The keys that stay keep their times and values. In contacts, those that are
/// stored with the take and those of bones that hardly move, the tolerance is a tenth of a millimeter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ReduceKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<KeySet>,
    /// The tolerance in millimeters, 0 to 10,000.
    pub tolerance: f32,
    /// Millimeters in one unit of the model: 1000 where it is in meters, `"guess"` for what the size of the figure suggests; 1000 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<EditUnit>,
}

map_references!(ReduceKeys { take, keys, tolerance, unit });

impl EditKind for ReduceKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"reduce_keys","take":"Walk","keys":[{"bones":["Head"]}],"tolerance":1}"#,
        description: "Removes the keys of the head without which nothing moves by more than 1 mm.",
    };

    const SHOWS_DIFFERENCE: bool = true;

    fn label(&self) -> &'static str {
        "Reduce keys"
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

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        None
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let unit = match self.unit {
            // Of no length: nothing moves, whatever is removed.
            Some(EditUnit::Stated(0.0)) => 0.0,
            unit => EditUnit::length(unit, 1000.0, work.skeleton())?,
        };
        for (what, value, most) in [("the tolerance", self.tolerance, 1e4), ("the unit", unit, 1e9)] {
            if !(0.0..=most).contains(&value) {
                return Err(EditError::Number { what, value });
            }
        }
        let take = work.take(&self.take)?;
        let chosen = work.keys(take, &self.keys)?;
        let result = Arc::clone(&work.slot(take).result);
        let (tolerance, millimeters_per_unit) = (self.tolerance, unit);
        let given = contacts::stored(work, take).contacts().to_vec();
        let contacts = Contacts { given, ..Contacts::default() };
        let settings =
            ReduceSettings { tolerance, millimeters_per_unit, contacts, ..ReduceSettings::default() };
        let reduced = reduce(&result, work.skeleton(), &settings)
            .map_err(|_| EditError::Nothing("the take is too long to be reduced as a whole"))?;
        let mut any = false;
        for (address, keys) in chosen {
            let Some(track) = reduced.take.tracks.get(address.bone as usize) else { continue };
            let kept = match address.property {
                Property::Translation => &track.translation.times,
                Property::Rotation => &track.rotation.times,
                Property::Scale => &track.scale.times,
            };
            let times = work.slot(take).times(address.bone, address.property);
            let is_gone = |&key: &u32| {
                let time = times[key as usize];
                kept.binary_search_by(|kept| kept.total_cmp(&time)).is_err()
            };
            let gone: Vec<u32> = keys.into_iter().filter(is_gone).collect();
            if !gone.is_empty() {
                any = true;
                work.perform(Op::Splice(address, gone, Vec::new()));
            }
        }
        if any { Ok(()) } else { Err(EditError::Nothing("no key is redundant within this tolerance")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let tolerance = from.choice([0.0, 1.0, 5000.0]);
        Self {
            take: from.take(),
            keys: from.keys(),
            tolerance,
            unit: from.choice([None, Some(1000.0.into()), Some(10.0.into()), Some(EditUnit::GUESS)]),
        }
    }
}
