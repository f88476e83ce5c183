//! The context menu of a bone, in the viewport and in the hierarchy: commands for the selection.

use super::commands::Id;
use super::context::PanelContext;
use super::menu;
use super::request::Request;
use egui::{Popup, Response, SetOpenCommand, Ui};

/// The commands in groups, which are separated by lines.
const GROUPS: &[&[Id]] = &[
    &[Id::Key, Id::CopyPose, Id::PastePose, Id::PasteMirrored],
    &[Id::ResetPose, Id::ResetToRest],
    &[Id::Pin, Id::LookAt],
    &[Id::SelectParent, Id::SelectChild, Id::SelectBranch, Id::SelectMirror],
    &[Id::HideSelected, Id::HideOthers, Id::ShowAll],
    &[Id::FrameSelected],
];

/// Opens the menu where the right button was clicked on `response`. If the bone there, `at`, is not selected, it is
/// selected first, so that the menu acts on the bone under the pointer. While the left button is down, the right one
/// only cancels a drag.
pub(super) fn show(
    response: &Response,
    context: &PanelContext<'_>,
    at: Option<u32>,
    requests: &mut Vec<Request>,
) {
    let open = is_asked(response);
    if open && let Some(bone) = at.filter(|&bone| !context.selection.contains(bone)) {
        requests.push(Request::Select(Some(bone)));
    }
    at_pointer(response, open, |ui| entries(ui, context, requests));
}

/// Returns whether the menu of `response` is asked for. While the left button is down, the right one only cancels a drag.
pub(super) fn is_asked(response: &Response) -> bool {
    response.secondary_clicked() && !response.ctx.input(|input| input.pointer.primary_down())
}

/// Draws a menu where the pointer was when it was opened; a click on `response` closes it.
pub(super) fn at_pointer(response: &Response, opens: bool, entries: impl FnOnce(&mut Ui)) {
    let command = match () {
        () if opens => Some(SetOpenCommand::Bool(true)),
        () if response.clicked() => Some(SetOpenCommand::Bool(false)),
        () => None,
    };
    Popup::menu(response).open_memory(command).at_pointer_fixed().show(entries);
}

fn entries(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    for (index, group) in GROUPS.iter().enumerate() {
        if index > 0 {
            ui.separator();
        }
        group.iter().for_each(|&id| menu::item(ui, context, id, false, requests));
    }
}
