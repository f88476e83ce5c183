//! Drags on the curves: keys sideways in time or up and down in value, tangents by their handles, and selection boxes.

use super::buttonless::ButtonlessCurves;
use super::canvas::{CurveCanvas, CurveKey, CurvePoint, CurveTarget, change_text};
use super::curve::Curve;
use super::id::CurveId;
use super::tangents::TangentHandle;
use super::values::{ValueChange, ValueKey, given_angles, value_edit};
use crate::panels::dope::to_frame;
use crate::panels::drag::{
    DragEvent, PanelDrag, PointerInput, Press, SelectionBox, choice_of, position, readout,
};
use crate::panels::keys::intervals::keys_between;
use crate::panels::keys::{ChannelId, KeyDragOp, KeyPanel, KeysRequest};
use crate::panels::request::Request;
use dragonfly_document::bones::Choice;
use egui::{CursorIcon, Modifiers, Pos2, Response, Ui, pos2};
use std::sync::Arc;

/// The drag on the curves.
#[derive(Debug, Default)]
pub(super) struct CurveDrag {
    machine: PanelDrag<CurveTarget, CurveDragged>,
    /// Component of the key that was pressed on last.
    component: usize,
    /// The curve of that key.
    pressed: Option<CurveId>,
    buttonless: Option<ButtonlessCurves>,
}

/// The dragged part of the curves. `requested` is whether the drag was requested; if no drag exists after that, it was
/// refused or cancelled.
#[derive(Debug)]
enum CurveDragged {
    Times {
        /// Time of the pressed key when the drag began, seconds.
        grabbed: f32,
        /// Time under the pointer at the press, seconds.
        pressed: f32,
        copies: bool,
        requested: bool,
    },
    Values {
        keys: Vec<ValueKey>,
        /// The curves of these keys when the drag began.
        curves: Vec<Arc<Curve>>,
        component: usize,
        /// Distance from there.
        by: f32,
        /// Value under the pointer at the press.
        pressed: f32,
        /// The pressed curve, and the value of the pressed key at the press.
        of: (CurveId, f32),
        requested: bool,
    },
    Tangent {
        handle: TangentHandle,
        curve: Arc<Curve>,
        requested: bool,
    },
    Box(SelectionBox),
}

/// Stretches of time of channels, and of shape keys.
type BoxedKeys = (Vec<(ChannelId, Vec<[f32; 2]>)>, Vec<[f32; 2]>);

/// Largest number of keys whose values are dragged at once.
pub(super) const MOST: usize = 2000;

impl CurveDrag {
    /// Component of the key that was pressed on last, 0 for X.
    pub(super) fn component(&self) -> usize {
        self.component
    }

    /// Returns the curve of the key that was pressed on last.
    pub(super) fn pressed(&self) -> Option<CurveId> {
        self.pressed
    }

    /// Whether a press on the curves, or a drag without a button, is in progress.
    pub(super) fn is_busy(&self) -> bool {
        self.machine.is_busy() || self.buttonless.is_some()
    }

    /// Acts on what the pointer does on `canvas`.
    pub(super) fn update(
        &mut self,
        ui: &Ui,
        response: &Response,
        canvas: &CurveCanvas<'_>,
        requests: &mut Vec<Request>,
    ) {
        let input = PointerInput::read(ui);
        self.follow_pointer(ui, canvas, &input, requests);
        let pointer = response.interact_pointer_pos().or_else(|| response.hover_pos());
        if !self.is_busy()
            && response.hovered()
            && let Some(pointer) = pointer
        {
            canvas.hover(ui, pointer, &input, requests);
        }
        let held = response.is_pointer_button_down_on() || response.clicked();
        match self.machine.step(&input, held, |at| canvas.target_at(at)) {
            DragEvent::Nothing | DragEvent::Cancelled(CurveDragged::Box(_)) => {}
            DragEvent::Pressed => {
                if let Some(Press { on: CurveTarget::Key(key), .. }) = self.machine.pressed() {
                    (self.component, self.pressed) = (key.component, Some(key.curve.id));
                }
            }
            DragEvent::Started(press) => {
                if let Some(pointer) = input.pointer
                    && let Some(drag) = canvas.start(press, pointer, requests)
                {
                    self.machine.begin(drag);
                    self.advance(ui, pointer, canvas, &input, requests);
                }
            }
            DragEvent::Moved(at) => self.advance(ui, position(at), canvas, &input, requests),
            DragEvent::Clicked(press) => {
                if let CurveTarget::Key(key) = &press.on {
                    (self.component, self.pressed) = (key.component, Some(key.curve.id));
                }
                click(&press, requests);
            }
            DragEvent::Dropped(CurveDragged::Box(drawn)) => {
                if let Some(pointer) = pointer.or(input.pointer) {
                    let to = [canvas.time.time_at(pointer.x), canvas.scales.view.value_at(pointer.y)];
                    let (parts, shapes) = canvas.boxed(drawn.ranges(to));
                    let choice = drawn.choice;
                    requests.push(Request::Timeline(KeysRequest::SelectKeys { parts, shapes, choice }));
                }
            }
            DragEvent::Dropped(_) => requests.push(Request::Timeline(KeysRequest::Release)),
            DragEvent::Cancelled(_) => requests.push(Request::Timeline(KeysRequest::Cancel)),
        }
    }

    /// Requests what a drag without a button does now, if there is one in the curves.
    fn follow_pointer(
        &mut self,
        ui: &Ui,
        canvas: &CurveCanvas<'_>,
        input: &PointerInput,
        requests: &mut Vec<Request>,
    ) {
        let start = canvas.context.keys.buttonless().and_then(|drag| drag.start_in(KeyPanel::Curves));
        let Some(from) = start else { return self.buttonless = None };
        let component = self.component;
        let pressed = self.pressed;
        let drag =
            self.buttonless.get_or_insert_with(|| ButtonlessCurves::new(canvas, from, component, pressed));
        if let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) {
            drag.follow(ui, pointer, canvas, input, requests);
        }
    }

    fn advance(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        canvas: &CurveCanvas<'_>,
        input: &PointerInput,
        requests: &mut Vec<Request>,
    ) {
        let Some(drag) = self.machine.drag_mut() else { return };
        // The document refused the drag, or a key cancelled it.
        if drag.was_requested() && !canvas.context.keys.is_dragging() {
            return self.machine.spend();
        }
        if let Some(op) = drag.op(ui, pointer, canvas, input) {
            if let CurveDragged::Values { keys, curves, component, by, .. } = drag {
                requests.extend(given_angles(curves, keys, *component, ValueChange::Add(*by)));
            }
            requests.push(Request::Timeline(KeysRequest::Drag(op)));
        }
    }
}

impl CurveDragged {
    fn was_requested(&self) -> bool {
        match self {
            Self::Times { requested, .. }
            | Self::Values { requested, .. }
            | Self::Tangent { requested, .. } => *requested,
            Self::Box(_) => false,
        }
    }

    /// Shows the amount of the drag next to the pointer, and returns its operation; `None` for a selection box, and if
    /// there is no valid operation.
    fn op(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        canvas: &CurveCanvas<'_>,
        input: &PointerInput,
    ) -> Option<KeyDragOp> {
        let context = canvas.context;
        match self {
            Self::Times { grabbed, pressed, copies, requested } => {
                let by = canvas.time.time_at(pointer.x) - *pressed;
                let snap = context.keys.snap() != input.modifiers.command;
                let by = if snap { to_frame(*grabbed + by, context) - *grabbed } else { by };
                ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
                let frames = by * context.frame_rate as f32;
                readout(ui, pointer, &format!("{by:+.3} s   {frames:+.1} frames"));
                *requested = true;
                Some(if *copies { KeyDragOp::Duplicate(by) } else { KeyDragOp::Move(by) })
            }
            Self::Values { keys, component, pressed, by: dragged, of, requested, .. } => {
                ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
                if keys.len() > MOST {
                    readout(ui, pointer, &format!("At most {MOST} key values can be dragged at once"));
                    return None;
                }
                let scale = canvas.scales.of(of.0, *component);
                let by = scale.value_at(pointer.y) - *pressed;
                let (look, usual) = (context.settings.curves, (scale.step() / 2.0) as f32);
                let by = look.snapped(of.1, by, input.modifiers.command, usual);
                readout(ui, pointer, &change_text(of.0, *component, by));
                let edit = value_edit(context.take_ref()?, keys, *component, ValueChange::Add(by))?;
                (*dragged, *requested) = (by, true);
                Some(KeyDragOp::Edit(edit))
            }
            Self::Tangent { handle, curve, requested } => {
                let scale = canvas.scales.of(handle.id, handle.component);
                let slope = handle.slope_at(pointer, canvas.time, &scale);
                ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
                readout(ui, pointer, &format!("{} / s", change_text(handle.id, handle.component, slope)));
                let edit = handle.edit(context.take_ref()?, curve, slope, input.modifiers.alt)?;
                *requested = true;
                Some(KeyDragOp::Edit(edit))
            }
            Self::Box(drawn) => {
                let [time, value] = drawn.from;
                let corner = pos2(canvas.time.x_of(time), canvas.scales.view.y_of(value));
                SelectionBox::paint(ui, canvas.scales.view.rect, corner, pointer);
                None
            }
        }
    }
}

/// Acts on a click on a key, a handle or the empty canvas.
fn click(press: &Press<CurveTarget>, requests: &mut Vec<Request>) {
    match &press.on {
        CurveTarget::Key(on) => requests.push(select(on, choice_of(press.modifiers))),
        CurveTarget::Handle(_) => {}
        CurveTarget::Nothing => {
            if !press.modifiers.command && !press.modifiers.shift {
                requests.push(Request::Timeline(KeysRequest::Deselect));
            }
        }
    }
}

impl CurveCanvas<'_> {
    /// Shows what is under the pointer; the right button selects it for the menu.
    fn hover(&self, ui: &Ui, pointer: Pos2, input: &PointerInput, requests: &mut Vec<Request>) {
        match self.target_at(pointer) {
            CurveTarget::Key(on) => {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
                readout(ui, pointer, &self.description(&on));
                if input.secondary_pressed && !on.selected {
                    requests.push(select(&on, Choice::Replace));
                }
            }
            CurveTarget::Handle(_) => ui.ctx().set_cursor_icon(CursorIcon::Grab),
            CurveTarget::Nothing => {
                if let Some(CurvePoint { curve, component, number }) = self.curve_at(pointer) {
                    let time = self.time.time_at(pointer.x);
                    readout(ui, pointer, &self.description_at(&curve, component, number, time));
                }
            }
        }
    }

    /// Returns what a press becomes when the pointer has moved far enough, to `pointer`.
    fn start(
        &self,
        press: Press<CurveTarget>,
        pointer: Pos2,
        requests: &mut Vec<Request>,
    ) -> Option<CurveDragged> {
        let Press { at, on, modifiers } = press;
        match on {
            CurveTarget::Handle(handle) => {
                let curve = self.curves.iter().find(|curve| curve.id == handle.id)?;
                Some(CurveDragged::Tangent { handle, curve: Arc::clone(curve), requested: false })
            }
            CurveTarget::Nothing => Some(CurveDragged::Box(SelectionBox {
                from: [self.time.time_at(at.x), self.scales.view.value_at(at.y)],
                choice: choice_of(modifiers),
            })),
            CurveTarget::Key(on) => Some(self.start_on_key(&on, at, pointer, modifiers, requests)),
        }
    }

    fn start_on_key(
        &self,
        on: &CurveKey,
        at: Pos2,
        pointer: Pos2,
        modifiers: Modifiers,
        requests: &mut Vec<Request>,
    ) -> CurveDragged {
        if !on.selected {
            let choice = if modifiers.shift { Choice::Add } else { Choice::Replace };
            requests.push(select(on, choice));
        }
        let moved = pointer - at;
        // The first movement decides between time and value: both at once would be two edits in one.
        if moved.x.abs() >= moved.y.abs() {
            let copies = modifiers.alt || (modifiers.shift && on.selected);
            let pressed = self.time.time_at(at.x);
            CurveDragged::Times { grabbed: on.time(), pressed, copies, requested: false }
        } else {
            let pressed = self.scales.of(on.curve.id, on.component).value_at(at.y);
            let of = (on.curve.id, on.curve.key(on.key)[on.component]);
            let keys = self.value_keys(on);
            let mut curves: Vec<Arc<Curve>> = self.curves.to_vec();
            curves.retain(|curve| keys.iter().any(|key| key.id == curve.id));
            CurveDragged::Values {
                keys,
                curves,
                component: on.component,
                pressed,
                by: 0.0,
                of,
                requested: false,
            }
        }
    }

    /// Returns the keys whose values a drag of `on` changes: those selected keys of the same property whose curves are
    /// shown.
    fn value_keys(&self, on: &CurveKey) -> Vec<ValueKey> {
        if !on.selected {
            return ValueKey::of(&on.curve, on.key).into_iter().collect();
        }
        let same = self.curves.iter().filter(|curve| {
            // All shape keys share the selection of their keys: only the pressed curve changes.
            if on.curve.id.is_shape() { curve.id == on.curve.id } else { curve.id.bit() == on.curve.id.bit() }
        });
        let keys = same.flat_map(|curve| {
            let chosen = curve.id.selected(&self.drawn.selection);
            chosen.keys(curve.times()).flatten().filter_map(|key| ValueKey::of(curve, key))
        });
        keys.take(MOST + 1).collect()
    }

    /// Returns the keys in a box of times and values: of channels, and of shape keys.
    fn boxed(&self, [times, values]: [[f32; 2]; 2]) -> BoxedKeys {
        /// Number of keys of a curve in the range of times above which the values are not tested, and all of them are
        /// selected.
        const LOOKED_AT: usize = 50_000;
        let (mut parts, mut shapes) = (Vec::new(), Vec::new());
        let mut add = |id: CurveId, found: Vec<[f32; 2]>| match id.channel() {
            Some(id) => parts.push((id, found)),
            None => shapes.extend(found),
        };
        for curve in self.curves {
            let keys = keys_between(curve.times(), times);
            if keys.len() > LOOKED_AT {
                add(curve.id, vec![times]);
                continue;
            }
            let (scales, view) = (self.scales.all(curve.id), &self.scales.view);
            let inside = |&key: &usize| {
                let numbers = curve.key(key);
                let shown = |at: usize| {
                    if self.scales.ranges.is_normalized() {
                        view.value_at(scales[at].y_of(numbers[at]))
                    } else {
                        numbers[at]
                    }
                };
                self.components(curve).any(|at| (values[0]..=values[1]).contains(&shown(at)))
            };
            let found: Vec<[f32; 2]> = keys.filter(inside).map(|key| [curve.times()[key]; 2]).collect();
            if !found.is_empty() {
                add(curve.id, found);
            }
        }
        (parts, shapes)
    }
}

fn select(on: &CurveKey, choice: Choice) -> Request {
    let stretch = [on.time(); 2];
    let channels = on.curve.id.channel().into_iter().collect();
    let shapes = on.curve.id.is_shape();
    Request::Timeline(KeysRequest::Select { channels, shapes, stretch, choice })
}
