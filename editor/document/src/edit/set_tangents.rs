//! Sets the tangents of a key.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_many_tangents::TangentsAt;
use super::{Arbitrary, BoneRef, EditedBones, Example, Property, TakeRef, cost};
use crate::adapter::change::KeyChange;
use crate::adapter::kind::{ChannelKind, ChannelNumbers, with_kind};
use crate::adapter::op::{ChannelAddress, Op};
use crate::adapter::plan::{Transaction, finite, key_at, pose::numbers};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::Interpolation;
use dragonfly_anim::data::Skeleton;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sets the tangents of a key of a cubic spline, in units per second. An absent tangent stays as it is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetTangents {
    /// The take.
    pub take: TakeRef,
    /// Seconds: the time of the key.
    pub time: f32,
    /// The bone.
    pub bone: BoneRef,
    /// The channel.
    pub property: Property,
    /// In-tangent: three numbers, for rotations four.
    #[serde(default, rename = "in", skip_serializing_if = "Option::is_none")]
    pub arrive: Option<Vec<f32>>,
    /// Out-tangent.
    #[serde(default, rename = "out", skip_serializing_if = "Option::is_none")]
    pub leave: Option<Vec<f32>>,
}

map_references!(SetTangents { take, time, bone, property, arrive, leave });

impl EditKind for SetTangents {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_tangents","take":"Walk","time":0.5,"bone":"Head","property":"translation","in":[0,1,0],"out":[0,1,0]}"#,
        description: "Sets both tangents of a key of a cubic spline.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Set tangents"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::named([&self.bone], skeleton)
    }

    fn cost(&self, _adapter: &ModelAdapter) -> Option<usize> {
        Some(cost::of_poses(1))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let Self { take, time, bone, property, arrive, leave } = self;
        let (time, bone, property) = (*time, bone.clone(), *property);
        let at = TangentsAt { time, bone, property, arrive: arrive.clone(), leave: leave.clone() };
        at.plan(work, take)
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let property = from.property();
        let count = if property == Property::Rotation { 4 } else { 3 };
        let arrive = from.optional(|from| from.numbers(count));
        let leave = from.optional(|from| from.numbers(count));
        Self { take: from.take(), time: from.time(), bone: from.bone(), property, arrive, leave }
    }
}

impl TangentsAt {
    /// Sets the tangents of this key of a take.
    pub(super) fn plan(&self, work: &mut Transaction, take: &TakeRef) -> Result<(), EditError> {
        let (take, property) = (work.take(take)?, self.property);
        let time = finite("a time", self.time)?;
        let bone = work.track(take, &self.bone)?;
        let tangents = [&self.arrive, &self.leave]
            .map(|given| given.as_ref().map(|given| numbers("a tangent", given, property)).transpose());
        let [arrive, leave] = tangents;
        let (arrive, leave) = (arrive?, leave?);
        if arrive.is_none() && leave.is_none() {
            return Err(EditError::Nothing("no tangent is given"));
        }
        let address = ChannelAddress { take, bone, property };
        let key = key_at(work.slot(take).times(bone, property), time);
        let key = key.map_err(|_| EditError::NoKey { bone, property, time })?;
        with_kind!(property, set_tangents::<K>(work, address, key, arrive, leave))
    }
}

fn set_tangents<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    key: usize,
    arrive: Option<ChannelNumbers>,
    leave: Option<ChannelNumbers>,
) -> Result<(), EditError> {
    let slot = work.slot(address.take);
    let spline = slot
        .original_of::<K>(address.bone)
        .is_some_and(|channel| channel.interpolation == Interpolation::CubicSpline);
    if !spline {
        return Err(EditError::NoSpline { bone: address.bone, property: address.property });
    }
    let Some(found) = slot.key::<K>(address.property, address.bone, key) else { return Ok(()) };
    let before = found.change.unwrap_or(KeyChange::identity::<K>());
    let change = before.given_tangents::<K>(&found.original, [arrive, leave]);
    work.perform(Op::Changes(address, vec![(key as u32, change.some::<K>())]));
    Ok(())
}
