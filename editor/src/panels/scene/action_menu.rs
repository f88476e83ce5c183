//! The entries that add an action of the table, for a thing or for the scene.

use super::gesture_request::gesture_request;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::scene::{ChangedThings, SceneRequest};
use crate::panels::submenu::submenu;
use dragonfly_anim::stage::PlannedThing;
use dragonfly_anim::stage::gesture::add_new_action;
use dragonfly_anim::stage::table::{NEW_ACTIONS, NewActionRow, NewActionTarget, PROPERTIES, element};
use dragonfly_document::SceneView;
use dragonfly_document::edit::ScriptLabel;
use egui::{Button, ScrollArea, Ui};

/// Height from which on a list of names scrolls, points.
const LIST: f32 = 320.0;

/// Draws the entry "Add action" with those for the thing `who`, and those that belong to no thing.
pub(in crate::panels) fn submenu_of(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    scene: &SceneView,
    who: Option<&str>,
    requests: &mut Vec<Request>,
) {
    submenu(ui, "Add action", |ui| {
        let things = scene.plan.as_ref().map_or(&[][..], |plan| plan.things());
        let own = things.iter().find(|thing| Some(&*thing.id) == who);
        let mut menu = ActionMenu { context, scene, things, requests };
        for row in NEW_ACTIONS {
            let kinds = element(row.element).map_or(&[][..], |row| row.who);
            match own {
                _ if kinds.is_empty() => menu.entry(ui, row, None),
                Some(own) if kinds.contains(&own.kind) => menu.entry(ui, row, Some(own)),
                Some(_) | None => {}
            }
        }
    });
}

struct ActionMenu<'a> {
    context: &'a PanelContext<'a>,
    scene: &'a SceneView,
    things: &'a [PlannedThing],
    requests: &'a mut Vec<Request>,
}

impl ActionMenu<'_> {
    fn entry(&mut self, ui: &mut Ui, row: &NewActionRow, own: Option<&PlannedThing>) {
        let id = own.map(|own| &*own.id);
        match row.target {
            NewActionTarget::Nothing | NewActionTarget::OwnPlace => self.leaf(ui, row.title, row, id, None),
            NewActionTarget::Thing { kinds, .. } => {
                let others: Vec<&str> = self
                    .things
                    .iter()
                    .filter(|thing| kinds.contains(&thing.kind) && Some(&*thing.id) != id)
                    .map(|thing| &*thing.id)
                    .collect();
                self.list(ui, row, id, &others, "Nothing in the scene can be named there");
            }
            NewActionTarget::Property => {
                let of = own.map_or("", |own| own.kind);
                let names: Vec<&str> =
                    PROPERTIES.iter().filter(|row| row.thing == of).map(|row| row.name).collect();
                self.list(ui, row, id, &names, "It has no properties that change");
            }
        }
    }

    fn list(&mut self, ui: &mut Ui, row: &NewActionRow, who: Option<&str>, targets: &[&str], none: &str) {
        submenu(ui, row.title, |ui| {
            if targets.is_empty() {
                ui.add_enabled(false, Button::new(none).frame(false));
            }
            ScrollArea::vertical().max_height(LIST).show(ui, |ui| {
                for &target in targets {
                    self.leaf(ui, target, row, who, Some(target));
                }
            });
        });
    }

    fn leaf(
        &mut self,
        ui: &mut Ui,
        title: &str,
        row: &NewActionRow,
        who: Option<&str>,
        target: Option<&str>,
    ) {
        if !ui.add(Button::new(title).frame_when_inactive(false)).clicked() {
            return;
        }
        let at = self.context.scene_time();
        let things = who.map_or(ChangedThings::None, ChangedThings::Thing);
        self.requests.push(gesture_request(
            self.context,
            self.scene,
            (SceneRequest::AddActions, ScriptLabel::adding(row.element), things),
            |scene| add_new_action(scene, row, who, target, at),
        ));
        ui.close();
    }
}
