//! The picture: transparent, so that what the graphics thread draws shows through; small tools lie over it.

mod axes;
mod cards;
mod hand;
mod ik;
mod overlay;
mod readout;
mod toolbar;

use super::state::{Request, State};
use super::style;
use super::theme::Theme;
use super::{Panel, Place};
use egui::accesskit::Role;
use egui::{Align2, CornerRadius, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};

/// The picture and what lies over it. What the mouse does there is up to the controls of the scene
/// ([`crate::control::Hands`]), which hear of it before the panels do.
#[derive(Debug, Default)]
pub struct Viewport;

impl Panel for Viewport {
    fn id(&self) -> &'static str {
        super::VIEWPORT
    }

    fn title(&self) -> &'static str {
        "Viewport"
    }

    fn place(&self) -> Place {
        Place::Middle
    }

    fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        let rect = ui.max_rect();
        requests.push(Request::Viewport(rect));
        let response = ui.interact(rect, ui.scope_id().with("picture"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Viewport"));
        overlay::pointer(ui, &response, state, requests);
        if state.view.is_some() {
            super::bone_menu::show(&response, state, state.pointed, requests);
        }
        let mut shields = Vec::new();
        if state.view.is_some() {
            overlay::drawn(ui, rect, state);
            shields.push(toolbar::toolbar(ui, rect, state, requests));
            shields.extend(hand::toolbar(ui, rect, state, requests));
            shields.extend(axes::axes(ui, rect, state, requests));
            caption(ui, rect, state);
            readout::show(ui, rect, state);
        }
        requests.push(Request::Shields(shields));
        cards::show(ui, rect, state, requests);
    }
}

/// What is seen: model and take, quietly, at the top left.
fn caption(ui: &Ui, rect: Rect, state: &State) {
    let Some(loaded) = state.loaded() else { return };
    let theme = Theme::of(ui);
    let take = match state.playback.take {
        Some(take) => state.digest.takes.get(take).map_or(String::new(), |take| take.name.clone()),
        None => "Rest pose".to_owned(),
    };
    let painter = ui.painter().with_clip_rect(rect);
    let at = pos2(rect.left() + 14.0, rect.top() + 12.0);
    let font = FontId::proportional(style::BODY);
    let place = painter.text(at, Align2::LEFT_TOP, &loaded.title, font, theme.text);
    if rect.width() > 640.0 {
        let font = FontId::proportional(style::SMALL);
        painter.text(pos2(at.x, place.bottom() + 2.0), Align2::LEFT_TOP, take, font, theme.weak);
    }
}

/// The ground of an overlay.
fn glass(ui: &Ui, rect: Rect) {
    let theme = Theme::of(ui);
    let stroke = Stroke::new(1.0, theme.glass_line);
    ui.painter().rect(rect, CornerRadius::same(6), theme.glass, stroke, egui::StrokeKind::Inside);
}

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(7.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), Stroke::new(1.0, Theme::of(ui).glass_line));
}

fn divider_across(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(16.0, 7.0), Sense::hover());
    ui.painter().hline(rect.x_range(), rect.center().y, Stroke::new(1.0, Theme::of(ui).glass_line));
}
