//! New texts of a scene's script.

use crate::panels::request::Effect;
use crate::panels::scene::{NewThing, SceneBase, ScriptChange, new_thing_text};
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::stage::gesture::GestureRefusal;
use std::sync::Arc;

/// Sends a new text of the script.
pub(super) fn change_text(workspace: &mut Workspace, change: &ScriptChange) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    match workspace.scene.change(&scene, change) {
        Ok(change) => change.map(Effect::Change),
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Makes a gesture on the scene as it is now a step of the history.
pub(super) fn gesture(
    workspace: &mut Workspace,
    label: &'static str,
    act: impl FnOnce(&SceneBase) -> Result<String, GestureRefusal>,
) -> Option<Effect> {
    let scene = Arc::clone(workspace.model.view()?.scene.as_ref()?);
    let base = SceneBase::of(&scene, workspace.scene.text(&scene));
    match base.and_then(|base| Ok((act(&base)?, Arc::clone(base.text())))) {
        Ok((text, from)) => change_text(workspace, &ScriptChange { from, text, label, gesture: None }),
        Err(refusal) => {
            workspace.say(MessageSeverity::Info, refusal.to_string());
            None
        }
    }
}

/// Adds a thing to the cast and selects it.
pub(in crate::panels) fn add(workspace: &mut Workspace, thing: &NewThing) -> Option<Effect> {
    let mut added = None;
    let effect = gesture(workspace, thing.label(), |base| {
        let (text, id) = new_thing_text(&base.script, base.text(), thing)?;
        added = Some(id);
        Ok(text)
    });
    if let Some(id) = added {
        workspace.scene.await_thing(id);
    }
    effect
}
