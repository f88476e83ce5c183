//! The ruler: drags of the playhead and of the play range, and the bar that scales the selected keys.

use super::areas::DopeAreas;
use super::sheet::Sheet;
use crate::panels::commands::Id;
use crate::panels::context::PanelContext;
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput};
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest, TimeScale};
use crate::panels::request::Request;
use crate::panels::ruler::frame_of;
use crate::panels::theme::Theme;
use dragonfly_picture::between;
use egui::{
    Align2, CornerRadius, CursorIcon, FontId, Painter, PointerButton, Rect, Response, Sense, Stroke, Ui,
    WidgetInfo, pos2, vec2,
};

/// A ruler on which the playhead is dragged.
#[derive(Debug, Default)]
pub(in crate::panels) struct Scrub {
    /// The command that resumes playback after scrubbing.
    resume: Option<Id>,
}

/// A ruler on which the playhead is dragged, in one frame.
#[derive(Clone, Copy)]
pub(in crate::panels) struct ScrubRuler<'a> {
    pub(in crate::panels) head: Rect,
    /// Its accessible name.
    pub(in crate::panels) name: &'static str,
    pub(in crate::panels) scale: &'a TimeScale,
    pub(in crate::panels) context: &'a PanelContext<'a>,
}

/// The drags on the ruler.
#[derive(Debug, Default)]
pub(super) struct Head {
    scrub: Scrub,
    scaling: PanelDrag<(), Scaling>,
    /// Name of the end of the bar that is dragged.
    grip: Option<&'static str>,
    /// Times of the first and the last selected key, computed when the selection changed.
    extent: Option<(Drawn, Option<[f32; 2]>)>,
}

/// Distance within which a key is under the pointer, points.
const NEAR: f32 = 4.0;

/// The bar over the selected keys, while one of its ends is dragged.
#[derive(Clone, Copy, Debug)]
struct Scaling {
    /// Time of the end that is not dragged, seconds.
    other: f32,
    /// Time of the dragged end when the drag began, seconds.
    grabbed: f32,
    /// Whether the drag was requested. If no drag exists after that, it was refused or cancelled.
    requested: bool,
}

/// Draws the background of the ruler, its lines and numbers.
pub(super) fn back(
    painter: &Painter,
    areas: &DopeAreas,
    scale: &TimeScale,
    context: &PanelContext<'_>,
    theme: &Theme,
) {
    let top = Rect::from_min_max(areas.all.min, pos2(areas.all.right(), areas.bar.bottom()));
    painter.rect_filled(top, CornerRadius::ZERO, theme.bar);
    painter.hline(top.x_range(), top.bottom(), Stroke::new(1.0, theme.line));
    let right = painter
        .with_clip_rect(Rect::from_min_max(areas.head.min, areas.all.max).intersect(painter.clip_rect()));
    ticks(&right, areas.head, areas.all.bottom(), scale, context, theme);
}

/// Draws the lines and numbers of a ruler; also used by the curves.
pub(in crate::panels) fn ticks(
    painter: &Painter,
    head: Rect,
    bottom: f32,
    scale: &TimeScale,
    context: &PanelContext<'_>,
    theme: &Theme,
) {
    let rate = context.frames_per_second();
    let ruler = scale.ruler();
    let decimals = ruler.decimals(rate);
    let seconds = context.keys.ruler_in_seconds();
    let fine = Stroke::new(1.0, theme.line.gamma_multiply(0.55));
    for tick in ruler.ticks(rate) {
        let x = painter.round_to_pixel_center(scale.x_of(tick.time));
        if tick.major {
            painter.vline(x, head.bottom()..=bottom, fine);
            painter.vline(x, head.bottom() - 7.0..=head.bottom(), Stroke::new(1.0, theme.faint));
            let label = if seconds {
                format!("{:.decimals$}", tick.time)
            } else {
                frame_of(tick.time, rate).to_string()
            };
            let at = pos2(x, head.top() + 9.0);
            painter.text(at, Align2::CENTER_CENTER, label, FontId::monospace(10.0), theme.weak);
        } else {
            painter.vline(x, head.bottom() - 3.0..=head.bottom(), Stroke::new(1.0, theme.line));
        }
    }
}

impl Scrub {
    /// Lets the playhead follow the pointer on a ruler, and returns the ruler's response. `seconds` returns where the playhead goes for a
    /// time under the pointer, with snapping or without it; `None` leaves the playhead where it is.
    pub(in crate::panels) fn follow(
        &mut self,
        ui: &Ui,
        ruler: &ScrubRuler<'_>,
        seconds: impl FnOnce(f32, bool) -> Option<f32>,
        requests: &mut Vec<Request>,
    ) -> Response {
        let ScrubRuler { head, name, scale, context } = *ruler;
        let response = ui.interact(head, ui.scope_id().with(name), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(context.time()), name));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        // Scrubbing starts with the press: a drag starts only after a movement, and a press is a click only after a
        // quick release, which a slow frame can miss.
        let (primary, modifiers) = ui.input(|input| (input.pointer.primary_down(), input.modifiers));
        let down = response.is_pointer_button_down_on() && primary;
        if down && context.playback.playing && self.resume.is_none() {
            // Playback pauses while the pointer is down, and resumes in the same direction.
            let command = if context.playback.speed < 0.0 { Id::PlayBackwards } else { Id::PlayPause };
            self.resume = Some(command);
            requests.push(Request::Command(command));
        }
        if (down || response.clicked_by(PointerButton::Primary))
            && let Some(pointer) = response.interact_pointer_pos()
        {
            // A pointer beyond the visible part means its end, so that the edge of the ruler is the end of a take that
            // is shown whole.
            let window = scale.window;
            let time = f64::from(scale.time_at(pointer.x));
            let time = between(time, window.start, window.start + window.length) as f32;
            let snaps = context.keys.snap() != modifiers.command;
            requests.extend(seconds(time, snaps).map(Request::Seek));
        }
        if !down && let Some(command) = self.resume.take() {
            requests.push(Request::Command(command));
        }
        response
    }

    /// Handles input on `head`; `name` is its accessible name.
    pub(in crate::panels) fn show(
        &mut self,
        ui: &Ui,
        head: Rect,
        name: &'static str,
        scale: &TimeScale,
        context: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let ruler = ScrubRuler { head, name, scale, context };
        let seconds =
            |time: f32, snaps: bool| Some(if snaps { to_key_or_frame(time, scale, context) } else { time });
        let response = self.follow(ui, &ruler, seconds, requests);
        if response.double_clicked() {
            requests.push(Request::Command(Id::FitKeys));
        }
        response.context_menu(|ui| {
            for id in [
                Id::AddMarker,
                Id::AddEvent,
                Id::RangeFromHere,
                Id::RangeToHere,
                Id::RangeOfKeys,
                Id::RangeWhole,
                Id::FitKeys,
            ] {
                super::super::menu::item(ui, context, id, false, requests);
            }
            ui.separator();
            let seconds = context.keys.ruler_in_seconds();
            super::super::menu::item(ui, context, Id::ToggleRulerSeconds, seconds, requests);
        });
        super::scroll::wheel(ui, &response, scale, requests);
    }
}

impl Head {
    pub(super) fn show(&mut self, ui: &mut Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, scale, context, .. } = *sheet;
        self.scrub.show(ui, areas.head, "Time track", scale, context, requests);
        range_ends(ui, areas.head, scale, context, requests);
        self.bar(ui, sheet, requests);
    }

    /// Draws the bar over the selected keys. Its ends scale the keys about each other, with Alt about the playhead.
    fn bar(&mut self, ui: &Ui, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let Sheet { areas, scale, drawn, theme, .. } = *sheet;
        let painter = ui.painter().with_clip_rect(areas.bar);
        let known = self.extent.as_ref().filter(|(of, _)| {
            of.selection.same(&drawn.selection) && std::sync::Arc::ptr_eq(&of.take, &drawn.take)
        });
        let extent = match known {
            Some((_, extent)) => *extent,
            None => self.extent.insert((drawn.clone(), drawn.selection.extent(&drawn.take))).1,
        };
        let Some([from, to]) = extent.filter(|[from, to]| to - from > scale.seconds(6.0)) else {
            self.scaling = PanelDrag::default();
            return;
        };
        let (left, right) = (scale.x_of(from), scale.x_of(to));
        let bar =
            Rect::from_min_max(pos2(left, areas.bar.top() + 2.0), pos2(right, areas.bar.bottom() - 2.0));
        painter.rect_filled(bar, CornerRadius::same(2), theme.accent_soft);
        for (end, x, name) in
            [(from, left, "Scale keys by their start"), (to, right, "Scale keys by their end")]
        {
            let grip = Rect::from_center_size(pos2(x, areas.bar.center().y), vec2(12.0, areas.bar.height()));
            if !areas.bar.expand(6.0).contains_rect(grip.shrink(4.0)) {
                continue;
            }
            let response = ui.interact(grip, ui.scope_id().with(name), Sense::drag());
            response.widget_info(|| WidgetInfo::labeled(egui::accesskit::Role::Button, true, name));
            let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(format!(
                "{name}\nAbout the other end, with Alt about the playhead\nHold 2 at the end to slow the part of all bones and move all later keys\nCtrl inverts snapping"
            ));
            let lit = response.hovered() || response.dragged();
            let color = if lit { theme.accent } else { theme.accent.gamma_multiply(0.7) };
            painter.rect_filled(
                Rect::from_center_size(grip.center(), vec2(4.0, 8.0)),
                CornerRadius::same(2),
                color,
            );
            if response.drag_started_by(PointerButton::Primary) {
                let other = if end == from { to } else { from };
                self.scaling = PanelDrag::dragging(Scaling { other, grabbed: end, requested: false });
                self.grip = Some(name);
            }
            if self.grip == Some(name) {
                self.scale_by(ui, &response, sheet, requests);
            }
        }
    }

    fn scale_by(&mut self, ui: &Ui, response: &Response, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
        let context = sheet.context;
        let input = PointerInput::of_widget(ui, response);
        match self.scaling.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(pointer) => {
                let Some(scaling) = self.scaling.drag_mut() else { return };
                if scaling.requested && !context.keys.is_dragging() {
                    return self.scaling.spend();
                }
                if let Some(op) = scaling.op(pointer.x, &input, sheet) {
                    scaling.requested = true;
                    requests.push(Request::Timeline(KeysRequest::Drag(op)));
                }
            }
            DragEvent::Dropped(_) => requests.push(Request::Timeline(KeysRequest::Release)),
            DragEvent::Cancelled(_) => requests.push(Request::Timeline(KeysRequest::Cancel)),
            DragEvent::Nothing | DragEvent::Pressed | DragEvent::Started(_) | DragEvent::Clicked(_) => {}
        }
        if !self.scaling.is_busy() {
            self.grip = None;
        }
    }
}

impl Scaling {
    /// Returns the operation that brings the dragged end to `x`; `None` if no factor does.
    fn op(&self, x: f32, input: &PointerInput, sheet: &Sheet<'_>) -> Option<KeyDragOp> {
        let context = sheet.context;
        let snap = context.keys.snap() != input.modifiers.command;
        let time = sheet.scale.time_at(x);
        let time = if snap { to_frame(time, context) } else { time };
        // Read in every frame: Alt may be pressed in the middle of the drag.
        let now = context.time();
        let by_playhead = input.modifiers.alt && (now - self.grabbed).abs() > context.frame_seconds() * 0.5;
        let about = if by_playhead { now } else { self.other };
        let factor = (time - about) / (self.grabbed - about);
        // Zero would bring all keys to one time, so a thousandth is the least.
        let factor = if factor.abs() < 1e-3 { 1e-3_f32.copysign(factor) } else { factor.clamp(-1e3, 1e3) };
        let slows = input.ripple && self.grabbed > self.other;
        let op = if slows {
            KeyDragOp::Stretch { part: [self.other, self.grabbed], factor: factor.max(1e-3) }
        } else {
            KeyDragOp::Scale { about, factor }
        };
        factor.is_finite().then_some(op)
    }
}

/// Returns the key or the end of the take under the pointer, or else the frame nearest to a time, seconds. A pose set
/// slightly off a key would add a second key.
fn to_key_or_frame(time: f32, scale: &TimeScale, context: &PanelContext<'_>) -> f32 {
    let reach = scale.seconds(NEAR).min(context.frame_seconds() * 0.5);
    let beside = [true, false].into_iter().filter_map(|forward| context.next_key_from(time, forward));
    let end = context.shown_take().map(|take| take.end());
    let nearest = beside.chain(end).min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
    nearest.filter(|key| (key - time).abs() <= reach).unwrap_or_else(|| to_frame(time, context))
}

/// Returns the frame nearest to a time, seconds.
pub(in crate::panels) fn to_frame(time: f32, context: &PanelContext<'_>) -> f32 {
    let rate = context.frames_per_second();
    crate::panels::ruler::time_of(crate::panels::ruler::frame_of(time, rate), rate)
}

/// Draws the ends of the play range, which can be dragged.
pub(in crate::panels) fn range_ends(
    ui: &Ui,
    head: Rect,
    scale: &TimeScale,
    context: &PanelContext<'_>,
    requests: &mut Vec<Request>,
) {
    let Some([from, to]) = context.keys.range() else { return };
    let theme = Theme::of(ui);
    let painter = ui.painter().with_clip_rect(head);
    let band =
        Rect::from_min_max(pos2(scale.x_of(from), head.bottom() - 3.0), pos2(scale.x_of(to), head.bottom()));
    painter.rect_filled(band, CornerRadius::ZERO, theme.warning.gamma_multiply(0.5));
    for (time, first) in [(from, true), (to, false)] {
        let x = scale.x_of(time);
        let inward = if first { 1.0 } else { -1.0 };
        let name = if first { "Start of the play range" } else { "End of the play range" };
        let middle = pos2(x + inward * 4.0, head.bottom() - 6.0);
        let grip = Rect::from_center_size(middle, vec2(10.0, 12.0));
        if !head.contains(grip.center()) {
            continue;
        }
        let response = ui.interact(grip, ui.scope_id().with(name), Sense::drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(time), name));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal).on_hover_text(name);
        let lit = response.hovered() || response.dragged();
        let color = if lit { theme.warning } else { theme.warning.gamma_multiply(0.8) };
        let corners =
            vec![pos2(x, head.bottom()), pos2(x, head.bottom() - 9.0), pos2(x + inward * 6.0, head.bottom())];
        painter.add(egui::Shape::convex_polygon(corners, color, Stroke::NONE));
        if response.dragged_by(PointerButton::Primary)
            && let Some(pointer) = response.interact_pointer_pos()
        {
            let at = to_frame(scale.time_at(pointer.x), context);
            // An end that is dragged past the other one stops there.
            let range = if first {
                [at.min(to - context.frame_seconds()), to]
            } else {
                [from, at.max(from + context.frame_seconds())]
            };
            requests.push(Request::Timeline(KeysRequest::Range(Some(range))));
        }
    }
}
