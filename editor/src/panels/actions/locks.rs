//! Locked bones: edits leave them unchanged and report that in a message.

use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::BoneIndex;

/// Returns the effect, unless it edits a locked bone: then the drag of keys ends with a message.
pub(super) fn unlocked(workspace: &mut Workspace, effect: Effect) -> Option<Effect> {
    if !workspace.keys.flags().any_locked() {
        return Some(effect);
    }
    let changes = match &effect {
        Effect::Change(change) | Effect::Cut(_, change) => std::slice::from_ref(change),
        Effect::Changes(changes) => changes,
        Effect::Send(..)
        | Effect::OpenDialog
        | Effect::CompareDialog
        | Effect::Choose(..)
        | Effect::CancelDrag
        | Effect::ReleaseDrag
        | Effect::Copy(_)
        | Effect::PastePose { .. }
        | Effect::Pick(..)
        | Effect::Catch(..)
        | Effect::FullScreen
        | Effect::TogglePanel(_)
        | Effect::ShowPanel(_)
        | Effect::ResetLayout
        | Effect::RetryDevice
        | Effect::NewScene(_)
        | Effect::LookAtModels(_)
        | Effect::LookAtFiles(_)
        | Effect::CopyFiles(_)
        | Effect::DemoScene(_)
        | Effect::NewProject(_)
        | Effect::File(_) => &[],
    };
    let skeleton = &workspace.model.loaded()?.model.animation.skeleton;
    let flags = workspace.keys.flags();
    let Some(bone) = changes.iter().find_map(|change| flags.locked_bone_in(change, skeleton)) else {
        return Some(effect);
    };
    say_locked(workspace, bone);
    workspace.keys.drop_drag();
    None
}

/// Removes the items of locked bones from a list, with a message. Returns whether anything is left.
pub(super) fn remove_locked<T>(
    workspace: &mut Workspace,
    list: &mut Vec<T>,
    bone_of: impl Fn(&T) -> BoneIndex,
) -> bool {
    let flags = workspace.keys.flags();
    let mut locked: Vec<BoneIndex> = list.iter().map(&bone_of).filter(|&bone| flags.locked(bone)).collect();
    list.retain(|item| !flags.locked(bone_of(item)));
    locked.sort_unstable();
    locked.dedup();
    match locked[..] {
        [] => {}
        [bone, ..] if list.is_empty() => say_locked(workspace, bone),
        [bone] => {
            let text = format!("{} is locked and stays unchanged", workspace.read().bone_name(bone));
            workspace.say(MessageSeverity::Info, text);
        }
        _ => {
            let text = format!("{} bones are locked and stay unchanged", locked.len());
            workspace.say(MessageSeverity::Info, text);
        }
    }
    !list.is_empty()
}

/// Reports that a bone is locked.
pub(super) fn say_locked(workspace: &mut Workspace, bone: BoneIndex) {
    let text = format!("{} is locked: its keys are not edited", workspace.read().bone_name(bone));
    workspace.say(MessageSeverity::Warning, text);
}
