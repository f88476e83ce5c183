//! Adds keys (thesis §2.2.2.4).

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, NewKey, Property, TakeRef};
use crate::adapter::EditError;
use crate::adapter::kind::with_kind;
use crate::adapter::plan::{Transaction, key_at, key_time, keys::insert};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Adds keys at a time: in channels that have keys or, where bones are named, in all channels of these bones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AddKeys {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// The channels of these bones; all three where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub properties: Vec<Property>,
    /// The value of the new keys.
    #[serde(default)]
    pub value: NewKey,
    /// Adds keys only in channels that already have keys, even where bones are named.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub keyed_only: bool,
}

map_references!(AddKeys { take, time, bones, properties, value, keyed_only });

impl EditKind for AddKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"add_keys","take":"Walk","time":0.25,"bones":["Head"],"value":"current"}"#,
        description: "Adds keys of the head that keep the motion; \"predecessor\" copies the keys before.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Add keys"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::listed(&self.bones, skeleton)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        key_time(self.time, work.slot(take))?;
        let mut added = false;
        for address in work.channels(take, (&self.bones, &self.properties))? {
            let times = work.slot(take).times(address.bone, address.property);
            // A channel that does not move gets keys only where its bone is named.
            let wanted = !times.is_empty() || !(self.bones.is_empty() || self.keyed_only);
            if wanted && key_at(times, self.time).is_err() {
                with_kind!(address.property, insert::<K>(work, address, self.time, self.value));
                added = true;
            }
        }
        if added { Ok(()) } else { Err(EditError::Nothing("there are keys at that time")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let value = from.choice([NewKey::Predecessor, NewKey::Current]);
        let (take, time, keyed_only) = (from.take(), from.between(0.0, 1.5), from.flag());
        Self { take, time, bones: from.bones(), properties: from.properties(), value, keyed_only }
    }
}
