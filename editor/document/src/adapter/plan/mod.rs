//! From an edit to operations: a file a family of edits.

mod arrange;
mod chosen;
mod cut;
mod keys;
mod morph;
mod paste;
mod paste_keys;
mod pending;
mod pose;
mod remap;
mod spline;
mod takes;
mod timing;
mod unstep;

pub(super) use pose::{Way, changed, rotation, vector};

use super::kind::{Held, Kind};
use super::op::{Op, Place};
use super::slot::{Content, Slot, TakeId, key_at};
use super::times::Shared;
use super::{EditError, ModelAdapter};
use crate::edit::{BoneRef, Edit, Property, TakeRef};
use dragonfly_anim::data::{Bone, Channel};
use std::collections::BTreeSet;
use std::sync::Arc;

/// An edit under way: the document as it is so far, and what leads back.
pub(super) struct Work {
    adapter: ModelAdapter,
    undo: Vec<Op>,
    shared: Shared,
    /// Takes whose keys lie elsewhere now: their begin and end are looked for once, at the end.
    touched: Vec<TakeId>,
}

/// Does `edit` on `work`.
pub(super) fn run(work: &mut Work, edit: &Edit) -> Result<(), EditError> {
    match edit {
        Edit::Set { take, time, poses, unstep } => pose::set(work, take, *time, poses, *unstep),
        Edit::SetMany { take, at, unstep } => pose::set_many(work, take, at, *unstep),
        Edit::Offset { take, time, poses, unstep } => pose::offset(work, take, *time, poses, *unstep),
        Edit::Reset { take, time, bones, properties, to } => {
            pose::reset(work, take, *time, (bones, properties), *to)
        }
        Edit::Pend { take, time, poses } => pending::pend(work, take, *time, poses),
        Edit::Paste { take, time, poses, mirrored, pending, unstep } => {
            let way = paste::Way { mirrored: *mirrored, pending: *pending, unstep: *unstep };
            paste::paste(work, take, *time, poses, way)
        }
        Edit::KeyPending { take, time, bones, unstep } => pending::key(work, take, *time, bones, *unstep),
        Edit::DropPending { take, time, bones } => pending::drop(work, take, *time, bones),
        Edit::AddKeys { take, time, bones, properties, value, keyed_only } => {
            keys::add(work, take, *time, (bones, properties), *value, *keyed_only)
        }
        Edit::DeleteKeys { take, keys } => keys::delete(work, take, keys),
        Edit::MoveKeys { take, keys, by } => timing::shift(work, take, keys, *by),
        Edit::ScaleKeys { take, keys, about, factor } => timing::scale(work, take, keys, *about, *factor),
        Edit::DuplicateKeys { take, keys, by } => timing::duplicate(work, take, keys, *by),
        Edit::PasteKeys { take, time, channels } => paste_keys::paste(work, take, *time, channels),
        Edit::Ripple { take, from, by } => timing::ripple(work, take, *from, *by),
        Edit::SnapKeys { take, keys, rate } => timing::snap(work, take, keys, *rate),
        Edit::SetInterpolation { take, bones, properties, interpolation } => {
            spline::interpolate(work, take, (bones, properties), *interpolation)
        }
        Edit::SetTangents { take, time, bone, property, arrive, leave } => {
            let tangents = [arrive.as_deref(), leave.as_deref()];
            spline::tangents(work, take, *time, bone, *property, tangents)
        }
        Edit::CreateTake { name, copy, at } => takes::create(work, name, copy.as_ref(), *at),
        Edit::DeleteTake { take } => takes::delete(work, take),
        Edit::RenameTake { take, name } => takes::rename(work, take, name),
        Edit::MoveTake { take, to } => takes::reorder(work, take, *to),
        Edit::SplitTake { take, time, name } => cut::split(work, take, *time, name),
        Edit::TrimTake { take, from, to, to_start } => cut::trim(work, take, *from, *to, *to_start),
        Edit::ReverseTake { take } => remap::reverse(work, take),
        Edit::RetimeTake { take, start, length } => remap::retime(work, take, *start, *length),
    }
}

/// Bones and properties as an edit names them; none of either means all.
type Named<'a> = (&'a [BoneRef], &'a [Property]);

impl Work {
    pub(super) fn on(adapter: ModelAdapter) -> Self {
        Self { adapter, undo: Vec::new(), shared: Shared::default(), touched: Vec::new() }
    }

    /// The document, and what leads back from it in the order of doing.
    pub(super) fn done(mut self) -> (ModelAdapter, Vec<Op>) {
        self.adapter.measure(&self.touched);
        (self.adapter, self.undo)
    }

    pub(super) fn perform(&mut self, op: Op) {
        if let Some(take) = op.keys_of()
            && !self.touched.contains(&take)
        {
            self.touched.push(take);
        }
        let inverse = self.adapter.perform(op, &mut self.shared);
        self.undo.push(inverse);
    }

    /// Puts a channel in place of another; it shares its times with those that got the same of the same.
    fn replace<K: Kind>(&mut self, place: Place, mut content: Content, old_times: &Arc<[f32]>) {
        if let Some(channel) = K::Value::unwrap(&content.original) {
            let times = self.shared.times(old_times, channel.times.to_vec());
            content.original = K::Value::wrap(Channel { times, ..channel.clone() });
        }
        self.perform(Op::Replace(place, Box::new(content)));
    }

    fn take(&self, take: &TakeRef) -> Result<TakeId, EditError> {
        self.adapter.take(take).map(|slot| slot.id)
    }

    fn index(&self, take: TakeId) -> usize {
        self.adapter.slots.iter().position(|slot| slot.id == take).unwrap_or_default()
    }

    /// The take as it is so far.
    fn slot(&self, take: TakeId) -> &Arc<Slot> {
        &self.adapter.slots[self.index(take)]
    }

    fn bone(&self, bone: &BoneRef) -> Result<u32, EditError> {
        self.adapter.bone(bone)
    }

    fn skeleton_bone(&self, bone: u32) -> &Bone {
        &self.adapter.skeleton.bones[bone as usize]
    }

    /// The channels that are meant, bone after bone.
    fn channels(&self, take: TakeId, (bones, properties): Named<'_>) -> Result<Vec<Place>, EditError> {
        let slot = self.slot(take);
        let bones: Vec<u32> = if bones.is_empty() {
            (0..slot.original.tracks.len() as u32).collect()
        } else {
            let found: BTreeSet<u32> = bones.iter().map(|bone| self.bone(bone)).collect::<Result<_, _>>()?;
            found.into_iter().collect()
        };
        if let Some(&bone) = bones.iter().find(|&&bone| bone as usize >= slot.original.tracks.len()) {
            return Err(EditError::NoTrack(bone));
        }
        let wanted = |property: &Property| properties.is_empty() || properties.contains(property);
        let of_bone = |bone: u32| {
            let places = Property::ALL.into_iter().filter(wanted);
            places.map(move |property| Place { take, bone, property })
        };
        Ok(bones.into_iter().flat_map(of_bone).collect())
    }
}

fn finite(what: &'static str, value: f32) -> Result<f32, EditError> {
    // Sums and products of two of them are numbers, too.
    if value.is_finite() && value.abs() <= 1e18 { Ok(value) } else { Err(EditError::Number { what, value }) }
}

/// A time at which a key may lie.
fn key_time(time: f32, slot: &Slot) -> Result<f32, EditError> {
    finite("a time", time)?;
    // What was read before 0 s may stay there.
    if time < slot.original.start.min(0.0) { Err(EditError::BeforeZero(time)) } else { Ok(time) }
}

/// The rest value of a channel.
fn rest<K: Kind>(work: &Work, bone: u32) -> K::Value {
    K::of(&dragonfly_anim::sample::rest_pose(work.skeleton_bone(bone)))
}
