//! A menu entry that changes the script.

use super::sheet::SceneSheet;
use crate::panels::request::Request;
use crate::panels::scene::gesture_request::{GestureStep, gesture_request};
use dragonfly_anim::stage::gesture::{GestureRefusal, GestureScene};
use egui::{Button, Ui};

/// Draws an entry that makes a step of the script.
pub(super) fn gesture(
    ui: &mut Ui,
    title: &str,
    step: GestureStep<'_>,
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
    act: impl FnOnce(&GestureScene<'_>) -> Result<String, GestureRefusal>,
) {
    if ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
        requests.push(gesture_request(sheet.context, sheet.scene, step, act));
        ui.close();
    }
}
