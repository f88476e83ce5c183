//! What a hand does on the keys: clicks, boxes, drags. A drag is one gesture; Escape and the right button take it back.

use super::ROW;
use super::head::to_frame;
use super::place::Places;
use super::rows::{RowKind, Rows};
use super::scroll;
use crate::panels::context::PanelContext;
use crate::panels::keys::{ChannelId, Drawn, KeyDragOp, KeysRequest, TimeScale, channel};
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::SAME_TIME;
use egui::{
    CornerRadius, CursorIcon, FontId, Key, Modifiers, PointerButton, Pos2, Rect, Response, Stroke,
    StrokeKind, Ui, pos2, vec2,
};
use std::sync::Arc;

/// What the pointer does on the keys.
#[derive(Debug, Default)]
pub(super) struct Hand {
    doing: Doing,
}

#[derive(Debug, Default)]
enum Doing {
    #[default]
    Nothing,
    /// Pressed, and not yet moved far enough to be a drag.
    Pressed { at: Pos2, on: Option<OnKey>, modifiers: Modifiers },
    /// Keys are dragged; `grabbed` is the time of the key under the pointer when it began.
    Keys { grabbed: f32, pressed: f32, how: How, begun: bool },
    /// A box from a time and a height in the rows.
    Box { time: f32, height: f32, choice: Choice },
    /// Taken back: nothing more until the button is up.
    Spent,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum How {
    Move,
    Duplicate,
    Ripple { from: f32 },
}

/// A key under the pointer.
#[derive(Clone, Copy, Debug)]
struct OnKey {
    row: usize,
    time: f32,
    selected: bool,
}

/// Points: how near a key must be to be under the pointer.
const REACH: f32 = 5.5;
/// Points: how far the pointer goes before it is a drag.
const DRAG: f32 = 4.0;

impl Hand {
    /// Is it in the middle of something?
    pub(super) fn is_busy(&self) -> bool {
        !matches!(self.doing, Doing::Nothing)
    }

    #[allow(clippy::too_many_arguments, reason = "a hand reaches everything that it sees")]
    pub(super) fn update(
        &mut self,
        ui: &Ui,
        canvas: &Response,
        places: &Places,
        scrolled: &mut f32,
        rows: &Rows,
        scale: &TimeScale,
        drawn: &Drawn,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        *scrolled = (*scrolled - scroll::pan(ui, canvas, scale, requests)).max(0.0);
        scroll::wheel(ui, canvas, scale, requests);
        let input = Input::read(ui);
        let pointer = canvas.interact_pointer_pos().or_else(|| canvas.hover_pos());
        let on = pointer.and_then(|pointer| under(pointer, places, *scrolled, rows, scale, drawn));
        if canvas.hovered() && matches!(self.doing, Doing::Nothing) && on.is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        // A menu is about what is under the pointer.
        if canvas.hovered()
            && input.secondary_pressed
            && !self.is_busy()
            && let Some(on) = on.filter(|on| !on.selected)
        {
            requests.push(select(rows, on.row, [on.time; 2], Choice::Replace));
        }
        if !input.primary_down {
            self.let_go(rows, scale, *scrolled, places, pointer.or(input.pointer), requests);
            return;
        }
        // Asked first: egui lets go of what is dragged by Escape itself.
        let held = canvas.is_pointer_button_down_on();
        let begun = held || !matches!(self.doing, Doing::Nothing);
        if begun && (input.secondary_down || input.escape) && !matches!(self.doing, Doing::Spent) {
            if matches!(self.doing, Doing::Keys { .. }) {
                requests.push(Request::Timeline(KeysRequest::Cancel));
            }
            self.doing = Doing::Spent;
        }
        let (true, Some(pointer)) = (held, input.pointer) else {
            return;
        };
        match &mut self.doing {
            Doing::Nothing if input.pans => self.doing = Doing::Spent,
            Doing::Nothing => {
                let at = input.pressed_at.unwrap_or(pointer);
                let on = under(at, places, *scrolled, rows, scale, drawn);
                self.doing = Doing::Pressed { at, on, modifiers: input.modifiers };
            }
            Doing::Pressed { at, on, modifiers } if at.distance(pointer) > DRAG => {
                let (at, on, modifiers) = (*at, *on, *modifiers);
                self.begin(at, on, modifiers, places, *scrolled, rows, scale, drawn, &input, requests);
                self.go_on(ui, pointer, scale, &input, state, requests);
            }
            Doing::Keys { .. } => self.go_on(ui, pointer, scale, &input, state, requests),
            Doing::Box { time, height, .. } => {
                let corner = pos2(scale.x_of(*time), places.canvas.top() - *scrolled + *height);
                let theme = Theme::of(ui);
                let frame = Rect::from_two_pos(corner, pointer);
                let painter = ui.painter().with_clip_rect(places.canvas);
                painter.rect_filled(frame, CornerRadius::ZERO, theme.accent.gamma_multiply(0.12));
                painter.rect_stroke(
                    frame,
                    CornerRadius::ZERO,
                    Stroke::new(1.0, theme.accent),
                    StrokeKind::Inside,
                );
                // Rows come to a hand that reaches beyond them.
                let beyond = (pointer.y - places.canvas.bottom()).max(0.0)
                    + (pointer.y - places.canvas.top()).min(0.0);
                if beyond != 0.0 {
                    *scrolled = (*scrolled + beyond.clamp(-ROW, ROW) * 0.3).max(0.0);
                    ui.ctx().request_repaint();
                }
            }
            Doing::Pressed { .. } | Doing::Spent => {}
        }
    }

    #[allow(clippy::too_many_arguments, reason = "as above")]
    fn begin(
        &mut self,
        at: Pos2,
        on: Option<OnKey>,
        modifiers: Modifiers,
        places: &Places,
        scrolled: f32,
        rows: &Rows,
        scale: &TimeScale,
        drawn: &Drawn,
        input: &Input,
        requests: &mut Vec<Request>,
    ) {
        // Of keys side by side none can be aimed at: a hand that has not selected them means a box.
        let Some(on) = on.filter(|on| on.selected || !crowded(on, rows, scale, drawn)) else {
            let height = at.y - places.canvas.top() + scrolled;
            self.doing = Doing::Box { time: scale.time_at(at.x), height, choice: choice(modifiers) };
            return;
        };
        let mut first = on.time;
        if on.selected {
            first = drawn.selection.extent(&drawn.take).map_or(on.time, |[from, _]| from);
        } else {
            let choice = if modifiers.shift { Choice::Add } else { Choice::Replace };
            requests.push(select(rows, on.row, [on.time; 2], choice));
        }
        let how = match modifiers {
            _ if input.ripple => How::Ripple { from: first.min(on.time) },
            Modifiers { alt: true, .. } => How::Duplicate,
            Modifiers { shift: true, .. } if on.selected => How::Duplicate,
            _ => How::Move,
        };
        self.doing = Doing::Keys { grabbed: on.time, pressed: scale.time_at(at.x), how, begun: false };
    }

    fn go_on(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        scale: &TimeScale,
        input: &Input,
        state: &PanelContext<'_>,
        requests: &mut Vec<Request>,
    ) {
        let Doing::Keys { grabbed, pressed, how, begun } = &mut self.doing else { return };
        // Refused, or taken back by a key: the hand holds nothing any more.
        if *begun && !state.keys.drag().is_some_and(|drag| drag.held()) {
            self.doing = Doing::Spent;
            return;
        }
        let by = scale.time_at(pointer.x) - *pressed;
        let snap = state.keys.snap() != input.modifiers.command;
        let by = if snap { to_frame(*grabbed + by, state) - *grabbed } else { by };
        let deed = match *how {
            How::Move => KeyDragOp::Move(by),
            How::Duplicate => KeyDragOp::Duplicate(by),
            How::Ripple { from } => KeyDragOp::Ripple { from, by },
        };
        *begun |=
            !requests.iter().any(|request| matches!(request, Request::Timeline(KeysRequest::Select { .. })));
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let verb = match how {
            How::Move => "",
            How::Duplicate => "Copy ",
            How::Ripple { .. } => "Ripple ",
        };
        let frames = by * state.settings.frame_rate as f32;
        readout(ui, pointer, &format!("{verb}{by:+.3} s   {frames:+.1} frames"));
        requests.push(Request::Timeline(KeysRequest::Drag(deed)));
    }

    fn let_go(
        &mut self,
        rows: &Rows,
        scale: &TimeScale,
        scrolled: f32,
        places: &Places,
        pointer: Option<Pos2>,
        requests: &mut Vec<Request>,
    ) {
        match std::mem::take(&mut self.doing) {
            Doing::Nothing | Doing::Spent => {}
            Doing::Pressed { on, modifiers, .. } => click(on, modifiers, rows, requests),
            Doing::Keys { .. } => requests.push(Request::Timeline(KeysRequest::Release)),
            Doing::Box { time, height, choice } => {
                let Some(pointer) = pointer else { return };
                let other = pointer.y - places.canvas.top() + scrolled;
                let (top, bottom) = (height.min(other), height.max(other));
                let end = scale.time_at(pointer.x);
                let stretch = [time.min(end), time.max(end)];
                let touched = |at: usize| {
                    let middle = (at as f32 + 0.5) * ROW;
                    middle + REACH >= top && middle - REACH <= bottom
                };
                let mut channels: Vec<ChannelId> = Vec::new();
                // Rows above others hold what those hold.
                for (_, row) in rows.list().iter().enumerate().filter(|(at, _)| touched(*at)) {
                    channels.extend_from_slice(rows.of(row.kind));
                }
                channels.sort_unstable();
                channels.dedup();
                requests.push(Request::Timeline(KeysRequest::Select {
                    channels: channels.into(),
                    stretch,
                    choice,
                }));
            }
        }
    }
}

/// A click on a key, or beside all.
fn click(on: Option<OnKey>, modifiers: Modifiers, rows: &Rows, requests: &mut Vec<Request>) {
    match on {
        Some(on) if modifiers.alt => {
            // The whole column: every bone's keys at that time.
            let stretch = [on.time - SAME_TIME, on.time + SAME_TIME];
            let choice = if modifiers.command {
                Choice::Toggle
            } else if modifiers.shift {
                Choice::Add
            } else {
                Choice::Replace
            };
            let channels = Arc::clone(rows.channels());
            requests.push(Request::Timeline(KeysRequest::Select { channels, stretch, choice }));
        }
        Some(on) => requests.push(select(rows, on.row, [on.time; 2], choice(modifiers))),
        None if modifiers.command || modifiers.shift => {}
        None => requests.push(Request::Timeline(KeysRequest::Deselect)),
    }
}

fn choice(modifiers: Modifiers) -> Choice {
    match modifiers {
        Modifiers { command: true, .. } => Choice::Toggle,
        Modifiers { shift: true, .. } => Choice::Add,
        _ => Choice::Replace,
    }
}

fn select(rows: &Rows, row: usize, stretch: [f32; 2], choice: Choice) -> Request {
    let kind = rows.list().get(row).map_or(RowKind::Morphs, |row| row.kind);
    Request::Timeline(KeysRequest::Select { channels: rows.of(kind).into(), stretch, choice })
}

/// The key under the pointer.
fn under(
    pointer: Pos2,
    places: &Places,
    scrolled: f32,
    rows: &Rows,
    scale: &TimeScale,
    drawn: &Drawn,
) -> Option<OnKey> {
    if !places.canvas.contains(pointer) {
        return None;
    }
    let at = ((pointer.y - places.canvas.top() + scrolled) / ROW).floor();
    let row = rows.list().get(if at >= 0.0 { at as usize } else { return None })?;
    let time = scale.time_at(pointer.x);
    let reach = scale.seconds(REACH);
    let channels = rows.of(row.kind);
    let nearest = channels.iter().filter_map(|&id| channel::nearest(&drawn.take, id, time));
    let time = nearest
        .filter(|key| (key - time).abs() <= reach)
        .min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()))?;
    let selected = channels.iter().any(|&id| {
        let intervals = drawn.selection.of(id);
        intervals.holds(time)
            && channel::nearest(&drawn.take, id, time).is_some_and(|key| (key - time).abs() <= SAME_TIME)
    });
    Some(OnKey { row: at as usize, time, selected })
}

/// Is another key of the row so near that it would be under the pointer too?
fn crowded(on: &OnKey, rows: &Rows, scale: &TimeScale, drawn: &Drawn) -> bool {
    let Some(row) = rows.list().get(on.row) else { return false };
    let reach = scale.seconds(REACH);
    // A key less than twice the reach away is nearer to the middle of that stretch than this one.
    let middles = [on.time - reach, on.time + reach];
    rows.of(row.kind).iter().any(|&id| {
        let other = |middle| channel::nearest(&drawn.take, id, middle);
        middles.into_iter().filter_map(other).any(|key| {
            let apart = (key - on.time).abs();
            apart > SAME_TIME && apart < 2.0 * reach
        })
    })
}

/// What is asked of the input, read once.
pub(in crate::panels) struct Input {
    pub(in crate::panels) primary_down: bool,
    pub(in crate::panels) secondary_down: bool,
    pub(in crate::panels) secondary_pressed: bool,
    pub(in crate::panels) escape: bool,
    pub(in crate::panels) ripple: bool,
    pub(in crate::panels) pans: bool,
    pub(in crate::panels) modifiers: Modifiers,
    pub(in crate::panels) pointer: Option<Pos2>,
    pub(in crate::panels) pressed_at: Option<Pos2>,
}

impl Input {
    pub(in crate::panels) fn read(ui: &Ui) -> Self {
        ui.input(|input| Self {
            primary_down: input.pointer.primary_down(),
            secondary_down: input.pointer.secondary_down(),
            secondary_pressed: input.pointer.button_pressed(PointerButton::Secondary),
            escape: input.key_down(Key::Escape),
            ripple: input.key_down(Key::Num2),
            pans: input.modifiers.alt && input.modifiers.shift,
            modifiers: input.modifiers,
            pointer: input.pointer.interact_pos(),
            pressed_at: input.pointer.press_origin(),
        })
    }
}

/// Says beside the pointer what a drag comes to.
pub(in crate::panels) fn readout(ui: &Ui, pointer: Pos2, text: &str) {
    let theme = Theme::of(ui);
    let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::unique("readout"));
    let painter = ui.ctx().layer_painter(layer);
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::monospace(11.0), theme.text);
    let screen = ui.ctx().content_rect();
    let size = galley.size() + vec2(12.0, 6.0);
    let corner = pos2(
        (pointer.x + 14.0).min(screen.right() - size.x).max(screen.left()),
        (pointer.y - 28.0).max(screen.top()),
    );
    let rect = Rect::from_min_size(corner, size);
    painter.rect_filled(rect, CornerRadius::same(4), theme.raised);
    painter.rect_stroke(rect, CornerRadius::same(4), Stroke::new(1.0, theme.line), StrokeKind::Inside);
    painter.galley(rect.min + vec2(6.0, 3.0), galley, theme.text);
}
