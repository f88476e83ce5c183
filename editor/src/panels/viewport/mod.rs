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
            let caption = Caption::of(ui, context);
            let tools = toolbar::toolbar(ui, first, caption.least() + NAME + GAP, context, requests);
            shields.push(tools);
            let column = tools::toolbar(ui, first, context, requests);
            shields.extend(column);
            let left = column.map_or(first.left(), |column| column.right()) + 10.0;
            shields.extend(axes::axes(ui, rect, context, requests));
            shields.extend(second.map(|second| second::title(ui, second, context, requests)));
            let bottom = caption.show(ui, first, [left, tools.left()], context);
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

/// Width that a name has next to the toolbar at least, unless it is shorter, points.
const LEAST_NAME: f32 = 120.0;
/// Distances of the name from the edge of the viewport and from the toolbar, points.
const NAME: f32 = 14.0;
const GAP: f32 = 12.0;

/// The names of model and take, or of scene and camera, at the top left.
struct Caption {
    title: String,
    /// Width of the title, points.
    width: f32,
}

impl Caption {
    fn of(ui: &Ui, context: &PanelContext<'_>) -> Self {
        let title = match context.view {
            Some(view) if view.scene.is_some() => match (camera_title(context), context.second_view) {
                // Each of two views has the name of its camera.
                (camera, Some(_)) => camera.unwrap_or_else(|| FREE.to_owned()),
                (Some(camera), None) => format!("{}  ·  {camera}", view.file.title),
                (None, None) => view.file.title.clone(),
            },
            Some(view) if view.waiting_scene.is_some() => context.name_in_scene(&view.file.title),
            Some(view) => view.file.title.clone(),
            None => String::new(),
        };
        let galley =
            ui.painter().layout_no_wrap(title.clone(), FontId::proportional(style::BODY), Color32::WHITE);
        // A point more, so that rounding truncates nothing.
        Self { title, width: galley.size().x.ceil() + 1.0 }
    }

    /// Returns the width that it has next to the toolbar at least, points; in a view that is too narrow for that it is below.
    fn least(&self) -> f32 {
        self.width.min(LEAST_NAME)
    }

    /// Draws the names as far as `right`; long names are truncated. `left` is where there are no tools below the toolbar. Returns the lower edge.
    fn show(&self, ui: &Ui, rect: Rect, [left, right]: [f32; 2], context: &PanelContext<'_>) -> f32 {
        let Some(view) = context.view else { return rect.top() };
        let theme = Theme::of(ui);
        let at = pos2(rect.left() + NAME, rect.top() + 12.0);
        let width = right - at.x - GAP;
        let what = if view.scene.is_some() { "scene" } else { "model" };
        let big = (style::BODY, theme.text);
        if context.second_view.is_some() && width < self.least() - 0.5 {
            let at = pos2(left, rect.top() + 52.0);
            return name(ui, at, rect.right() - left - 10.0, &self.title, what, big);
        }
        let bottom = name(ui, at, width, &self.title, what, big);
        if rect.width() <= 640.0 {
            return bottom;
        }
        let (text, what) = match &view.scene {
            Some(scene) => {
                let things = scene.plan.as_ref().map_or(0, |plan| plan.things().len());
                (Cow::Owned(widgets::count(things, "thing", "things")), "cast")
            }
            None => (take_title(context), "take"),
        };
        name(ui, pos2(at.x, bottom + 2.0), width, &text, what, (style::SMALL, theme.weak))
    }
}

/// Returns the name of the take that is shown, with the layer whose keys are edited.
fn take_title<'a>(context: &PanelContext<'a>) -> Cow<'a, str> {
    let take = match context.playback.take {
        Some(take) => context.digest.takes.get(take).map_or("", |take| take.name.as_str()),
        None => "Rest pose",
    };
    let layer = context.layer().and_then(|layer| context.layers().get(layer));
    match layer {
        Some(layer) => Cow::Owned(format!("{take}  ·  layer {}", layer.settings.name)),
        None => Cow::Borrowed(take),
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
