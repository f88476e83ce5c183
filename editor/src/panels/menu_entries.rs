//! The entries of menus that run commands.

use super::commands::{self, Command, Id};
use super::compared::CompareWith;
use super::context::PanelContext;
use super::icons::Icon;
use super::request::Request;
use super::style;
use super::submenu::GUTTER;
use super::theme::Theme;
use super::widgets::{disabled_hint_beside, hint_beside};
use crate::control::line::{LineSurface, LineUse};
use egui::{Button, Rect, RichText, Ui, pos2, vec2};

/// Draws an entry: title and shortcut, with a check mark before the title and the title in the accent color if `on`.
pub(super) fn item(ui: &mut Ui, context: &PanelContext<'_>, id: Id, on: bool, requests: &mut Vec<Request>) {
    let command = commands::get(id);
    let shortcut =
        RichText::new(commands::shortcut_text(ui.ctx(), id)).size(style::SMALL).color(Theme::of(ui).faint);
    let color = match (on, id) {
        // Dangerous while it is on: every movement is recorded.
        (true, Id::AutoKey) => Theme::of(ui).error,
        (true, _) => Theme::of(ui).accent,
        (false, _) => Theme::of(ui).text,
    };
    let title = RichText::new(super::commands::title(context, id)).color(color);
    let button = Button::new(title).shortcut_text(shortcut).frame_when_inactive(false);
    let enabled = command.when.holds(context);
    let response = ui
        .scope(|ui| {
            ui.spacing_mut().button_padding.x += GUTTER;
            ui.add_enabled(enabled, button)
        })
        .inner;
    if on {
        let at = pos2(response.rect.left() + 0.5 * GUTTER + 4.0, response.rect.center().y);
        let color = if enabled { color } else { color.gamma_multiply(0.5) };
        Icon::Saved.paint(ui.painter(), Rect::from_center_size(at, vec2(16.0, 16.0)), color);
    }
    hint_beside(&response, command.help);
    let why = format!("{}\n{}", command.help, command.when.reason());
    disabled_hint_beside(&response, why);
    if response.clicked() {
        requests.push(Request::Command(id));
        ui.close();
    }
}

/// Draws entries, with the lines below the last ones of groups.
pub(super) fn entries(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    listed: impl Iterator<Item = &'static Command>,
    requests: &mut Vec<Request>,
) {
    for command in listed {
        let on = match command.id {
            Id::CompareOpened => context.compared == CompareWith::Opened,
            Id::UndoSelections => context.settings.undo_selections,
            Id::ToggleSnap => context.keys.snap(),
            Id::ToggleHoldFeet => context.keys.holds_feet(),
            Id::ToggleRulerSeconds => context.keys.ruler_in_seconds(),
            Id::ListChangedBones => context.keys.only_changed(),
            Id::ToggleCurl => context.settings.tools.curl,
            Id::ToggleGhosts => context.settings.tools.ghosts.shown,
            Id::TogglePath => context.settings.tools.path,
            Id::ToolLine => context.tools.controls().line().use_of() == Some(LineUse::Note),
            Id::ToolPath => context.tools.controls().line().use_of() == Some(LineUse::Path),
            Id::PoseLine => context.tools.controls().line().use_of() == Some(LineUse::Pose),
            Id::MotionStroke => context.tools.controls().line().use_of() == Some(LineUse::Motion),
            Id::ToggleScrubSounds => context.settings.scrub_sounds,
            Id::LinesOnGround => is_drawn_on(context, LineSurface::Ground),
            Id::LinesInView => is_drawn_on(context, LineSurface::View),
            Id::LinesOnSurface => is_drawn_on(context, LineSurface::Surface),
            Id::LinesOnBone => is_drawn_on(context, LineSurface::Bone),
            Id::ToggleLinesFrom => context.settings.tools.lines_from_playhead,
            Id::ToggleProblems => context.findings.is_on(),
            Id::ToggleGroundSnap => context.settings.tools.ground,
            Id::ToggleSceneRipple => context.scene_editing.ripple(),
            _ => false,
        };
        item(ui, context, command.id, on, requests);
        if GROUP_ENDS.contains(&command.id) {
            ui.separator();
        }
    }
}

fn is_drawn_on(context: &PanelContext<'_>, surface: LineSurface) -> bool {
    context.scene().is_some() && context.tools.controls().line().note_surface() == surface
}

/// The last entries of groups in long menus.
const GROUP_ENDS: &[Id] = &[
    Id::UndoSelections,
    // Select
    Id::InvertSelection,
    Id::ShrinkSelection,
    Id::ExtendMirror,
    Id::RemoveFromSelectionSet,
    Id::ShowAll,
    Id::LockBones,
    // Tools
    Id::ToolScale,
    Id::ScaleNow,
    Id::SpaceView,
    Id::ToggleCurl,
    Id::LassoSelect,
    // Keys
    Id::InvertKeys,
    Id::CopyKeys,
    Id::ToggleSnap,
    Id::RippleClose,
    // Take
    Id::MoveTakeDown,
    Id::ReverseTake,
    Id::CompareOpened,
    Id::MirrorDialog,
    Id::Retarget,
    // Scene
    Id::ProjectFromScene,
    Id::SceneLift,
    Id::ShowAllThings,
    Id::LockThings,
    Id::ToggleGroundSnap,
    Id::NextShot,
    Id::ClipEndToPlayhead,
    Id::NextEdge,
    Id::SelectAllActions,
    Id::LoopWhole,
];
