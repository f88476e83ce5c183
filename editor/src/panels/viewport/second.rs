//! Two views of a scene side by side, each with a camera of its own. The one under the pointer is the active one: the viewport.

use super::image_frame;
use crate::panels::context::PanelContext;
use crate::panels::icons::Icon;
use crate::panels::request::Request;
use crate::panels::scene::SceneRequest;
use crate::panels::style;
use crate::panels::theme::Theme;
use crate::panels::widgets::focus_ring;
use dragonfly_picture::ThroughCamera;
use dragonfly_picture::between;
use egui::accesskit::Role;
use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Button, CornerRadius, CursorIcon, FontId, Popup, Rect, RichText, Sense, Stroke, TextWrapMode, Ui,
    WidgetInfo, pos2, vec2,
};
use std::sync::Arc;

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
    /// The second one, if it is shown.
    pub(super) second: Option<Rect>,
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
        return ViewPlaces { first: rect, active: rect, second: None };
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
    let text = super::title_through(context, of_second(context)).unwrap_or_else(|| "free camera".to_owned());
    let name =
        if context.is_second_active { "First view".to_owned() } else { format!("Second view, {text}") };
    let picture = ui.interact(other, ui.scope_id().with("second view"), Sense::hover());
    picture.widget_info(|| WidgetInfo::labeled(Role::Image, true, &name));
    ViewPlaces { first, active, second: Some(second) }
}

fn of_second<'a>(context: &PanelContext<'a>) -> &'a ThroughCamera {
    if context.is_second_active { context.through } else { context.other_through }
}

/// Draws the name of the camera of the second view, which opens the choice of another one. Returns its area.
pub(super) fn title(ui: &Ui, second: Rect, context: &PanelContext<'_>, requests: &mut Vec<Request>) -> Rect {
    let (theme, through) = (Theme::of(ui), of_second(context));
    let text = super::title_through(context, through).unwrap_or_else(|| super::FREE.to_owned());
    let mut job = LayoutJob::simple_singleline(text.clone(), FontId::proportional(style::BODY), theme.text);
    job.wrap = TextWrapping::truncate_at_width((second.width() - 52.0).max(0.0));
    let galley = ui.painter().layout_job(job);
    let at = second.left_top() + vec2(14.0, 12.0);
    let place = Rect::from_min_size(at, galley.size() + vec2(20.0, 0.0)).expand(4.0);
    let response = ui.interact(place, ui.scope_id().with("camera of the second view"), Sense::click());
    let name = format!("Camera of the second view: {text}");
    response.widget_info(|| WidgetInfo::labeled(Role::Button, ui.is_enabled(), &name));
    if response.hovered() || response.is_pointer_button_down_on() {
        ui.painter().rect_filled(place, CornerRadius::same(style::RADIUS), theme.hover);
    }
    let mark = pos2(at.x + galley.size().x + 11.0, place.center().y);
    Icon::Down.paint(ui.painter(), Rect::from_center_size(mark, vec2(16.0, 16.0)), theme.weak);
    ui.painter().galley(at, galley, theme.text);
    focus_ring(ui, &response, place);
    Popup::menu(&response).show(|ui| {
        ui.style_mut().wrap_mode = Some(TextWrapMode::Extend);
        choice(ui, context, through, requests);
    });
    place
}

/// Draws the entries that choose through which camera the second view looks.
fn choice(ui: &mut Ui, context: &PanelContext<'_>, through: &ThroughCamera, requests: &mut Vec<Request>) {
    let plan = context.scene().and_then(|scene| scene.plan.as_ref());
    let things = plan.into_iter().flat_map(|plan| plan.things());
    let cameras = things
        .filter(|thing| thing.kind == "camera")
        .map(|camera| (ThroughCamera::Of(Arc::from(&*camera.id)), camera.id.to_string()));
    let others = [
        (ThroughCamera::Free, super::FREE.to_owned()),
        (ThroughCamera::Shot, "Camera of the shot".to_owned()),
    ];
    for (camera, title) in others.into_iter().chain(cameras) {
        let color = if camera == *through { Theme::of(ui).accent } else { Theme::of(ui).text };
        let button = Button::new(RichText::new(title).color(color)).frame_when_inactive(false);
        if ui.add(button).clicked() {
            requests.push(Request::Scene(SceneRequest::ThroughSecond(camera)));
            ui.close();
        }
    }
}
