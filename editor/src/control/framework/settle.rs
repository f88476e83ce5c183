//! Notifies controls when mouse and focus change.

use super::{Capture, ControlFramework, ROUNDS};
use crate::control::area::ControlId;
use crate::control::base::{BaseControl, ControlLookup};
use crate::control::key::{HELD_KEYS, Modifiers};
use glam::Vec2;

impl ControlFramework {
    /// Cancels what was begun with the mouse and releases all keys, because their releases will not arrive.
    pub(super) fn lost(&mut self, controls: &mut dyn ControlLookup) {
        let captured = match self.capture {
            Capture::By { control, .. } => Some(control),
            _ => None,
        };
        let grabbed = self.grabbed.take().filter(|&grabbed| Some(grabbed) != captured);
        self.lost_mouse(controls);
        if let Some(control) = grabbed.and_then(|id| self.there(id, controls)) {
            control.input_lost(self);
        }
        self.mouse = None;
        self.modifiers = Modifiers::default();
        for _ in 0..HELD_KEYS {
            let Some(key) = self.keys.first() else { return };
            self.key_up(key, controls);
        }
    }

    pub(super) fn lost_mouse(&mut self, controls: &mut dyn ControlLookup) {
        self.held = [false; 3];
        let Capture::By { control, topmost } = std::mem::take(&mut self.capture) else { return };
        let mut next = Some(control);
        while let Some(id) = next {
            next = self.places.parent(id).filter(|_| id != topmost);
            if let Some(control) = self.there(id, controls) {
                control.input_lost(self);
            }
        }
    }

    /// Notifies the controls of mouse and focus until nothing changes any more.
    pub(super) fn settle(&mut self, controls: &mut dyn ControlLookup) {
        for _ in 0..ROUNDS {
            let over = match self.capture {
                // A captured mouse stays with its control.
                Capture::By { .. } | Capture::Gone => self.entered,
                Capture::Free => self.grabbed.or_else(|| self.under(self.pointer()?, controls)),
            };
            if over == self.entered && self.focus == self.focus_told {
                return;
            }
            if over != self.entered {
                if let Some(control) = self.entered.take().and_then(|id| controls.control(id)) {
                    control.mouse_leave(self);
                }
                // The control that was left may have unregistered the other one.
                if let Some(id) = over.filter(|&id| self.places.area(id).is_some()) {
                    self.entered = Some(id);
                    if let Some(control) = controls.control(id) {
                        control.mouse_enter(self);
                    }
                }
            }
            if self.focus != self.focus_told {
                let now = self.focus;
                if let Some(control) = self.focus_told.take().and_then(|id| controls.control(id)) {
                    control.null_focus(self);
                }
                if let Some(id) = now.filter(|_| self.focus == now) {
                    self.focus_told = now;
                    if let Some(control) = controls.control(id) {
                        control.set_focus(self);
                    }
                }
            }
        }
        // If two controls keep taking the focus from each other, it stays with the one that was notified last.
        self.focus = self.focus_told;
    }

    /// Returns the position of the mouse; `None` outside the window.
    pub(super) fn pointer(&self) -> Option<Vec2> {
        self.mouse.filter(|_| !self.mouse_gone)
    }

    /// Returns the control at a point; never the root, which has no function.
    pub(super) fn under(&self, point: Vec2, controls: &mut dyn ControlLookup) -> Option<ControlId> {
        let window = self.places.area(ControlId::ROOT)?;
        if !window.holds(point) {
            return None;
        }
        self.places.smallest(|id, area| {
            area.holds(point) && controls.control(id).is_some_and(|control| control.is_pos_on(point))
        })
    }

    /// Returns the control if it is still registered: a control that was called before may have unregistered it.
    pub(super) fn there<'a>(
        &self,
        id: ControlId,
        controls: &'a mut dyn ControlLookup,
    ) -> Option<&'a mut dyn BaseControl> {
        self.places.area(id)?;
        controls.control(id)
    }

    pub(super) fn is_on(&self, id: ControlId, point: Vec2, controls: &mut dyn ControlLookup) -> bool {
        let holds = self.places.area(id).is_some_and(|area| area.holds(point));
        holds && controls.control(id).is_some_and(|control| control.is_pos_on(point))
    }
}
