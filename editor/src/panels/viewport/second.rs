//! Two views of a scene side by side, each with a camera of its own. The one under the pointer is the active one: the viewport.

use super::image_frame;
use crate::panels::context::PanelContext;
use crate::panels::request::Request;
use crate::panels::style;
use crate::panels::theme::Theme;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::{Align2, CursorIcon, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// Least width of either view, points.
const LEAST: f32 = 120.0;
/// Width of the line between them that can be dragged, points.
const GRIP: f32 = 6.0;

/// The places of one or two views.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewPlaces {
    /// The first one, on the left, with the toolbars.
    pub(super) first: Rect,
    /// The active one.
    pub(super) active: Rect,
}

/// Draws what is over the view that is not active, and the line between both. Without a scene and without room there is one view.
pub(super) fn show(
    ui: &Ui,
    rect: Rect,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) -> ViewPlaces {
    let is_shown = context.settings.look.second_view && context.scene().is_some();
    if !is_shown || rect.width() < 2.0 * LEAST + GRIP {
        if context.second_view.is_some() {
            requests.push(Request::SecondView(None));
        }
        return ViewPlaces { first: rect, active: rect };
    }
    let place = ui.scope_id().with("share of the second view");
    let share = ui.data(|data| data.get_temp::<f32>(place)).unwrap_or(0.5);
    let middle =
        between(rect.left() + rect.width() * (1.0 - share), rect.left() + LEAST, rect.right() - LEAST);
    let grip = Rect::from_center_size(pos2(middle, rect.center().y), vec2(GRIP, rect.height()));
    let response = ui.interact(grip, place, Sense::drag()).on_hover_cursor(CursorIcon::ResizeHorizontal);
    response.widget_info(|| WidgetInfo::labeled(Role::Splitter, true, "Width of the second view"));
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        let share = ((rect.right() - at.x) / rect.width()).clamp(0.0, 1.0);
        ui.data_mut(|data| data.insert_temp(place, share));
    }
    let first = Rect::from_min_max(rect.min, pos2(grip.left(), rect.bottom()));
    let second = Rect::from_min_max(pos2(grip.right(), rect.top()), rect.max);
    let [active, other] = if context.is_second_active { [second, first] } else { [first, second] };
    if context.second_view != Some(other) {
        requests.push(Request::SecondView(Some(other)));
    }
    let theme = Theme::of(ui);
    let color = if response.hovered() || response.dragged() { theme.accent } else { theme.line };
    ui.painter().rect_filled(grip, 0.0, theme.bar);
    ui.painter().vline(middle, rect.y_range(), Stroke::new(1.0, color));
    if *context.other_through != ThroughCamera::Free {
        image_frame::frame(ui, other, context);
    }
    let of_second = if context.is_second_active { context.through } else { context.other_through };
    let text = super::title_through(context, of_second).unwrap_or_else(|| "free camera".to_owned());
    let font = FontId::proportional(style::BODY);
    ui.painter().text(second.left_top() + vec2(14.0, 12.0), Align2::LEFT_TOP, &text, font, theme.text);
    let name =
        if context.is_second_active { "First view".to_owned() } else { format!("Second view, {text}") };
    let picture = ui.interact(other, ui.scope_id().with("second view"), Sense::hover());
    picture.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    ViewPlaces { first, active }
}
