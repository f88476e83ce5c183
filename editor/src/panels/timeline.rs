//! Time from left to right: ruler, keys, playhead; dragged anywhere.

use super::commands::Id;
use super::ruler::{self, Ruler};
use super::state::{Request, State};
use super::style::{self, GRID};
use super::theme::Theme;
use super::{Panel, Place, transport, widgets};
use egui::{
    Align2, Color32, CornerRadius, CursorIcon, FontId, Painter, Rect, Sense, Shape, Stroke, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};

/// Transport and timeline.
#[derive(Debug, Default)]
pub struct Timeline {
    /// The command that lets time go on after scrubbing.
    resume: Option<Id>,
}

const RULER: f32 = 24.0;
const LANE: f32 = 22.0;
const GUTTER: f32 = 104.0;

impl Panel for Timeline {
    fn id(&self) -> &'static str {
        "timeline"
    }

    fn title(&self) -> &'static str {
        "Timeline"
    }

    fn place(&self) -> Place {
        Place::Below
    }

    fn show(&mut self, ui: &mut Ui, state: &State, requests: &mut Vec<Request>) {
        ui.spacing_mut().item_spacing.y = 0.0;
        transport::show(ui, state, requests);
        let rect = ui.available_rect_before_wrap();
        if rect.height() < RULER || rect.width() < GUTTER + 40.0 {
            return;
        }
        if state.take().is_none() {
            let text = if state.view.is_none() { "Keys appear here" } else { "The rest pose does not move" };
            ui.painter().rect_filled(rect, CornerRadius::ZERO, Theme::of(ui).sunken);
            widgets::empty(ui, text, "");
            return;
        }
        let ruler = Ruler {
            left: rect.left() + GUTTER + 8.0,
            width: (rect.width() - GUTTER - 28.0).max(1.0),
            start: state.playback.start,
            length: state.playback.length,
        };
        self.scrub(ui, rect, &ruler, state, requests);
        paint(ui, rect, &ruler, state);
    }
}

impl Timeline {
    fn scrub(&mut self, ui: &mut Ui, rect: Rect, ruler: &Ruler, state: &State, requests: &mut Vec<Request>) {
        let track = Rect::from_min_max(pos2(rect.left() + GUTTER - 8.0, rect.top()), rect.max);
        let response = ui.interact(track, ui.scope_id().with("track"), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::slider(true, f64::from(state.time()), "Time track"));
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        // From the press on, as a hand expects: not only once a movement has made it a drag, and not only
        // once a quick release has made it a click, which it is not any more when a frame took long.
        let primary = ui.input(|input| input.pointer.primary_down());
        let down = response.is_pointer_button_down_on() && primary;
        if down && state.playback.playing && self.resume.is_none() {
            // Time stands while it is held, and goes on as it went before.
            let command = if state.playback.speed < 0.0 { Id::PlayBackwards } else { Id::PlayPause };
            self.resume = Some(command);
            requests.push(Request::Command(command));
        }
        if (down || response.clicked())
            && let Some(pointer) = response.interact_pointer_pos()
        {
            requests.push(Request::Seek(ruler.time_at(pointer.x)));
        }
        if !down && let Some(command) = self.resume.take() {
            requests.push(Request::Command(command));
        }
        if response.hovered() {
            let turned = ui.input(|input| {
                if input.modifiers.alt {
                    input.smooth_scroll_delta().x + input.smooth_scroll_delta().y
                } else {
                    0.0
                }
            });
            if turned.abs() > 1.0 {
                requests.push(Request::Command(if turned > 0.0 { Id::PreviousFrame } else { Id::NextFrame }));
            }
        }
    }
}

fn paint(ui: &Ui, rect: Rect, ruler: &Ruler, state: &State) {
    let theme = Theme::of(ui);
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect_filled(rect, CornerRadius::ZERO, theme.sunken);
    let head = Rect::from_min_size(rect.min, vec2(rect.width(), RULER));
    painter.rect_filled(head, CornerRadius::ZERO, theme.bar);
    painter.hline(rect.x_range(), head.bottom(), Stroke::new(1.0, theme.line));
    ticks(&painter, rect, head, ruler, state, theme);
    lanes(ui, &painter, rect, head, ruler, state, theme);
    playhead(&painter, rect, head, ruler, state, theme);
    pending(&painter, head, ruler, state, theme);
    painter.vline(rect.left() + GUTTER - 10.0, rect.y_range(), Stroke::new(1.0, theme.line));
    let unit = Rect::from_min_max(
        pos2(rect.left() + 12.0, head.top()),
        pos2(rect.left() + GUTTER - 14.0, head.bottom()),
    );
    widgets::text_in(ui, unit, "Seconds", &TextStyle::Small, theme.faint);
}

fn ticks(painter: &Painter, rect: Rect, head: Rect, ruler: &Ruler, state: &State, theme: &Theme) {
    let rate = state.settings.frame_rate;
    let decimals = ruler.decimals(rate);
    let fine = Stroke::new(1.0, theme.line.gamma_multiply(0.55));
    for tick in ruler.ticks(rate) {
        let x = painter.round_to_pixel_center(ruler.x_of(tick.time));
        if tick.major {
            painter.vline(x, head.bottom()..=rect.bottom(), fine);
            painter.vline(x, head.bottom() - 7.0..=head.bottom(), Stroke::new(1.0, theme.faint));
            let label = format!("{:.decimals$}", tick.time);
            painter.text(
                pos2(x, head.top() + 9.0),
                Align2::CENTER_CENTER,
                label,
                FontId::monospace(10.0),
                theme.weak,
            );
        } else {
            painter.vline(x, head.bottom() - 3.0..=head.bottom(), Stroke::new(1.0, theme.line));
        }
    }
}

fn lanes(ui: &Ui, painter: &Painter, rect: Rect, head: Rect, ruler: &Ruler, state: &State, theme: &Theme) {
    let lanes = &state.digest.lanes;
    let all: [(&str, &[f32], Color32); 1] = [("All bones", &lanes.all, theme.key)];
    let channels = &lanes.channels;
    let of_bone: [(&str, &[f32], Color32); 3] = [
        ("Translation", &channels[0], theme.key),
        ("Rotation", &channels[1], theme.key),
        ("Scale", &channels[2], theme.key),
    ];
    let shown: &[(&str, &[f32], Color32)] = if state.selected().is_some() { &of_bone } else { &all };
    let now = state.time();
    let pixel = 1.0 / ui.pixels_per_point();
    for (index, (name, times, color)) in shown.iter().enumerate() {
        let top = head.bottom() + 6.0 + index as f32 * LANE;
        if top > rect.bottom() {
            break;
        }
        let middle = top + LANE / 2.0;
        let label =
            Rect::from_min_max(pos2(rect.left() + 12.0, top), pos2(rect.left() + GUTTER - 14.0, top + LANE));
        let tone = if times.is_empty() { theme.faint } else { theme.weak };
        widgets::text_in(ui, label, name, &TextStyle::Small, tone);
        let line = Stroke::new(1.0, theme.line);
        painter.hline(ruler.left..=ruler.left + ruler.width, painter.round_to_pixel_center(middle), line);
        // Keys closer than a diamond's half are drawn as a band: its edge is still exact to the pixel.
        let dense = times.len() as f32 > ruler.width / 5.0;
        for time in ruler::thin(times, ruler, pixel) {
            let center = pos2(ruler.x_of(time), middle);
            let here = (time - now).abs() < 1e-4;
            if dense && !here {
                painter.vline(
                    center.x,
                    middle - 4.0..=middle + 4.0,
                    Stroke::new(1.0, color.gamma_multiply(0.7)),
                );
            } else {
                diamond(
                    painter,
                    center,
                    if here { 5.5 } else { 4.5 },
                    if here { theme.accent } else { *color },
                );
            }
        }
    }
}

/// A small hollow diamond in the ruler where poses wait to be keyed.
fn pending(painter: &Painter, head: Rect, ruler: &Ruler, state: &State, theme: &Theme) {
    for time in state.pending_times() {
        let center = pos2(ruler.x_of(time), head.bottom() - 5.0);
        let points = [vec2(0.0, -4.0), vec2(4.0, 0.0), vec2(0.0, 4.0), vec2(-4.0, 0.0)];
        let points = points.into_iter().map(|offset| center + offset).collect();
        painter.add(Shape::convex_polygon(points, theme.bar, Stroke::new(1.3, theme.warning)));
    }
}

fn playhead(painter: &Painter, rect: Rect, head: Rect, ruler: &Ruler, state: &State, theme: &Theme) {
    let x = painter.round_to_pixel_center(ruler.x_of(state.time()));
    painter.vline(x, head.bottom() - 4.0..=rect.bottom(), Stroke::new(1.0, theme.accent));
    let y = head.bottom() - 1.0;
    let flag = vec![
        pos2(x - 5.0, y - 9.0),
        pos2(x + 5.0, y - 9.0),
        pos2(x + 5.0, y - 5.0),
        pos2(x, y),
        pos2(x - 5.0, y - 5.0),
    ];
    painter.add(Shape::convex_polygon(flag, theme.accent, Stroke::NONE));
}

fn diamond(painter: &Painter, center: egui::Pos2, radius: f32, color: Color32) {
    let points = [vec2(0.0, -radius), vec2(radius, 0.0), vec2(0.0, radius), vec2(-radius, 0.0)];
    let points = points.into_iter().map(|offset| center + offset).collect();
    painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
}

/// The height at which three lanes are seen.
pub(super) const HEIGHT: f32 = style::BAR + 32.0 + RULER + 3.0 * LANE + 3.0 * GRID;
