//! One input, from its arrival to the notifications that follow it.

use super::ControlFramework;
use crate::control::area::ControlId;
use crate::control::base::ControlLookup;
use crate::control::input::InputEvent;

impl ControlFramework {
    /// Routes an input to its control, then to the parents as far as it is passed on. Returns the control that stopped
    /// it; `None` if it reached the root.
    pub fn resolve_input(
        &mut self,
        event: InputEvent,
        controls: &mut dyn ControlLookup,
    ) -> Option<ControlId> {
        self.settle(controls);
        let stopped = match event {
            InputEvent::MouseMove(at) => self.mouse_move(at, controls),
            InputEvent::MouseGone => {
                self.mouse_gone = true;
                None
            }
            InputEvent::MouseDown(button) => self.mouse_down(button, controls),
            InputEvent::MouseUp(button) => self.mouse_up(button, controls),
            InputEvent::Wheel(by) => self.wheel(by, controls),
            InputEvent::KeyDown(key) => self.key_down(key, controls),
            InputEvent::KeyUp(key) => self.key_up(key, controls),
            InputEvent::Modifiers(modifiers) => {
                self.modifiers = modifiers;
                // The modifier keys may change a drag, although the mouse rests.
                self.pointer().and_then(|at| self.mouse_move(at, controls))
            }
            InputEvent::Lost => {
                self.lost(controls);
                None
            }
        };
        self.settle(controls);
        stopped
    }

    /// Notifies the controls if mouse or focus changed without an input, for example because a control was moved.
    /// Called once per frame.
    pub fn update(&mut self, controls: &mut dyn ControlLookup) {
        self.settle(controls);
    }
}
