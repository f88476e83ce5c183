//! Clicks, selection boxes and drags on the keys of the dope sheet. A drag is one gesture; Escape and the right button
//! cancel it.

use super::buttonless::ButtonlessTimes;
use super::head::to_frame;
use super::rows::RowKind;
use super::sheet::{ROW, Sheet};
use crate::panels::drag::{
    DragEvent, PanelDrag, PointerInput, Press, SelectionBox, choice_of, position, readout,
};
use crate::panels::keys::{ChannelId, KeyDragOp, KeyPanel, KeysRequest, channel};
use crate::panels::request::Request;
use dragonfly_document::bones::Choice;
use dragonfly_document::edit::SAME_TIME;
use egui::{CursorIcon, Modifiers, Pos2, Response, Ui, pos2};
use std::sync::Arc;

/// The drag on the keys.
#[derive(Debug, Default)]
pub(super) struct DopeDrag {
    machine: PanelDrag<Option<DopeKey>, DopeDragged>,
}

/// What is dragged.
#[derive(Debug)]
enum DopeDragged {
    Keys(DraggedKeys),
    Box(SelectionBox),
}

/// The selected keys, while they are dragged.
#[derive(Clone, Copy, Debug)]
struct DraggedKeys {
    /// Time of the key under the pointer when the drag began, seconds.
    grabbed: f32,
    /// Time under the pointer at the press, seconds.
    pressed: f32,
    mode: DragMode,
    /// Whether the drag was requested. If no drag exists after that, it was refused or cancelled.
    requested: bool,
}

/// What dragging keys does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum DragMode {
    Move,
    Duplicate,
    Ripple { from: f32 },
}

/// A key under the pointer.
#[derive(Clone, Copy, Debug)]
struct DopeKey {
    row: usize,
    time: f32,
    selected: bool,
}

/// Distance within which a key is under the pointer, points.
const REACH: f32 = 5.5;

impl DopeDrag {
    /// Whether a press on the keys is in progress.
    pub(super) fn is_busy(&self) -> bool {
        self.machine.is_busy()
    }

    /// Acts on what the pointer does on `canvas`. Returns by how many points the rows scroll, because a selection box
    /// reaches beyond them.
    pub(super) fn update(
        &mut self,
        ui: &Ui,
        canvas: &Response,
        sheet: &Sheet<'_>,
        requests: &mut Vec<Request>,
    ) -> f32 {
        let input = PointerInput::read(ui);
        if let Some(from) = sheet.context.keys.buttonless().and_then(|drag| drag.start_in(KeyPanel::Timeline))
        {
            follow_pointer(ui, from, sheet, &input, requests);
        }
        let pointer = canvas.interact_pointer_pos().or_else(|| canvas.hover_pos());
        let on = pointer.and_then(|pointer| sheet.key_at(pointer));
        if canvas.hovered() && !self.is_busy() && on.is_some() {
            ui.ctx().set_cursor_icon(CursorIcon::Grab);
        }
        // The context menu acts on what is under the pointer.
        if canvas.hovered()
            && input.secondary_pressed
            && !self.is_busy()
            && let Some(on) = on.filter(|on| !on.selected)
        {
            requests.push(sheet.select(on.row, [on.time; 2], Choice::Replace));
        }
        let held = canvas.is_pointer_button_down_on() || canvas.clicked();
        match self.machine.step(&input, held, |at| sheet.key_at(at)) {
            DragEvent::Nothing | DragEvent::Pressed | DragEvent::Cancelled(DopeDragged::Box(_)) => {}
            DragEvent::Started(press) => {
                self.machine.begin(start(&press, sheet, &input, requests));
                if let Some(pointer) = input.pointer {
                    return self.advance(ui, pointer, sheet, &input, requests);
                }
            }
            DragEvent::Moved(at) => return self.advance(ui, position(at), sheet, &input, requests),
            DragEvent::Clicked(press) => click(&press, sheet, requests),
            DragEvent::Dropped(DopeDragged::Keys(_)) => {
                requests.push(Request::Timeline(KeysRequest::Release));
            }
            DragEvent::Dropped(DopeDragged::Box(drawn)) => {
                if let Some(pointer) = pointer.or(input.pointer) {
                    requests.push(sheet.boxed(&drawn, pointer));
                }
            }
            DragEvent::Cancelled(DopeDragged::Keys(_)) => {
                requests.push(Request::Timeline(KeysRequest::Cancel));
            }
        }
        0.0
    }

    fn advance(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        sheet: &Sheet<'_>,
        input: &PointerInput,
        requests: &mut Vec<Request>,
    ) -> f32 {
        let canvas = sheet.areas.canvas;
        match self.machine.drag_mut() {
            // The document refused the drag, or a key cancelled it.
            Some(DopeDragged::Keys(keys)) if keys.requested && !sheet.context.keys.is_dragging() => {
                self.machine.spend();
            }
            Some(DopeDragged::Keys(keys)) => {
                let op = keys.op(ui, pointer, sheet, input);
                // If a selection is requested in this frame, the drag begins after it, so it does not count as
                // requested yet.
                keys.requested |= !requests
                    .iter()
                    .any(|request| matches!(request, Request::Timeline(KeysRequest::Select { .. })));
                requests.push(Request::Timeline(KeysRequest::Drag(op)));
            }
            Some(DopeDragged::Box(drawn)) => {
                let [time, height] = drawn.from;
                let corner = pos2(sheet.scale.x_of(time), canvas.top() - sheet.scroll + height);
                SelectionBox::paint(ui, canvas, corner, pointer);
                let beyond = (pointer.y - canvas.bottom()).max(0.0) + (pointer.y - canvas.top()).min(0.0);
                if beyond != 0.0 {
                    ui.ctx().request_repaint();
                    return beyond.clamp(-ROW, ROW) * 0.3;
                }
            }
            None => {}
        }
        0.0
    }
}

/// Requests what the drag without a button does now, which began at `from`.
fn follow_pointer(ui: &Ui, from: Pos2, sheet: &Sheet<'_>, input: &PointerInput, requests: &mut Vec<Request>) {
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
    let times = ButtonlessTimes::new(sheet.context, &sheet.drawn.take, sheet.scale, from);
    if let Some(op) = times.and_then(|times| times.op(ui, pointer, input)) {
        requests.push(Request::Timeline(KeysRequest::Drag(op)));
    }
}

/// Returns what a press becomes when the pointer has moved far enough.
fn start(
    press: &Press<Option<DopeKey>>,
    sheet: &Sheet<'_>,
    input: &PointerInput,
    requests: &mut Vec<Request>,
) -> DopeDragged {
    let Press { at, on, modifiers } = *press;
    let pressed = sheet.scale.time_at(at.x);
    // Among crowded keys no single one can be aimed at: unless the key is selected, the drag draws a box.
    let Some(on) = on.filter(|on| on.selected || !sheet.is_crowded(on)) else {
        let height = at.y - sheet.areas.canvas.top() + sheet.scroll;
        return DopeDragged::Box(SelectionBox { from: [pressed, height], choice: choice_of(modifiers) });
    };
    let mut first = on.time;
    if on.selected {
        first = sheet.drawn.selection.extent(&sheet.drawn.take).map_or(on.time, |[from, _]| from);
    } else {
        let choice = if modifiers.shift { Choice::Add } else { Choice::Replace };
        requests.push(sheet.select(on.row, [on.time; 2], choice));
    }
    let mode = match modifiers {
        _ if input.ripple => DragMode::Ripple { from: first.min(on.time) },
        Modifiers { alt: true, .. } => DragMode::Duplicate,
        Modifiers { shift: true, .. } if on.selected => DragMode::Duplicate,
        _ => DragMode::Move,
    };
    DopeDragged::Keys(DraggedKeys { grabbed: on.time, pressed, mode, requested: false })
}

impl DraggedKeys {
    /// Shows how far the keys are dragged, and returns the operation that brings them there.
    fn op(&self, ui: &Ui, pointer: Pos2, sheet: &Sheet<'_>, input: &PointerInput) -> KeyDragOp {
        let context = sheet.context;
        let by = sheet.scale.time_at(pointer.x) - self.pressed;
        let snap = context.keys.snap() != input.modifiers.command;
        let by = if snap { to_frame(self.grabbed + by, context) - self.grabbed } else { by };
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        let (verb, op) = match self.mode {
            DragMode::Move => ("", KeyDragOp::Move(by)),
            DragMode::Duplicate => ("Duplicate ", KeyDragOp::Duplicate(by)),
            DragMode::Ripple { from } => ("Ripple ", KeyDragOp::Ripple { from, by }),
        };
        let frames = by * context.frame_rate as f32;
        readout(ui, pointer, &format!("{verb}{by:+.3} s   {frames:+.1} frames"));
        op
    }
}

/// Acts on a click on a key, or on the empty canvas.
fn click(press: &Press<Option<DopeKey>>, sheet: &Sheet<'_>, requests: &mut Vec<Request>) {
    let Press { on, modifiers, .. } = *press;
    match on {
        Some(on) if modifiers.alt => {
            // The whole column: the keys of all listed bones at that time.
            let stretch = [on.time - SAME_TIME, on.time + SAME_TIME];
            let channels = Arc::clone(sheet.rows.channels());
            let choice = choice_of(modifiers);
            let select = KeysRequest::Select { channels, shapes: false, stretch, choice };
            requests.push(Request::Timeline(select));
        }
        Some(on) => requests.push(sheet.select(on.row, [on.time; 2], choice_of(modifiers))),
        None if modifiers.command || modifiers.shift => {}
        None => requests.push(Request::Timeline(KeysRequest::Deselect)),
    }
}

impl Sheet<'_> {
    fn select(&self, row: usize, stretch: [f32; 2], choice: Choice) -> Request {
        let kind = self.rows.list().get(row).map_or(RowKind::Morphs, |row| row.kind);
        let (channels, shapes) = (self.rows.of(kind).into(), kind == RowKind::Morphs);
        Request::Timeline(KeysRequest::Select { channels, shapes, stretch, choice })
    }

    /// Returns the request that selects the keys in a box from its first corner to `pointer`.
    fn boxed(&self, drawn: &SelectionBox, pointer: Pos2) -> Request {
        let other = pointer.y - self.areas.canvas.top() + self.scroll;
        let [stretch, [top, bottom]] = drawn.ranges([self.scale.time_at(pointer.x), other]);
        let touched = |at: usize| {
            let middle = (at as f32 + 0.5) * ROW;
            middle + REACH >= top && middle - REACH <= bottom
        };
        let (mut channels, mut shapes): (Vec<ChannelId>, bool) = (Vec::new(), false);
        // A row contains the channels of the rows below it as well.
        for (_, row) in self.rows.list().iter().enumerate().filter(|(at, _)| touched(*at)) {
            channels.extend_from_slice(self.rows.of(row.kind));
            shapes |= row.kind == RowKind::Morphs;
        }
        channels.sort_unstable();
        channels.dedup();
        let (channels, choice) = (channels.into(), drawn.choice);
        Request::Timeline(KeysRequest::Select { channels, shapes, stretch, choice })
    }

    /// Returns the key under the pointer.
    fn key_at(&self, pointer: Pos2) -> Option<DopeKey> {
        let Self { areas, rows, scale, drawn, scroll, .. } = *self;
        if !areas.canvas.contains(pointer) || self.context.keys.draws_box() {
            return None;
        }
        let at = ((pointer.y - areas.canvas.top() + scroll) / ROW).floor();
        let row = rows.list().get(if at >= 0.0 { at as usize } else { return None })?;
        let time = scale.time_at(pointer.x);
        let reach = scale.seconds(REACH);
        let channels = rows.of(row.kind);
        let nearest = channels.iter().filter_map(|&id| channel::nearest(&drawn.take, id, time));
        let is_shapes = row.kind == RowKind::Morphs;
        let morphs = drawn.take.morphs.iter().filter(|_| is_shapes);
        let shapes = morphs.filter_map(|track| channel::nearest_of(&track.times, time));
        let time = nearest
            .chain(shapes)
            .filter(|key| (key - time).abs() <= reach)
            .min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()))?;
        let selected = channels.iter().any(|&id| {
            let intervals = drawn.selection.of(id);
            intervals.holds(time)
                && channel::nearest(&drawn.take, id, time).is_some_and(|key| (key - time).abs() <= SAME_TIME)
        });
        let selected = selected || (is_shapes && drawn.selection.shapes().holds(time));
        Some(DopeKey { row: at as usize, time, selected })
    }

    /// Returns whether another key of the row is so near that it is under the pointer as well.
    fn is_crowded(&self, on: &DopeKey) -> bool {
        let Some(row) = self.rows.list().get(on.row) else { return false };
        let reach = self.scale.seconds(REACH);
        // Another key less than twice the reach away is nearer to one of these times than the key itself.
        let middles = [on.time - reach, on.time + reach];
        self.rows.of(row.kind).iter().any(|&id| {
            let other = |middle| channel::nearest(&self.drawn.take, id, middle);
            middles.into_iter().filter_map(other).any(|key| {
                let apart = (key - on.time).abs();
                apart > SAME_TIME && apart < 2.0 * reach
            })
        })
    }
}
