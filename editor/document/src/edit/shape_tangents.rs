//! Computes the tangents of keys from the keys around them.

use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::set_interpolation::become_interpolation;
use super::{Arbitrary, EditedBones, Example, KeySet, TakeRef, cost};
use crate::adapter::change::{KeyChange, Triple};
use crate::adapter::kind::{ChannelKind, ChannelNumbers, with_kind};
use crate::adapter::op::{ChannelAddress, Op};
use crate::adapter::plan::{Transaction, list, spline::near, spline::value};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{Channel, Interpolation, Skeleton};
use dragonfly_anim::tangents::{NeighborKey, tangents};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Computes the tangents of keys. A channel that is no cubic spline becomes one, whose other keys get smooth tangents.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShapeTangents {
    /// The take.
    pub take: TakeRef,
    /// The keys.
    pub keys: Vec<KeySet>,
    /// The kind of tangents.
    pub kind: KeyTangents,
}

/// A kind of tangents.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum KeyTangents {
    /// Smooth: the slope of the parabola through the key and its neighbors.
    Auto,
    /// Smooth, but the curve stays between the values of the keys.
    Clamped,
    /// Horizontal.
    Flat,
    /// Straight to the neighbors.
    Linear,
    /// The same before and after the key: the mean of both.
    Unified,
}

impl From<KeyTangents> for dragonfly_anim::tangents::TangentKind {
    fn from(kind: KeyTangents) -> Self {
        match kind {
            KeyTangents::Auto => Self::Auto,
            KeyTangents::Clamped => Self::Clamped,
            KeyTangents::Flat => Self::Flat,
            KeyTangents::Linear => Self::Linear,
            KeyTangents::Unified => Self::Unified,
        }
    }
}

map_references!(ShapeTangents { take, keys, kind });

impl EditKind for ShapeTangents {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"shape_tangents","take":"Walk","keys":[{"bones":["Head"],"from":0,"to":1}],"kind":"clamped"}"#,
        description: "Makes the head move smoothly through the keys of the first second, without overshooting them.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match self.kind {
            KeyTangents::Auto => "Smooth tangents",
            KeyTangents::Clamped => "Clamp tangents",
            KeyTangents::Flat => "Flatten tangents",
            KeyTangents::Linear => "Straighten tangents",
            KeyTangents::Unified => "Unify tangents",
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

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        let columns = cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?;
        Some(columns + cost::of_keys(adapter, &self.take, &self.keys))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let take = work.take(&self.take)?;
        let mut is_changed = false;
        for (address, keys) in work.keys(take, &self.keys)? {
            is_changed |= with_kind!(address.property, shape::<K>(work, address, &keys, self.kind))?;
        }
        if is_changed { Ok(()) } else { Err(EditError::Nothing("the keys have these tangents already")) }
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let kind = from.choice([
            KeyTangents::Auto,
            KeyTangents::Clamped,
            KeyTangents::Flat,
            KeyTangents::Linear,
            KeyTangents::Unified,
        ]);
        Self { take: from.take(), keys: from.keys(), kind }
    }
}

/// Computes the tangents of keys of a channel. Returns whether any changed.
fn shape<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    keys: &[u32],
    kind: KeyTangents,
) -> Result<bool, EditError> {
    let became_spline = become_interpolation::<K>(work, address, Interpolation::CubicSpline);
    let slot = work.slot(address.take);
    let Some(result) = slot.result.tracks.get(address.bone as usize).map(K::channel) else {
        return Ok(became_spline);
    };
    let mut changes = list(keys.len())?;
    for &key in keys {
        let Some(found) = slot.key::<K>(address.property, address.bone, key as usize) else { continue };
        let before = found.change.unwrap_or(KeyChange::identity::<K>());
        let now: Triple = before.result::<K>(&found.original);
        let wanted = tangents_of::<K>(result, key as usize, now, kind);
        let change = before.given_tangents::<K>(&found.original, wanted.map(Some));
        if change != before {
            changes.push((key, change.some::<K>()));
        }
    }
    let is_changed = became_spline || !changes.is_empty();
    if !changes.is_empty() {
        work.perform(Op::Changes(address, changes));
    }
    Ok(is_changed)
}

/// Returns the in-tangent and the out-tangent that a key is to have.
fn tangents_of<K: ChannelKind>(
    channel: &Channel<K::Value>,
    key: usize,
    now: Triple,
    kind: KeyTangents,
) -> [ChannelNumbers; 2] {
    let neighbor = |other: Option<usize>| {
        let other = other.filter(|&other| other < channel.len())?;
        let seconds = (channel.times[other] - channel.times[key]).abs();
        Some(NeighborKey { seconds, value: near::<K>(value::<K>(channel, other), now[1]) })
    };
    tangents(kind.into(), neighbor(key.checked_sub(1)), now[1], neighbor(Some(key + 1)), [now[0], now[2]])
}
