//! The dope sheet: a row for all bones, a row a bone, and below it its channels; keys as diamonds, and as bands where
//! they lie closer than can be seen.

mod gutter;
mod hand;
mod head;
mod markers;
mod marks;
mod menu;
mod overlay;
mod place;
mod rows;
mod scroll;

use super::context::PanelContext;
use super::keys::window::TimeScale;
use super::request::Request;
use super::theme::Theme;
use egui::{CornerRadius, Rect, Sense, Stroke, Ui, WidgetInfo};
use hand::Hand;
use marks::KeysMesh;
use place::Places;
use rows::Rows;

pub(super) use hand::{Input, readout};
pub(super) use head::{Scrub, ticks, to_frame};
pub(super) use marks::Pen;
pub(super) use menu::show as key_menu;
pub(super) use overlay::{line as playhead, shade};
pub(super) use scroll::{pan, time_bar, wheel};

/// See the module: what it remembers between frames, none of it about the document.
#[derive(Debug, Default)]
pub(super) struct Dope {
    rows: Rows,
    keys: KeysMesh,
    /// Points: how far the rows are scrolled up.
    scroll: f32,
    hand: Hand,
    head: head::Head,
    markers: markers::MarkerLane,
    menu: menu::KeyMenu,
    filter: String,
}

/// Height of a row.
pub(super) const ROW: f32 = 20.0;

impl Dope {
    /// Draws it into `rect`; a take is shown.
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        rect: Rect,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Some(drawn) = state.drawn_keys() else { return };
        self.rows.update(state, &drawn.take);
        let places = Places::of(rect, state);
        let scale = TimeScale {
            left: places.canvas.left() + place::ROOM,
            width: (places.canvas.width() - place::ROOM - place::ROOM_RIGHT).max(1.0),
            window: state.keys.window(&drawn.take),
        };
        let content = self.rows.list().len() as f32 * ROW;
        self.scroll = self.scroll.clamp(0.0, (content - places.canvas.height()).max(0.0));
        let theme = Theme::of(ui);
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.rect_filled(rect, CornerRadius::ZERO, theme.sunken);

        head::back(&painter, &places, &scale, state, theme);
        let canvas = ui.interact(places.canvas, ui.scope_id().with("keys"), Sense::click_and_drag());
        let selected = self.keys.selected();
        canvas.widget_info(|| {
            WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, format!("Keys, {selected} selected"))
        });
        overlay::rows(&painter, &places, self.scroll, &self.rows, state, theme);
        overlay::outside_range(&painter, &places, &scale, state, theme);
        self.keys.paint(&painter, &places, self.scroll, &self.rows, &scale, &drawn, state, theme);
        self.hand.update(ui, &canvas, &places, &mut self.scroll, &self.rows, &scale, &drawn, state, requests);
        self.menu.show(&canvas, &self.hand, state, requests);
        self.head.show(ui, &places, &scale, &drawn, state, requests);
        self.markers.show(ui, &places, &scale, state, requests);
        overlay::pending(&painter, &places, &scale, state, theme);
        overlay::playhead(&painter, &places, &scale, state, theme);
        gutter::show(ui, &places, self.scroll, &mut self.rows, state, requests);
        gutter::tools(ui, &places, &mut self.filter, state, requests);
        scroll::show(ui, &places, &mut self.scroll, content, &scale, &drawn.take, requests);
        painter.vline(places.canvas.left() - 0.5, rect.y_range(), Stroke::new(1.0, theme.line));
        if self.rows.is_empty() {
            overlay::nothing(&painter, &places, state, theme);
        }
        follow(&scale, state, requests);
    }
}

/// While it plays, the playhead is not lost out of sight: the window turns a page.
fn follow(scale: &TimeScale, state: &PanelContext<'_>, requests: &mut Vec<Request>) {
    use super::keys::KeysRequest;
    if !state.playback.playing {
        return;
    }
    let (time, window) = (f64::from(state.time()), scale.window);
    if time < window.start || time > window.start + window.length {
        let turned = super::keys::TimeWindow { start: time - window.length * 0.02, ..window };
        requests.push(Request::Timeline(KeysRequest::Window(Some(turned))));
    }
}
