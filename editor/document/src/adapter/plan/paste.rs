//! Poses from elsewhere put on, as they are or mirrored.

use super::super::kind::{Kind, Rotation, Scale, Translation};
use super::super::slot::{Slot, TakeId};
use super::pose::{self, rotation, vector};
use super::{EditError, Work, key_time, pending};
use crate::edit::{BonePose, BoneRef, TakeRef};
use crate::posing::mirror::Mirror;
use dragonfly_anim::data::Channel;
use dragonfly_anim::sample::sample_channel;
use glam::{Quat, Vec3};

/// How a pose is pasted; see [`crate::edit::Edit::Paste`].
pub(super) struct Way {
    pub(super) mirrored: bool,
    pub(super) pending: bool,
    pub(super) unstep: bool,
}

pub(super) fn paste(
    work: &mut Work,
    take: &TakeRef,
    time: f32,
    poses: &[BonePose],
    way: Way,
) -> Result<(), EditError> {
    let id = work.take(take)?;
    key_time(time, work.slot(id))?;
    let mut met = false;
    let mut wanted = Vec::new();
    let mirror = way.mirrored.then(|| Mirror::of(&work.adapter.skeleton));
    for pose in poses {
        // What another model has and this one has not is passed over.
        let Ok(bone) = work.bone(&pose.bone) else { continue };
        met = true;
        let translation = pose.translation.map(|given| vector("a translation", given)).transpose()?;
        let turn = pose.rotation.map(rotation).transpose()?;
        let scale = pose.scale.map(|given| vector("a scale", given)).transpose()?;
        let placed = match &mirror {
            None => Some((bone, translation, turn, scale)),
            Some(mirror) => mirror.target(bone).map(|target| {
                let translation = translation.and_then(|given| mirror.translation(bone, given));
                let turn = turn.and_then(|given| mirror.rotation(bone, given));
                (target, translation, turn, scale.and_then(|given| mirror.scale(bone, given)))
            }),
        };
        if let Some((bone, translation, turn, scale)) = placed {
            wanted.push(BonePose {
                bone: BoneRef::Index(bone),
                translation: news::<Translation>(work, id, bone, time, translation).map(Vec3::into),
                rotation: news::<Rotation>(work, id, bone, time, turn).map(Quat::into),
                scale: news::<Scale>(work, id, bone, time, scale).map(Vec3::into),
            });
        }
    }
    if !met {
        return Err(EditError::Nothing("none of the bones is in this model"));
    }
    wanted.retain(|pose| pose.translation.is_some() || pose.rotation.is_some() || pose.scale.is_some());
    if wanted.is_empty() {
        return Err(EditError::Nothing("the bones are in this pose already"));
    }
    if way.pending {
        pending::pend(work, take, time, &wanted)
    } else {
        pose::set(work, take, time, &wanted, way.unstep)
    }
}

/// The value, unless the channel has no keys and shows it anyway: a pose is pasted, not keys of everything.
fn news<K: Kind>(
    work: &Work,
    take: TakeId,
    bone: u32,
    time: f32,
    value: Option<K::Value>,
) -> Option<K::Value> {
    let value = value?;
    let slot: &Slot = work.slot(take);
    let channel: &Channel<K::Value> = K::channel(slot.result.tracks.get(bone as usize)?);
    let waits = slot.pending_at(time).is_some_and(|at| at.of(bone).is_some());
    if !channel.is_empty() || waits {
        return Some(value);
    }
    let shown = K::numbers(sample_channel(channel, super::rest::<K>(work, bone), time));
    let near = |sign: f32| {
        let pairs = shown.iter().zip(K::numbers(value));
        pairs.into_iter().all(|(shown, value)| (shown - sign * value).abs() <= 1e-5 * (1.0 + shown.abs()))
    };
    let turn = K::IDENTITY == Rotation::IDENTITY;
    let same = near(1.0) || (turn && near(-1.0));
    (!same).then_some(value)
}
