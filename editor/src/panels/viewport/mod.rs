//! The viewport panel: transparent, so that the image of the graphics thread shows through, with small toolbars on top.

mod axes;
mod cards;
mod glass;
mod ik;
mod image_frame;
mod line_options;
mod overlay;
mod readout;
mod second;
mod toolbar;
mod tools;

use super::bone_menu;
use super::context::PanelContext;
use super::request::Request;
use super::scene::{SceneRequest, active_request};
use super::style;
use super::theme::Theme;
use super::{Panel, PanelPlace, PanelSubject, widgets};
use dragonfly_picture::ThroughCamera;
use egui::accesskit::Role;
use egui::text::{LayoutJob, TextWrapping};
use egui::{Color32, FontId, Pos2, Rect, Response, Sense, Ui, WidgetInfo, pos2};
use std::borrow::Cow;

/// The viewport and its overlays. Mouse input in it goes to the controls of the scene ([`crate::control::ViewportTools`])
/// before the panels get it.
#[derive(Debug, Default)]
pub struct Viewport;

impl Panel for Viewport {
    fn id(&self) -> &'static str {
        super::VIEWPORT
    }

    fn title(&self) -> &'static str {
        "Viewport"
    }

    fn place(&self) -> PanelPlace {
        PanelPlace::Middle
    }

    fn subject(&self) -> PanelSubject {
        PanelSubject::Any
    }

    fn show(&mut self, ui: &mut Ui, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
        let second::ViewPlaces { first, active: rect, second } =
            second::show(ui, ui.max_rect(), context, requests);
        requests.push(Request::Viewport(rect));
        let response = ui.interact(rect, ui.scope_id().with("picture"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Viewport"));
        overlay::pointer(ui, &response, context, requests);
        if context.scene().is_some() {
            edit_model(&response, context, requests);
            thing_menu(&response, context, requests);
        } else if context.view.is_some() {
            bone_menu::show(&response, context, context.pointed, requests);
        }
        let mut shields = Vec::new();
        if context.view.is_some() {
            image_frame::show(ui, rect, context);
            overlay::drawn(ui, rect, context);
            let tools = toolbar::toolbar(ui, first, context, requests);
            shields.push(tools);
            let column = tools::toolbar(ui, first, context, requests);
            shields.extend(column);
            let left = column.map_or(first.left(), |column| column.right()) + 10.0;
            shields.extend(axes::axes(ui, rect, context, requests));
            shields.extend(second.map(|second| second::title(ui, second, context, requests)));
            let bottom = caption(ui, first, [left, tools.left()], context);
            let place = pos2(left, (first.top() + 52.0).max(bottom + 6.0));
            shields.extend(line_options::show(ui, first, place, context, requests));
            readout::show(ui, rect, context);
        }
        requests.push(Request::Shields(shields));
        cards::show(ui, first, context, requests);
    }
}

/// The name of the free camera.
const FREE: &str = "Free camera";

/// Least width of the name of a camera next to the toolbar, points; in a narrower view it is below.
const LEAST_NAME: f32 = 120.0;

/// Draws the names of model and take at the top left, as far as `right`; long names are truncated. `left` is where there are no tools below the
/// toolbar. Returns the lower edge.
fn caption(ui: &Ui, rect: Rect, [left, right]: [f32; 2], context: &PanelContext<'_>) -> f32 {
    let Some(view) = context.view else { return rect.top() };
    let theme = Theme::of(ui);
    let take = match context.playback.take {
        Some(take) => context.digest.takes.get(take).map_or("", |take| take.name.as_str()),
        None => "Rest pose",
    };
    // The layer whose keys are edited.
    let layer = context.layer().and_then(|layer| context.layers().get(layer));
    let take = match layer {
        Some(layer) => Cow::Owned(format!("{take}  ·  layer {}", layer.settings.name)),
        None => Cow::Borrowed(take),
    };
    let at = pos2(rect.left() + 14.0, rect.top() + 12.0);
    let width = right - at.x - 12.0;
    if let Some(scene) = &view.scene {
        let title = match (camera_title(context), context.second_view) {
            // Each of two views has the name of its camera.
            (camera, Some(_)) => camera.unwrap_or_else(|| FREE.to_owned()),
            (Some(camera), None) => format!("{}  ·  {camera}", view.file.title),
            (None, None) => view.file.title.clone(),
        };
        if context.second_view.is_some() && width < LEAST_NAME {
            let at = pos2(left, rect.top() + 52.0);
            let width = rect.right() - left - 10.0;
            return name(ui, at, width, &title, "scene", (style::BODY, theme.text));
        }
        let bottom = name(ui, at, width, &title, "scene", (style::BODY, theme.text));
        if rect.width() <= 640.0 {
            return bottom;
        }
        let things = scene.plan.as_ref().map_or(0, |plan| plan.things().len());
        let text = widgets::count(things, "thing", "things");
        return name(ui, pos2(at.x, bottom + 2.0), width, &text, "cast", (style::SMALL, theme.weak));
    }
    let bottom = name(ui, at, width, &view.file.title, "model", (style::BODY, theme.text));
    match rect.width() > 640.0 {
        true => name(ui, pos2(at.x, bottom + 2.0), width, &take, "take", (style::SMALL, theme.weak)),
        false => bottom,
    }
}

/// Returns the name of the camera through which the first view looks; `None` for the free one.
fn camera_title(context: &PanelContext<'_>) -> Option<String> {
    match context.is_second_active {
        true => title_through(context, context.other_through),
        false => {
            let attached = if context.is_camera_attached { "  ·  camera to view" } else { "" };
            title_through(context, context.through).map(|title| format!("{title}{attached}"))
        }
    }
}

/// Returns the name of the camera through which a view looks; `None` for the free one.
fn title_through(context: &PanelContext<'_>, through: &ThroughCamera) -> Option<String> {
    match through {
        ThroughCamera::Free => None,
        ThroughCamera::Shot => Some(format!("shot: {}", context.shot_camera().unwrap_or("no camera"))),
        ThroughCamera::Of(id) => Some(id.to_string()),
    }
}

/// Opens the model of the thing under the pointer after a double click.
fn edit_model(response: &Response, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let Some(thing) = context.stage.hovered().filter(|_| response.double_clicked()) else { return };
    let plan = context.scene().and_then(|scene| scene.plan.as_ref());
    let planned = plan.and_then(|plan| plan.things().get(plan.thing_called(thing)?));
    if planned.is_some_and(|planned| matches!(planned.kind, "role" | "prop")) {
        requests.push(Request::Scene(SceneRequest::EditModel(Box::from(&**thing))));
    }
}

/// Opens the menu of a thing of the scene where the right button was clicked. A thing there that is not selected is selected first.
fn thing_menu(response: &Response, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    let open = bone_menu::is_asked(response);
    if let Some(thing) = context.stage.hovered().filter(|_| open) {
        requests.push(Request::Scene(active_request(context, thing)));
    }
    bone_menu::at_pointer(response, open, |ui| super::scene::thing_menu(ui, context, requests));
}

/// Draws a name on one line, with the whole name as tooltip if it is truncated. Returns its lower edge.
fn name(ui: &Ui, at: Pos2, width: f32, text: &str, what: &str, (size, color): (f32, Color32)) -> f32 {
    let mut job = LayoutJob::simple_singleline(text.to_owned(), FontId::proportional(size), color);
    job.wrap = TextWrapping::truncate_at_width(width.max(0.0));
    let galley = ui.painter().layout_job(job);
    let (place, cut) = (Rect::from_min_size(at, galley.size()), galley.elided);
    ui.painter().galley(at, galley, color);
    let response = ui.interact(place, ui.scope_id().with(("name", what)), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Label, true, format!("Shown {what}: {text}")));
    if cut {
        response.on_hover_text(widgets::shortened(text));
    }
    place.bottom()
}
