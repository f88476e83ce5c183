//! Gestures of menus and lists: one change of the script, or the reason why it is refused.

use super::{ChangedThings, SceneBase, SceneRequest, ScriptChange};
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;

/// Returns the request that makes a gesture on the newest script a step of the history.
pub(in crate::panels) fn gesture_request(
    context: &PanelContext<'_>,
    scene: &SceneView,
    label: ScriptLabel,
    things: ChangedThings<'_>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> Request {
    request_of(gesture_step(context, scene, label, things, act).map(SceneRequest::Text))
}

/// Returns the request that adds actions to the newest script in a step of the history, and selects them.
pub(in crate::panels) fn add_request(
    context: &PanelContext<'_>,
    scene: &SceneView,
    label: ScriptLabel,
    things: ChangedThings<'_>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> Request {
    request_of(gesture_step(context, scene, label, things, act).map(SceneRequest::AddActions))
}

fn request_of(request: Result<SceneRequest, GestureRefusal>) -> Request {
    Request::Scene(request.unwrap_or_else(|refusal| SceneRequest::Refused(refusal.to_string())))
}

fn gesture_step(
    context: &PanelContext<'_>,
    scene: &SceneView,
    label: ScriptLabel,
    things: ChangedThings<'_>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> Result<ScriptChange, GestureRefusal> {
    let base = SceneBase::of(scene, context.scene_editing.text(scene))?;
    let text = act(&base.scene())?;
    Ok(base.step(text, label, things))
}

/// Returns the label of a step that moves actions; those that play takes are clips.
pub(in crate::panels) fn move_label(script: &StageScript, actions: &[usize]) -> ScriptLabel {
    let is_clip =
        |&action: &usize| script.actions().get(action).is_some() && script.element(action).row.name == "play";
    match (actions.iter().all(is_clip), actions.len() > 1) {
        (true, false) => ScriptLabel::MoveClip,
        (true, true) => ScriptLabel::MoveClips,
        (false, false) => ScriptLabel::MoveAction,
        (false, true) => ScriptLabel::MoveActions,
    }
}
