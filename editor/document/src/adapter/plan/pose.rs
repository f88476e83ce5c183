//! Poses of bones at a time.

use super::super::change::KeyChange;
use super::super::kind::{ChannelKind, ChannelNumbers, RotationChannel, ScaleChannel, TranslationChannel};
use super::super::op::{ChannelAddress, Op};
use super::super::slot::KeyContent;
use super::keys::insert;
use super::pending::overwritten;
use super::{EditError, Transaction, finite, key_at, key_time, layer, unstep};
use crate::edit::mode::NewKey;
use crate::edit::pose::BonePose;
use crate::edit::target::{Property, TakeRef};
use glam::{Quat, Vec3};

/// How a given pose changes the value of a channel.
#[derive(Clone, Copy, Debug)]
pub(crate) enum PoseMode {
    /// Replaces it.
    Set,
    /// Is applied on top of it.
    Offset,
}

/// Gives bones their poses at a time.
pub(crate) fn pose_bones(
    work: &mut Transaction,
    take: &TakeRef,
    time: f32,
    poses: &[BonePose],
    mode: PoseMode,
    unstep: bool,
) -> Result<(), EditError> {
    let take = work.take(take)?;
    key_time(time, work.slot(take))?;
    let mut touched = Vec::new();
    for pose in poses {
        let bone = work.track(take, &pose.bone)?;
        let address = |property| ChannelAddress { take, bone, property };
        if let Some(translation) = pose.translation {
            let wanted = vector("a translation", translation)?;
            pose_channel::<TranslationChannel>(
                work,
                address(Property::Translation),
                time,
                wanted,
                mode,
                unstep,
            )?;
        }
        if let Some(numbers) = pose.rotation {
            pose_channel::<RotationChannel>(
                work,
                address(Property::Rotation),
                time,
                rotation(numbers)?,
                mode,
                unstep,
            )?;
        }
        if let Some(scale) = pose.scale {
            pose_channel::<ScaleChannel>(
                work,
                address(Property::Scale),
                time,
                vector("a scale", scale)?,
                mode,
                unstep,
            )?;
        }
        let given = [pose.translation.is_some(), pose.rotation.is_some(), pose.scale.is_some()];
        let given = Property::ALL.into_iter().zip(given).filter(|(_, given)| *given);
        touched.extend(given.map(|(property, _)| (bone, property)));
    }
    overwritten(work, layer::base_of(work, take), time, &touched);
    if !touched.is_empty() { Ok(()) } else { Err(EditError::Nothing("no pose is given")) }
}

/// Gives a channel a value at a time. Adds a key where there is none.
pub(crate) fn pose_channel<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    time: f32,
    wanted: K::Value,
    mode: PoseMode,
    unstep: bool,
) -> Result<(), EditError> {
    if unstep {
        unstep::channel::<K>(work, address);
    }
    // An offset applies on top of the pose that is shown.
    let pending = work
        .slot(layer::base_of(work, address.take))
        .pending_at(time)
        .and_then(|at| at.of(address.bone)?.get(address.property));
    let key_of_layer = layer::key_for::<K>(work, address, time, |shown| match mode {
        PoseMode::Set => wanted,
        PoseMode::Offset => K::offset(pending.map_or(shown, K::value), wanted),
    })?;
    let key = match key_at(work.slot(address.take).times(address.bone, address.property), time) {
        Ok(key) => key,
        Err(_) => insert::<K>(work, address, time, NewKey::Current),
    };
    change_key::<K>(work, address, key, |now| match (key_of_layer, mode) {
        (Some(key), _) => key,
        (None, PoseMode::Set) => wanted,
        (None, PoseMode::Offset) => K::offset(pending.map_or(now, K::value), wanted),
    })
}

/// Gives a key another value; the changes of its tangents stay.
pub(crate) fn change_key<K: ChannelKind>(
    work: &mut Transaction,
    address: ChannelAddress,
    key: usize,
    wanted: impl FnOnce(K::Value) -> K::Value,
) -> Result<(), EditError> {
    let found = work.slot(address.take).key::<K>(address.property, address.bone, key);
    let Some(found) = found else { return Ok(()) };
    let change = changed::<K>(address.bone, &found, wanted)?;
    work.perform(Op::Changes(address, vec![(key as u32, change)]));
    Ok(())
}

/// Returns the change that gives a key another value and keeps its tangents; `None` where the key becomes the original again.
pub(crate) fn changed<K: ChannelKind>(
    bone: u32,
    found: &KeyContent,
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

/// Returns the wanted value. A quaternion gets the sign that keeps a spline from turning the long way: q and -q are the
/// same rotation.
fn near<K: ChannelKind>(wanted: K::Value, now: ChannelNumbers) -> K::Value {
    let numbers = K::numbers(wanted);
    let turn = K::IDENTITY == RotationChannel::IDENTITY;
    let dot: f32 = numbers.iter().zip(now).map(|(a, b)| a * b).sum();
    if turn && dot < 0.0 { K::value(numbers.map(|number| -number)) } else { wanted }
}

/// Returns the vector if its components are usable numbers.
pub(crate) fn vector(what: &'static str, numbers: [f32; 3]) -> Result<Vec3, EditError> {
    for number in numbers {
        finite(what, number)?;
    }
    Ok(Vec3::from_array(numbers))
}

/// Returns the rotation, normalized.
pub(crate) fn rotation(numbers: [f32; 4]) -> Result<Quat, EditError> {
    for number in numbers {
        finite("a rotation", number)?;
    }
    let rotation = Quat::from_array(numbers);
    let length = rotation.length();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(EditError::NoRotation);
    }
    // A quaternion of unit length stays as given, to the bit.
    Ok(if (length - 1.0).abs() <= 1e-6 { rotation } else { rotation.normalize() })
}

/// Returns the numbers of a value or of a tangent of a channel: three, for rotations four.
pub(crate) fn numbers(
    what: &'static str,
    given: &[f32],
    property: Property,
) -> Result<ChannelNumbers, EditError> {
    let wanted = if property == Property::Rotation { 4 } else { 3 };
    if given.len() != wanted {
        return Err(EditError::Count { what, wanted, given: given.len() });
    }
    let mut numbers = [0.0; 4];
    for (number, &given) in numbers.iter_mut().zip(given) {
        *number = finite(what, given)?;
    }
    Ok(numbers)
}
