//! Pastes a copied pose.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::target::BoneFinder;
use super::{
    Arbitrary, BonePose, BoneRef, EditedBones, Example, OffsetFalloff, OffsetKeys, OffsetScope, SetPending,
    SetPose, TakeRef, cost,
};
use crate::adapter::kind::{ChannelKind, RotationChannel, ScaleChannel, TranslationChannel};
use crate::adapter::plan::{
    Transaction, key_time, layer,
    pose::{rotation, vector},
};
use crate::adapter::{EditError, ModelAdapter, TakeId};
use crate::bones::MirrorPairs;
use crate::posing::mirror::Mirror;
use dragonfly_anim::data::Channel;
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::sample::{rest_pose, sample_channel};
use glam::{Quat, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pastes copied poses. Bones that the model does not have are left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PastePose {
    /// The take.
    pub take: TakeRef,
    /// Seconds.
    pub time: f32,
    /// The copied poses; one for each bone.
    pub poses: Vec<BonePose>,
    /// Mirrors the poses to the other side. Pairs of bones are guessed from their names and positions.
    #[serde(default)]
    pub mirrored: bool,
    /// Makes pending poses instead of keys.
    #[serde(default)]
    pub pending: bool,
    /// Makes channels linear first that consist of two equal keys with step interpolation, as exporters write channels
    /// that do not move. The bone then moves to the pose instead of jumping to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unstep: bool,
    /// Offsets these keys of the bones by as much as the poses change at the time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub over: Option<OffsetScope>,
    /// How the offset fades out around the keys.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub falloff: Option<OffsetFalloff>,
}

map_references!(PastePose { take, time, poses, mirrored, pending, unstep, over, falloff });

impl EditKind for PastePose {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"paste","take":"Walk","time":1,"poses":[{"bone":"Hand.L","rotation":[0,0.2588190,0,0.9659258]}],"mirrored":true}"#,
        description: "Gives the right hand the pose of the left one, mirrored.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        if self.mirrored { "Paste pose mirrored" } else { "Paste pose" }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        let pairs = self.mirrored.then(|| MirrorPairs::of(skeleton));
        let mut finder = BoneFinder::new(skeleton);
        let given = self.poses.iter().filter_map(|pose| finder.find(&pose.bone));
        let target = |bone| pairs.as_ref().map_or(Some(bone), |pairs| pairs.mirror_of(bone));
        EditedBones::Named(given.filter_map(target).collect())
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        let columns = match self.over {
            Some(_) => cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?,
            None => 0,
        };
        // Each of the copied keys is also offset.
        Some(columns * 16 + cost::of_poses(self.poses.len()))
    }

    fn detail(&self, _adapter: &ModelAdapter) -> Option<String> {
        self.over.as_ref().map(|over| over.keys_text().to_owned())
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let (id, time) = (work.take(&self.take)?, self.time);
        key_time(time, work.slot(id))?;
        let mut found = false;
        let mut poses = Vec::new();
        let mirror = self.mirrored.then(|| Mirror::of(work.skeleton()));
        let mut finder = BoneFinder::new(work.skeleton());
        let bones: Vec<_> = self.poses.iter().map(|pose| finder.find(&pose.bone)).collect();
        for (pose, bone) in self.poses.iter().zip(bones) {
            // The pose may come from a model that has other bones.
            let Some(bone) = bone else { continue };
            found = true;
            let translation = pose.translation.map(|given| vector("a translation", given)).transpose()?;
            let turn = pose.rotation.map(rotation).transpose()?;
            let scale = pose.scale.map(|given| vector("a scale", given)).transpose()?;
            let target = match &mirror {
                None => Some((bone, translation, turn, scale)),
                Some(mirror) => mirror.target(bone).map(|target| {
                    let translation = translation.and_then(|given| mirror.translation(bone, given));
                    let turn = turn.and_then(|given| mirror.rotation(bone, given));
                    (target, translation, turn, scale.and_then(|given| mirror.scale(bone, given)))
                }),
            };
            if let Some((bone, translation, turn, scale)) = target {
                poses.push(BonePose {
                    bone: BoneRef::Index(bone),
                    translation: changed::<TranslationChannel>(work, id, bone, time, translation)
                        .map(Vec3::into),
                    rotation: changed::<RotationChannel>(work, id, bone, time, turn).map(Quat::into),
                    scale: changed::<ScaleChannel>(work, id, bone, time, scale).map(Vec3::into),
                });
            }
        }
        if !found {
            return Err(EditError::Nothing("none of the bones is in this model"));
        }
        poses.retain(|pose| pose.translation.is_some() || pose.rotation.is_some() || pose.scale.is_some());
        if poses.is_empty() {
            return Err(EditError::Nothing("the bones are in this pose already"));
        }
        let take = self.take.clone();
        if let Some(over) = self.over.clone() {
            OffsetKeys { take, poses, at: Some(time), over, falloff: self.falloff }.plan(work)
        } else if self.pending {
            SetPending { take, time, poses }.plan(work)
        } else {
            SetPose { take, time, poses, unstep: self.unstep }.plan(work)
        }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let [mirrored, pending, unstep] = [(); 3].map(|()| from.flag());
        let over = from.optional(OffsetScope::arbitrary);
        let falloff = from.optional(OffsetFalloff::arbitrary);
        let (take, time, poses) = (from.take(), from.time(), from.poses());
        Self { take, time, poses, mirrored, pending, unstep, over, falloff }
    }
}

/// Returns the value; `None` for a channel that has no keys and already shows that value, so that pasting a pose does
/// not add keys to every channel.
fn changed<K: ChannelKind>(
    work: &Transaction,
    take: TakeId,
    bone: u32,
    time: f32,
    value: Option<K::Value>,
) -> Option<K::Value> {
    let value = value?;
    let (slot, base) = (work.slot(take), work.slot(layer::base_of(work, take)));
    let channel: &Channel<K::Value> = K::channel(slot.result.tracks.get(bone as usize)?);
    let waits = base.pending_at(time).is_some_and(|at| at.of(bone).is_some());
    if !channel.is_empty() || waits {
        return Some(value);
    }
    let seen = K::channel(base.shown().tracks.get(bone as usize)?);
    let rest = K::of(&rest_pose(work.skeleton().bones.get(bone as usize)?));
    let shown = K::numbers(sample_channel(seen, rest, time));
    let near = |sign: f32| {
        let pairs = shown.iter().zip(K::numbers(value));
        pairs.into_iter().all(|(shown, value)| (shown - sign * value).abs() <= 1e-5 * (1.0 + shown.abs()))
    };
    let turn = K::IDENTITY == RotationChannel::IDENTITY;
    let same = near(1.0) || (turn && near(-1.0));
    (!same).then_some(value)
}
