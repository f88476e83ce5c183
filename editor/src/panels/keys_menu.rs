//! The menu of commands for keys. Commands of one kind have menus of their own, so that it is not higher than a small window.

use super::commands::{self, Category, Id};
use super::context::PanelContext;
use super::menu_entries::{entries, item};
use super::request::Request;
use super::submenu::submenu;
use egui::Ui;

/// Titles of the menus in the menu, each with its commands.
const KINDS: [(&str, &[Id]); 5] = [
    (
        "Move, scale",
        &[
            Id::MoveKeysNow,
            Id::ScaleKeysNow,
            Id::DuplicateKeysNow,
            Id::KeysEarlier,
            Id::KeysLater,
            Id::KeysSlower,
            Id::KeysFaster,
            Id::KeysReverse,
            Id::SnapKeys,
        ],
    ),
    ("Interpolation", &[Id::InterpolateStep, Id::InterpolateLinear, Id::InterpolateSpline]),
    (
        "Tangents",
        &[Id::TangentsAuto, Id::TangentsClamped, Id::TangentsFlat, Id::TangentsLinear, Id::TangentsUnified],
    ),
    ("Events, markers", &[Id::AddEvent, Id::AddMarker, Id::PreviousMarker, Id::NextMarker]),
    ("Play range", &[Id::RangeOfKeys, Id::RangeFromHere, Id::RangeToHere, Id::RangeWhole]),
];

/// Commands that open a menu at the pointer, over keys; the menus here have the same entries.
const AT_POINTER: [Id; 2] = [Id::InterpolationMenu, Id::TangentMenu];

/// The last commands of groups in the menus for in-betweens.
const GROUP_ENDS: [Id; 6] =
    [Id::RelaxKeys, Id::BlendToNext, Id::EaseOutKeys, Id::BlendToTake, Id::DelayKeys, Id::RemovePeaks];

/// Draws the menu.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let inbetweens = commands::of(Category::InBetween);
    let smooth = inbetweens.iter().position(|command| command.id == Id::SmoothKeys).unwrap_or_default();
    for (title, commands) in [("In-between", &inbetweens[..smooth]), ("Smooth, bake", &inbetweens[smooth..])]
    {
        submenu(ui, title, |ui| {
            for command in commands {
                item(ui, context, command.id, false, requests);
                if GROUP_ENDS.contains(&command.id) {
                    ui.separator();
                }
            }
        });
    }
    for (title, commands) in KINDS {
        submenu(ui, title, |ui| {
            for &id in commands {
                item(ui, context, id, false, requests);
            }
        });
    }
    ui.separator();
    let is_elsewhere =
        |id: Id| AT_POINTER.contains(&id) || KINDS.iter().any(|(_, commands)| commands.contains(&id));
    let listed = commands::of(Category::Keys).iter().filter(|command| !is_elsewhere(command.id));
    entries(ui, context, listed, requests);
}
