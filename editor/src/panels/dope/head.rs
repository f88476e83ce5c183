//! The ruler: time is dragged here, the range that plays is set, and the selected keys are scaled by the bar below.

use super::place::Places;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest, TimeScale};
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use egui::{
    Align2, CornerRadius, CursorIcon, FontId, Painter, PointerButton, Rect, Response, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

/// A ruler on which time is dragged.
#[derive(Debug, Default)]
pub(in crate::panels) struct Scrub {
    /// The command that lets time go on after scrubbing.
    resume: Option<Id>,
}

/// What is held in the ruler.
#[derive(Debug, Default)]
pub(super) struct Head {
    scrub: Scrub,
    /// Scaling: what stays, and where the end was that is held.
    scaling: Option<Scaling>,
    /// The first and the last selected key, found when the selection changed.
    extent: Option<(Drawn, Option<[f32; 2]>)>,
}

/// Points: how near a key must be to be under the pointer.
const NEAR: f32 = 4.0;

#[derive(Clone, Copy, Debug)]
struct Scaling {
    /// The end that is not held, seconds.
    other: f32,
    grabbed: f32,
    begun: bool,
}

/// Lines and numbers, behind everything.
pub(super) fn back(
    painter: &Painter,
    places: &Places,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let top = Rect::from_min_max(places.all.min, pos2(places.all.right(), places.bar.bottom()));
    painter.rect_filled(top, CornerRadius::ZERO, theme.bar);
    painter.hline(top.x_range(), top.bottom(), Stroke::new(1.0, theme.line));
    let right = painter
        .with_clip_rect(Rect::from_min_max(places.head.min, places.all.max).intersect(painter.clip_rect()));
    ticks(&right, places.head, places.all.bottom(), scale, state, theme);
}

/// The lines of a ruler; also for the curves.
pub(in crate::panels) fn ticks(
    painter: &Painter,
    head: Rect,
    bottom: f32,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    theme: &Theme,
) {
    let rate = state.settings.frame_rate;
    let ruler = scale.ruler();
    let decimals = ruler.decimals(rate);
    let fine = Stroke::new(1.0, theme.line.gamma_multiply(0.55));
    for tick in ruler.ticks(rate) {
        let x = painter.round_to_pixel_center(scale.x_of(tick.time));
        if tick.major {
            painter.vline(x, head.bottom()..=bottom, fine);
            painter.vline(x, head.bottom() - 7.0..=head.bottom(), Stroke::new(1.0, theme.faint));
            let label = format!("{:.decimals$}", tick.time);
            let at = pos2(x, head.top() + 9.0);
            painter.text(at, Align2::CENTER_CENTER, label, FontId::monospace(10.0), theme.weak);
        } else {
            painter.vline(x, head.bottom() - 3.0..=head.bottom(), Stroke::new(1.0, theme.line));
        }
    }
}

impl Scrub {
    /// Takes what is done on `head`, which a screen reader calls `name`.
    pub(in crate::panels) fn show(
        &mut self,
        ui: &Ui,
        head: Rect,
        name: &'static str,
        scale: &TimeScale,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let response = ui.interact(head, ui.scope_id().with(name), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(state.time()), name));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        // From the press on, as a hand expects: not only once a movement has made it a drag, and not only
        // once a quick release has made it a click, which it is not any more when a frame took long.
        let (primary, modifiers) = ui.input(|input| (input.pointer.primary_down(), input.modifiers));
        let down = response.is_pointer_button_down_on() && primary;
        if down && state.playback.playing && self.resume.is_none() {
            // Time stands while it is held, and goes on as it went before.
            let command = if state.playback.speed < 0.0 { Id::PlayBackwards } else { Id::PlayPause };
            self.resume = Some(command);
            requests.push(Request::Command(command));
        }
        if (down || response.clicked_by(PointerButton::Primary))
            && let Some(pointer) = response.interact_pointer_pos()
        {
            // Beside what is shown its end is meant, so that the edge of the ruler is the end of a take that is seen whole.
            let window = scale.window;
            let time = f64::from(scale.time_at(pointer.x));
            let time = time.clamp(window.start, window.start + window.length) as f32;
            let snap = state.keys.snap() != modifiers.command;
            requests.push(Request::Seek(if snap { to_key_or_frame(time, scale, state) } else { time }));
        }
        if !down && let Some(command) = self.resume.take() {
            requests.push(Request::Command(command));
        }
        if response.double_clicked() {
            requests.push(Request::Command(Id::FitKeys));
        }
        response.context_menu(|ui| {
            for id in [
                Id::AddMarker,
                Id::RangeFromHere,
                Id::RangeToHere,
                Id::RangeOfKeys,
                Id::RangeWhole,
                Id::FitKeys,
            ] {
                super::super::menu::item(ui, state, id, false, requests);
            }
        });
        super::scroll::wheel(ui, &response, scale, requests);
    }
}

impl Head {
    pub(super) fn show(
        &mut self,
        ui: &mut Ui,
        places: &Places,
        scale: &TimeScale,
        drawn: &Drawn,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        self.scrub.show(ui, places.head, "Time track", scale, state, requests);
        range_ends(ui, places, scale, state, requests);
        self.bar(ui, places, scale, drawn, state, requests);
    }

    /// The bar over the selected keys: its ends scale them about each other, with Alt about the playhead.
    fn bar(
        &mut self,
        ui: &Ui,
        places: &Places,
        scale: &TimeScale,
        drawn: &Drawn,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let theme = Theme::of(ui);
        let painter = ui.painter().with_clip_rect(places.bar);
        let known = self.extent.as_ref().filter(|(of, _)| {
            of.selection.same(&drawn.selection) && std::sync::Arc::ptr_eq(&of.take, &drawn.take)
        });
        let extent = match known {
            Some((_, extent)) => *extent,
            None => self.extent.insert((drawn.clone(), drawn.selection.extent(&drawn.take))).1,
        };
        let extent = extent.map(|extent| drawn.shift.stretch(extent));
        let Some([from, to]) = extent.filter(|[from, to]| to - from > scale.seconds(6.0)) else {
            self.scaling = None;
            return;
        };
        let (left, right) = (scale.x_of(from), scale.x_of(to));
        let bar =
            Rect::from_min_max(pos2(left, places.bar.top() + 2.0), pos2(right, places.bar.bottom() - 2.0));
        painter.rect_filled(bar, CornerRadius::same(2), theme.accent_soft);
        for (end, x, name) in
            [(from, left, "Scale keys by their begin"), (to, right, "Scale keys by their end")]
        {
            let grip =
                Rect::from_center_size(pos2(x, places.bar.center().y), vec2(12.0, places.bar.height()));
            if !places.bar.expand(6.0).contains_rect(grip.shrink(4.0)) {
                continue;
            }
            let response = ui.interact(grip, ui.scope_id().with(name), Sense::drag());
            response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Button, true, name));
            let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(format!(
                "{name}\nThe other end stays; with Alt the playhead does\nCtrl inverts snapping"
            ));
            let lit = response.hovered() || response.dragged();
            let color = if lit { theme.accent } else { theme.accent.gamma_multiply(0.7) };
            painter.rect_filled(
                Rect::from_center_size(grip.center(), vec2(4.0, 8.0)),
                CornerRadius::same(2),
                color,
            );
            self.scale_by(ui, &response, end, [from, to], scale, state, requests);
        }
    }

    #[allow(clippy::too_many_arguments, reason = "a drag follows from all of it")]
    fn scale_by(
        &mut self,
        ui: &Ui,
        response: &Response,
        end: f32,
        [from, to]: [f32; 2],
        scale: &TimeScale,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        if response.drag_started_by(PointerButton::Primary) {
            let other = if end == from { to } else { from };
            self.scaling = Some(Scaling { other, grabbed: end, begun: false });
        }
        let Some(scaling) = &mut self.scaling else { return };
        let cancelled = ui.input(|input| input.pointer.secondary_down() || input.key_down(egui::Key::Escape));
        // By Escape egui ends the drag itself.
        if cancelled || response.dragged_by(PointerButton::Primary) {
            let gone = scaling.begun && !state.keys.drag().is_some_and(|drag| drag.held());
            if cancelled || gone {
                requests.push(Request::Timeline(KeysRequest::Cancel));
                self.scaling = None;
                return;
            }
            let Some(pointer) = response.interact_pointer_pos() else { return };
            let snap = state.keys.snap() != ui.input(|input| input.modifiers.command);
            let time = scale.time_at(pointer.x);
            let time = if snap { to_frame(time, state) } else { time };
            // Asked anew each time: a hand may think of it in the midst of the drag.
            let now = state.time();
            let by_playhead = ui.input(|input| input.modifiers.alt)
                && (now - scaling.grabbed).abs() > state.frame_seconds() * 0.5;
            let about = if by_playhead { now } else { scaling.other };
            let factor = (time - about) / (scaling.grabbed - about);
            // Zero would bring all keys to one time; a thousandth is as near as it gets.
            let factor =
                if factor.abs() < 1e-3 { 1e-3_f32.copysign(factor) } else { factor.clamp(-1e3, 1e3) };
            if factor.is_finite() {
                scaling.begun = true;
                requests.push(Request::Timeline(KeysRequest::Drag(KeyDragOp::Scale { about, factor })));
            }
        }
        if response.drag_stopped() && self.scaling.take().is_some() {
            requests.push(Request::Timeline(KeysRequest::Release));
        }
    }
}

/// The key or the end of the take under the pointer, or else the frame nearest to a time, seconds: a pose that is put a
/// hair beside a key would be a second key.
fn to_key_or_frame(time: f32, scale: &TimeScale, state: &PanelContext<'_>) -> f32 {
    let reach = scale.seconds(NEAR).min(state.frame_seconds() * 0.5);
    let beside = [true, false].into_iter().filter_map(|forward| state.next_key_from(time, forward));
    let end = state.take().map(|take| take.end());
    let nearest = beside.chain(end).min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
    nearest.filter(|key| (key - time).abs() <= reach).unwrap_or_else(|| to_frame(time, state))
}

/// The frame nearest to a time, seconds.
pub(in crate::panels) fn to_frame(time: f32, state: &PanelContext<'_>) -> f32 {
    let rate = state.settings.frame_rate;
    crate::panels::ruler::time_of(crate::panels::ruler::frame_of(time, rate), rate)
}

/// The ends of the range that plays, to be dragged.
fn range_ends(
    ui: &Ui,
    places: &Places,
    scale: &TimeScale,
    state: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) {
    let Some([from, to]) = state.keys.range() else { return };
    let theme = Theme::of(ui);
    let painter = ui.painter().with_clip_rect(places.head);
    let band = Rect::from_min_max(
        pos2(scale.x_of(from), places.head.bottom() - 3.0),
        pos2(scale.x_of(to), places.head.bottom()),
    );
    painter.rect_filled(band, CornerRadius::ZERO, theme.warning.gamma_multiply(0.5));
    for (time, first) in [(from, true), (to, false)] {
        let x = scale.x_of(time);
        let inward = if first { 1.0 } else { -1.0 };
        let name = if first { "Begin of the play range" } else { "End of the play range" };
        let middle = pos2(x + inward * 4.0, places.head.bottom() - 6.0);
        let grip = Rect::from_center_size(middle, vec2(10.0, 12.0));
        if !places.head.contains(grip.center()) {
            continue;
        }
        let response = ui.interact(grip, ui.scope_id().with(name), Sense::drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(time), name));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(name);
        let lit = response.hovered() || response.dragged();
        let color = if lit { theme.warning } else { theme.warning.gamma_multiply(0.8) };
        let corners = vec![
            pos2(x, places.head.bottom()),
            pos2(x, places.head.bottom() - 9.0),
            pos2(x + inward * 6.0, places.head.bottom()),
        ];
        painter.add(egui::Shape::convex_polygon(corners, color, Stroke::NONE));
        if response.dragged_by(PointerButton::Primary)
            && let Some(pointer) = response.interact_pointer_pos()
        {
            let at = to_frame(scale.time_at(pointer.x), state);
            // An end that is dragged past the other stops there.
            let range = if first {
                [at.min(to - state.frame_seconds()), to]
            } else {
                [from, at.max(from + state.frame_seconds())]
            };
            requests.push(Request::Timeline(KeysRequest::Range(Some(range))));
        }
    }
}
