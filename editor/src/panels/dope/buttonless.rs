//! A drag of keys without a button that changes times: in the timeline and in the curves.

use super::head::to_frame;
use crate::panels::context::PanelContext;
use crate::panels::drag::{PointerInput, readout};
use crate::panels::keys::{ButtonlessDrag, ButtonlessKind, KeyDragOp, TimeScale};
use dragonfly_anim::data::Take;
use egui::{CursorIcon, Pos2, Ui};

/// A drag without a button that changes times, and where its keys and the pointer were when it began.
#[derive(Clone, Copy)]
pub(in crate::panels) struct ButtonlessTimes<'a> {
    context: &'a PanelContext<'a>,
    drag: &'a ButtonlessDrag,
    scale: &'a TimeScale,
    /// Position of the pointer when the drag began, points.
    from: Pos2,
    /// Time of the first key when the drag began, seconds.
    first: f32,
}

/// Distance from the playhead, points, below which scaling measures from there: nearer, every point would be a large
/// factor.
const NEAREST: f32 = 20.0;

impl<'a> ButtonlessTimes<'a> {
    /// Returns the drag that began at `from`; `None` if no keys are selected.
    pub(in crate::panels) fn new(
        context: &'a PanelContext<'a>,
        drawn: &Take,
        scale: &'a TimeScale,
        from: Pos2,
    ) -> Option<Self> {
        let drag = context.keys.buttonless()?;
        let first = match context.keys.drag() {
            Some(dragged) => dragged.first_time()?,
            None => context.keys.selection().extent(drawn)?[0],
        };
        Some(Self { context, drag, scale, from, first })
    }

    /// Shows the amount of the drag next to `pointer`, and returns its operation.
    pub(in crate::panels) fn op(&self, ui: &Ui, pointer: Pos2, input: &PointerInput) -> Option<KeyDragOp> {
        ui.ctx().set_cursor_icon(CursorIcon::ResizeHorizontal);
        let (text, op) = match self.drag.kind() {
            ButtonlessKind::Scale => {
                let (about, factor) = (self.context.time(), self.factor(pointer));
                (format!("Scale {factor:.3}"), KeyDragOp::Scale { about, factor })
            }
            ButtonlessKind::Move => {
                let by = self.by(pointer, input);
                (self.distance("", by), KeyDragOp::Move(by))
            }
            ButtonlessKind::Duplicate => {
                let by = self.by(pointer, input);
                (self.distance("Duplicate ", by), KeyDragOp::Duplicate(by))
            }
        };
        let typed = self.drag.typed();
        let text = if typed.is_empty() { text } else { format!("{text}   [{typed}]") };
        readout(ui, pointer, &text);
        Some(op)
    }

    /// Returns the distance in seconds: the typed frames, or where the pointer is.
    fn by(&self, pointer: Pos2, input: &PointerInput) -> f32 {
        if let Some(frames) = self.drag.amount() {
            return frames * self.context.frame_seconds();
        }
        let by = self.scale.time_at(pointer.x) - self.scale.time_at(self.from.x);
        let snap = self.context.keys.snap() != input.modifiers.command;
        if snap { to_frame(self.first + by, self.context) - self.first } else { by }
    }

    /// Returns the typed factor, or the ratio of the distances from the playhead; never 0.
    fn factor(&self, pointer: Pos2) -> f32 {
        let about = self.scale.x_of(self.context.time());
        let began = self.from.x - about;
        let reach = if began < 0.0 { began.min(-NEAREST) } else { began.max(NEAREST) };
        let factor = self.drag.amount().unwrap_or(1.0 + (pointer.x - self.from.x) / reach);
        // At 0 all keys would become one.
        if factor.abs() < 1e-3 { 1e-3_f32.copysign(factor) } else { factor }
    }

    fn distance(&self, verb: &str, by: f32) -> String {
        let frames = by * self.context.frame_rate as f32;
        format!("{verb}{by:+.3} s   {frames:+.1} frames")
    }
}
