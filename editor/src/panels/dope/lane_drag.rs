//! The drag of a mark along its lane: of a marker, an event or a contact.

use super::head::to_frame;
use super::sheet::Sheet;
use crate::panels::drag::{DragEvent, PanelDrag, PointerInput};
use egui::{PointerButton, Pos2, Response, Ui};

/// The mark under the pointer, of the many in a lane. It is changed when it is released, so that the order stays during
/// the drag.
///
/// `K` identifies a mark, `D` is the mark during the drag.
#[derive(Debug)]
pub(super) struct LaneDrag<K, D> {
    drag: PanelDrag<(), D>,
    /// The mark whose drag `drag` follows.
    dragged: Option<K>,
}

impl<K, D> Default for LaneDrag<K, D> {
    fn default() -> Self {
        Self { drag: PanelDrag::default(), dragged: None }
    }
}

/// The drag of a mark at a single time: its index and its time, seconds.
pub(super) type MarkDrag = LaneDrag<usize, (usize, f32)>;

impl<K: PartialEq + Copy, D: Copy> LaneDrag<K, D> {
    /// Returns the thing as it is during the drag.
    pub(super) fn held(&self) -> Option<&D> {
        self.drag.drag()
    }

    /// Follows the pointer over one thing. `start` returns the thing where a drag of it begins, and `moved` the thing with the pointer at a
    /// new place. Returns the thing when it is released.
    pub(super) fn step(
        &mut self,
        ui: &Ui,
        (key, response): (K, &Response),
        start: impl FnOnce(&PointerInput) -> Option<D>,
        moved: impl FnOnce(D, &PointerInput, Pos2) -> D,
    ) -> Option<D> {
        let input = PointerInput::of_widget(ui, response);
        if response.drag_started_by(PointerButton::Primary)
            && let Some(thing) = start(&input)
        {
            self.drag = PanelDrag::dragging(thing);
            self.dragged = Some(key);
        }
        if self.dragged != Some(key) {
            return None;
        }
        let mut dropped = None;
        match self.drag.step(&input, input.primary_down, |_| ()) {
            DragEvent::Moved(pointer) => {
                if let Some(thing) = self.drag.drag().copied() {
                    self.drag.begin(moved(thing, &input, Pos2::new(pointer.x, pointer.y)));
                }
            }
            DragEvent::Dropped(thing) => dropped = Some(thing),
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

impl MarkDrag {
    /// Returns the time at which a mark is drawn, seconds: that of the pointer while it is dragged, otherwise its own.
    pub(super) fn time_of(&self, index: usize, own: f32) -> f32 {
        let held = self.held().filter(|(held, _)| *held == index);
        held.map_or(own, |(_, time)| *time)
    }

    /// Follows the pointer over the mark with this index and time. Returns its new time when it is released.
    pub(super) fn step_mark(
        &mut self,
        ui: &Ui,
        sheet: &Sheet<'_>,
        (index, own): (usize, f32),
        response: &Response,
    ) -> Option<f32> {
        let start = |_: &PointerInput| Some((index, own));
        let moved =
            |_, input: &PointerInput, at: Pos2| (index, snapped(sheet, input, sheet.scale.time_at(at.x)));
        self.step(ui, (index, response), start, moved).map(|(_, time)| time)
    }
}

/// Returns the time of a drag: a whole frame where keys snap, and the other way round while Ctrl is held.
pub(super) fn snapped(sheet: &Sheet<'_>, input: &PointerInput, time: f32) -> f32 {
    let snaps = sheet.context.keys.snap() != input.modifiers.command;
    if snaps { to_frame(time, sheet.context) } else { time }
}
