//! Commands for the pose at the time shown: key, drop, copy, paste, reset.

use super::{edit, locks};
use crate::panels::count_text::count;
use crate::panels::keys::channel::BoneNames;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Skeleton, Take, Transform};
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::adapter::PendingAt;
use dragonfly_document::bones::MirrorPairs;
use dragonfly_document::edit::{
    BonePose, BoneRef, DropPending, Edit, KeyPending, PastePose, Property, ResetPose, ResetTo,
};
use dragonfly_document::posing::clipboard;
use std::sync::Arc;

/// Turns auto-key on or off.
pub(in crate::panels) fn toggle_auto_key(workspace: &mut Workspace) {
    workspace.settings.auto_key = !workspace.settings.auto_key;
    let text = if workspace.settings.auto_key {
        "Auto-key is on: a changed pose becomes a key"
    } else {
        "Auto-key is off: a changed pose is pending until it is keyed"
    };
    workspace.say(MessageSeverity::Info, text);
}

/// Keys the poses that are pending at the time shown. If there are none, adds keys that keep the motion, for the
/// selected bones or for all.
pub(in crate::panels) fn key(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (take, time) = (panels.take_ref()?, panels.time());
    if panels.pending_here().is_none() {
        return panels.key_edit().map(edit);
    }
    let bones = free_pending(workspace, Some(time))?;
    Some(edit(Edit::KeyPending(KeyPending { take, time: Some(time), bones, shapes: true, unstep: true })))
}

/// Keys all pending poses of the take.
pub(in crate::panels) fn key_pending(workspace: &mut Workspace) -> Option<Effect> {
    let bones = free_pending(workspace, None)?;
    let take = workspace.read().take_ref()?;
    Some(edit(Edit::KeyPending(KeyPending { take, time: None, bones, shapes: true, unstep: true })))
}

/// Discards all pending poses of the take.
pub(in crate::panels) fn drop_pending(workspace: &mut Workspace) -> Option<Effect> {
    let bones = free_pending(workspace, None)?;
    let take = workspace.read().take_ref()?;
    Some(edit(Edit::DropPending(DropPending { take, time: None, bones, shapes: true })))
}

/// Returns the bones whose pending poses are keyed or dropped, at one time or at all, as edits name them: an empty list, which
/// means all, if no bone is locked, otherwise those that are not locked. `None` if all of them are locked, with a
/// message.
fn free_pending(workspace: &mut Workspace, time: Option<f32>) -> Option<Vec<BoneRef>> {
    if !workspace.keys.flags().any_locked() {
        return Some(Vec::new());
    }
    let slot = workspace.read().slot()?;
    let at: Vec<&PendingAt> = match time {
        Some(time) => slot.pending_at(time).map(|at| &**at).into_iter().collect(),
        None => slot.pending().iter().map(|at| &**at).collect(),
    };
    let has_shapes = at.iter().any(|at| !at.shapes.is_empty());
    let mut bones: Vec<BoneIndex> = at.into_iter().flat_map(|at| &at.poses).map(|pose| pose.bone).collect();
    bones.sort_unstable();
    bones.dedup();
    // The document refuses this with the message that nothing is pending.
    if bones.is_empty() {
        return Some(workspace.read().free_refs());
    }
    if !locks::remove_locked(workspace, &mut bones, |bone| *bone) {
        // No lock concerns the shape keys.
        return has_shapes.then(|| workspace.read().free_refs()).filter(|bones| !bones.is_empty());
    }
    Some(bones.into_iter().map(BoneRef::Index).collect())
}

/// Returns the poses of bones with the names of these, as texts and files have them.
pub(super) fn named_poses(skeleton: &Skeleton, poses: &[Transform], bones: &[BoneIndex]) -> Vec<BonePose> {
    let names = BoneNames::of(skeleton);
    let pose = |&bone: &BoneIndex| {
        Some(BonePose { bone: names.reference(bone), ..whole(bone, poses.get(bone as usize)?) })
    };
    bones.iter().filter_map(pose).collect()
}

/// Copies the poses of the selected bones, or of all.
pub(in crate::panels) fn copy(workspace: &mut Workspace) -> Option<Effect> {
    let bones = workspace.read().selected_or_all();
    let view = workspace.model.view()?;
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let poses = workspace.posed.update(view, take, time).poses();
    let copied = named_poses(&view.loaded.model.animation.skeleton, poses, &bones);
    let bones = count(copied.len(), "bone", "bones");
    workspace.say(MessageSeverity::Info, format!("Copied the pose of {bones}"));
    let text = clipboard::to_text(&copied);
    workspace.copied_pose = Some(copied.into());
    Some(Effect::Copy(text))
}

/// Pastes copied poses at the time shown.
pub(super) fn paste(workspace: &mut Workspace, mut poses: Vec<BonePose>, mirrored: bool) -> Option<Effect> {
    let Some(take) = workspace.read().take_ref() else {
        workspace.say(MessageSeverity::Info, "The rest pose cannot be edited: show a take first");
        return None;
    };
    if workspace.keys.flags().any_locked() {
        let skeleton = Arc::clone(&workspace.model.loaded()?.model.animation.skeleton);
        let mirror = mirrored.then(|| MirrorPairs::of(&skeleton));
        let target = |pose: &BonePose| {
            let bone = match &pose.bone {
                BoneRef::Index(bone) => Some(*bone),
                BoneRef::Name(name) => skeleton.find(name),
            };
            let on = |bone| mirror.as_ref().map_or(Some(bone), |pairs| pairs.mirror_of(bone));
            bone.and_then(on).unwrap_or(BoneIndex::MAX)
        };
        if !locks::remove_locked(workspace, &mut poses, target) {
            return None;
        }
    }
    if let Some(reason) = workspace.read().scope_refusal() {
        workspace.say(MessageSeverity::Warning, reason);
        return None;
    }
    let panels = workspace.read();
    let (over, falloff) = (panels.offset_scope(), panels.offset_falloff());
    let (time, pending) = (panels.time(), over.is_none() && !panels.settings.auto_key);
    let paste = PastePose { take, time, poses, mirrored, pending, unstep: true, over, falloff };
    Some(edit(Edit::PastePose(paste)))
}

/// Resets channels of the selected bones to the pose in the file, or to the rest pose.
pub(in crate::panels) fn reset(
    workspace: &mut Workspace,
    properties: &[Property],
    to: ResetTo,
) -> Option<Effect> {
    let panels = workspace.read();
    let (take, time, slot) = (panels.take_ref()?, panels.time(), panels.slot()?);
    let bones: Vec<BoneIndex> = panels.bones_to_pose().collect();
    let keyed =
        |bone: BoneIndex| properties.iter().any(|&property| slot.key_at(bone, property, time).is_some());
    // If there are keys, this edit resets them exactly, including their tangents.
    if to == ResetTo::Original && panels.settings.auto_key && bones.iter().any(|&bone| keyed(bone)) {
        let (bones, properties) = (panels.selected_refs(), properties.to_vec());
        return Some(edit(Edit::ResetPose(ResetPose { take, time, bones, properties, to })));
    }
    let rules = &panels.loaded()?.model.animation.skeleton.bones;
    let pose = |&bone: &BoneIndex| {
        let rest = rules.get(bone as usize)?;
        let pose = match to {
            ResetTo::Rest => rest_pose(rest),
            ResetTo::Original => sampled(&slot.original, bone, rest, time),
        };
        Some(only(whole(bone, &pose), properties))
    };
    panels.pose_edit_here(bones.iter().filter_map(pose).collect()).map(edit)
}

fn sampled(take: &Take, bone: BoneIndex, rules: &dragonfly_anim::data::Bone, time: f32) -> Transform {
    take.tracks.get(bone as usize).map_or(rest_pose(rules), |track| sample_track(track, rules, time))
}

/// Returns all three channels of a pose.
fn whole(bone: BoneIndex, pose: &Transform) -> BonePose {
    BonePose {
        bone: BoneRef::Index(bone),
        translation: Some(pose.translation.to_array()),
        rotation: Some(pose.rotation.to_array()),
        scale: Some(pose.scale.to_array()),
    }
}

/// Returns a pose with these channels alone.
fn only(pose: BonePose, properties: &[Property]) -> BonePose {
    let has = |property| properties.contains(&property);
    BonePose {
        translation: pose.translation.filter(|_| has(Property::Translation)),
        rotation: pose.rotation.filter(|_| has(Property::Rotation)),
        scale: pose.scale.filter(|_| has(Property::Scale)),
        ..pose
    }
}
