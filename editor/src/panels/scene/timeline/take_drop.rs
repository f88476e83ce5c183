//! A take that is dragged from the list onto a lane: the bar that it would be, and its drop.

use super::sheet::SceneSheet;
use super::snap::snapped_time;
use crate::panels::drag::readout;
use crate::panels::request::Request;
use crate::panels::scene::gesture_request::gesture_request;
use crate::panels::scene::{ChangedThings, DraggedTake, SceneRequest};
use dragonfly_anim::stage::gesture::add_clip;
use dragonfly_anim::stage::lanes::SceneLane;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::edit::ScriptLabel;
use egui::{CornerRadius, DragAndDrop, Painter, Pos2, Stroke, StrokeKind, Ui};

/// Shows where the take would be that is dragged over the lanes, and adds it where it is dropped.
pub(super) fn update(ui: &Ui, painter: &Painter, sheet: &SceneSheet<'_>, requests: &mut Vec<Request>) {
    let Some(take) = DragAndDrop::payload::<DraggedTake>(ui.ctx()) else { return };
    let (pointer, is_released) =
        ui.input(|input| (input.pointer.interact_pos(), input.pointer.primary_released()));
    let Some(at) = pointer.filter(|at| sheet.canvas.contains(*at)) else { return };
    let begin = snapped(at, ui, sheet);
    let lane = sheet.layout.lane_at(at.y - sheet.canvas.top() + sheet.scroll);
    let lane = lane.and_then(|lane| Some((lane, sheet.lanes.list.get(lane)?)));
    let (lane, length) = match lane
        .map(|(index, lane)| Ok::<_, String>((index, length(lane, &take.take, sheet)?)))
    {
        Some(Ok(found)) => found,
        Some(Err(reason)) => return refuse(ui, at, reason, is_released, requests),
        None => return refuse(ui, at, "Drop it onto the lane of a role".to_owned(), is_released, requests),
    };
    let name = sheet.lanes.list.get(lane).map_or("", |lane| &*lane.name);
    let span = [begin, begin + length];
    let bar = sheet.layout.main_bar(lane, span, sheet.canvas.top() - sheet.scroll, sheet.scale);
    let painter = painter.with_clip_rect(sheet.canvas.intersect(painter.clip_rect()));
    painter.rect_filled(bar, CornerRadius::same(4), sheet.theme.accent.gamma_multiply(0.3));
    let edge = Stroke::new(1.0, sheet.theme.accent);
    painter.rect_stroke(bar, CornerRadius::same(4), edge, StrokeKind::Inside);
    readout(ui, at, &format!("{name} · {}: begins at {:.3} s", take.take, begin.seconds()));
    if is_released {
        requests.push(gesture_request(
            sheet.context,
            sheet.scene,
            (SceneRequest::AddActions, ScriptLabel::AddClip, ChangedThings::Thing(name)),
            |scene| add_clip(scene, name, &take.take, begin),
        ));
    }
}

fn snapped(at: Pos2, ui: &Ui, sheet: &SceneSheet<'_>) -> StageTime {
    let time = StageTime::from_seconds(f64::from(sheet.scale.time_at(at.x)).max(0.0));
    let rate = sheet.scene.script.as_ref().map(|script| script.rate());
    let is_snapping = sheet.context.keys.snap() != ui.input(|input| input.modifiers.command);
    match rate.filter(|_| is_snapping) {
        Some(rate) => {
            let reach = StageTime::from_seconds(f64::from(sheet.scale.seconds(6.0)));
            snapped_time(time, sheet.lanes, sheet.context.scene_time(), reach, rate)
        }
        None => time,
    }
}

/// Returns how long the take is for the thing of a lane, or why that does not play it.
fn length(lane: &SceneLane, take: &str, sheet: &SceneSheet<'_>) -> Result<StageTime, String> {
    let plan = sheet.scene.plan.as_ref();
    let thing = plan.and_then(|plan| plan.things().get(plan.thing_called(&lane.name)?));
    let Some(model) = thing.and_then(|thing| thing.model.as_ref()) else {
        return Err(format!("{} plays no takes: drop it onto the lane of a role", lane.name));
    };
    if sheet.context.scene_editing.is_locked(&lane.name) {
        return Err(format!("{} is locked", lane.name));
    }
    let found = model.take_called(take).and_then(|take| model.takes().get(take));
    found
        .map(|take| take.length())
        .ok_or_else(|| format!("The model of {} lacks the take \"{take}\"", lane.name))
}

fn refuse(ui: &Ui, at: Pos2, reason: String, is_released: bool, requests: &mut Vec<Request>) {
    readout(ui, at, &reason);
    if is_released {
        requests.push(Request::Scene(SceneRequest::Refused(reason)));
    }
}
