//! The context menu of keys.

use super::drag::DopeDrag;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::key_aim::{INTERPOLATIONS, TANGENTS};
use crate::panels::menu::item;
use crate::panels::request::Request;
use dragonfly_document::Change;
use egui::{Button, Response, Ui};

/// The context menu of keys in the dope sheet.
#[derive(Debug, Default)]
pub(super) struct KeyMenu;

impl KeyMenu {
    pub(super) fn show(
        &self,
        canvas: &Response,
        drag: &DopeDrag,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        // A right-click that cancels a drag opens no menu.
        if drag.is_busy() {
            return;
        }
        canvas.context_menu(|ui| show(ui, context, requests));
    }
}

/// Draws the entries, for the dope sheet and for the curves.
pub(in crate::panels) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let button = Button::new("Add keys at the playhead").frame_when_inactive(false);
    let hint = "Add keys that keep the motion, for the selected bones or for all";
    if ui.add_enabled(context.take().is_some(), button).on_hover_text(hint).clicked() {
        requests.extend(context.key_edit().map(|edit| Request::Change(Change::Edit(edit, None))));
        ui.close();
    }
    for id in [Id::CutKeys, Id::CopyKeys, Id::PastePose] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::DuplicateKeys, Id::DeleteKeys, Id::SnapKeys] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in INTERPOLATIONS {
        item(ui, context, id, false, requests);
    }
    ui.menu_button("Tangents", |ui| {
        for id in TANGENTS {
            item(ui, context, id, false, requests);
        }
    });
    ui.separator();
    for id in [Id::KeysSlower, Id::KeysFaster, Id::KeysReverse] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::RippleOpen, Id::RippleClose] {
        item(ui, context, id, false, requests);
    }
    ui.separator();
    for id in [Id::SelectAllKeys, Id::RangeOfKeys, Id::FitKeys] {
        item(ui, context, id, false, requests);
    }
}
