//! The toolbar for camera and shading, at the top right of the viewport.

use super::glass::{divider, glass};
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::widgets::icon_button;
use dragonfly_picture::camera::Projection;
use dragonfly_picture::{BoneLook, Shading, ThroughCamera};
use egui::{Align, Layout, Rect, Ui, UiBuilder, pos2, vec2};

/// Draws a button for everything about camera and shading, so that nothing needs a numeric keypad or a middle button.
/// Returns its area.
pub(super) fn toolbar(
    ui: &mut Ui,
    rect: Rect,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> Rect {
    let look = &context.settings.look;
    // A narrow viewport keeps the buttons that have no alternative nearby; the menus contain all of them.
    // One of two views needs room for the name of its camera.
    let wide = rect.width() > if context.second_view.is_some() { 640.0 } else { 430.0 };
    let is_scene = context.scene().is_some();
    let (buttons, dividers) = if wide { (13.0, 3.0) } else { (6.0, 1.0) };
    let buttons = buttons + if is_scene { 2.0 } else { 0.0 };
    let width = buttons * 26.0 + dividers * 9.0 + 2.0 * GRID;
    let at = Rect::from_min_size(pos2(rect.right() - width - 10.0, rect.top() + 10.0), vec2(width, 32.0));
    glass(ui, at);
    let mut ui = ui.new_child(
        UiBuilder::new()
            .max_rect(at.shrink(GRID))
            .layout(Layout::right_to_left(Align::Center))
            .id_salt("tools"),
    );
    let ui = &mut ui;
    ui.spacing_mut().item_spacing.x = 2.0;
    views(ui, context, requests);
    let (icon, flat) = match context.camera.projection {
        Projection::Perspective => (Icon::Perspective, false),
        Projection::Orthographic => (Icon::Orthographic, true),
    };
    command_button(ui, icon, Id::ToggleProjection, flat, requests);
    command_button(ui, Icon::Frame, Id::FrameAll, false, requests);
    if is_scene {
        cameras(ui, context, requests);
        command_button(ui, Icon::Sun, Id::ToggleHelpers, look.helpers, requests);
    }
    divider(ui);
    command_button(ui, Icon::Grid, Id::ToggleGrid, look.grid, requests);
    command_button(ui, Icon::XRay, Id::ToggleXRay, look.bones_in_front, requests);
    command_button(ui, Icon::Bone, Id::ToggleSkeleton, context.shows_skeleton(), requests);
    if wide {
        divider(ui);
        // No bone has a shape while none is drawn.
        let shown = context.shows_skeleton();
        ui.add_enabled_ui(shown, |ui| {
            for (icon, id, shape) in [
                (Icon::Lines, Id::BonesLines, BoneLook::Lines),
                (Icon::Sticks, Id::BonesSticks, BoneLook::Sticks),
                (Icon::Octahedra, Id::BonesOctahedra, BoneLook::Octahedra),
            ] {
                command_button(ui, icon, id, shown && look.bone_look == shape, requests);
            }
        });
        divider(ui);
        command_button(ui, Icon::Unlit, Id::ShadeUnlit, look.shading == Shading::Unlit, requests);
        command_button(ui, Icon::Clay, Id::ShadeClay, look.shading == Shading::Clay, requests);
        command_button(ui, Icon::Material, Id::ShadeMaterial, look.shading == Shading::Material, requests);
        command_button(ui, Icon::Surface, Id::ToggleSurface, look.surface, requests);
    }
    at
}

/// Draws the button for the camera through which the viewport looks.
fn cameras(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let is_through = *context.through != ThroughCamera::Free;
    let response = icon_button(ui, Icon::Camera, "Look through", is_through).on_hover_text("Look through");
    egui::Popup::menu(&response).show(|ui| {
        ui.set_min_width(230.0);
        menu::look_through(ui, context, requests);
    });
}

fn views(ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let response = icon_button(ui, Icon::View, "Views", false).on_hover_text("Views");
    egui::Popup::menu(&response).show(|ui| {
        ui.set_width(160.0);
        for id in [Id::ViewFront, Id::ViewBack, Id::ViewRight, Id::ViewLeft, Id::ViewTop, Id::ViewBottom] {
            menu::item(ui, context, id, false, requests);
        }
        ui.separator();
        menu::item(ui, context, Id::FrameSelected, false, requests);
    });
}
