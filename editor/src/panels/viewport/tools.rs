//! The toolbar on the left of the viewport: tool, axes and pivot of the gizmo.

use super::glass::{divider_across, glass};
use super::ik;
use crate::control::line::LineUse;
use crate::panels::command_button::column_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::menu;
use crate::panels::request::Request;
use crate::panels::style::GRID;
use crate::panels::widgets::{hint_beside, icon_button};
use dragonfly_picture::gizmo::{GizmoSpace, Pivot, Tool};
use egui::{Align, Layout, Rect, Ui, UiBuilder, pos2, vec2};

/// Draws the toolbar and returns its area. A low viewport gets two columns; where that is not enough, a menu has the buttons that do
/// not fit.
pub(super) fn toolbar(
    ui: &mut Ui,
    rect: Rect,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> Option<Rect> {
    let hand = &context.settings.tools;
    let top = rect.top() + 52.0;
    // The axes of the scene are below.
    let room = rect.bottom() - top - 92.0;
    let height = |buttons: f32, dividers: f32| {
        buttons * 24.0 + dividers * 7.0 + (buttons + dividers - 1.0) * 2.0 + 2.0 * GRID
    };
    // All but the first have a button for the rest.
    let ik = if context.ik.on { 3.0 } else { 2.0 };
    let has_scene = context.scene().is_some();
    let drawn = if has_scene { 2.0 } else { 0.0 };
    let heights = [8.0 + ik + drawn, 7.0 + ik + drawn, 7.0 + drawn, 5.0 + drawn, 1.0];
    let heights: [f32; 5] = std::array::from_fn(|at| height(heights[at], [3.0, 2.0, 1.0, 0.0, 0.0][at]));
    let fits = heights.iter().position(|&height| height <= room).filter(|_| rect.width() >= 240.0)?;
    let two = matches!(fits, 1 | 2) && rect.width() >= 320.0;
    let (width, high) = if two { (58.0, height(6.0 + drawn, 1.0)) } else { (32.0, heights[fits]) };
    let at = Rect::from_min_size(pos2(rect.left() + 10.0, top), vec2(width, high));
    glass(ui, at);
    let mut column = |left: f32, salt: &str| {
        let place = Rect::from_min_size(pos2(at.left() + left, at.top()), vec2(32.0, high)).shrink(GRID);
        let layout = Layout::top_down(Align::Center);
        let mut ui = ui.new_child(UiBuilder::new().max_rect(place).layout(layout).id_salt(salt));
        ui.spacing_mut().item_spacing.y = 2.0;
        ui
    };
    let (mut first, mut second) = (column(0.0, "hand"), two.then(|| column(26.0, "hand, second")));
    let ui = &mut first;
    let use_of = context.tools.controls().line().use_of();
    for (icon, id, tool) in HANDS.into_iter().filter(|_| fits <= 3) {
        column_button(ui, icon, id, hand.tool == tool && use_of.is_none(), requests);
    }
    if has_scene && fits <= 3 {
        for (icon, id, own) in DRAWING {
            column_button(ui, icon, id, use_of == Some(own), requests);
        }
    }
    if fits <= 2 {
        divider_across(ui);
        choice(ui, context, space_icon(hand.space), space_name(hand.space), &SPACES, requests);
        choice(ui, context, pivot_icon(hand.pivot), pivot_name(hand.pivot), &PIVOTS, requests);
    }
    let ui = match &mut second {
        Some(second) => second,
        None => {
            if fits <= 1 {
                divider_across(ui);
            }
            ui
        }
    };
    if fits <= 1 || two {
        ik::tools(ui, context, requests);
    }
    if fits == 0 || two {
        divider_across(ui);
        column_button(ui, Icon::Ghosts, Id::ToggleGhosts, hand.ghosts.shown, requests);
        column_button(ui, Icon::Path, Id::TogglePath, hand.path, requests);
    }
    if fits > 0 && !two {
        rest(ui, context, fits, requests);
    }
    Some(at)
}

/// The tools that a drag in the viewport uses.
const HANDS: [(Icon, Id, Option<Tool>); 4] = [
    (Icon::Select, Id::ToolSelect, None),
    (Icon::Move, Id::ToolMove, Some(Tool::Move)),
    (Icon::Rotate, Id::ToolRotate, Some(Tool::Rotate)),
    (Icon::Scale, Id::ToolScale, Some(Tool::Scale)),
];

/// The tools that draw in scenes.
const DRAWING: [(Icon, Id, LineUse); 2] =
    [(Icon::Pencil, Id::ToolLine, LineUse::Note), (Icon::Trail, Id::ToolPath, LineUse::Path)];

/// Draws the button with the menu of the tools that do not fit.
fn rest(ui: &mut Ui, context: &PanelContext<'_>, fits: usize, requests: &mut Vec<Request>) {
    let hand = &context.settings.tools;
    let response = icon_button(ui, Icon::Down, "More tools", false);
    egui::Popup::menu(&response).align(egui::RectAlign::RIGHT_START).show(|ui| {
        ui.set_width(190.0);
        for (_, id, tool) in HANDS.into_iter().filter(|_| fits > 3) {
            menu::item(ui, context, id, hand.tool == tool, requests);
        }
        if fits > 3 && context.scene().is_some() {
            for (_, id, own) in DRAWING {
                let on = context.tools.controls().line().use_of() == Some(own);
                menu::item(ui, context, id, on, requests);
            }
        }
        if fits > 2 {
            menu::item(ui, context, Id::NextSpace, false, requests);
            for (id, _, pivot) in PIVOTS {
                menu::item(ui, context, id, pivot == Some(hand.pivot), requests);
            }
        }
        if fits > 1 {
            menu::item(ui, context, Id::ToggleIk, context.ik.on, requests);
            menu::item(ui, context, Id::Pin, false, requests);
        }
        menu::item(ui, context, Id::ToggleGhosts, hand.ghosts.shown, requests);
        menu::item(ui, context, Id::TogglePath, hand.path, requests);
    });
    hint_beside(&response, "More tools");
}

const SPACES: [(Id, Option<GizmoSpace>, Option<Pivot>); 4] = [
    (Id::SpaceLocal, Some(GizmoSpace::Local), None),
    (Id::SpaceParent, Some(GizmoSpace::Parent), None),
    (Id::SpaceWorld, Some(GizmoSpace::World), None),
    (Id::SpaceView, Some(GizmoSpace::View), None),
];

const PIVOTS: [(Id, Option<GizmoSpace>, Option<Pivot>); 3] = [
    (Id::PivotIndividual, None, Some(Pivot::Individual)),
    (Id::PivotMedian, None, Some(Pivot::Median)),
    (Id::PivotActive, None, Some(Pivot::Active)),
];

/// Draws a button that shows the chosen entry and opens the list.
fn choice(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    icon: Icon,
    name: &str,
    list: &[(Id, Option<GizmoSpace>, Option<Pivot>)],
    requests: &mut Vec<Request>,
) {
    let hand = &context.settings.tools;
    let response = icon_button(ui, icon, name, false);
    egui::Popup::menu(&response).align(egui::RectAlign::RIGHT_START).show(|ui| {
        ui.set_width(190.0);
        for &(id, space, pivot) in list {
            let on = space == Some(hand.space) || pivot == Some(hand.pivot);
            menu::item(ui, context, id, on, requests);
        }
        ui.separator();
        let is_space = list.iter().any(|entry| entry.1.is_some());
        if is_space {
            menu::item(ui, context, Id::NextSpace, false, requests);
        } else {
            menu::item(ui, context, Id::ToggleCurl, hand.curl, requests);
        }
    });
    hint_beside(&response, name);
}

fn space_icon(space: GizmoSpace) -> Icon {
    match space {
        GizmoSpace::Local => Icon::AxesLocal,
        GizmoSpace::Parent => Icon::AxesParent,
        GizmoSpace::World => Icon::AxesWorld,
        GizmoSpace::View => Icon::AxesView,
    }
}

fn space_name(space: GizmoSpace) -> &'static str {
    match space {
        GizmoSpace::Local => "Axes: local",
        GizmoSpace::Parent => "Axes: parent",
        GizmoSpace::World => "Axes: world",
        GizmoSpace::View => "Axes: view",
    }
}

fn pivot_icon(pivot: Pivot) -> Icon {
    match pivot {
        Pivot::Individual => Icon::PivotIndividual,
        Pivot::Median => Icon::PivotMedian,
        Pivot::Active => Icon::PivotActive,
    }
}

fn pivot_name(pivot: Pivot) -> &'static str {
    match pivot {
        Pivot::Individual => "Pivot: individual joints",
        Pivot::Median => "Pivot: median point",
        Pivot::Active => "Pivot: active bone",
    }
}
