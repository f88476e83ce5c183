//! Sets the interpolation of channels.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, KeyInterpolation, Property, TakeRef};
use crate::adapter::EditError;
use crate::adapter::change::{KeyChange, add, put, subtract};
use crate::adapter::kind::{ChannelKind, ChannelValue, with_kind};
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::{
    Transaction,
    spline::{slope, value},
};
use crate::adapter::slot::ChannelContent;
use dragonfly_anim::data::Skeleton;
use dragonfly_anim::data::{Channel, Interpolation};
use dragonfly_anim::sample::Value;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Sets how channels interpolate between their keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SetInterpolation {
    /// The take.
    pub take: TakeRef,
    /// The bones; all where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bones: Vec<BoneRef>,
    /// The channels of these bones; all three where empty.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub properties: Vec<Property>,
    /// The interpolation.
    pub interpolation: KeyInterpolation,
}

map_references!(SetInterpolation { take, bones, properties, interpolation });

impl EditKind for SetInterpolation {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"set_interpolation","take":"Walk","bones":["Head"],"interpolation":"cubic_spline"}"#,
        description: "Makes the head move smoothly through its keys.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    const SHOWS_DIFFERENCE: bool = true;

    fn label(&self) -> &'static str {
        "Set interpolation"
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        EditedBones::listed(&self.bones, skeleton)
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let wanted = Interpolation::from(self.interpolation);
        let mut changed = false;
        for address in work.channels(take, (&self.bones, &self.properties))? {
            changed |= with_kind!(address.property, become_interpolation::<K>(work, address, wanted));
        }
        if changed { Ok(()) } else { Err(EditError::Nothing("the channels have that interpolation already")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let interpolation =
            from.choice([KeyInterpolation::Step, KeyInterpolation::Linear, KeyInterpolation::CubicSpline]);
        Self { take: from.take(), bones: from.bones(), properties: from.properties(), interpolation }
    }
}

/// Sets the interpolation of a channel. Returns whether it had another one.
pub(super) fn become_interpolation<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    wanted: Interpolation,
) -> bool {
    let slot = work.slot(address.take);
    let Some(old) = slot.original_of::<K>(address.bone).cloned() else { return false };
    if old.is_empty() || old.interpolation == wanted {
        return false;
    }
    let old_changes = slot.changes(address.bone, address.property).to_vec();
    let result = slot.result.tracks.get(address.bone as usize).map(K::channel).cloned().unwrap_or_default();
    let was_spline = old.interpolation == Interpolation::CubicSpline;
    let is_spline = wanted == Interpolation::CubicSpline;
    let old_times = Arc::clone(&old.times);
    let (original, changes) = if is_spline {
        (smooth::<K>(&old), tangent_changes::<K>(&old, &result, &old_changes))
    } else if was_spline {
        let values: Vec<K::Value> = (0..old.len()).filter_map(|key| old.value(key)).collect();
        let flat = |change: KeyChange| KeyChange::of_value(change.value).some::<K>();
        let changes = old_changes.iter().filter_map(|&(key, change)| Some((key, flat(change)?))).collect();
        (Channel { values: values.into(), interpolation: wanted, ..old }, changes)
    } else {
        (Channel { interpolation: wanted, ..old }, old_changes)
    };
    work.replace::<K>(address, ChannelContent { original: K::Value::wrap(original), changes }, &old_times);
    true
}

/// Returns the same keys with tangents from the key before to the key after.
fn smooth<K: ChannelKind>(channel: &Channel<K::Value>) -> Channel<K::Value> {
    let mut values = vec![K::Value::ZERO; channel.len() * 3];
    for key in 0..channel.len() {
        let slope = slope::<K>(channel, key);
        put::<K>(&mut values, Interpolation::CubicSpline, key, &[slope, value::<K>(channel, key), slope]);
    }
    Channel {
        times: Arc::clone(&channel.times),
        values: values.into(),
        interpolation: Interpolation::CubicSpline,
    }
}

/// Returns the changes of a channel that becomes a spline: the result gets the tangents of its own curve.
fn tangent_changes<K: ChannelKind>(
    original: &Channel<K::Value>,
    result: &Channel<K::Value>,
    changes: &[(u32, KeyChange)],
) -> Vec<(u32, KeyChange)> {
    if changes.is_empty() {
        return Vec::new();
    }
    let changed = |key: usize| changes.binary_search_by_key(&(key as u32), |(key, _)| *key).ok();
    let change = |key: usize| {
        let change = changed(key).map_or(KeyChange::identity::<K>(), |at| changes[at].1);
        let wanted = slope::<K>(result, key);
        let own = slope::<K>(original, key);
        let [arrive, _, leave] = change.result::<K>(&[own, value::<K>(original, key), own]);
        let change = KeyChange {
            arrive: add(change.arrive, subtract(wanted, arrive)),
            leave: add(change.leave, subtract(wanted, leave)),
            ..change
        };
        Some((key as u32, change.some::<K>()?))
    };
    // A changed key changes the curve at its neighbors, too.
    let near = |key: &usize| {
        let around = key.saturating_sub(1)..=(key + 1);
        around.into_iter().any(|key| changed(key).is_some())
    };
    (0..original.len()).filter(near).filter_map(change).collect()
}
