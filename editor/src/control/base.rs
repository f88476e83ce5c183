//! The trait of all controls (thesis §3.2.9.3).

use super::area::{Area, ControlId};
use super::framework::ControlFramework;
use super::input::{Button, PlaceError};
use super::key::{Key, Modifiers};
use glam::Vec2;

/// Whether an input is passed on after a control has processed it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFlow {
    /// It is not passed on.
    Stop,
    /// It is passed on to the parent.
    ToParent,
}

/// The thesis's flags: the kinds of input that a control's default methods pass on to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassFlags {
    /// Movements of the mouse, and its wheel.
    pub mouse_move: bool,
    /// Mouse buttons.
    pub mouse_button: bool,
    /// Keys.
    pub keys: bool,
}

impl PassFlags {
    /// Everything is passed on to the parent, as if the control did not exist.
    pub const ALL: Self = Self { mouse_move: true, mouse_button: true, keys: true };
    /// Nothing is passed on.
    pub const NONE: Self = Self { mouse_move: false, mouse_button: false, keys: false };

    fn pass(on: bool) -> InputFlow {
        if on { InputFlow::ToParent } else { InputFlow::Stop }
    }
}

/// The state of the mouse in an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mouse {
    /// Position in points from the top left of the window; outside the control while it has captured the mouse.
    pub at: Vec2,
    /// Modifier keys.
    pub modifiers: Modifiers,
}

/// A control of the scene. The default methods do nothing, and pass on what [`Self::flags`] contains.
///
/// The owner of a control registers its area in a [`ControlFramework`], which calls the methods below. Each method
/// gets the framework, and may register, unregister, move and focus controls there, itself included.
pub trait BaseControl {
    /// Returns what the default methods pass on.
    fn flags(&self) -> PassFlags {
        PassFlags::ALL
    }

    /// Whether a point inside its area belongs to the control: for controls that are not rectangles.
    fn is_pos_on(&self, point: Vec2) -> bool {
        let _ = point;
        true
    }

    /// Registers a control inside this one, whose id is `own`. An area outside it is an error.
    fn register_control(
        &self,
        own: ControlId,
        area: Area,
        framework: &mut ControlFramework,
    ) -> Result<ControlId, PlaceError> {
        framework.register_inside(own, area)
    }

    /// Unregisters a control inside this one, whose id is `own`. Returns whether it existed.
    fn unregister_control(&self, own: ControlId, inner: ControlId, framework: &mut ControlFramework) -> bool {
        inner != own && framework.is_inside(inner, own) && framework.unregister_control(inner)
    }

    /// The control has got the keyboard focus.
    fn set_focus(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// The control has lost the keyboard focus.
    fn null_focus(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// A key went down, or repeats because it is held. Sent to the control that has captured the mouse, else to the
    /// focused one, else to the one under the mouse.
    fn key_down(
        &mut self,
        key: Key,
        modifiers: Modifiers,
        repeat: bool,
        framework: &mut ControlFramework,
    ) -> InputFlow {
        let _ = (key, modifiers, repeat, framework);
        PassFlags::pass(self.flags().keys)
    }

    /// A key went up. Sent to the control that got the press, wherever mouse and focus are now.
    fn key_up(&mut self, key: Key, modifiers: Modifiers, framework: &mut ControlFramework) -> InputFlow {
        let _ = (key, modifiers, framework);
        PassFlags::pass(self.flags().keys)
    }

    /// The mouse has entered this control, and is not over a control inside it. Not passed on to the parent.
    fn mouse_enter(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// The mouse has left. Follows each [`Self::mouse_enter`] exactly once, unless the control is unregistered.
    fn mouse_leave(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// The mouse moved, inside the control or captured by it.
    fn mouse_move(&mut self, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let _ = (mouse, framework);
        PassFlags::pass(self.flags().mouse_move)
    }

    /// The wheel was turned, in points.
    fn mouse_wheel(&mut self, by: Vec2, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let _ = (by, mouse, framework);
        PassFlags::pass(self.flags().mouse_move)
    }

    /// A button went down. The mouse is captured until all buttons are up.
    fn mouse_down(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let _ = (button, mouse, framework);
        PassFlags::pass(self.flags().mouse_button)
    }

    /// A button went up that went down in this control.
    fn mouse_up(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let _ = (button, mouse, framework);
        PassFlags::pass(self.flags().mouse_button)
    }

    /// The control must cancel what it does with the mouse, because the release will never arrive. Sent to the control
    /// that has captured the mouse and to those that it passed the press on to; when the whole window lost its input,
    /// also to a control that grabbed the mouse.
    fn input_lost(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }
}

/// Access to the controls. The framework knows only their ids and areas, so that each control has one owner.
pub trait ControlLookup {
    /// Returns the control with this id; `None`, which acts like a control without function, if there is none (any
    /// more).
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl>;
}
