//! A menu entry that changes the script.

use super::sheet::SceneSheet;
use crate::panels::request::Request;
use crate::panels::scene::ChangedThings;
use crate::panels::scene::gesture_request::{add_request, gesture_request};
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use dragonfly_document::edit::ScriptLabel;
use egui::{Button, Ui};

/// Draws an entry that changes the script: these things of it.
pub(super) fn gesture(
    ui: &mut Ui,
    title: &str,
    (label, things): (ScriptLabel, ChangedThings<'_>),
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) {
    if ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
        requests.push(gesture_request(sheet.context, sheet.scene, label, things, act));
        ui.close();
    }
}

/// Draws an entry that adds an action to the script, which is then selected.
pub(super) fn addition(
    ui: &mut Ui,
    title: &str,
    (label, things): (ScriptLabel, ChangedThings<'_>),
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) {
    if ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
        requests.push(add_request(sheet.context, sheet.scene, label, things, act));
        ui.close();
    }
}
