//! The context menu of the lanes: of a bar, or of the lane under the pointer.

use super::bar_menu;
use super::drag::BarDragging;
use super::lane_layout::SceneHit;
use super::menu_entry::gesture;
use super::sheet::SceneSheet;
use crate::panels::commands::Id;
use crate::panels::menu::{item, submenu};
use crate::panels::request::Request;
use crate::panels::scene::{ChangedThings, SceneRequest, add_action_menu};
use dragonfly_anim::stage::gesture::{add_clip, attach_thing, cut_to};
use dragonfly_anim::stage::lanes::SceneLane;
use dragonfly_document::edit::ScriptLabel;
use egui::{Button, Response, Ui};

/// The context menu, and what it was opened on.
#[derive(Debug, Default)]
pub(super) struct SceneMenu {
    on: Option<SceneHit>,
}

impl SceneMenu {
    pub(super) fn show(
        &mut self,
        response: &Response,
        drag: &BarDragging,
        sheet: &SceneSheet<'_>,
        requests: &mut Vec<Request>,
    ) {
        // A right-click that cancels a drag opens no menu.
        if drag.is_busy() {
            return;
        }
        if response.secondary_clicked() {
            self.on = drag.hovered();
            // Of several selected actions each one opens the menu for all.
            if let Some(SceneHit::Bar { action, .. }) = self.on
                && !sheet.context.scene_editing.is_action_selected(action)
            {
                requests.push(Request::Scene(SceneRequest::SelectAction(Some(action))));
            }
        }
        let on = self.on;
        response.context_menu(|ui| match on {
            Some(SceneHit::Bar { action, .. }) => bar_menu::show(ui, action, sheet, requests),
            Some(SceneHit::Lane(lane)) => match sheet.lanes.list.get(lane) {
                Some(lane) => lane_entries(ui, lane, sheet, requests),
                None => general(ui, sheet, requests),
            },
            Some(SceneHit::Nothing) | None => general(ui, sheet, requests),
        });
    }
}

fn lane_entries(ui: &mut Ui, lane: &SceneLane, sheet: &SceneSheet<'_>, requests: &mut Vec<Request>) {
    let at = sheet.context.scene_time();
    let things = sheet.scene.plan.as_ref().map_or(&[][..], |plan| plan.things());
    let own = things.iter().find(|thing| *thing.id == *lane.name);
    if let Some(model) = own.and_then(|thing| thing.model.as_ref()) {
        submenu(ui, "Add clip at the playhead", |ui| {
            if model.takes().is_empty() {
                ui.add_enabled(false, Button::new("The model has no takes").frame(false));
            }
            egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
                for take in model.takes() {
                    gesture(
                        ui,
                        take.name(),
                        (SceneRequest::AddActions, ScriptLabel::AddClip, ChangedThings::Thing(&lane.name)),
                        sheet,
                        requests,
                        |scene| add_clip(scene, &lane.name, take.name(), at),
                    );
                }
            });
        });
    }
    let who = (!lane.kind.is_empty()).then_some(&*lane.name);
    add_action_menu(ui, sheet.context, sheet.scene, who, requests);
    if matches!(lane.kind, "role" | "prop" | "light" | "effect" | "camera") {
        submenu(ui, "Attach at the playhead to", |ui| {
            for other in
                things.iter().filter(|other| matches!(other.kind, "role" | "prop") && *other.id != *lane.name)
            {
                attach_entries(ui, &lane.name, other, sheet, requests);
            }
        });
        ui.separator();
    }
    general(ui, sheet, requests);
}

fn attach_entries(
    ui: &mut Ui,
    who: &str,
    holder: &dragonfly_anim::stage::PlannedThing,
    sheet: &SceneSheet<'_>,
    requests: &mut Vec<Request>,
) {
    let at = sheet.context.scene_time();
    submenu(ui, &*holder.id, |ui| {
        gesture(
            ui,
            "The whole",
            (SceneRequest::AddActions, ScriptLabel::Attach, ChangedThings::Thing(who)),
            sheet,
            requests,
            |scene| attach_thing(scene, who, &holder.id, at),
        );
        let bones = holder.model.as_ref().map_or(&[][..], |model| &model.skeleton().bones);
        egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
            for bone in bones.iter().filter(|bone| !bone.name.is_empty()) {
                let to = format!("{}.{}", holder.id, bone.name);
                gesture(
                    ui,
                    &bone.name,
                    (SceneRequest::AddActions, ScriptLabel::Attach, ChangedThings::Thing(who)),
                    sheet,
                    requests,
                    |scene| attach_thing(scene, who, &to, at),
                );
            }
        });
    });
}

/// Draws the entries that every lane has.
fn general(ui: &mut Ui, sheet: &SceneSheet<'_>, requests: &mut Vec<Request>) {
    let at = sheet.context.scene_time();
    let things = sheet.scene.plan.as_ref().map_or(&[][..], |plan| plan.things());
    submenu(ui, "Cut at the playhead to", |ui| {
        for camera in things.iter().filter(|thing| thing.kind == "camera") {
            gesture(
                ui,
                &camera.id,
                (SceneRequest::AddActions, ScriptLabel::AddShot, ChangedThings::None),
                sheet,
                requests,
                |scene| cut_to(scene, &camera.id, at),
            );
        }
    });
    ui.separator();
    item(ui, sheet.context, Id::PasteActions, false, requests);
    item(ui, sheet.context, Id::SelectAllActions, false, requests);
    ui.separator();
    for id in [Id::FitScene, Id::ToggleSceneRipple, Id::ToggleSnap] {
        let on = match id {
            Id::ToggleSceneRipple => sheet.context.scene_editing.ripple(),
            Id::ToggleSnap => sheet.context.keys.snap(),
            _ => false,
        };
        item(ui, sheet.context, id, on, requests);
    }
}
