//! Pins, IK and bones that look at another one.

use super::{bones, edit, locks};
use crate::panels::count_text::count;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::posing::{PoseDragState, look_at};
use std::sync::Arc;

/// Returns the state from which a drag at the time shown starts: the poses as they are shown, the pins, the IK
/// settings.
pub(in crate::panels) fn hold(workspace: &mut Workspace) -> Option<PoseDragState> {
    let (fixed, mode) = (workspace.read().fixed_bones(), workspace.tools.ik());
    let view = workspace.model.view()?;
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let poses = workspace.posed.update(view, take, time).poses();
    let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
    Some(PoseDragState::new(skeleton, poses, workspace.bones.pins(), mode, None).with_fixed(&fixed))
}

/// Pins the selected bones, or unpins them if all of them are pinned.
pub(in crate::panels) fn toggle_pins(workspace: &mut Workspace) {
    let pinned = workspace.bones.toggle_pins();
    let bones = workspace.bones.bones();
    let stay = if bones.len() == 1 { "it stays in place" } else { "they stay in place" };
    let what = bones::bones_text(workspace, bones);
    let text = if pinned {
        format!("Pinned {what}: {stay} while other bones move")
    } else {
        format!("Unpinned {what}")
    };
    workspace.say(MessageSeverity::Info, text);
}

/// Unpins all bones.
pub(in crate::panels) fn free_pins(workspace: &mut Workspace) {
    workspace.bones.set_pins(Vec::new());
    workspace.say(MessageSeverity::Info, "All bones are unpinned");
}

/// Turns IK on or off.
pub(in crate::panels) fn toggle_ik(workspace: &mut Workspace) {
    workspace.tools.toggle_ik();
    say_ik(workspace);
}

/// Changes the length of the IK chain: the number of bones above a moved bone that follow it.
pub(in crate::panels) fn lengthen_ik(workspace: &mut Workspace, by: i64) {
    workspace.tools.lengthen_ik(by);
    say_ik(workspace);
}

fn say_ik(workspace: &mut Workspace) {
    let ik = workspace.tools.ik();
    let bones = count(ik.length as usize, "bone", "bones");
    let text = if ik.on {
        format!("IK is on: moving a bone also moves {bones} above it")
    } else {
        format!("IK is off: a moved bone moves alone (with IK also {bones} above it)")
    };
    workspace.say(MessageSeverity::Info, text);
}

/// Makes the active bone the pole target, towards which elbows and knees bend; clears the pole target if it already
/// is that bone.
pub(in crate::panels) fn toggle_pole(workspace: &mut Workspace) {
    let Some(active) = workspace.bones.active() else { return };
    let pole = Some(active).filter(|_| workspace.tools.ik().pole != Some(active));
    workspace.tools.set_pole(pole);
    let text = match pole {
        Some(bone) => format!("Elbows and knees bend towards {}", workspace.read().bone_name(bone)),
        None => "The pole target of IK was cleared".to_owned(),
    };
    workspace.say(MessageSeverity::Info, text);
}

/// Aims the selected bones at the active one.
pub(in crate::panels) fn look(workspace: &mut Workspace) -> Option<Effect> {
    let active = workspace.bones.active()?;
    let others: Vec<BoneIndex> = workspace.read().bones_to_pose().filter(|&bone| bone != active).collect();
    if others.is_empty() {
        match workspace.bones.bones().iter().copied().find(|&bone| bone != active) {
            Some(locked) => locks::say_locked(workspace, locked),
            None => {
                let text = "Select the bones to rotate, and last the bone to look at";
                workspace.say(MessageSeverity::Info, text);
            }
        }
        return None;
    }
    let view = workspace.model.view()?;
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let animation = workspace.posed.update(view, take, time);
    let skeleton = &view.loaded.model.animation.skeleton;
    let target = animation.to_root().get(active as usize)?.w_axis.truncate();
    let poses = look_at(skeleton, animation.poses(), &others, target);
    if poses.is_empty() {
        workspace.say(MessageSeverity::Info, "There is nothing to rotate");
    }
    if let Some(reason) = workspace.read().scope_refusal() {
        workspace.say(MessageSeverity::Warning, reason);
        return None;
    }
    workspace.read().pose_edit(poses).map(edit)
}
