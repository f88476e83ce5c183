//! A menu entry that changes the script.

use super::sheet::SceneSheet;
use crate::panels::request::Request;
use crate::panels::scene::{SceneBase, SceneRequest, ScriptChange};
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use egui::{Button, Ui};

/// Draws an entry that changes the script.
pub(super) fn gesture(
    ui: &mut Ui,
    title: &str,
    label: &'static str,
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) {
    if !ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
        return;
    }
    let base = SceneBase::of(sheet.scene, sheet.context.scene_editing.text(sheet.scene));
    let done = base.and_then(|base| {
        let text = act(&base.scene())?;
        Ok(ScriptChange {
            from: std::sync::Arc::clone(base.text()),
            text,
            also: Vec::new(),
            label,
            gesture: None,
        })
    });
    requests.push(Request::Scene(match done {
        Ok(change) => SceneRequest::Text(change),
        Err(refusal) => SceneRequest::Refused(refusal.to_string()),
    }));
    ui.close();
}
