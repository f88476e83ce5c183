//! Actions of a scene through the clipboard.

use super::scene_clips::unlocked_actions;
use super::scene_text::step;
use crate::panels::count_text::count;
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, SceneBase};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::{copied_clips, is_copied_clips, paste_clips, things_of_pasted};
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::ScriptLabel;
use std::sync::Arc;

/// Copies the selected actions.
pub(in crate::panels) fn copy(workspace: &mut Workspace) -> Option<Effect> {
    Some(Effect::Copy(copied(workspace, "Copied")?))
}

/// Copies the selected actions and deletes them.
pub(in crate::panels) fn cut(workspace: &mut Workspace) -> Option<Effect> {
    unlocked_actions(workspace)?;
    let text = copied(workspace, "Cut")?;
    match super::scene_clips::delete(workspace, false)? {
        Effect::Change(change) => Some(Effect::Cut(text, change)),
        _ => None,
    }
}

fn copied(workspace: &mut Workspace, verb: &str) -> Option<String> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let actions = workspace.scene.actions().to_vec();
    let base = SceneBase::of(&scene, workspace.scene.text(&scene));
    match base.and_then(|base| copied_clips(&base.scene(), &actions)) {
        Ok(text) => {
            let text_of_status = format!("{verb} {}", count(actions.len(), "action", "actions"));
            workspace.say(MessageSeverity::Info, text_of_status);
            Some(text)
        }
        Err(refusal) => {
            workspace.say(MessageSeverity::Info, refusal.to_string());
            None
        }
    }
}

/// Inserts copied actions at the playhead: for the role or prop that is selected while no action is, otherwise for the things that they were
/// copied from.
pub(super) fn paste(workspace: &mut Workspace, text: &str) -> Option<Effect> {
    if !is_copied_clips(text) {
        workspace.say(MessageSeverity::Info, "The clipboard contains no actions of a scene");
        return None;
    }
    let at = workspace.read().scene_time();
    let onto = match (workspace.scene.actions(), workspace.scene.things()) {
        ([], [thing]) => Some(thing.clone()),
        _ => None,
    };
    step(workspace, |base| {
        let things = things_of_pasted(text, onto.as_deref())?;
        let pasted = paste_clips(&base.scene(), text, at, onto.as_deref())?;
        Ok(base.step(pasted, ScriptLabel::Paste, ChangedThings::Things(&things)))
    })
}

/// Selects all actions of the timeline.
pub(in crate::panels) fn select_all(workspace: &mut Workspace) {
    let lanes = Arc::clone(workspace.scene.lanes());
    let actions: Vec<usize> = lanes.list.iter().flat_map(|lane| &lane.bars).map(|bar| bar.action).collect();
    workspace.scene.select_actions(&actions, Choice::Replace);
}
