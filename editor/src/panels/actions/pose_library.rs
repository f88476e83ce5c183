//! The pose library: poses to save, and poses to apply.

use super::pose::named_poses;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::MirrorPairs;
use dragonfly_document::edit::{BonePose, BoneRef};
use dragonfly_document::posing::{StickLine, clipboard, stick_figure};
use std::sync::Arc;

/// Returns the poses of the selected bones at the time shown, or of all, with the names of the bones.
pub(in crate::panels) fn shown_pose(context: &PanelContext<'_>) -> Option<Vec<BonePose>> {
    let skeleton = &context.loaded()?.model.animation.skeleton;
    let now = context.posed.animation()?.poses();
    let poses = named_poses(skeleton, now, &context.selected_or_all());
    (!poses.is_empty()).then_some(poses)
}

/// Returns the poses of a stored pose for the selected bones, or for all if none is selected, with indices of bones. Of a mirrored pose,
/// the bones that it moves count as selected. Bones that the model does not have are left out.
pub(in crate::panels) fn for_bones(
    context: &PanelContext<'_>,
    poses: &[BonePose],
    mirrored: bool,
) -> Vec<BonePose> {
    let Some(loaded) = context.loaded() else { return Vec::new() };
    let skeleton = &loaded.model.animation.skeleton;
    let mirror = mirrored.then(|| MirrorPairs::of(skeleton));
    let selected = |bone: BoneIndex| {
        let bone = mirror.as_ref().map_or(Some(bone), |pairs| pairs.mirror_of(bone));
        context.selection.bones().is_empty() || bone.is_some_and(|bone| context.selection.contains(bone))
    };
    let found = |pose: &BonePose| {
        let bone = pose.bone.find_in(skeleton).filter(|&bone| selected(bone))?;
        Some(BonePose { bone: BoneRef::Index(bone), ..pose.clone() })
    };
    poses.iter().filter_map(found).collect()
}

/// Returns the request that applies a stored pose at the time shown: one edit, which respects auto-key, locks and the scope of edits.
pub(in crate::panels) fn apply(
    context: &PanelContext<'_>,
    poses: &[BonePose],
    mirrored: bool,
) -> Option<Request> {
    let poses = for_bones(context, poses, mirrored);
    let text = if poses.is_empty() { String::new() } else { clipboard::to_text(&poses) };
    (!text.is_empty()).then_some(Request::PastePose { text, mirrored })
}

/// Returns the picture of a stored pose on the skeleton of the model.
pub(in crate::panels) fn figure(context: &PanelContext<'_>, poses: &[BonePose]) -> Arc<[StickLine]> {
    let lines = context.loaded().map(|loaded| stick_figure(&loaded.model.animation.skeleton, poses));
    lines.unwrap_or_default().into()
}
