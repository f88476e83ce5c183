//! The names of the lanes, and the switches above them.

use super::sheet::SceneSheet;
use crate::panels::command_button::command_button;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::request::Request;
use crate::panels::scene::thing_icon::icon;
use crate::panels::scene::{SceneRequest, active_request, thing_menu};
use crate::panels::theme::Theme;
use crate::panels::widgets;
use dragonfly_document::bones::Choice;
use egui::accesskit::Role;
use egui::{CornerRadius, Rect, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2, vec2};

/// Draws the names.
pub(super) fn show(ui: &mut Ui, sheet: &SceneSheet<'_>, requests: &mut Vec<Request>) {
    let theme = sheet.theme;
    let painter = ui.painter().with_clip_rect(sheet.names.intersect(ui.clip_rect()));
    painter.rect_filled(sheet.names, CornerRadius::ZERO, theme.panel);
    for (index, lane) in sheet.lanes.list.iter().enumerate() {
        let [top, bottom] = sheet.layout.span(index).map(|y| sheet.names.top() - sheet.scroll + y);
        let row = Rect::from_min_max(pos2(sheet.names.left(), top), pos2(sheet.names.right(), bottom));
        let seen = row.intersect(sheet.names);
        if seen.height() < 2.0 {
            continue;
        }
        let is_thing = !lane.kind.is_empty();
        let response = ui.interact(seen, ui.scope_id().with(("lane", index)), Sense::click());
        let is_selected = is_thing && sheet.context.scene_editing.is_selected(&lane.name);
        response.widget_info(|| {
            WidgetInfo::selected(Role::ListItem, true, is_selected, format!("Lane of {}", lane.name))
        });
        if is_selected || response.hovered() {
            let fill = if is_selected { theme.accent_soft } else { theme.hover };
            painter.rect_filled(row.shrink2(vec2(2.0, 1.0)), CornerRadius::same(3), fill);
        }
        let first = Rect::from_min_size(row.min, vec2(row.width(), 24.0_f32.min(row.height())));
        let color = if is_selected { theme.accent } else { theme.text };
        let mark = Rect::from_center_size(pos2(row.left() + 16.0, first.center().y), vec2(16.0, 16.0));
        icon(if is_thing { lane.kind } else { &lane.name }).paint(&painter, mark, theme.weak);
        let text =
            Rect::from_min_max(pos2(row.left() + 30.0, first.top()), pos2(row.right() - 6.0, first.bottom()));
        let mut clipped = ui.new_child(egui::UiBuilder::new().max_rect(text));
        clipped.set_clip_rect(painter.clip_rect());
        let shown = widgets::cut_in_middle(ui, &lane.name, text.width(), &TextStyle::Body);
        widgets::text_in(&clipped, text, &shown, &TextStyle::Body, color);
        painter.hline(row.x_range(), bottom + 0.5, Stroke::new(1.0, theme.line.gamma_multiply(0.6)));
        if response.clicked() && is_thing {
            let choice =
                if ui.input(|input| input.modifiers.command) { Choice::Toggle } else { Choice::Replace };
            requests.push(Request::Scene(SceneRequest::SelectThings(vec![lane.name.clone()], choice)));
        }
        if is_thing {
            if response.secondary_clicked() {
                requests.push(Request::Scene(active_request(sheet.context, &lane.name)));
            }
            response.context_menu(|ui| thing_menu(ui, sheet.context, requests));
        }
        if response.double_clicked() && is_thing {
            requests.push(Request::Scene(SceneRequest::Rename(Some(lane.name.clone()))));
        }
    }
}

/// Draws the switches above the names: snapping, ripple, the whole scene.
pub(super) fn tools(ui: &mut Ui, rect: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let theme = Theme::of(ui);
    ui.painter().rect_filled(rect, CornerRadius::ZERO, theme.bar);
    ui.painter().hline(rect.x_range(), rect.bottom(), Stroke::new(1.0, theme.line));
    let mut bar = ui.new_child(
        egui::UiBuilder::new()
            .max_rect(rect.shrink2(vec2(6.0, 0.0)))
            .layout(egui::Layout::left_to_right(egui::Align::Center)),
    );
    bar.spacing_mut().item_spacing.x = 2.0;
    command_button(&mut bar, Icon::Snap, Id::ToggleSnap, context.keys.snap(), requests);
    command_button(&mut bar, Icon::Right, Id::ToggleSceneRipple, context.scene_editing.ripple(), requests);
    command_button(&mut bar, Icon::Fit, Id::FitScene, false, requests);
    command_button(&mut bar, Icon::Split, Id::CutHere, false, requests);
}
