//! Gestures of menus and lists: one change of the script, or the reason why it is refused.

use super::{ChangedThings, SceneBase, SceneRequest, ScriptChange};
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use dragonfly_anim::stage::script::StageScript;
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;

/// A step that a gesture makes: the request that carries it out, its label, and the things that it changes.
pub(in crate::panels) type GestureStep<'a> =
    (fn(ScriptChange) -> SceneRequest, ScriptLabel, ChangedThings<'a>);

/// Returns the request that makes a gesture on the newest script a step of the history.
pub(in crate::panels) fn gesture_request(
    context: &PanelContext<'_>,
    scene: &SceneView,
    (request, label, things): GestureStep<'_>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) -> Request {
    let step = || {
        let base = SceneBase::of(scene, context.scene_editing.text(scene))?;
        let text = act(&base.scene())?;
        Ok(request(base.step(text, label, things)))
    };
    let made = step();
    Request::Scene(made.unwrap_or_else(|refusal: GestureRefusal| SceneRequest::Refused(refusal.to_string())))
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
