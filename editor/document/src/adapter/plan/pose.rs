//! Poses at a time: set, offset, reset.

use super::super::change::KeyChange;
use super::super::kind::{Kind, Numbers, Rotation, Scale, Translation, with_kind};
use super::super::op::{Op, Place};
use super::super::slot::Key;
use super::keys::insert;
use super::pending::overwritten;
use super::{EditError, Named, Work, finite, key_at, key_time, rest, unstep};
use crate::edit::{BonePose, NewKey, PoseAt, Property, ResetTo, TakeRef};
use glam::{Quat, Vec3};

pub(super) fn set(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    poses: &[BonePose],
    unstep: bool,
) -> Result<(), EditError> {
    each(work, take, time, poses, Way::Set, unstep)
}

pub(super) fn set_many(
    work: &mut Work,
    take: &TakeRef,
    at: &[PoseAt],
    unstep: bool,
) -> Result<(), EditError> {
    if at.is_empty() {
        return Err(EditError::Nothing("no pose is given"));
    }
    at.iter().try_for_each(|at| each(work, take, at.time, &at.poses, Way::Set, unstep))
}

pub(super) fn offset(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    poses: &[BonePose],
    unstep: bool,
) -> Result<(), EditError> {
    each(work, take, time, poses, Way::Offset, unstep)
}

pub(super) fn reset(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    named: Named<'_>,
    to: ResetTo,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    finite("a time", time)?;
    let places = work.channels(take, named)?;
    let channels: Vec<_> = places.iter().map(|place| (place.bone, place.property)).collect();
    let mut met = overwritten(work, take, time, &channels);
    for place in places {
        let Ok(key) = key_at(work.slot(take).times(place.bone, place.property), time) else { continue };
        met = true;
        match to {
            ResetTo::Original => {
                work.perform(Op::Changes(place, vec![(key as u32, None)]));
            }
            ResetTo::Rest => with_kind!(place.property, to_rest::<K>(work, place, key))?,
        }
    }
    if met { Ok(()) } else { Err(EditError::Nothing("there is no key at that time")) }
}

fn to_rest<K: Kind>(work: &mut Work, place: Place, key: usize) -> Result<(), EditError> {
    let rest = rest::<K>(work, place.bone);
    change_key::<K>(work, place, key, |_| rest)
}

/// What becomes of the value that is there.
#[derive(Clone, Copy, Debug)]
pub(in super::super) enum Way {
    Set,
    Offset,
}

fn each(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    poses: &[BonePose],
    way: Way,
    unstep: bool,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    key_time(time, work.slot(take))?;
    let mut touched = Vec::new();
    for pose in poses {
        let bone = work.bone(&pose.bone)?;
        if bone as usize >= work.slot(take).original.tracks.len() {
            return Err(EditError::NoTrack(bone));
        }
        let place = |property| Place { take, bone, property };
        if let Some(translation) = pose.translation {
            let wanted = vector("a translation", translation)?;
            one::<Translation>(work, place(Property::Translation), time, wanted, way, unstep)?;
        }
        if let Some(numbers) = pose.rotation {
            one::<Rotation>(work, place(Property::Rotation), time, rotation(numbers)?, way, unstep)?;
        }
        if let Some(scale) = pose.scale {
            one::<Scale>(work, place(Property::Scale), time, vector("a scale", scale)?, way, unstep)?;
        }
        let given = [pose.translation.is_some(), pose.rotation.is_some(), pose.scale.is_some()];
        let given = Property::ALL.into_iter().zip(given).filter(|(_, given)| *given);
        touched.extend(given.map(|(property, _)| (bone, property)));
    }
    overwritten(work, take, time, &touched);
    if !touched.is_empty() { Ok(()) } else { Err(EditError::Nothing("no pose is given")) }
}

/// Gives a channel a pose at a time, where need be with a key that is added.
pub(super) fn one<K: Kind>(
    work: &mut Work,
    place: Place,
    time: f32,
    wanted: K::Value,
    way: Way,
    unstep: bool,
) -> Result<(), EditError> {
    if unstep {
        unstep::channel::<K>(work, place);
    }
    // On top of what is shown there.
    let pending =
        work.slot(place.take).pending_at(time).and_then(|at| at.of(place.bone)?.get(place.property));
    let key = match key_at(work.slot(place.take).times(place.bone, place.property), time) {
        Ok(key) => key,
        Err(_) => insert::<K>(work, place, time, NewKey::Current),
    };
    change_key::<K>(work, place, key, |now| match way {
        Way::Set => wanted,
        Way::Offset => K::offset(pending.map_or(now, K::value), wanted),
    })
}

/// Gives a key another value; its tangents keep what was changed of them.
fn change_key<K: Kind>(
    work: &mut Work,
    place: Place,
    key: usize,
    wanted: impl FnOnce(K::Value) -> K::Value,
) -> Result<(), EditError> {
    let found = work.slot(place.take).key::<K>(place.property, place.bone, key);
    let Some(found) = found else { return Ok(()) };
    let change = changed::<K>(place.bone, &found, wanted)?;
    work.perform(Op::Changes(place, vec![(key as u32, change)]));
    Ok(())
}

/// The change that gives a key another value, and nothing else; none where it is the original then.
pub(in super::super) fn changed<K: Kind>(
    bone: u32,
    found: &Key,
    wanted: impl FnOnce(K::Value) -> K::Value,
) -> Result<Option<KeyChange>, EditError> {
    let now = found.change.map_or(found.original, |change| change.result::<K>(&found.original))[1];
    let wanted = near::<K>(wanted(K::value(now)), now);
    let original = K::value(found.original[1]);
    let value = if wanted == original {
        K::IDENTITY
    } else {
        K::change(original, wanted).ok_or(EditError::ZeroScale { bone })?
    };
    let change = KeyChange { value, ..found.change.unwrap_or(KeyChange::identity::<K>()) };
    let result = change.result::<K>(&found.original);
    let largest = result.iter().flatten().fold(0.0_f32, |largest, number| largest.max(number.abs()));
    finite("the result", largest)?;
    Ok(change.some::<K>())
}

/// q and -q are the same rotation; the one that keeps a spline from turning the long way.
fn near<K: Kind>(wanted: K::Value, now: Numbers) -> K::Value {
    let numbers = K::numbers(wanted);
    let turn = K::IDENTITY == Rotation::IDENTITY;
    let dot: f32 = numbers.iter().zip(now).map(|(a, b)| a * b).sum();
    if turn && dot < 0.0 { K::value(numbers.map(|number| -number)) } else { wanted }
}

pub(in super::super) fn vector(what: &'static str, numbers: [f32; 3]) -> Result<Vec3, EditError> {
    for number in numbers {
        finite(what, number)?;
    }
    Ok(Vec3::from_array(numbers))
}

pub(in super::super) fn rotation(numbers: [f32; 4]) -> Result<Quat, EditError> {
    for number in numbers {
        finite("a rotation", number)?;
    }
    let rotation = Quat::from_array(numbers);
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(EditError::NoRotation);
    }
    // What is unit already stays as it was given, to the bit.
    Ok(if (length - 1.0).abs() <= 1e-6 { rotation } else { rotation.normalize() })
}
