//! Invariants of every document.

use super::ModelAdapter;
use super::change::{KeyChange, triple};
use super::kind::{ChannelKind, RotationChannel, ScaleChannel, TranslationChannel};
use super::pending::PendingPose;
use super::slot::{LayerVersions, TakeVersions, extent};
use crate::edit::target::{Property, SAME_TIME};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::layers::flatten;
use std::sync::Arc;
use thiserror::Error;

/// A broken invariant: a bug in this program.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("take {take}: {what}")]
pub struct BrokenInvariant {
    /// Index of the take in the list.
    pub take: usize,
    /// The invariant.
    pub what: String,
}

impl ModelAdapter {
    /// Checks all invariants: original, changes and result correspond, untouched channels are shared, keys ascend,
    /// numbers are finite, start and length are those of the keys, takes are unique.
    pub fn check(&self) -> Result<(), BrokenInvariant> {
        for (take, slot) in self.slots.iter().enumerate() {
            let found =
                slot_is_right(slot).and_then(|()| layers_are_right(slot, &self.skeleton)).and_then(|()| {
                    let twice = self.slots[..take].iter().any(|other| other.id == slot.id);
                    if twice { Err(format!("{:?} is there twice", slot.id)) } else { Ok(()) }
                });
            found.map_err(|what| BrokenInvariant { take, what })?;
        }
        Ok(())
    }
}

type CheckResult = Result<(), String>;

fn ensure(holds: bool, what: impl FnOnce() -> String) -> CheckResult {
    if holds { Ok(()) } else { Err(what()) }
}

fn slot_is_right(slot: &TakeVersions) -> CheckResult {
    let (original, result) = (&slot.original, &slot.result);
    let unchanged = slot.changed().next().is_none();
    ensure(unchanged == Arc::ptr_eq(original, result), || "an unchanged take is its original".to_owned())?;
    ensure(original.name == result.name, || "the names differ".to_owned())?;
    ensure(original.extras == result.extras, || "the extras differ".to_owned())?;
    ensure(original.tracks.len() == result.tracks.len(), || "the tracks differ".to_owned())?;
    ensure(original.morphs == result.morphs, || "the morph tracks differ".to_owned())?;
    for take in [original, result] {
        let now = (take.start.to_bits(), take.length.to_bits());
        let (start, length) = extent(take);
        ensure(now == (start.to_bits(), length.to_bits()), || {
            "start and length are not those of the keys".to_owned()
        })?;
    }
    for (bone, property) in slot.changed() {
        ensure((bone as usize) < original.tracks.len(), || {
            format!("a change of bone {bone}, which is not there")
        })?;
        ensure(!slot.changes(bone, property).is_empty(), || "a list of no changes is kept".to_owned())?;
    }
    pending_is_right(slot)?;
    for bone in 0..original.tracks.len() as u32 {
        channel_is_right::<TranslationChannel>(slot, result, bone, Property::Translation)?;
        channel_is_right::<RotationChannel>(slot, result, bone, Property::Rotation)?;
        channel_is_right::<ScaleChannel>(slot, result, bone, Property::Scale)?;
    }
    Ok(())
}

/// Checks the keys of the layers, and that the take that is shown is the one that they give.
fn layers_are_right(slot: &TakeVersions, skeleton: &Skeleton) -> CheckResult {
    for layer in slot.layers() {
        slot_is_right(&layer.keys)?;
        let same = layer.keys.original.tracks.len() == slot.original.tracks.len();
        ensure(same && layer.keys.layers().is_empty(), || "a layer is not one of its take".to_owned())?;
        ensure(layer.keys.pending().is_empty(), || "a layer has pending poses".to_owned())?;
    }
    if slot.layers().is_empty() {
        return ensure(Arc::ptr_eq(slot.shown(), &slot.result), || {
            "a take without layers is its result".to_owned()
        });
    }
    let layers: Vec<_> = slot.layers().iter().map(LayerVersions::flat).collect();
    let flat = flatten(&slot.result, &layers, skeleton);
    ensure(flat == **slot.shown(), || "what is shown is not what the layers give".to_owned())
}

fn pending_is_right(slot: &TakeVersions) -> CheckResult {
    let pending = slot.pending();
    let apart = pending.windows(2).all(|pair| pair[1].time - pair[0].time > SAME_TIME);
    ensure(apart, || "pending poses do not ascend in time".to_owned())?;
    for at in pending {
        let inside = |pose: &PendingPose| (pose.bone as usize) < slot.original.tracks.len();
        let is_finite = |pose: &PendingPose| {
            let mut values = Property::ALL.into_iter().filter_map(|property| pose.get(property)).flatten();
            values.all(f32::is_finite)
        };
        let weights = at.shapes.iter().all(|shape| shape.weight.is_finite());
        let finite = at.time.is_finite() && at.poses.iter().all(is_finite) && weights;
        ensure(finite, || format!("what is pending at {} s is not finite", at.time))?;
        let ascend = at.poses.windows(2).all(|pair| pair[0].bone < pair[1].bone);
        let shapes = at.shapes.is_sorted_by_key(|shape| (shape.instance, shape.shape));
        let ascend = ascend && shapes;
        let some = !at.is_empty() && !at.poses.iter().any(PendingPose::is_empty);
        ensure(ascend && some && at.poses.iter().all(inside), || {
            format!("what is pending at {} s is not in order", at.time)
        })?;
    }
    Ok(())
}

fn channel_is_right<K: ChannelKind>(
    slot: &TakeVersions,
    result: &Take,
    bone: u32,
    property: Property,
) -> CheckResult {
    let at = || format!("bone {bone}, {}", property.name());
    let track = &result.tracks[bone as usize];
    ensure(track.bone == bone, || format!("{}: the track is of bone {}", at(), track.bone))?;
    let Some(original) = slot.original_of::<K>(bone) else { return Ok(()) };
    let (result, changes) = (K::channel(track), slot.changes(bone, property));
    ensure(result.interpolation == original.interpolation, || format!("{}: interpolations differ", at()))?;
    ensure(Arc::ptr_eq(&result.times, &original.times), || format!("{}: times are not shared", at()))?;
    let whole = result.values.len() == result.times.len() * result.values_per_key();
    ensure(whole && original.values.len() == result.values.len(), || {
        format!("{}: columns of other lengths", at())
    })?;
    let times_ascend = original.times.windows(2).all(|pair| pair[0] < pair[1]);
    ensure(times_ascend, || format!("{}: times do not ascend", at()))?;
    if changes.is_empty() {
        return ensure(Arc::ptr_eq(&result.values, &original.values), || {
            format!("{}: values are not shared", at())
        });
    }
    let ascend = changes.windows(2).all(|pair| pair[0].0 < pair[1].0);
    ensure(ascend, || format!("{}: changes do not ascend", at()))?;
    let inside = changes.last().is_none_or(|(key, _)| (*key as usize) < original.len());
    ensure(inside, || format!("{}: a change of a key that is not there", at()))?;
    for key in 0..original.len() {
        let as_read = triple::<K>(original, key);
        let change = slot.key_change(bone, property, key);
        ensure(change != Some(KeyChange::identity::<K>()), || {
            format!("{}: key {key}: a change of nothing", at())
        })?;
        let wanted = change.map_or(as_read, |change| change.result::<K>(&as_read));
        let now = triple::<K>(result, key);
        // Only splines have tangents to compare.
        let stored = if result.values_per_key() == 3 { 0..3 } else { 1..2 };
        let bits = |at: usize| wanted[at].map(f32::to_bits) == now[at].map(f32::to_bits);
        ensure(stored.into_iter().all(bits), || format!("{}: key {key} is not original + change", at()))?;
        let finite = now.iter().flatten().all(|number| number.is_finite());
        ensure(finite, || format!("{}: key {key} is not finite", at()))?;
    }
    Ok(())
}
