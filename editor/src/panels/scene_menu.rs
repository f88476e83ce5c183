//! The menu of scenes. Commands of one kind have menus of their own, so that it is not higher than a small window.

use super::commands::{self, Category, Id};
use super::context::PanelContext;
use super::menu_entries::entries;
use super::request::Request;
use super::scene::add_action_menu;
use super::submenu::submenu;
use egui::Ui;

/// Titles of the menus in the menu, each with its commands.
const KINDS: [(&str, &[Id]); 5] = [
    (
        "Add",
        &[
            Id::AddRole,
            Id::AddProp,
            Id::AddSceneCamera,
            Id::AddLight,
            Id::AddEffect,
            Id::AddPath,
            Id::AddMark,
            Id::AddSceneSound,
            Id::AddTitle,
        ],
    ),
    (
        "Things",
        &[
            Id::SceneRename,
            Id::HideThings,
            Id::HideOtherThings,
            Id::ShowAllThings,
            Id::LockThings,
            Id::DropToGround,
            Id::ToggleGroundSnap,
            Id::AttachHere,
            Id::DetachHere,
        ],
    ),
    ("Camera", &[Id::CutHere, Id::CutToCamera, Id::PreviousShot, Id::NextShot, Id::PickFocus]),
    ("Lines", &[Id::LineAsPath, Id::WalkAlong, Id::DeleteLine]),
    (
        "Timeline",
        &[
            Id::ClipToPlayhead,
            Id::ClipEarlier,
            Id::ClipLater,
            Id::ClipStartToPlayhead,
            Id::ClipEndToPlayhead,
            Id::SplitActions,
            Id::PreviousEdge,
            Id::NextEdge,
            Id::PreviousAction,
            Id::NextAction,
            Id::SelectAllActions,
            Id::LoopFromHere,
            Id::LoopToHere,
            Id::LoopActions,
            Id::LoopWhole,
            Id::ToggleSceneRipple,
            Id::FitScene,
        ],
    ),
];

/// Draws the menu.
pub(super) fn show(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    if let Some(scene) = context.scene() {
        let selected = context.scene_editing.things().last().map(|thing| &**thing);
        add_action_menu(ui, context, scene, selected, requests);
    }
    for (title, commands) in KINDS {
        submenu(ui, title, |ui| entries(ui, context, commands.iter().copied().map(commands::get), requests));
    }
    ui.separator();
    let is_elsewhere = |id: Id| KINDS.iter().any(|(_, commands)| commands.contains(&id));
    let listed = commands::of(Category::Scene).iter().filter(|command| !is_elsewhere(command.id));
    entries(ui, context, listed, requests);
}
