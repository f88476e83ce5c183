//! Routes one input: to the control that it is for, then to its parents.

use super::{Capture, ControlFramework};
use crate::control::area::ControlId;
use crate::control::base::{BaseControl, ControlLookup, InputFlow, Mouse};
use crate::control::input::Button;
use crate::control::key::Key;
use glam::Vec2;

impl ControlFramework {
    pub(super) fn mouse_move(&mut self, at: Vec2, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        // No screen is this large: such a position is an error of the driver.
        if !(at.is_finite() && at.abs().max_element() < 1e5) {
            return None;
        }
        self.mouse = Some(at);
        self.mouse_gone = false;
        self.settle(controls);
        self.tell_mouse(controls, |control, mouse, framework| control.mouse_move(mouse, framework))
    }

    pub(super) fn wheel(&mut self, by: Vec2, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        if !by.is_finite() {
            return None;
        }
        self.tell_mouse(controls, |control, mouse, framework| control.mouse_wheel(by, mouse, framework))
    }

    pub(super) fn mouse_down(
        &mut self,
        button: Button,
        controls: &mut dyn ControlLookup,
    ) -> Option<ControlId> {
        if self.held[button as usize] {
            // The release never arrived: what the press began is cancelled.
            self.lost_mouse(controls);
        }
        let begins = !self.held.contains(&true);
        self.held[button as usize] = true;
        if begins {
            let under = self.grabbed.or_else(|| self.under(self.pointer()?, controls));
            self.capture = under.map_or(Capture::Gone, |control| Capture::By { control, topmost: control });
        }
        let mouse = Mouse { at: self.mouse?, modifiers: self.modifiers };
        let Capture::By { control, .. } = self.capture else { return None };
        let mut next = Some(control);
        while let Some(id) = next {
            next = self.places.parent(id);
            if !begins || id == control || self.is_on(id, mouse.at, controls) {
                let Some(control) = self.there(id, controls) else { continue };
                match &mut self.capture {
                    // The last ancestor that any press was passed on to.
                    Capture::By { topmost, .. } if self.places.is_inside(*topmost, id) => *topmost = id,
                    Capture::By { .. } => {}
                    // The pressed control unregistered itself and passed the press on.
                    _ => self.capture = Capture::By { control: id, topmost: id },
                }
                if control.mouse_down(button, mouse, self) == InputFlow::Stop {
                    return Some(id);
                }
                // The control may have unregistered itself; its parent was read before.
            }
        }
        None
    }

    pub(super) fn mouse_up(&mut self, button: Button, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        if !std::mem::take(&mut self.held[button as usize]) {
            return None;
        }
        let stopped = match self.capture {
            Capture::By { .. } => self
                .tell_mouse(controls, |control, mouse, framework| control.mouse_up(button, mouse, framework)),
            _ => None,
        };
        if !self.held.contains(&true) {
            self.capture = Capture::Free;
        }
        stopped
    }

    /// Calls the control that has the mouse, or the one under it, then those that it passes the input on to.
    pub(super) fn tell_mouse(
        &mut self,
        controls: &mut dyn ControlLookup,
        mut tell: impl FnMut(&mut dyn BaseControl, Mouse, &mut Self) -> InputFlow,
    ) -> Option<ControlId> {
        let (first, is_captured) = match self.capture {
            Capture::By { control, .. } => (Some(control), true),
            Capture::Free if self.grabbed.is_some() => (self.grabbed, true),
            Capture::Free => (self.under(self.pointer()?, controls), false),
            Capture::Gone => (None, false),
        };
        let mouse = Mouse { at: self.mouse?, modifiers: self.modifiers };
        let mut next = first;
        while let Some(id) = next {
            next = self.places.parent(id);
            // A captured mouse may be anywhere: the controls that got the press get all later inputs of it.
            if is_captured || Some(id) == first || self.is_on(id, mouse.at, controls) {
                let Some(control) = self.there(id, controls) else { continue };
                if tell(control, mouse, self) == InputFlow::Stop {
                    return Some(id);
                }
            }
        }
        None
    }

    pub(super) fn key_down(&mut self, key: Key, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        let held = self.keys.find(key);
        let target = match held {
            Some(control) => control,
            None => {
                // During a drag, keys are for the drag: Escape, an axis, a number.
                let known = self.captured().or(self.focus);
                let control = match known {
                    Some(control) => control,
                    None => self.under(self.pointer()?, controls)?,
                };
                if let Some(oldest) = self.keys.full() {
                    self.key_up(oldest, controls);
                }
                self.keys.put(key, control);
                control
            }
        };
        let modifiers = self.modifiers;
        self.tell(target, controls, |control, framework| {
            control.key_down(key, modifiers, held.is_some(), framework)
        })
    }

    pub(super) fn key_up(&mut self, key: Key, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        let control = self.keys.take(key)?;
        let modifiers = self.modifiers;
        self.tell(control, controls, |control, framework| control.key_up(key, modifiers, framework))
    }

    /// Calls a control, and those that it passes the input on to.
    pub(super) fn tell(
        &mut self,
        first: ControlId,
        controls: &mut dyn ControlLookup,
        mut tell: impl FnMut(&mut dyn BaseControl, &mut Self) -> InputFlow,
    ) -> Option<ControlId> {
        let mut next = Some(first);
        while let Some(id) = next {
            next = self.places.parent(id);
            let Some(control) = self.there(id, controls) else { continue };
            if tell(control, self) == InputFlow::Stop {
                return Some(id);
            }
        }
        None
    }
}
