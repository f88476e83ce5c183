//! Finds the edited channels by comparing the takes as they were opened with the takes as they are now.

use super::super::target_path::TargetPath;
use super::columns::{EncodedKeys, KeyColumns, KeysOwner, keys};
use super::document::{ChannelTarget, FileAnimation};
use super::error::SaveError;
use crate::data::{Channel, Interpolation, ModelData, MorphTrack, Take, Track};
use crate::limits::CLIP_SECONDS;
use glam::Vec3;
use std::sync::Arc;

/// Change of a channel.
#[derive(Clone, Debug)]
pub(super) enum Action {
    Remove,
    Set(EncodedKeys),
}

/// A channel that differs.
#[derive(Clone, Debug)]
pub(super) struct ChannelEdit {
    pub(super) target: ChannelTarget,
    /// Name of the bone, or `mesh 3`.
    pub(super) label: String,
    pub(super) action: Action,
    /// The opened key times of each value, if the values are a subset of the opened ones.
    pub(super) values_of: Option<Arc<[f32]>>,
}

/// Returns the three channels of a track.
fn columns(track: &Track) -> [(TargetPath, KeyColumns<'_>); 3] {
    [
        (TargetPath::Translation, KeyColumns::Vector(&track.translation)),
        (TargetPath::Rotation, KeyColumns::Rotation(&track.rotation)),
        (TargetPath::Scale, KeyColumns::Vector(&track.scale)),
    ]
}

/// Returns the channels in which `now` differs from `opened` (`None` for a new take).
pub(super) fn edits(
    model: &ModelData,
    opened: Option<(&Take, &FileAnimation)>,
    now: &Take,
) -> Result<Vec<ChannelEdit>, SaveError> {
    let mut found = Vec::new();
    let bones = &model.animation.skeleton.bones;
    let mismatch = |reason| SaveError::Mismatch { place: format!("take \"{}\"", now.name), reason };
    if now.tracks.len() != bones.len() {
        return Err(mismatch(format!("{} tracks for {} bones", now.tracks.len(), bones.len())));
    }
    let still = Track::default();
    for (index, (bone, track)) in bones.iter().zip(&now.tracks).enumerate() {
        if track.bone as usize != index {
            return Err(mismatch(format!("the track at {index} is for bone {}", track.bone)));
        }
        let before = columns(opened.and_then(|(take, _)| take.tracks.get(index)).unwrap_or(&still));
        for ((path, before), (_, after)) in before.into_iter().zip(columns(track)) {
            if before.is_same(&after) {
                continue;
            }
            let Some(node) = bone.node else {
                return Err(no_node(now, &bone.name, "is not a node of the file"));
            };
            let owner = KeysOwner { take: &now.name, bone: &bone.name, path };
            found.push(edit((node, path), opened, before, after, owner)?);
        }
    }
    weights(model, opened, now, &mut found)?;
    Ok(found)
}

fn no_node(take: &Take, bone: &str, reason: &'static str) -> SaveError {
    SaveError::Node { take: take.name.clone(), bone: bone.to_owned(), reason }
}

fn edit(
    target: ChannelTarget,
    opened: Option<(&Take, &FileAnimation)>,
    before: KeyColumns<'_>,
    after: KeyColumns<'_>,
    owner: KeysOwner<'_>,
) -> Result<ChannelEdit, SaveError> {
    let in_file = opened.is_some_and(|(_, animation)| animation.channel(target).is_some());
    if !before.times().is_empty() && !in_file {
        let place = format!("take \"{}\", node {}, {}", owner.take, target.0, target.1.name());
        return Err(SaveError::Mismatch { place, reason: "the file has no such channel".to_owned() });
    }
    let action = if after.times().is_empty() { Action::Remove } else { Action::Set(keys(after, owner)?) };
    let stays = matches!(&action, Action::Set(keys) if before.holds(&keys.values));
    let values_of = stays.then(|| Arc::clone(before.times()));
    Ok(ChannelEdit { target, label: owner.bone.to_owned(), action, values_of })
}

/// Finds the edited morph weights, by mesh instance.
fn weights(
    model: &ModelData,
    opened: Option<(&Take, &FileAnimation)>,
    now: &Take,
    found: &mut Vec<ChannelEdit>,
) -> Result<(), SaveError> {
    let no_keys = |instance, targets| MorphTrack {
        instance,
        targets,
        times: Default::default(),
        weights: Default::default(),
        interpolation: Interpolation::Linear,
    };
    let of = |take: &Take| -> Result<Vec<Option<MorphTrack>>, SaveError> {
        let mut by_instance = vec![None; model.instances.len()];
        for track in &take.morphs {
            let place = || format!("take \"{}\", mesh {}", take.name, track.instance);
            let refuse = |reason: String| SaveError::Mismatch { place: place(), reason };
            let instance = model.instances.get(track.instance as usize);
            let instance = instance.ok_or_else(|| refuse("there is no such mesh instance".to_owned()))?;
            if instance.morph_weights.len() != track.targets as usize {
                let targets = instance.morph_weights.len();
                return Err(refuse(format!("{} weights for {targets} targets", track.targets)));
            }
            if by_instance[track.instance as usize].replace(track.clone()).is_some() {
                return Err(refuse("two tracks animate it".to_owned()));
            }
        }
        Ok(by_instance)
    };
    if now.morphs.is_empty() && opened.is_none_or(|(take, _)| take.morphs.is_empty()) {
        return Ok(());
    }
    let before = opened.map(|(take, _)| of(take)).transpose()?;
    for (index, after) in of(now)?.into_iter().enumerate() {
        let before = before.as_ref().and_then(|before| before[index].clone());
        if before.is_none() && after.is_none() {
            continue;
        }
        let targets = before.as_ref().or(after.as_ref()).map_or(0, |track| track.targets);
        let before = before.unwrap_or_else(|| no_keys(index as u32, targets));
        let after = after.unwrap_or_else(|| no_keys(index as u32, targets));
        let (before, after) = (KeyColumns::Weights(&before), KeyColumns::Weights(&after));
        if before.is_same(&after) {
            continue;
        }
        let label = format!("mesh {index}");
        let Some(node) = model.instances[index].node else {
            return Err(no_node(now, &label, "is not a node of the file"));
        };
        let owner = KeysOwner { take: &now.name, bone: &label, path: TargetPath::Weights };
        found.push(edit((node, TargetPath::Weights), opened, before, after, owner)?);
    }
    Ok(())
}

/// Returns an edit for a take that animates nothing, since an animation must have a channel: one key at the start of
/// the take that keeps the first bone at rest. `None` if the file has it already.
pub(super) fn placeholder(
    model: &ModelData,
    opened: Option<&Take>,
    now: &Take,
) -> Result<Option<ChannelEdit>, SaveError> {
    let bones = &model.animation.skeleton.bones;
    let still = bones.iter().enumerate().find(|(_, bone)| bone.node.is_some() && bone.rest_matrix.is_none());
    let Some((index, bone)) = still else {
        return Err(no_node(now, "", "animates nothing, and the file has no node for a placeholder channel"));
    };
    let start = if now.start.is_finite() { now.start.clamp(0.0, CLIP_SECONDS) } else { 0.0 };
    let rest = bone.rest.translation;
    let rest = if rest.is_finite() { rest } else { Vec3::ZERO };
    let channel = Channel::new([start], [rest], Interpolation::Step);
    let before = opened.and_then(|take| Some(&take.tracks.get(index)?.translation));
    if before.is_some_and(|before| KeyColumns::Vector(before).is_same(&KeyColumns::Vector(&channel))) {
        return Ok(None);
    }
    let owner = KeysOwner { take: &now.name, bone: &bone.name, path: TargetPath::Translation };
    let keys = keys(KeyColumns::Vector(&channel), owner)?;
    let target = (bone.node.unwrap_or_default(), TargetPath::Translation);
    Ok(Some(ChannelEdit { target, label: bone.name.clone(), action: Action::Set(keys), values_of: None }))
}
