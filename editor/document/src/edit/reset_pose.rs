//! Resets keys to the original or to the rest pose.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, Property, ResetTo, TakeRef, cost};
use crate::adapter::kind::{ChannelKind, with_kind};
use crate::adapter::op::{ChannelAddress, Op};
use crate::adapter::plan::{Transaction, finite, key_at, pending, pose, rest};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Undoes the changes of keys at a time, or resets them to the rest pose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResetPose {
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
    /// The pose to reset to.
    #[serde(default)]
    pub to: ResetTo,
}

map_references!(ResetPose { take, time, bones, properties, to });

impl EditKind for ResetPose {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"reset","take":"Walk","time":0.5,"bones":["Head"],"properties":["rotation"],"to":"original"}"#,
        description: "Restores the original rotation of the head at the key at 0.5 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match self.to {
            ResetTo::Original => "Reset to original",
            ResetTo::Rest => "Reset to rest pose",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::listed(&self.bones, skeleton)
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(adapter.skeleton().len()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        finite("a time", self.time)?;
        let addresses = work.channels(take, (&self.bones, &self.properties))?;
        let channels: Vec<_> = addresses.iter().map(|address| (address.bone, address.property)).collect();
        let base = work.base(&self.take)?;
        let mut found = pending::overwritten(work, base, self.time, &channels);
        for address in addresses {
            let times = work.slot(take).times(address.bone, address.property);
            let Ok(key) = key_at(times, self.time) else { continue };
            found = true;
            match self.to {
                ResetTo::Original => work.perform(Op::Changes(address, vec![(key as u32, None)])),
                ResetTo::Rest => with_kind!(address.property, to_rest::<K>(work, address, key))?,
            }
        }
        if found { Ok(()) } else { Err(EditError::Nothing("there is no key at that time")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let to = from.choice([ResetTo::Original, ResetTo::Rest]);
        Self { take: from.take(), time: from.time(), bones: from.bones(), properties: from.properties(), to }
    }
}

fn to_rest<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    key: usize,
) -> Result<(), EditError> {
    let rest = rest::<K>(work, address);
    pose::change_key::<K>(work, address, key, |_| rest)
}
