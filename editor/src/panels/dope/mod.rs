//! The dope sheet: a row for all bones, a row for each bone, and the channels of open bones. Keys are diamonds, or
//! bands where they are too dense.

mod areas;
mod buttonless;
mod contacts;
mod drag;
mod event_text;
mod events;
mod fade;
mod findings;
mod gutter;
mod head;
mod lane_drag;
mod markers;
mod marks;
mod menu;
mod overlay;
mod rows;
mod scroll;
mod sheet;
mod sound;
mod weight;

use super::context::PanelContext;
use super::key_canvases;
use super::keys::{KeyPanel, TimeScale};
use super::request::Request;
use super::theme::Theme;
use areas::DopeAreas;
pub(super) use buttonless::ButtonlessTimes;
use drag::DopeDrag;
use dragonfly_picture::between;
use egui::{CornerRadius, Rect, Sense, Stroke, Ui, WidgetInfo};
use marks::KeysMesh;
use rows::DopeRows;
use sheet::Sheet;

pub(super) use head::{Scrub, ScrubRuler, range_ends, ticks, to_frame};
pub(super) use marks::Pen;
pub(super) use menu::show as key_menu;
pub(super) use overlay::{line as playhead, shade};
pub(super) use scroll::{pan, time_bar, wheel};
pub(super) use sheet::ROW;

/// The dope sheet with its view state; it contains nothing of the document.
#[derive(Debug, Default)]
pub(super) struct Dope {
    rows: DopeRows,
    keys: KeysMesh,
    /// Number of points by which the rows are scrolled up.
    scroll: f32,
    drag: DopeDrag,
    head: head::Head,
    markers: markers::MarkerLane,
    events: events::EventLane,
    contacts: contacts::ContactLane,
    sound: sound::SoundLane,
    weight: weight::WeightLane,
    menu: menu::KeyMenu,
    filter: String,
}

impl Dope {
    /// Draws the dope sheet into `rect`; a take must be shown.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Some(drawn) = context.drawn_keys() else { return };
        self.rows.update(context, &drawn.take);
        let areas = DopeAreas::of(rect, context);
        let scale = TimeScale {
            left: areas.canvas.left() + areas::ROOM,
            width: (areas.canvas.width() - areas::ROOM - areas::ROOM_RIGHT).max(1.0),
            window: context.keys.window(&drawn.take),
        };
        let theme = Theme::of(ui);
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.rect_filled(rect, CornerRadius::ZERO, theme.sunken);
        head::back(&painter, &areas, &scale, context, theme);

        let canvas = ui.interact(areas.canvas, ui.scope_id().with("keys"), Sense::click_and_drag());
        key_canvases::note(ui.ctx(), KeyPanel::Timeline, areas.canvas);
        let selected = self.keys.selected();
        canvas.widget_info(|| {
            WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, format!("Keys, {selected} selected"))
        });
        let content = self.rows.list().len() as f32 * ROW;
        let scroll = self.scroll - scroll::pan(ui, &canvas, &scale, requests);
        self.scroll = between(scroll, 0.0, content - areas.canvas.height());
        scroll::wheel(ui, &canvas, &scale, requests);
        let sheet = Sheet {
            areas: &areas,
            rows: &self.rows,
            scroll: self.scroll,
            scale: &scale,
            drawn: &drawn,
            context,
            theme,
        };
        overlay::rows(&painter, &sheet);
        overlay::outside_range(&painter, &sheet);
        fade::paint(&painter, &sheet);
        self.keys.paint(&painter, &sheet);
        self.scroll = (self.scroll + self.drag.update(ui, &canvas, &sheet, requests)).max(0.0);
        self.menu.show(&canvas, &self.drag, context, requests);
        self.head.show(ui, &sheet, requests);
        findings::show(ui, &sheet, requests);
        self.markers.show(ui, &sheet, requests);
        self.events.show(ui, &sheet, requests);
        self.contacts.show(ui, &sheet, requests);
        self.sound.show(ui, &sheet, requests);
        self.weight.show(ui, &sheet, requests);
        overlay::pending(&painter, &sheet);
        overlay::playhead(&painter, &sheet);
        let toggled = gutter::show(ui, &sheet, requests);
        gutter::tools(ui, &areas, &mut self.filter, context, requests);
        if self.rows.is_empty() {
            overlay::nothing(&painter, &sheet);
        }
        if let Some(bone) = toggled {
            self.rows.toggle(bone);
        }
        scroll::show(ui, &areas, &mut self.scroll, content, &scale, &drawn.take, requests);
        painter.vline(areas.canvas.left() - 0.5, rect.y_range(), Stroke::new(1.0, theme.line));
        follow(&scale, context, requests);
    }
}

/// Moves the window by a page when the playhead leaves it during playback.
fn follow(scale: &TimeScale, context: &PanelContext<'_>, requests: &mut Vec<Request>) {
    use super::keys::KeysRequest;
    if !context.playback.playing {
        return;
    }
    let (time, window) = (f64::from(context.time()), scale.window);
    if time < window.start || time > window.start + window.length {
        let turned = super::keys::TimeWindow { start: time - window.length * 0.02, ..window };
        requests.push(Request::Timeline(KeysRequest::Window(Some(turned))));
    }
}
