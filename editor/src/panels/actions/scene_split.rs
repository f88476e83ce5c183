//! The selected actions of a scene, split at the playhead.

use super::scene_clips::unlocked_actions;
use super::scene_text::step;
use crate::panels::request::Effect;
use crate::panels::scene::{ChangedThings, SplitActions};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::split_clips;
use dragonfly_document::edit::ScriptLabel;
use std::sync::Arc;

/// Splits the selected actions that are on at the playhead, and selects their second halves.
pub(in crate::panels) fn split(workspace: &mut Workspace) -> Option<Effect> {
    let (actions, at) = (unlocked_actions(workspace)?, workspace.read().scene_time());
    let mut split = None;
    let effect = step(workspace, |base| {
        let clips = split_clips(&base.scene(), &actions, at)?;
        let things = ChangedThings::Actions(&actions);
        let change = base.step(clips.text.clone(), ScriptLabel::Split, things);
        split = Some((clips, SplitActions::new(Arc::clone(base.text()), actions.clone())));
        Ok(change)
    });
    let (clips, whole) = split.filter(|_| effect.is_some())?;
    workspace.scene.await_halves(Arc::from(clips.text), clips.halves, whole);
    if let Some(left) = clips.left {
        workspace.say(MessageSeverity::Info, left.to_string());
    }
    effect
}
