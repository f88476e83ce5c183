//! The toolbar for camera and shading, at the top right of the viewport. In a narrow viewport, a menu has the buttons that do not fit.

use super::glass::{divider, glass};
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::submenu::submenu;
use crate::panels::widgets::icon_button;
use dragonfly_picture::camera::Projection;
use dragonfly_picture::{BoneLook, Shading, ThroughCamera};
use egui::{Align, Layout, Rect, Ui, UiBuilder, pos2, vec2};

/// Distance of the toolbar from the edges of the viewport, points.
const EDGE: f32 = 10.0;
/// Widths of a button and of a line between groups with the space after them, points.
const BUTTON: f32 = 26.0;
const DIVIDER: f32 = 9.0;
/// Name of the button with the menu of the others.
const MORE: &str = "More view options";

/// An entry of the toolbar.
#[derive(Clone, Copy)]
enum ToolbarEntry {
    /// The button for the directions of view.
    Views,
    /// The button for the camera through which the viewport looks.
    Cameras,
    /// The button of a command: whether it is on, and whether it has an effect now.
    Command { icon: Icon, id: Id, on: bool, able: bool },
    /// The line between two groups.
    Divider,
}

impl ToolbarEntry {
    fn width(&self) -> f32 {
        match self {
            Self::Views | Self::Cameras | Self::Command { .. } => BUTTON,
            Self::Divider => DIVIDER,
        }
    }
}

/// Draws a button for everything about camera and shading, so that nothing needs a numeric keypad or a middle button. The toolbar leaves `name` points
/// for the name at the left. Returns its area.
pub(super) fn toolbar(
    ui: &mut Ui,
    rect: Rect,
    name: f32,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> Rect {
    let entries = entries(context);
    let (shown, hidden) = entries.split_at(fitting(&entries, rect.width() - name - EDGE));
    let more = if hidden.is_empty() { 0.0 } else { BUTTON };
    let width = width(shown) + more;
    let at = Rect::from_min_size(pos2(rect.right() - width - EDGE, rect.top() + EDGE), vec2(width, 32.0));
    glass(ui, at);
    let mut ui = ui.new_child(
        UiBuilder::new()
            .max_rect(at.shrink(GRID))
            .layout(Layout::right_to_left(Align::Center))
            .id_salt("tools"),
    );
    let ui = &mut ui;
    ui.spacing_mut().item_spacing.x = 2.0;
    if !hidden.is_empty() {
        rest(ui, hidden, context, requests);
    }
    for entry in shown {
        match *entry {
            ToolbarEntry::Views => {
                let response = icon_button(ui, Icon::View, "Views", false).on_hover_text("Views");
                egui::Popup::menu(&response).show(|ui| views(ui, context, requests));
            }
            ToolbarEntry::Cameras => {
                let is_through = *context.through != ThroughCamera::Free;
                let response =
                    icon_button(ui, Icon::Camera, "Look through", is_through).on_hover_text("Look through");
                egui::Popup::menu(&response).show(|ui| cameras(ui, context, requests));
            }
            ToolbarEntry::Command { icon, id, on, able } => {
                ui.add_enabled_ui(able, |ui| command_button(ui, icon, id, on, requests));
            }
            ToolbarEntry::Divider => divider(ui),
        }
    }
    at
}

/// Returns the entries from the right to the left: those first that a narrow viewport needs most.
fn entries(context: &PanelContext<'_>) -> Vec<ToolbarEntry> {
    let look = &context.settings.look;
    let command = |icon, id, on| ToolbarEntry::Command { icon, id, on, able: true };
    let (icon, flat) = match context.camera.projection {
        Projection::Perspective => (Icon::Perspective, false),
        Projection::Orthographic => (Icon::Orthographic, true),
    };
    let mut entries = vec![
        ToolbarEntry::Views,
        command(icon, Id::ToggleProjection, flat),
        command(Icon::Frame, Id::FrameAll, false),
    ];
    if context.scene().is_some() {
        entries.extend([ToolbarEntry::Cameras, command(Icon::Sun, Id::ToggleHelpers, look.helpers)]);
    }
    // No bone has a shape while none is drawn.
    let shown = context.shows_skeleton();
    let bones = |icon, id, shape| {
        let on = shown && look.bone_look == shape;
        ToolbarEntry::Command { icon, id, on, able: shown }
    };
    let shading = |icon, id, shading| command(icon, id, look.shading == shading);
    entries.extend([
        ToolbarEntry::Divider,
        command(Icon::Grid, Id::ToggleGrid, look.grid),
        command(Icon::XRay, Id::ToggleXRay, look.bones_in_front),
        command(Icon::Bone, Id::ToggleSkeleton, shown),
        ToolbarEntry::Divider,
        bones(Icon::Lines, Id::BonesLines, BoneLook::Lines),
        bones(Icon::Sticks, Id::BonesSticks, BoneLook::Sticks),
        bones(Icon::Octahedra, Id::BonesOctahedra, BoneLook::Octahedra),
        ToolbarEntry::Divider,
        shading(Icon::Unlit, Id::ShadeUnlit, Shading::Unlit),
        shading(Icon::Clay, Id::ShadeClay, Shading::Clay),
        shading(Icon::Material, Id::ShadeMaterial, Shading::Material),
        command(Icon::Surface, Id::ToggleSurface, look.surface),
    ]);
    entries
}

/// Returns the width of a toolbar with these entries, points.
fn width(entries: &[ToolbarEntry]) -> f32 {
    entries.iter().map(ToolbarEntry::width).sum::<f32>() + 2.0 * GRID
}

/// Returns how many entries, from the first one on, fit into a width with the button for the others.
fn fitting(entries: &[ToolbarEntry], room: f32) -> usize {
    if width(entries) <= room {
        return entries.len();
    }
    let fits = |count: &usize| {
        let shown = &entries[..*count];
        width(shown) + BUTTON <= room && !matches!(shown.last(), Some(ToolbarEntry::Divider))
    };
    (0..entries.len()).rev().find(fits).unwrap_or(0)
}

/// Draws the button with the menu of the entries that do not fit, from the top down in the order of the toolbar from the left.
fn rest(ui: &mut Ui, hidden: &[ToolbarEntry], context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let response = icon_button(ui, Icon::More, MORE, false).on_hover_text(MORE);
    egui::Popup::menu(&response).show(|ui| {
        ui.set_min_width(230.0);
        for (index, entry) in hidden.iter().enumerate().rev() {
            match *entry {
                ToolbarEntry::Views => submenu(ui, "Views", |ui| views(ui, context, requests)),
                ToolbarEntry::Cameras => submenu(ui, "Look through", |ui| cameras(ui, context, requests)),
                ToolbarEntry::Command { id, on, able, .. } => {
                    ui.add_enabled_ui(able, |ui| menu::item(ui, context, id, on, requests));
                }
                ToolbarEntry::Divider if index == 0 => {}
                ToolbarEntry::Divider => {
                    ui.separator();
                }
            }
        }
    });
}

/// Draws the choice of the camera through which the viewport looks.
fn cameras(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_min_width(230.0);
    menu::look_through(ui, context, requests);
}

/// Draws the directions of view.
fn views(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    ui.set_width(160.0);
    for id in [Id::ViewFront, Id::ViewBack, Id::ViewRight, Id::ViewLeft, Id::ViewTop, Id::ViewBottom] {
        menu::item(ui, context, id, false, requests);
    }
    ui.separator();
    menu::item(ui, context, Id::FrameSelected, false, requests);
}
