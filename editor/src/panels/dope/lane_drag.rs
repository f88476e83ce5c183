//! The drag of a mark along its lane: of a marker or an event.

use super::head::to_frame;
use super::sheet::Sheet;
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput};
use egui::{PointerButton, Response, Ui};

/// The mark that is dragged. It moves when it is released, so that the order stays during the drag.
#[derive(Debug, Default)]
pub(super) struct LaneDrag {
    /// Index and time, seconds, of the dragged mark.
    drag: PanelDrag<(), (usize, f32)>,
    /// Index of the mark whose drag `drag` follows.
    dragged: Option<usize>,
}

impl LaneDrag {
    /// Returns the time at which a mark is drawn, seconds: that of the pointer while it is dragged, otherwise its own.
    pub(super) fn time_of(&self, index: usize, own: f32) -> f32 {
        let held = self.drag.drag().filter(|(held, _)| *held == index);
        held.map_or(own, |(_, time)| *time)
    }

    /// Follows the pointer over the mark with this index and time. Returns its new time when it is released. Times are whole frames where
    /// keys snap, and the other way round while Ctrl is held.
    pub(super) fn step(
        &mut self,
        ui: &Ui,
        sheet: &Sheet<'_>,
        (index, own): (usize, f32),
        response: &Response,
    ) -> Option<f32> {
        if response.drag_started_by(PointerButton::Primary) {
            self.drag = PanelDrag::dragging((index, own));
            self.dragged = Some(index);
        }
        if self.dragged != Some(index) {
            return None;
        }
        let input = PointerInput::of_widget(ui, response);
        let mut dropped = None;
        match self.drag.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(pointer) => {
                let snap = sheet.context.keys.snap() != input.modifiers.command;
                let time = sheet.scale.time_at(pointer.x);
                self.drag.begin((index, if snap { to_frame(time, sheet.context) } else { time }));
            }
            DragEvent::Dropped((_, time)) => dropped = Some(time),
            DragEvent::Cancelled(_)
            | DragEvent::Nothing
            | DragEvent::Pressed
            | DragEvent::Started(_)
            | DragEvent::Clicked(_) => {}
        }
        self.dragged = self.dragged.filter(|_| self.drag.is_busy());
        dropped
    }
}
