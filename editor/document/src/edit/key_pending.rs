//! Keys pending poses.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, Property, TakeRef, cost};
use crate::adapter::kind::{ChannelKind, with_kind};
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::{PoseMode, Transaction, morph_keys, pending, pose};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Turns pending poses and weights of shape keys into keys. Weights become keys of the take also where the poses become keys of a layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KeyPending {
    /// The take.
    pub take: TakeRef,
    /// Seconds; all times where absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time: Option<f32>,
    /// The bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// Whether weights of shape keys are meant as well where bones are named; without bones they always are.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub shapes: bool,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
}

map_references!(KeyPending { take, time, bones, shapes, unstep });

impl EditKind for KeyPending {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"key_pending","take":"Walk","time":0.5}"#,
        description: "Keys the pending poses at 0.5 s.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Key pending poses"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::listed(&self.bones, skeleton)
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(adapter.pending_poses()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (take, base) = (work.take(&self.take)?, work.base(&self.take)?);
        for at in pending::selected(work, base, self.time, &self.bones, self.shapes)? {
            for pose in &at.poses {
                for property in Property::ALL {
                    if let Some(value) = pose.get(property) {
                        let address = ChannelAddress { take, bone: pose.bone, property };
                        with_kind!(property, key::<K>(work, address, at.time, value, self.unstep))?;
                    }
                }
            }
            let weights = at.shapes.iter().map(|at| (at.instance, (at.shape as usize, at.weight)));
            morph_keys::set_weights(work, base, at.time, weights)?;
            pending::remove(work, base, &at);
        }
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let time = from.optional(Arbitrary::time);
        Self { take: from.take(), time, bones: from.bones(), shapes: from.flag(), unstep: from.flag() }
    }
}

fn key<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    time: f32,
    value: [f32; 4],
    unstep: bool,
) -> Result<(), EditError> {
    pose::pose_channel::<K>(work, address, time, K::value(value), PoseMode::Set, unstep)
}
