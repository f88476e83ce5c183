//! Moves the values of keys between or beyond those of their neighbors.

use super::hold::{self, HeldFeet};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BonePose, BoneRef, EditedBones, Example, KeySet, TakeRef, cost};
use crate::adapter::kind::ChannelKind;
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::values::{ValueTool, change_values};
use crate::adapter::plan::{Transaction, finite, pose, rest};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{MorphTrack, Skeleton, Take, Transform};
use dragonfly_anim::inbetween::{BlendTarget, KeyValue, blend_keys};
use dragonfly_anim::sample::{sample_channel, sample_morph_weights};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Moves the values of keys toward or away from something. With a factor of 1 they are there, with 0 nothing changes, with -1 they are
/// as far away on the other side. Times stay. A tangent changes as the slope from the key before to the key after does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlendKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of morph targets are blended.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// The target toward which the keys move.
    pub toward: KeyTarget,
    /// Part of the way to the target, -10 to 10; 1 is at the target.
    pub factor: f32,
    /// Feet that are held where they were, in the contacts stored with the take, if the edit moves them there. Keys are added at
    /// every frame of these contacts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hold: Vec<BoneRef>,
}

/// The target toward which keys move. Their neighbors are the keys before and after each unbroken row of selected keys of a channel; at the end of
/// a channel, the end key itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum KeyTarget {
    /// The value this part of the way between the neighbors: 0 is the one before, 1 the one after.
    Between(f32),
    /// Away from the straight line between the neighbors; with a negative factor toward it.
    AwayFromLine,
    /// The straight line between the keys directly before and after each key.
    Average,
    /// The neighbor before.
    Previous,
    /// The neighbor after.
    Next,
    /// A slow start and a fast end between the neighbors.
    SlowStart,
    /// A fast start and a slow end between the neighbors.
    SlowEnd,
    /// The rest pose; for morph targets, weights of 0.
    Rest,
    /// These poses. Keys of other bones and channels stay, and so do those of morph targets.
    Pose(Vec<BonePose>),
    /// Another take at the same times, this many seconds later.
    OtherTake {
        /// The other take.
        take: TakeRef,
        /// Seconds that are added to the times of the keys.
        #[serde(default)]
        later: f32,
    },
    /// The curve of the key's own channel this many seconds earlier.
    Delayed(f32),
}

map_references!(BlendKeys { take, shapes, toward, factor, hold }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for BlendKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"blend_keys","take":"Walk","keys":[{"bones":["Head"],"at":[0.5]}],"toward":{"between":0.5},"factor":1}"#,
        description: "Moves the head's key at 0.5 s to the middle between its neighbors.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match self.toward {
            KeyTarget::Between(_) => "Tween keys",
            KeyTarget::AwayFromLine => "Push keys",
            KeyTarget::Average => "Relax keys",
            KeyTarget::Previous | KeyTarget::Next => "Blend keys to neighbor",
            KeyTarget::SlowStart | KeyTarget::SlowEnd => "Ease keys",
            KeyTarget::Rest => "Blend keys to rest pose",
            KeyTarget::Pose(_) => "Blend keys to pose",
            KeyTarget::OtherTake { .. } => "Blend keys to take",
            KeyTarget::Delayed(_) => "Delay values of keys",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        hold::with_limbs(EditedBones::of_keys(&self.keys, skeleton), &self.hold, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        if !self.hold.is_empty() {
            // It takes as long as the take has frames.
            return None;
        }
        let columns = cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?;
        // A rotation is blended in about the time of two keys that are moved.
        Some(columns + 3 * cost::of_keys(adapter, &self.take, &self.keys))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let factor = self.factor;
        if !(-10.0..=10.0).contains(&factor) {
            return Err(EditError::Number { what: "the factor", value: factor });
        }
        let take = work.take(&self.take)?;
        self.check(work)?;
        let held = HeldFeet::before(work, &self.take, &self.hold)?;
        change_values(work, take, &self.keys, &self.shapes, self)?;
        held.map_or(Ok(()), |held| held.hold(work))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (take, keys, shapes) = (from.take(), from.keys(), from.shapes());
        let toward = match from.below(11) {
            0 => KeyTarget::Between(from.between(-0.5, 1.5)),
            1 => KeyTarget::AwayFromLine,
            2 => KeyTarget::Average,
            3 => KeyTarget::Previous,
            4 => KeyTarget::Next,
            5 => KeyTarget::SlowStart,
            6 => KeyTarget::SlowEnd,
            7 => KeyTarget::Rest,
            8 => KeyTarget::Pose(from.poses()),
            9 => KeyTarget::OtherTake { take: from.take(), later: from.between(-0.5, 0.5) },
            _ => KeyTarget::Delayed(from.between(-0.5, 0.5)),
        };
        let factor = from.choice([0.0, 0.5, 1.0, -1.0, 1.5]);
        Self { take, keys, shapes, toward, factor, hold: from.feet() }
    }
}

impl BlendKeys {
    /// Checks the numbers and names of the target.
    fn check(&self, work: &Transaction) -> Result<(), EditError> {
        match &self.toward {
            KeyTarget::Between(part) if (-10.0..=10.0).contains(part) => Ok(()),
            KeyTarget::Between(part) => Err(EditError::Number { what: "the part of the way", value: *part }),
            KeyTarget::Delayed(seconds) => finite("the delay", *seconds).map(drop),
            KeyTarget::OtherTake { take, later } => {
                finite("the time", *later)?;
                work.take(take).map(drop)
            }
            KeyTarget::Pose(poses) => {
                poses.iter().try_for_each(|pose| work.bone(&pose.bone).and(pose_of(pose)).map(drop))
            }
            KeyTarget::AwayFromLine
            | KeyTarget::Average
            | KeyTarget::Previous
            | KeyTarget::Next
            | KeyTarget::SlowStart
            | KeyTarget::SlowEnd
            | KeyTarget::Rest => Ok(()),
        }
    }

    /// Blends the chosen keys; `wanted` returns the value toward which the key at a time moves, where the target is not made of keys.
    fn blend<T: KeyValue>(
        &self,
        times: &[f32],
        values: &[T],
        chosen: &[u32],
        wanted: impl Fn(f32) -> T,
    ) -> Vec<T> {
        let other: Vec<T>;
        let target = match &self.toward {
            KeyTarget::Between(part) => BlendTarget::Between(f64::from(*part)),
            KeyTarget::AwayFromLine => BlendTarget::AwayFromLine,
            KeyTarget::Average => BlendTarget::Average,
            KeyTarget::Previous => BlendTarget::Previous,
            KeyTarget::Next => BlendTarget::Next,
            KeyTarget::SlowStart => BlendTarget::SlowStart,
            KeyTarget::SlowEnd => BlendTarget::SlowEnd,
            KeyTarget::Rest | KeyTarget::Pose(_) | KeyTarget::OtherTake { .. } | KeyTarget::Delayed(_) => {
                other = chosen.iter().map(|&key| wanted(times[key as usize])).collect();
                BlendTarget::Values(&other)
            }
        };
        blend_keys(times, values, chosen, target, f64::from(self.factor))
    }

    /// Returns the take whose values are the target, and the seconds that are added to the time of a key.
    fn source<'a>(&self, work: &'a Transaction, own: &'a Take) -> Option<(&'a Take, f32)> {
        match &self.toward {
            KeyTarget::OtherTake { take, later } => Some((&*work.slot(work.take(take).ok()?).result, *later)),
            KeyTarget::Delayed(seconds) => Some((own, -seconds)),
            KeyTarget::Between(_)
            | KeyTarget::AwayFromLine
            | KeyTarget::Average
            | KeyTarget::Previous
            | KeyTarget::Next
            | KeyTarget::SlowStart
            | KeyTarget::SlowEnd
            | KeyTarget::Rest
            | KeyTarget::Pose(_) => None,
        }
    }
}

impl ValueTool for BlendKeys {
    fn bone_values<K: ChannelKind>(
        &self,
        work: &Transaction,
        address: ChannelAddress,
        values: &[K::Value],
        chosen: &[u32],
    ) -> Result<Option<Vec<K::Value>>, EditError> {
        let slot = work.slot(address.take);
        let mut constant = rest::<K>(work, address);
        if let KeyTarget::Pose(poses) = &self.toward {
            let of_bone = |pose: &&BonePose| work.bone(&pose.bone) == Ok(address.bone);
            let Some(pose) = poses.iter().rfind(of_bone) else { return Ok(None) };
            if !pose.gives(address.property) {
                return Ok(None);
            }
            constant = K::of(&pose_of(pose)?);
        }
        let source = self.source(work, &slot.result);
        let track = source.map(|(take, later)| (take.tracks.get(address.bone as usize), later));
        let wanted = |time: f32| match track {
            Some((Some(track), later)) => {
                K::as_key(sample_channel(K::channel(track), constant, time + later))
            }
            Some((None, _)) | None => constant,
        };
        let times = slot.times(address.bone, address.property);
        Ok(Some(self.blend(times, values, chosen, wanted)))
    }

    fn shape_weights(
        &self,
        work: &Transaction,
        track: &MorphTrack,
        target: usize,
        weights: &[f32],
        chosen: &[u32],
    ) -> Result<Option<Vec<f32>>, EditError> {
        if matches!(self.toward, KeyTarget::Pose(_)) {
            return Ok(None);
        }
        let own = Take { morphs: vec![track.clone()], ..Take::default() };
        let source = self.source(work, &own);
        let wanted = |time: f32| {
            let mut all = vec![0.0; track.targets as usize];
            if let Some((take, later)) = source {
                sample_morph_weights(Some(take), track.instance, &[], time + later, &mut all);
            }
            all.get(target).copied().unwrap_or_default()
        };
        Ok(Some(self.blend(&track.times, weights, chosen, wanted)))
    }
}

/// Returns the pose with its numbers checked; parts that it does not give are those of the identity.
fn pose_of(pose: &BonePose) -> Result<Transform, EditError> {
    let identity = Transform::IDENTITY;
    let vector = |what, given: Option<[f32; 3]>, otherwise| {
        given.map_or(Ok(otherwise), |numbers| pose::vector(what, numbers))
    };
    Ok(Transform {
        translation: vector("a translation", pose.translation, identity.translation)?,
        rotation: pose.rotation.map_or(Ok(identity.rotation), pose::rotation)?,
        scale: vector("a scale", pose.scale, identity.scale)?,
    })
}
