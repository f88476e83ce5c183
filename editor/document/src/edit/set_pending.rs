//! Sets pending poses.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_pose::pose_label;
use super::{Arbitrary, BonePose, EditedBones, Example, Property, TakeRef, cost};
use crate::adapter::PendingAt;
use crate::adapter::kind::{ChannelKind, RotationChannel, ScaleChannel, TranslationChannel};
use crate::adapter::op::Op;
use crate::adapter::plan::{
    Transaction, key_time,
    pose::{rotation, vector},
};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Shows bones in a pose at a time without adding keys. A pending pose is part of the document and of undo, but it is
/// not in a saved file until it is keyed. It replaces an earlier pending pose of the same channels at that time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetPending {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The wanted poses; one for each bone.
    pub poses: Vec<BonePose>,
}

map_references!(SetPending { take, time, poses });

impl EditKind for SetPending {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"pend","take":"Walk","time":0.5,"poses":[{"bone":"Head","rotation":[0,0.2588190,0,0.9659258]}]}"#,
        description: "Shows the head rotated by 30° at 0.5 s, without a key.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match pose_label(&self.poses) {
            "Move" => "Move (pending)",
            "Rotate" => "Rotate (pending)",
            "Scale" => "Scale (pending)",
            _ => "Pose (pending)",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named(self.poses.iter().map(|pose| &pose.bone), skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(self.poses.len()))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.base(&self.take)?;
        key_time(self.time, work.slot(take))?;
        let mut at = match work.slot(take).pending_at(self.time) {
            Some(at) => PendingAt::clone(at),
            None => PendingAt::none(self.time),
        };
        let mut given = false;
        for pose in &self.poses {
            let bone = work.track(take, &pose.bone)?;
            let values = [
                pose.translation
                    .map(|numbers| vector("a translation", numbers).map(TranslationChannel::numbers)),
                pose.rotation.map(|numbers| rotation(numbers).map(RotationChannel::numbers)),
                pose.scale.map(|numbers| vector("a scale", numbers).map(ScaleChannel::numbers)),
            ];
            for (property, value) in Property::ALL.into_iter().zip(values) {
                if let Some(value) = value {
                    at.entry(bone).set(property, Some(value?));
                    given = true;
                }
            }
        }
        if !given {
            return Err(EditError::Nothing("no pose is given"));
        }
        let time = at.time;
        work.perform(Op::Pending(take, time, Some(Arc::new(at))));
        Ok(())
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        Self { take: from.take(), time: from.time(), poses: from.poses() }
    }
}
