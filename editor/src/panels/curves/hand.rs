//! What a hand does on the curves: keys are dragged sidewards in time or up and down in value, tangents by their ends.

use super::axis::ValueScale;
use super::curve::Curve;
use super::tangents::{Handle, Tangents};
use super::values::{ValueKey, value_edit};
use crate::panels::context::PanelContext;
use crate::panels::dope::{Input, readout, to_frame};
use crate::panels::keys::intervals::keys_between;
use crate::panels::keys::{Drawn, KeyDragOp, KeysRequest, TimeScale};
use crate::panels::request::Request;
use crate::panels::theme::Theme;
use dragonfly_document::bones::Choice;
use egui::{CornerRadius, CursorIcon, Modifiers, Pos2, Rect, Response, Stroke, StrokeKind, Ui, pos2};
use std::sync::Arc;

/// See the module.
#[derive(Debug, Default)]
pub(super) struct Hand {
    doing: Doing,
    /// Of which component a key was taken hold of last.
    component: usize,
}

#[derive(Debug, Default)]
enum Doing {
    #[default]
    Nothing,
    Pressed {
        at: Pos2,
        on: On,
        modifiers: Modifiers,
    },
    Times {
        grabbed: f32,
        pressed: f32,
        copies: bool,
        begun: bool,
    },
    Values {
        keys: Vec<ValueKey>,
        component: usize,
        pressed: f32,
        begun: bool,
    },
    Tangent {
        handle: Handle,
        curve: Arc<Curve>,
        begun: bool,
    },
    Box {
        time: f32,
        value: f32,
        choice: Choice,
    },
    Spent,
}

/// What lies under the pointer.
#[derive(Clone, Debug)]
enum On {
    Nothing,
    Key(OnKey),
    Handle(Handle),
}

/// A key under the pointer, on the curve of one component.
#[derive(Clone, Debug)]
pub(super) struct OnKey {
    pub(super) curve: Arc<Curve>,
    pub(super) key: usize,
    pub(super) component: usize,
    pub(super) selected: bool,
}

/// Points: how near the pointer must be.
const REACH: f32 = 8.0;
/// Points: how far the pointer goes before it is a drag.
const DRAG: f32 = 4.0;
/// Keys whose values are dragged at once.
const MOST: usize = 2000;

/// What a hand reaches.
pub(super) struct Within<'a> {
    pub(super) curves: &'a [Arc<Curve>],
    pub(super) drawn: &'a Drawn,
    pub(super) time: &'a TimeScale,
    pub(super) value: &'a ValueScale,
    pub(super) components: u8,
    pub(super) tangents: &'a Tangents,
    pub(super) state: &'a PanelContext<'a>,
}

impl OnKey {
    fn time(&self) -> f32 {
        self.curve.times().get(self.key).copied().unwrap_or_default()
    }
}

impl Hand {
    /// Of which component a key was taken hold of last, x first.
    pub(super) fn component(&self) -> usize {
        self.component
    }

    pub(super) fn is_busy(&self) -> bool {
        !matches!(self.doing, Doing::Nothing)
    }

    pub(super) fn update(
        &mut self,
        ui: &Ui,
        canvas: &Response,
        within: &Within<'_>,
        requests: &mut Vec<Request>,
    ) {
        let input = Input::read(ui);
        let pointer = canvas.interact_pointer_pos().or_else(|| canvas.hover_pos());
        let on = pointer.map_or(On::Nothing, |pointer| within.under(pointer));
        if !self.is_busy() && canvas.hovered() {
            match &on {
                On::Key(on) => {
                    ui.ctx().set_cursor_icon(CursorIcon::Grab);
                    if let Some(pointer) = pointer {
                        readout(ui, pointer, &within.says(on));
                    }
                    if input.secondary_pressed && !on.selected {
                        requests.push(select(on, Choice::Replace));
                    }
                }
                On::Handle(_) => ui.ctx().set_cursor_icon(CursorIcon::Grab),
                On::Nothing => {}
            }
        }
        if !input.primary_down {
            return self.let_go(within, pointer.or(input.pointer), requests);
        }
        // Asked first: egui lets go of what is dragged by Escape itself.
        let held = canvas.is_pointer_button_down_on();
        let begun = held || !matches!(self.doing, Doing::Nothing);
        if begun && (input.secondary_down || input.escape) && !matches!(self.doing, Doing::Spent) {
            if matches!(self.doing, Doing::Times { .. } | Doing::Values { .. } | Doing::Tangent { .. }) {
                requests.push(Request::Timeline(KeysRequest::Cancel));
            }
            self.doing = Doing::Spent;
        }
        let (true, Some(pointer)) = (held, input.pointer) else { return };
        match &self.doing {
            Doing::Nothing if input.pans => self.doing = Doing::Spent,
            Doing::Nothing => {
                let at = input.pressed_at.unwrap_or(pointer);
                let on = within.under(at);
                if let On::Key(key) = &on {
                    self.component = key.component;
                }
                self.doing = Doing::Pressed { at, on, modifiers: input.modifiers };
            }
            Doing::Pressed { at, .. } if at.distance(pointer) > DRAG => {
                self.begin(pointer, within, requests);
                self.go_on(ui, pointer, within, &input, requests);
            }
            Doing::Box { time, value, .. } => {
                let corner = pos2(within.time.x_of(*time), within.value.y_of(*value));
                let theme = Theme::of(ui);
                let frame = Rect::from_two_pos(corner, pointer);
                let painter = ui.painter().with_clip_rect(within.value.rect);
                painter.rect_filled(frame, CornerRadius::ZERO, theme.accent.gamma_multiply(0.12));
                painter.rect_stroke(
                    frame,
                    CornerRadius::ZERO,
                    Stroke::new(1.0, theme.accent),
                    StrokeKind::Inside,
                );
            }
            Doing::Pressed { .. } | Doing::Spent => {}
            _ => self.go_on(ui, pointer, within, &input, requests),
        }
    }

    fn begin(&mut self, pointer: Pos2, within: &Within<'_>, requests: &mut Vec<Request>) {
        let Doing::Pressed { at, on, modifiers } = std::mem::take(&mut self.doing) else { return };
        self.doing = match on {
            On::Handle(handle) => match within.curves.iter().find(|curve| curve.id == handle.id) {
                Some(curve) => Doing::Tangent { handle, curve: Arc::clone(curve), begun: false },
                None => Doing::Spent,
            },
            On::Nothing => Doing::Box {
                time: within.time.time_at(at.x),
                value: within.value.value_at(at.y),
                choice: choice(modifiers),
            },
            On::Key(on) => {
                if !on.selected {
                    let choice = if modifiers.shift { Choice::Add } else { Choice::Replace };
                    requests.push(select(&on, choice));
                }
                let moved = pointer - at;
                // The first movement says which way: both at once would be two edits in one.
                if moved.x.abs() >= moved.y.abs() {
                    let copies = modifiers.alt || (modifiers.shift && on.selected);
                    let pressed = within.time.time_at(at.x);
                    Doing::Times { grabbed: on.time(), pressed, copies, begun: false }
                } else {
                    let keys = within.value_keys(&on);
                    let pressed = within.value.value_at(at.y);
                    Doing::Values { keys, component: on.component, pressed, begun: false }
                }
            }
        };
    }

    fn go_on(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        within: &Within<'_>,
        input: &Input,
        requests: &mut Vec<Request>,
    ) {
        let state = within.state;
        let lost = |begun: bool| begun && !state.keys.drag().is_some_and(|drag| drag.held());
        let deed = match &mut self.doing {
            Doing::Times { begun, .. } | Doing::Values { begun, .. } | Doing::Tangent { begun, .. }
                if lost(*begun) =>
            {
                self.doing = Doing::Spent;
                return;
            }
            Doing::Times { grabbed, pressed, copies, begun } => {
                let by = within.time.time_at(pointer.x) - *pressed;
                let snap = state.keys.snap() != input.modifiers.command;
                let by = if snap { to_frame(*grabbed + by, state) - *grabbed } else { by };
                *begun = true;
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
                readout(
                    ui,
                    pointer,
                    &format!("{by:+.3} s   {:+.1} frames", by * state.settings.frame_rate as f32),
                );
                if *copies { KeyDragOp::Duplicate(by) } else { KeyDragOp::Move(by) }
            }
            Doing::Values { keys, component, pressed, begun } => {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
                if keys.len() > MOST {
                    readout(ui, pointer, &format!("Values of at most {MOST} keys are dragged at once"));
                    return;
                }
                let mut by = within.value.value_at(pointer.y) - *pressed;
                if input.modifiers.command {
                    let step = (within.value.step() / 2.0) as f32;
                    by = (by / step).round() * step;
                }
                readout(ui, pointer, &format!("{} {by:+.3}", component_name(*component)));
                let Some(edit) = state.take_ref().and_then(|take| value_edit(take, keys, *component, by))
                else {
                    return;
                };
                *begun = true;
                KeyDragOp::Edit(edit)
            }
            Doing::Tangent { handle, curve, begun } => {
                let slope = handle.slope_at(pointer, within.time, within.value);
                ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
                readout(ui, pointer, &format!("{} {slope:+.3} / s", component_name(handle.component)));
                let Some(edit) =
                    state.take_ref().and_then(|take| handle.edit(take, curve, slope, input.modifiers.alt))
                else {
                    return;
                };
                *begun = true;
                KeyDragOp::Edit(edit)
            }
            _ => return,
        };
        requests.push(Request::Timeline(KeysRequest::Drag(deed)));
    }

    fn let_go(&mut self, within: &Within<'_>, pointer: Option<Pos2>, requests: &mut Vec<Request>) {
        match std::mem::take(&mut self.doing) {
            Doing::Nothing | Doing::Spent => {}
            Doing::Pressed { on: On::Key(on), modifiers, .. } => {
                requests.push(select(&on, choice(modifiers)))
            }
            Doing::Pressed { on: On::Handle(_), .. } => {}
            Doing::Pressed { modifiers, .. } => {
                if !modifiers.command && !modifiers.shift {
                    requests.push(Request::Timeline(KeysRequest::Deselect));
                }
            }
            Doing::Times { .. } | Doing::Values { .. } | Doing::Tangent { .. } => {
                requests.push(Request::Timeline(KeysRequest::Release));
            }
            Doing::Box { time, value, choice } => {
                let Some(pointer) = pointer else { return };
                let (end, other) = (within.time.time_at(pointer.x), within.value.value_at(pointer.y));
                let parts =
                    within.boxed([time.min(end), time.max(end)], [value.min(other), value.max(other)]);
                requests.push(Request::Timeline(KeysRequest::SelectKeys { parts, choice }));
            }
        }
    }
}

impl Within<'_> {
    fn components(&self, curve: &Curve) -> impl Iterator<Item = usize> {
        let components = self.components;
        (0..curve.width()).filter(move |at| components & (1 << at) != 0)
    }

    fn under(&self, pointer: Pos2) -> On {
        if let Some(handle) = self.tangents.under(pointer, REACH) {
            return On::Handle(handle);
        }
        let mut best: Option<(f32, OnKey)> = None;
        let stretch = [self.time.time_at(pointer.x - REACH), self.time.time_at(pointer.x + REACH)];
        for curve in self.curves {
            let keys = keys_between(curve.times(), stretch);
            // Where keys have no dots there is nothing to take hold of.
            if keys.len() > 8 {
                continue;
            }
            for key in keys {
                let (x, numbers) = (self.time.x_of(curve.times()[key]), curve.key(key));
                for component in self.components(curve) {
                    let distance = pos2(x, self.value.y_of(numbers[component])).distance(pointer);
                    if distance <= REACH && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                        let selected = curve.is_chosen(key, self.drawn.selection.of(curve.id));
                        best = Some((distance, OnKey { curve: Arc::clone(curve), key, component, selected }));
                    }
                }
            }
        }
        best.map_or(On::Nothing, |(_, on)| On::Key(on))
    }

    /// What a key is, beside the pointer.
    fn says(&self, on: &OnKey) -> String {
        let (bone, property) = on.curve.id;
        let number = on.curve.key(on.key)[on.component];
        format!(
            "{} {} {}  {number:.3}  at {:.3} s",
            self.state.bone_name(bone),
            property.name(),
            component_name(on.component),
            on.time()
        )
    }

    /// The keys whose values a drag of `on` changes: the selected ones of the same property that are shown.
    fn value_keys(&self, on: &OnKey) -> Vec<ValueKey> {
        if !on.selected {
            return ValueKey::of(&on.curve, on.key).into_iter().collect();
        }
        let same = self.curves.iter().filter(|curve| curve.id.1 == on.curve.id.1);
        let keys = same.flat_map(|curve| {
            let chosen = self.drawn.selection.of(curve.id);
            chosen.keys(curve.times()).flatten().filter_map(|key| ValueKey::of(curve, key))
        });
        keys.take(MOST + 1).collect()
    }

    /// The keys in a box.
    fn boxed(
        &self,
        times: [f32; 2],
        values: [f32; 2],
    ) -> Vec<(crate::panels::keys::ChannelId, Vec<[f32; 2]>)> {
        /// Of more keys than this the values are not looked at.
        const LOOKED_AT: usize = 50_000;
        let mut parts = Vec::new();
        for curve in self.curves {
            let keys = keys_between(curve.times(), times);
            if keys.len() > LOOKED_AT {
                parts.push((curve.id, vec![times]));
                continue;
            }
            let inside = |&key: &usize| {
                let numbers = curve.key(key);
                self.components(curve).any(|at| (values[0]..=values[1]).contains(&numbers[at]))
            };
            let found: Vec<[f32; 2]> = keys.filter(inside).map(|key| [curve.times()[key]; 2]).collect();
            if !found.is_empty() {
                parts.push((curve.id, found));
            }
        }
        parts
    }
}

fn select(on: &OnKey, choice: Choice) -> Request {
    let stretch = [on.time(); 2];
    Request::Timeline(KeysRequest::Select { channels: Arc::new([on.curve.id]), stretch, choice })
}

fn choice(modifiers: Modifiers) -> Choice {
    match modifiers {
        Modifiers { command: true, .. } => Choice::Toggle,
        Modifiers { shift: true, .. } => Choice::Add,
        _ => Choice::Replace,
    }
}

/// X, Y, Z, W.
pub(super) fn component_name(component: usize) -> &'static str {
    ["X", "Y", "Z", "W"].get(component).copied().unwrap_or("?")
}
