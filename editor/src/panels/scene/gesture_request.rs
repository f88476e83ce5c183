//! Gestures of menus and lists: one change of the script, or the reason why it is refused.

use super::{ChangedThings, SceneBase, SceneRequest};
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
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
    let base = SceneBase::of(scene, context.scene_editing.text(scene));
    let done = base.and_then(|base| {
        let text = act(&base.scene())?;
        Ok(base.step(text, label, things))
    });
    Request::Scene(match done {
        Ok(change) => SceneRequest::Text(change),
        Err(refusal) => SceneRequest::Refused(refusal.to_string()),
    })
}

/// Returns the label of a step that moves actions.
pub(in crate::panels) fn move_label(actions: &[usize]) -> ScriptLabel {
    if actions.len() > 1 { ScriptLabel::MoveClips } else { ScriptLabel::MoveClip }
}
