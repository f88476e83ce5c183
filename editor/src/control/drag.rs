//! One state machine for all drags: a press, a drag once the pointer has moved far enough, cancelling, and nothing more until
//! the button is up.
//!
//! The machine is driven by events: [`DragMachine::press`], [`moved`](DragMachine::moved),
//! [`released`](DragMachine::released), [`cancelled`](DragMachine::cancelled). The controls of the viewport call these
//! as inputs arrive; panels read the pointer once a frame and call them from `panels/drag`. The owner chooses the type
//! of the data that it keeps for a press (`P`) and the type of what can be dragged (`D`).
//!
//! ```text
//! Idle ──press──▶ Pressed ──4 points──▶ Started, then Dragging if the owner calls `begin`
//!   ▲                │                        │
//!   │             Clicked                  Dropped
//!   └────────────────┴────────────────────────┘      Cancelled ──▶ Spent ──button up──▶ Idle
//! ```
//!
//! Drags without a threshold, such as a drag by a key or an orbit of the camera, begin with [`DragMachine::begin`] or
//! [`DragMachine::dragging`].

use glam::Vec2;

/// Distance that the pointer moves before a press becomes a drag, points.
pub(crate) const THRESHOLD: f32 = 4.0;

/// The result of an event for the drag.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DragEvent<P, D> {
    /// Nothing to act on.
    Nothing,
    /// The button went down; [`DragMachine::pressed`] returns what is known of it.
    Pressed,
    /// The pointer moved past the threshold. The owner calls [`DragMachine::begin`] to drag something; otherwise the
    /// rest of the press is ignored.
    Started(P),
    /// The drag continues, with the pointer at this position.
    Moved(Vec2),
    /// The button went up before the threshold.
    Clicked(P),
    /// The button went up, and the drag takes effect.
    Dropped(D),
    /// The drag ended as if it had never begun.
    Cancelled(D),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum DragPhase<P, D> {
    Idle,
    /// The button went down at this position; a release within `slack` points of it is a click.
    Pressed {
        at: Vec2,
        slack: f32,
        press: P,
    },
    Dragging(D),
    /// Cancelled or refused: all events are ignored until the button is up.
    Spent,
}

/// The state machine of a drag; the documentation of the module shows its states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DragMachine<P, D> {
    phase: DragPhase<P, D>,
}

impl<P, D> Default for DragMachine<P, D> {
    fn default() -> Self {
        Self { phase: DragPhase::Idle }
    }
}

impl<P, D> DragMachine<P, D> {
    /// Returns a machine in the middle of a drag.
    pub(crate) fn dragging(drag: D) -> Self {
        Self { phase: DragPhase::Dragging(drag) }
    }

    /// Returns whether the button is down and its press belongs to this machine, or a drag is in progress.
    pub(crate) fn is_busy(&self) -> bool {
        !matches!(self.phase, DragPhase::Idle)
    }

    /// Returns whether a press or a drag is in progress that can be cancelled.
    pub(crate) fn can_cancel(&self) -> bool {
        matches!(self.phase, DragPhase::Pressed { .. } | DragPhase::Dragging(_))
    }

    /// Returns the press that has not become a drag.
    pub(crate) fn pressed(&self) -> Option<&P> {
        match &self.phase {
            DragPhase::Pressed { press, .. } => Some(press),
            DragPhase::Idle | DragPhase::Dragging(_) | DragPhase::Spent => None,
        }
    }

    /// Returns what is being dragged.
    pub(crate) fn drag(&self) -> Option<&D> {
        match &self.phase {
            DragPhase::Dragging(drag) => Some(drag),
            DragPhase::Idle | DragPhase::Pressed { .. } | DragPhase::Spent => None,
        }
    }

    /// Returns what is being dragged, to be changed.
    pub(crate) fn drag_mut(&mut self) -> Option<&mut D> {
        match &mut self.phase {
            DragPhase::Dragging(drag) => Some(drag),
            DragPhase::Idle | DragPhase::Pressed { .. } | DragPhase::Spent => None,
        }
    }

    /// Begins to drag `drag`, in response to [`DragEvent::Started`] or at once.
    pub(crate) fn begin(&mut self, drag: D) {
        self.phase = DragPhase::Dragging(drag);
    }

    /// Ends a press or drag without an event; the rest of the press is ignored.
    pub(crate) fn spend(&mut self) {
        self.phase = DragPhase::Spent;
    }

    /// The button went down at `at`.
    pub(crate) fn press(&mut self, at: Vec2, press: P) {
        self.press_within(at, press, THRESHOLD);
    }

    /// The button went down at `at`, where the pointer may move by `slack` points instead of [`THRESHOLD`] and still click.
    pub(crate) fn press_within(&mut self, at: Vec2, press: P, slack: f32) {
        self.phase = DragPhase::Pressed { at, slack, press };
    }

    /// The pointer moved to `to`.
    pub(crate) fn moved(&mut self, to: Vec2) -> DragEvent<P, D> {
        match std::mem::replace(&mut self.phase, DragPhase::Spent) {
            DragPhase::Pressed { at, slack, press } if at.distance(to) > slack => DragEvent::Started(press),
            DragPhase::Dragging(drag) => {
                self.phase = DragPhase::Dragging(drag);
                DragEvent::Moved(to)
            }
            phase @ (DragPhase::Idle | DragPhase::Pressed { .. } | DragPhase::Spent) => {
                self.phase = phase;
                DragEvent::Nothing
            }
        }
    }

    /// The button went up.
    pub(crate) fn released(&mut self) -> DragEvent<P, D> {
        match std::mem::replace(&mut self.phase, DragPhase::Idle) {
            DragPhase::Idle | DragPhase::Spent => DragEvent::Nothing,
            DragPhase::Pressed { press, .. } => DragEvent::Clicked(press),
            DragPhase::Dragging(drag) => DragEvent::Dropped(drag),
        }
    }

    /// Escape, another button or lost input cancels the press or drag; the rest of the press is ignored.
    pub(crate) fn cancelled(&mut self) -> DragEvent<P, D> {
        match std::mem::replace(&mut self.phase, DragPhase::Spent) {
            DragPhase::Dragging(drag) => DragEvent::Cancelled(drag),
            DragPhase::Idle | DragPhase::Pressed { .. } | DragPhase::Spent => DragEvent::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec2;

    type Machine = DragMachine<&'static str, u32>;

    fn pressed() -> Machine {
        let mut machine = Machine::default();
        machine.press(Vec2::ZERO, "key");
        assert_eq!(machine.pressed(), Some(&"key"));
        machine
    }

    fn dragging() -> Machine {
        let mut machine = pressed();
        assert_eq!(machine.moved(vec2(9.0, 0.0)), DragEvent::Started("key"));
        machine.begin(7);
        machine
    }

    #[test]
    fn a_press_within_the_threshold_is_a_click() {
        let mut machine = pressed();
        assert_eq!(machine.moved(vec2(THRESHOLD, 0.0)), DragEvent::Nothing);
        assert_eq!(machine.released(), DragEvent::Clicked("key"));
        assert!(!machine.is_busy());
    }

    #[test]
    fn a_press_may_have_a_threshold_of_its_own() {
        let mut machine = Machine::default();
        machine.press_within(Vec2::ZERO, "ring", 1.5);
        assert_eq!(machine.moved(vec2(1.5, 0.0)), DragEvent::Nothing);
        assert_eq!(machine.moved(vec2(1.6, 0.0)), DragEvent::Started("ring"));
    }

    #[test]
    fn a_press_beyond_the_threshold_is_a_drag_until_the_button_is_up() {
        let mut machine = dragging();
        assert_eq!(machine.moved(vec2(1.0, 0.0)), DragEvent::Moved(vec2(1.0, 0.0)));
        assert_eq!(machine.released(), DragEvent::Dropped(7));
        assert_eq!(machine.released(), DragEvent::Nothing);
    }

    #[test]
    fn a_drag_is_cancelled_once_and_the_rest_of_the_press_is_ignored() {
        let mut machine = dragging();
        assert!(machine.can_cancel());
        assert_eq!(machine.cancelled(), DragEvent::Cancelled(7));
        assert!(!machine.can_cancel());
        assert_eq!(machine.cancelled(), DragEvent::Nothing);
        assert_eq!(machine.moved(vec2(30.0, 0.0)), DragEvent::Nothing);
        assert!(machine.is_busy());
        assert_eq!(machine.released(), DragEvent::Nothing);
        assert!(!machine.is_busy());
    }

    #[test]
    fn a_press_that_is_cancelled_is_no_click() {
        let mut machine = pressed();
        assert_eq!(machine.cancelled(), DragEvent::Nothing);
        assert_eq!(machine.released(), DragEvent::Nothing);
    }

    #[test]
    fn a_press_is_ignored_after_a_start_that_begins_no_drag() {
        let mut machine = pressed();
        assert_eq!(machine.moved(vec2(9.0, 0.0)), DragEvent::Started("key"));
        assert_eq!(machine.moved(vec2(19.0, 0.0)), DragEvent::Nothing);
        assert_eq!(machine.released(), DragEvent::Nothing);
    }

    #[test]
    fn a_press_after_a_cancelled_one_counts() {
        let mut machine = dragging();
        machine.cancelled();
        machine.press(Vec2::ZERO, "other");
        assert_eq!(machine.released(), DragEvent::Clicked("other"));
    }

    #[test]
    fn a_drag_can_begin_without_a_press() {
        let mut machine = Machine::dragging(3);
        assert_eq!(machine.moved(Vec2::ONE), DragEvent::Moved(Vec2::ONE));
        assert_eq!(machine.drag(), Some(&3));
        assert_eq!(machine.released(), DragEvent::Dropped(3));
    }
}
