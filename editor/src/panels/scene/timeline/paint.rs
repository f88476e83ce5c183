//! Lanes, bars, cross-fades, the playhead.

use super::lane_layout::{SceneHit, fade_handles};
use super::sheet::SceneSheet;
use super::take_marks::TakeMarks;
use super::thumbnail::ShotTextures;
use super::waveform::{SceneWaveforms, sound_of};
use crate::panels::keys::TimeScale;
use crate::panels::scene::SceneSound;
use crate::panels::theme::Theme;
use dragonfly_anim::stage::lanes::{SceneBar, SceneLane, Takeover};
use dragonfly_picture::between;
use egui::{Align2, Color32, CornerRadius, FontId, Painter, Rect, Shape, Stroke, StrokeKind, pos2, vec2};

/// Most lines for repetitions that are drawn in a bar.
const MOST_REPETITIONS: usize = 200;

/// Contents of bars that are kept for the next frame.
#[derive(Debug, Default)]
pub(super) struct BarContents {
    waveforms: SceneWaveforms,
    marks: TakeMarks,
    shots: ShotTextures,
}

/// Draws the beds of the lanes and the lines of time.
pub(super) fn lanes(painter: &Painter, sheet: &SceneSheet<'_>) {
    let (canvas, theme) = (sheet.canvas, sheet.theme);
    let painter = painter.with_clip_rect(canvas.intersect(painter.clip_rect()));
    for (index, lane) in sheet.lanes.list.iter().enumerate() {
        let [top, bottom] = sheet.layout.span(index).map(|y| canvas.top() - sheet.scroll + y);
        if bottom < canvas.top() || top > canvas.bottom() {
            continue;
        }
        let rect = Rect::from_min_max(pos2(canvas.left(), top), pos2(canvas.right(), bottom));
        if sheet.context.scene_editing.is_selected(&lane.name) {
            painter.rect_filled(rect, CornerRadius::ZERO, theme.accent_soft.gamma_multiply(0.35));
        }
        painter.hline(rect.x_range(), bottom + 0.5, Stroke::new(1.0, theme.line.gamma_multiply(0.6)));
    }
    let seconds = sheet.scale.ruler();
    for tick in seconds.ticks(sheet.context.frames_per_second()).into_iter().filter(|tick| tick.major) {
        let x = painter.round_to_pixel_center(sheet.scale.x_of(tick.time));
        painter.vline(x, canvas.y_range(), Stroke::new(1.0, theme.line.gamma_multiply(0.45)));
    }
    // The time after the end of the script.
    if let Some(plan) = &sheet.scene.plan {
        let end = sheet.scale.x_of(plan.length().seconds() as f32).max(canvas.left());
        if end < canvas.right() {
            let rest = Rect::from_min_max(pos2(end, canvas.top()), canvas.max);
            painter.rect_filled(rest, CornerRadius::ZERO, theme.gap.gamma_multiply(0.35));
            painter.vline(end, canvas.y_range(), Stroke::new(1.0, theme.faint.gamma_multiply(0.6)));
        }
    }
}

/// Draws all bars; those of included files are dim, because they are changed there.
pub(super) fn bars(
    painter: &Painter,
    sheet: &SceneSheet<'_>,
    hovered: Option<SceneHit>,
    contents: &mut BarContents,
) {
    contents.waveforms.begin_frame();
    contents.shots.begin_frame();
    let painter = painter.with_clip_rect(sheet.canvas.intersect(painter.clip_rect()));
    let top = sheet.canvas.top() - sheet.scroll;
    for (index, lane) in sheet.lanes.list.iter().enumerate() {
        let is_dim = sheet.context.scene_editing.is_hidden(&lane.name)
            || sheet.context.scene_editing.is_locked(&lane.name);
        for bar in &lane.bars {
            let rect = sheet.layout.bar(index, bar, top, sheet.scale);
            if rect.right() >= sheet.canvas.left()
                && rect.left() <= sheet.canvas.right()
                && rect.bottom() >= sheet.canvas.top()
                && rect.top() <= sheet.canvas.bottom()
            {
                let is_hovered =
                    matches!(hovered, Some(SceneHit::Bar { action, .. }) if action == bar.action);
                let state = BarState { is_hovered, is_dim: is_dim || bar.file.is_some() };
                draw_bar(&painter, sheet, (lane, bar, rect), state, contents);
                takeover(&painter, bar, rect, sheet);
            }
        }
    }
}

/// Returns the color of a kind of action.
fn hue(theme: &Theme, lane: &SceneLane, bar: &SceneBar) -> Color32 {
    let at = match (bar.kind, lane.kind) {
        ("shot", _) => 0,
        ("play", _) => 2,
        ("move", _) => 4,
        ("look" | "turn" | "place", _) => 3,
        ("attach" | "detach", _) => 1,
        ("sound", _) => 5,
        _ => 1,
    };
    theme.bone_hue(at, 1)
}

#[derive(Clone, Copy)]
struct BarState {
    is_hovered: bool,
    is_dim: bool,
}

fn draw_bar(
    painter: &Painter,
    sheet: &SceneSheet<'_>,
    (lane, bar, rect): (&SceneLane, &SceneBar, Rect),
    BarState { is_hovered, is_dim }: BarState,
    contents: &mut BarContents,
) {
    let theme = sheet.theme;
    let is_selected = sheet.context.scene_editing.is_action_selected(bar.action);
    let strength = if is_dim { 0.35 } else { 1.0 };
    let color = hue(theme, lane, bar).gamma_multiply(strength);
    if bar.is_instant() {
        return instant(painter, rect, color, is_selected, is_hovered, theme);
    }
    let radius = CornerRadius::same(4);
    // Opaque under the color, so that a bar covers what it is over.
    painter.rect_filled(rect, radius, theme.sunken);
    let fill = color.gamma_multiply(if is_hovered || is_selected { 0.42 } else { 0.30 });
    painter.rect_filled(rect, radius, fill);
    contents.waveforms.show(painter, sheet, bar, rect, color.gamma_multiply(0.8));
    let beside = contents.shots.show(painter, sheet, bar, rect);
    fades(painter, sheet, bar, rect, color);
    for time in bar.repetitions(MOST_REPETITIONS) {
        let x = sheet.scale.x_of(time.seconds() as f32);
        painter.vline(x, rect.top() + 3.0..=rect.bottom() - 3.0, Stroke::new(1.0, color.gamma_multiply(0.7)));
    }
    // An action without a length of its own has an open end.
    let edge =
        Stroke::new(if is_selected { 1.6 } else { 1.0 }, if is_selected { theme.accent } else { color });
    if bar.is_passive && bar.kind != "shot" {
        let steps = [2.0_f32, 5.0, 8.0];
        for (index, step) in steps.into_iter().enumerate() {
            let shade = color.gamma_multiply(0.8 - index as f32 * 0.25);
            painter.vline(
                rect.right() - step,
                rect.top() + 4.0..=rect.bottom() - 4.0,
                Stroke::new(1.0, shade),
            );
        }
    }
    painter.rect_stroke(rect, radius, edge, StrokeKind::Inside);
    contents.marks.show(painter, sheet, bar, rect, color);
    for mark in &bar.marks {
        let x = sheet.scale.x_of(mark.time.seconds() as f32);
        let corners =
            vec![pos2(x - 4.0, rect.bottom()), pos2(x + 4.0, rect.bottom()), pos2(x, rect.bottom() - 6.0)];
        painter.add(Shape::convex_polygon(corners, theme.warning, Stroke::NONE));
    }
    let shown = beside.intersect(sheet.canvas);
    if shown.width() > 18.0 {
        let color = if is_dim { theme.faint } else { theme.text };
        match sound_of(sheet, bar) {
            Some(SceneSound::Problem(reason)) => label(painter, shown, reason, theme.warning),
            Some(SceneSound::Reading | SceneSound::Read(_)) | None => {
                label(painter, shown, &bar.label, color)
            }
        }
    }
    if (is_hovered || is_selected) && bar.file.is_none() {
        for (_, x) in fade_handles(bar, rect, sheet.scale).into_iter().flatten() {
            let x = between(x, rect.left() + 3.0, rect.right() - 3.0);
            painter.circle_filled(pos2(x, rect.top() + 3.0), 2.6, theme.text);
        }
    }
}

/// Draws an action that takes no time.
fn instant(
    painter: &Painter,
    rect: Rect,
    color: Color32,
    is_selected: bool,
    is_hovered: bool,
    theme: &Theme,
) {
    let (center, size) = (rect.center(), if is_hovered || is_selected { 6.0 } else { 5.0 });
    let corners =
        [vec2(0.0, -size), vec2(size, 0.0), vec2(0.0, size), vec2(-size, 0.0)].map(|by| center + by);
    let stroke = if is_selected { Stroke::new(1.6, theme.accent) } else { Stroke::new(1.0, theme.sunken) };
    painter.add(Shape::convex_polygon(corners.to_vec(), color, stroke));
}

/// Draws the fades of a bar as slopes.
fn fades(painter: &Painter, sheet: &SceneSheet<'_>, bar: &SceneBar, rect: Rect, color: Color32) {
    let width = |seconds: f64| ((seconds * sheet.scale.per_second()) as f32).min(rect.width());
    let (fade_in, fade_out) = (width(bar.fade_in.seconds()), width(bar.fade_out.seconds()));
    let shade = sheet.theme.sunken.gamma_multiply(0.65);
    if fade_in > 1.0 {
        let corners = vec![rect.left_top(), pos2(rect.left() + fade_in, rect.top()), rect.left_bottom()];
        painter.add(Shape::convex_polygon(corners, shade, Stroke::NONE));
        let line = [rect.left_bottom(), pos2(rect.left() + fade_in, rect.top())];
        painter.line_segment(line, Stroke::new(1.0, color));
    }
    if fade_out > 1.0 {
        let corners = vec![rect.right_top(), rect.right_bottom(), pos2(rect.right() - fade_out, rect.top())];
        painter.add(Shape::convex_polygon(corners, shade, Stroke::NONE));
        let line = [rect.right_bottom(), pos2(rect.right() - fade_out, rect.top())];
        painter.line_segment(line, Stroke::new(1.0, color));
    }
}

/// Draws how a bar takes over from one that is still on, and gives back to it: a cross where they mix, a line where one cuts the other off.
fn takeover(painter: &Painter, bar: &SceneBar, rect: Rect, sheet: &SceneSheet<'_>) {
    let ends = [(mixed_part(bar, rect, sheet.scale), 1.0), (handed_back_part(bar, rect, sheet.scale), -1.0)];
    for (part, inwards) in ends {
        let Some(part) = part else { continue };
        if part.width() == 0.0 {
            let stroke = Stroke::new(2.0, sheet.theme.text.gamma_multiply(0.8));
            painter.vline(part.left() + inwards, part.y_range(), stroke);
        } else {
            let stroke = Stroke::new(1.0, sheet.theme.text.gamma_multiply(0.45));
            painter.line_segment([part.left_bottom(), part.right_top()], stroke);
            painter.line_segment([part.left_top(), part.right_bottom()], stroke);
        }
    }
}

/// Returns the part of a bar in which it mixes with the one before it, without width where it cuts that one off; `None` where it does neither.
pub fn mixed_part(bar: &SceneBar, rect: Rect, scale: &TimeScale) -> Option<Rect> {
    let right = match bar.takeover {
        Takeover::After => return None,
        Takeover::Cut => rect.left(),
        Takeover::Mix(until) => scale.x_of(until.seconds() as f32).min(rect.right()),
    };
    Some(Rect::from_min_max(rect.min, pos2(right.max(rect.left()), rect.bottom())))
}

/// Returns the part of a bar in which it mixes with the one before it again, which is still on after it, without width if it is cut off; `None` if that one
/// is over.
pub fn handed_back_part(bar: &SceneBar, rect: Rect, scale: &TimeScale) -> Option<Rect> {
    let left = match bar.hand_back? {
        from if from >= bar.end => rect.right(),
        from => scale.x_of(from.seconds() as f32).max(rect.left()),
    };
    Some(Rect::from_min_max(pos2(left.min(rect.right()), rect.top()), rect.max))
}

/// Draws the name of a bar, cut at its right end.
fn label(painter: &Painter, rect: Rect, text: &str, color: Color32) {
    let mut job =
        egui::text::LayoutJob::simple_singleline(text.to_owned(), FontId::proportional(11.0), color);
    job.wrap = egui::text::TextWrapping::truncate_at_width((rect.width() - 12.0).max(0.0));
    let galley = painter.layout_job(job);
    let at = pos2(rect.left() + 7.0, rect.center().y - galley.size().y / 2.0);
    painter.galley(at, galley, color);
}

/// Draws the playhead.
pub(super) fn playhead(painter: &Painter, sheet: &SceneSheet<'_>) {
    let x = sheet.scale.x_of(sheet.context.time());
    if x < sheet.head.left() || x > sheet.head.right() {
        return;
    }
    let (theme, head) = (sheet.theme, sheet.head);
    painter.vline(x, head.bottom()..=sheet.canvas.bottom(), Stroke::new(1.4, theme.accent));
    let corners =
        vec![pos2(x - 5.0, head.bottom() - 9.0), pos2(x + 5.0, head.bottom() - 9.0), pos2(x, head.bottom())];
    painter.add(Shape::convex_polygon(corners, theme.accent, Stroke::NONE));
}

/// Draws what to do in a scene without actions.
pub(super) fn hint(painter: &Painter, sheet: &SceneSheet<'_>) {
    let text = "Nothing happens yet: right-click a lane to add a clip, or write an action into the script";
    let at = pos2(
        sheet.canvas.center().x,
        (sheet.canvas.top() + sheet.layout.height() + 28.0).min(sheet.canvas.bottom() - 14.0),
    );
    painter.text(at, Align2::CENTER_CENTER, text, FontId::proportional(12.0), sheet.theme.weak);
}
