//! One state machine for all drags in panels: a press, a drag once the pointer has moved far enough, cancelling by Escape
//! or the right button, and nothing more until the button is up.
//!
//! A panel calls [`DragMachine::step`] once a frame with what the pointer does and acts on the [`DragEvent`] that comes
//! back. What can be pressed on (`T`) and what can be dragged (`D`) are types of the panel.
//!
//! ```text
//! Idle ──press──▶ Pressed ──4 points──▶ Started, then Dragging if the panel calls `begin`
//!   ▲                │                        │
//!   │             Clicked                  Dropped
//!   └────────────────┴────────────────────────┘      Cancelled ──▶ Spent ──button up──▶ Idle
//! ```

mod field_gesture;
mod pointer;
mod selection_box;

pub(in crate::panels) use field_gesture::FieldGesture;
pub(in crate::panels) use pointer::{PointerInput, readout};
pub(in crate::panels) use selection_box::{SelectionBox, choice_of};

use egui::{Modifiers, Pos2};

/// Points that the pointer moves before a press becomes a drag.
const THRESHOLD: f32 = 4.0;

/// A press of the primary button.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::panels) struct Press<T> {
    /// Where it was, points.
    pub(in crate::panels) at: Pos2,
    /// Target under the pointer.
    pub(in crate::panels) on: T,
    /// Modifier keys held at that time.
    pub(in crate::panels) modifiers: Modifiers,
}

/// The change of a drag in one frame.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::panels) enum DragEvent<T, D> {
    /// Nothing to act on.
    Nothing,
    /// The button went down; [`DragMachine::press`] returns where.
    Pressed,
    /// The pointer moved past the threshold. The panel calls [`DragMachine::begin`] to drag something; otherwise the
    /// rest of the press is ignored.
    Started(Press<T>),
    /// The drag continues, with the pointer at this position.
    Moved(Pos2),
    /// The button went up before the threshold.
    Clicked(Press<T>),
    /// The button went up and the drag counts.
    Dropped(D),
    /// Escape or the right button ended the drag, as if it had never begun.
    Cancelled(D),
}

#[derive(Clone, Debug, PartialEq)]
enum Phase<T, D> {
    Idle,
    Pressed(Press<T>),
    Dragging(D),
    /// Cancelled or refused: nothing more until the button is up.
    Spent,
}

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::panels) struct DragMachine<T, D> {
    phase: Phase<T, D>,
}

impl<T, D> Default for DragMachine<T, D> {
    fn default() -> Self {
        Self { phase: Phase::Idle }
    }
}

impl<T, D> DragMachine<T, D> {
    /// Returns a machine in the middle of a drag: for widgets whose press and threshold egui has seen.
    pub(in crate::panels) fn dragging(drag: D) -> Self {
        Self { phase: Phase::Dragging(drag) }
    }

    /// Whether the button is down and its press belongs to this machine.
    pub(in crate::panels) fn is_busy(&self) -> bool {
        !matches!(self.phase, Phase::Idle)
    }

    /// The press that has not become a drag.
    pub(in crate::panels) fn press(&self) -> Option<&Press<T>> {
        match &self.phase {
            Phase::Pressed(press) => Some(press),
            Phase::Idle | Phase::Dragging(_) | Phase::Spent => None,
        }
    }

    /// What is being dragged.
    pub(in crate::panels) fn drag(&self) -> Option<&D> {
        match &self.phase {
            Phase::Dragging(drag) => Some(drag),
            Phase::Idle | Phase::Pressed(_) | Phase::Spent => None,
        }
    }

    /// [`Self::drag`], to be altered.
    pub(in crate::panels) fn drag_mut(&mut self) -> Option<&mut D> {
        match &mut self.phase {
            Phase::Dragging(drag) => Some(drag),
            Phase::Idle | Phase::Pressed(_) | Phase::Spent => None,
        }
    }

    /// Drags `drag` from now on; called on [`DragEvent::Started`].
    pub(in crate::panels) fn begin(&mut self, drag: D) {
        self.phase = Phase::Dragging(drag);
    }

    /// Ends a press or drag without an event; the rest of the press is ignored.
    pub(in crate::panels) fn spend(&mut self) {
        self.phase = Phase::Spent;
    }

    /// Advances by one frame. `held` is whether egui gives the pressed pointer to this panel; `target` returns what is under
    /// a point.
    pub(in crate::panels) fn step(
        &mut self,
        input: &PointerInput,
        held: bool,
        target: impl FnOnce(Pos2) -> T,
    ) -> DragEvent<T, D> {
        let cancels_drag = input.cancels && self.drag().is_some();
        if !input.primary_down && !cancels_drag {
            return match std::mem::replace(&mut self.phase, Phase::Idle) {
                Phase::Idle | Phase::Spent => DragEvent::Nothing,
                Phase::Pressed(press) => DragEvent::Clicked(press),
                Phase::Dragging(drag) => DragEvent::Dropped(drag),
            };
        }
        // Before `held`: egui itself releases what it drags when Escape is pressed.
        if input.cancels && (held || self.is_busy()) {
            return match std::mem::replace(&mut self.phase, Phase::Spent) {
                Phase::Dragging(drag) => DragEvent::Cancelled(drag),
                Phase::Idle | Phase::Pressed(_) | Phase::Spent => DragEvent::Nothing,
            };
        }
        let (true, Some(pointer)) = (held, input.pointer) else { return DragEvent::Nothing };
        match &self.phase {
            Phase::Idle if input.pans => self.phase = Phase::Spent,
            Phase::Idle => {
                let at = input.pressed_at.unwrap_or(pointer);
                self.phase = Phase::Pressed(Press { at, on: target(at), modifiers: input.modifiers });
                return DragEvent::Pressed;
            }
            Phase::Pressed(press) if press.at.distance(pointer) > THRESHOLD => {
                if let Phase::Pressed(press) = std::mem::replace(&mut self.phase, Phase::Spent) {
                    return DragEvent::Started(press);
                }
            }
            Phase::Dragging(_) => return DragEvent::Moved(pointer),
            Phase::Pressed(_) | Phase::Spent => {}
        }
        DragEvent::Nothing
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::pos2;

    type Machine = DragMachine<&'static str, u32>;

    fn down(x: f32) -> PointerInput {
        let at = Some(pos2(x, 0.0));
        PointerInput {
            primary_down: true,
            pointer: at,
            pressed_at: Some(Pos2::ZERO),
            ..PointerInput::default()
        }
    }

    fn up() -> PointerInput {
        PointerInput::default()
    }

    fn step(machine: &mut Machine, input: PointerInput) -> DragEvent<&'static str, u32> {
        machine.step(&input, input.primary_down, |_| "key")
    }

    fn dragging() -> Machine {
        let mut machine = Machine::default();
        assert_eq!(step(&mut machine, down(0.0)), DragEvent::Pressed);
        assert!(matches!(step(&mut machine, down(9.0)), DragEvent::Started(_)));
        machine.begin(7);
        machine
    }

    #[test]
    fn a_press_within_the_threshold_is_a_click() {
        let mut machine = Machine::default();
        assert_eq!(step(&mut machine, down(0.0)), DragEvent::Pressed);
        assert_eq!(step(&mut machine, down(THRESHOLD)), DragEvent::Nothing);
        assert!(matches!(step(&mut machine, up()), DragEvent::Clicked(press) if press.on == "key"));
        assert!(!machine.is_busy());
    }

    #[test]
    fn a_press_beyond_the_threshold_is_a_drag_until_the_button_is_up() {
        let mut machine = dragging();
        assert_eq!(step(&mut machine, down(1.0)), DragEvent::Moved(pos2(1.0, 0.0)));
        assert_eq!(step(&mut machine, up()), DragEvent::Dropped(7));
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
    }

    #[test]
    fn escape_cancels_once_and_the_rest_of_the_press_is_ignored() {
        let mut machine = dragging();
        let escape = PointerInput { cancels: true, ..down(20.0) };
        // egui takes the pointer away in the frame of Escape.
        assert_eq!(machine.step(&escape, false, |_| "key"), DragEvent::Cancelled(7));
        assert_eq!(step(&mut machine, escape), DragEvent::Nothing);
        assert_eq!(step(&mut machine, down(30.0)), DragEvent::Nothing);
        assert!(machine.is_busy());
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
        assert!(!machine.is_busy());
    }

    #[test]
    fn escape_in_the_frame_of_the_release_cancels() {
        let mut machine = dragging();
        assert_eq!(step(&mut machine, PointerInput { cancels: true, ..up() }), DragEvent::Cancelled(7));
    }

    #[test]
    fn a_press_that_escape_cancels_is_no_click() {
        let mut machine = Machine::default();
        step(&mut machine, down(0.0));
        assert_eq!(step(&mut machine, PointerInput { cancels: true, ..down(0.0) }), DragEvent::Nothing);
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
    }

    #[test]
    fn a_press_that_pans_drags_nothing() {
        let mut machine = Machine::default();
        assert_eq!(step(&mut machine, PointerInput { pans: true, ..down(0.0) }), DragEvent::Nothing);
        assert_eq!(step(&mut machine, down(50.0)), DragEvent::Nothing);
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
    }

    #[test]
    fn a_start_that_begins_nothing_is_spent() {
        let mut machine = Machine::default();
        step(&mut machine, down(0.0));
        assert!(matches!(step(&mut machine, down(9.0)), DragEvent::Started(_)));
        assert_eq!(step(&mut machine, down(19.0)), DragEvent::Nothing);
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
    }

    #[test]
    fn a_press_elsewhere_does_not_begin() {
        let mut machine = Machine::default();
        assert_eq!(machine.step(&down(0.0), false, |_| "key"), DragEvent::Nothing);
        assert!(!machine.is_busy());
    }
}
