//! The drags of panels: [`PanelDrag`] driven once a frame by what the pointer does.
//!
//! A panel calls [`PanelDrag::step`] once a frame with what the pointer does and acts on the [`DragEvent`] that comes
//! back. What can be pressed on (`T`) and what can be dragged (`D`) are types of the panel. Escape and the right button
//! cancel.

mod field_gesture;
mod pointer;
mod selection_box;

pub(in crate::panels) use crate::control::drag::DragEvent;
pub(in crate::panels) use field_gesture::FieldGesture;
pub(in crate::panels) use pointer::{PointerInput, position, readout};
pub(in crate::panels) use selection_box::{SelectionBox, choice_of};

use crate::control::drag::DragMachine;
use egui::{Modifiers, Pos2};
use glam::Vec2;

/// A press of the primary button.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::panels) struct Press<T> {
    /// Position of the press, points.
    pub(in crate::panels) at: Pos2,
    /// Target under the pointer.
    pub(in crate::panels) on: T,
    /// Modifier keys held at that time.
    pub(in crate::panels) modifiers: Modifiers,
}

/// The drag machine of a panel: `T` is what can be pressed, `D` is what can be dragged.
pub(in crate::panels) type PanelDrag<T, D> = DragMachine<Press<T>, D>;

impl<T, D> PanelDrag<T, D> {
    /// Advances by one frame. `held` is whether egui gives the pressed pointer to this panel, or a click within one frame;
    /// `target` returns what is under a point.
    pub(in crate::panels) fn step(
        &mut self,
        input: &PointerInput,
        held: bool,
        target: impl FnOnce(Pos2) -> T,
    ) -> DragEvent<Press<T>, D> {
        let cancels_drag = input.cancels && self.drag().is_some();
        if !input.primary_down && !cancels_drag {
            if let Some(at) = input.pointer.filter(|_| held && input.clicked && !self.is_busy()) {
                self.press(Vec2::new(at.x, at.y), Press { at, on: target(at), modifiers: input.modifiers });
            }
            return self.released();
        }
        // Before `held`: egui itself releases what it drags when Escape is pressed.
        if input.cancels && (held || self.is_busy()) {
            return self.cancelled();
        }
        let (true, Some(pointer)) = (held, input.pointer) else { return DragEvent::Nothing };
        if self.is_busy() {
            return self.moved(Vec2::new(pointer.x, pointer.y));
        }
        if input.pans {
            self.spend();
            return DragEvent::Nothing;
        }
        let at = input.pressed_at.unwrap_or(pointer);
        self.press(Vec2::new(at.x, at.y), Press { at, on: target(at), modifiers: input.modifiers });
        DragEvent::Pressed
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::drag::THRESHOLD;
    use egui::pos2;

    type Machine = PanelDrag<&'static str, u32>;

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

    fn step(machine: &mut Machine, input: PointerInput) -> DragEvent<Press<&'static str>, u32> {
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
    fn a_press_and_a_release_in_one_frame_are_a_click() {
        let mut machine = Machine::default();
        let quick = PointerInput { clicked: true, pointer: Some(pos2(3.0, 0.0)), ..up() };
        assert_eq!(machine.step(&quick, false, |_| "key"), DragEvent::Nothing, "on another widget");
        assert!(
            matches!(machine.step(&quick, true, |_| "key"), DragEvent::Clicked(press) if press.at.x == 3.0)
        );
        assert!(!machine.is_busy());
        let mut machine = dragging();
        assert_eq!(
            machine.step(&quick, true, |_| "key"),
            DragEvent::Dropped(7),
            "the end of a drag is no click"
        );
    }

    #[test]
    fn a_press_beyond_the_threshold_is_a_drag_until_the_button_is_up() {
        let mut machine = dragging();
        assert_eq!(step(&mut machine, down(1.0)), DragEvent::Moved(Vec2::new(1.0, 0.0)));
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
    fn a_press_is_ignored_after_a_start_that_begins_no_drag() {
        let mut machine = Machine::default();
        step(&mut machine, down(0.0));
        assert!(matches!(step(&mut machine, down(9.0)), DragEvent::Started(_)));
        assert_eq!(step(&mut machine, down(19.0)), DragEvent::Nothing);
        assert_eq!(step(&mut machine, up()), DragEvent::Nothing);
    }

    #[test]
    fn a_press_that_egui_gives_to_another_widget_is_ignored() {
        let mut machine = Machine::default();
        assert_eq!(machine.step(&down(0.0), false, |_| "key"), DragEvent::Nothing);
        assert!(!machine.is_busy());
    }
}
