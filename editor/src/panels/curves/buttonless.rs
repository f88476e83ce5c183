//! A drag of keys without a button in the curves: sideways in time, or up and down in value.

use super::canvas::{CurveCanvas, change_text};
use super::curve::Curve;
use super::drag::MOST;
use super::id::CurveId;
use super::key_numbers::focused;
use super::values::{ValueChange, ValueKey, given_angles, value_edit};
use crate::control::drag::THRESHOLD;
use crate::panels::dope::ButtonlessTimes;
use crate::panels::drag::{PointerInput, readout};
use crate::panels::keys::{ButtonlessKind, KeyAxis, KeyDragOp, KeysRequest};
use crate::panels::request::Request;
use egui::{CursorIcon, Pos2, Ui};
use std::sync::Arc;

/// A drag without a button, with the selected keys as they were when it began.
#[derive(Debug)]
pub(super) struct ButtonlessCurves {
    /// Position of the pointer when the drag began, points.
    from: Pos2,
    /// Value under the pointer when the drag began.
    value: f32,
    /// Selected keys of the property whose values are moved.
    keys: Vec<ValueKey>,
    /// The curves of these keys.
    curves: Vec<Arc<Curve>>,
    component: usize,
    /// The direction in which the pointer moved first.
    first: Option<KeyAxis>,
}

impl ButtonlessCurves {
    /// Begins a drag at `from` with the selected keys whose curves are shown. The values that move are those with the property
    /// of the first key: `component` if it is shown, otherwise the first one that is.
    pub(super) fn new(
        canvas: &CurveCanvas<'_>,
        from: Pos2,
        component: usize,
        pressed: Option<CurveId>,
    ) -> Self {
        let selected = |curve: &Arc<Curve>| {
            let chosen = curve.id.selected(&canvas.drawn.selection);
            let keys = chosen.keys(curve.times()).flatten().filter_map(|key| ValueKey::of(curve, key));
            keys.take(MOST + 1).collect::<Vec<_>>()
        };
        let (mut keys, mut curves): (Vec<ValueKey>, Vec<Arc<Curve>>) = (Vec::new(), Vec::new());
        for curve in &focused(canvas.curves, canvas.drawn, pressed) {
            let is_same = curves.first().is_none_or(|first| first.id.bit() == curve.id.bit());
            let own = if is_same && keys.len() <= MOST { selected(curve) } else { Vec::new() };
            if !own.is_empty() {
                keys.extend(own);
                curves.push(Arc::clone(curve));
            }
        }
        let shown: Vec<usize> =
            curves.first().map(|curve| canvas.components(curve).collect()).unwrap_or_default();
        let component =
            if shown.contains(&component) { component } else { shown.first().copied().unwrap_or(0) };
        let of = curves.first().map(|curve| curve.id);
        let scale = of.map_or(canvas.scales.view, |id| canvas.scales.of(id, component));
        Self { from, value: scale.value_at(from.y), keys, curves, component, first: None }
    }

    /// Requests what the drag does with the pointer at `pointer`.
    pub(super) fn follow(
        &mut self,
        ui: &Ui,
        pointer: Pos2,
        canvas: &CurveCanvas<'_>,
        input: &PointerInput,
        requests: &mut Vec<Request>,
    ) {
        let Some(drag) = canvas.context.keys.buttonless() else { return };
        if self.first.is_none() && pointer.distance(self.from) >= THRESHOLD {
            let moved = pointer - self.from;
            // The first movement decides between time and value: both at once would be two edits in one.
            let is_time = moved.x.abs() >= moved.y.abs();
            self.first = Some(if is_time { KeyAxis::Time } else { KeyAxis::Value });
        }
        let is_value = drag.axis().or(self.first) == Some(KeyAxis::Value);
        let op = if is_value && drag.kind() == ButtonlessKind::Move {
            self.values(ui, pointer, canvas, input, requests)
        } else {
            let times = ButtonlessTimes::new(canvas.context, &canvas.drawn.take, canvas.time, self.from);
            times.and_then(|times| times.op(ui, pointer, input))
        };
        if let Some(op) = op {
            requests.push(Request::Timeline(KeysRequest::Drag(op)));
        }
    }

    /// Shows by how much values are moved, and returns the operation that moves them there.
    fn values(
        &self,
        ui: &Ui,
        pointer: Pos2,
        canvas: &CurveCanvas<'_>,
        input: &PointerInput,
        requests: &mut Vec<Request>,
    ) -> Option<KeyDragOp> {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeVertical);
        if self.keys.len() > MOST {
            readout(ui, pointer, &format!("At most {MOST} key values can be dragged at once"));
            return None;
        }
        let typed = canvas.context.keys.buttonless().and_then(|drag| drag.amount());
        let first = self.keys.first()?;
        let scale = canvas.scales.of(first.id, self.component);
        let by = typed.unwrap_or_else(|| {
            let (look, usual) = (canvas.context.settings.curves, (scale.step() / 2.0) as f32);
            let value = first.numbers[self.component.min(3)];
            look.snapped(value, scale.value_at(pointer.y) - self.value, input.modifiers.command, usual)
        });
        readout(ui, pointer, &change_text(first.id, self.component, by));
        let edit = value_edit(canvas.context.take_ref()?, &self.keys, self.component, ValueChange::Add(by))?;
        requests.extend(given_angles(&self.curves, &self.keys, self.component, ValueChange::Add(by)));
        Some(KeyDragOp::Edit(edit))
    }
}
