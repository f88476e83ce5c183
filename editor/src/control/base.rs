//! What every control is (thesis §3.2.9.3).

use super::Button;
use super::framework::ControlFramework;
use super::input::PlaceError;
use super::key::{Key, Modifiers};
use glam::Vec2;

/// Names a control in its [`ControlFramework`]. The name of a control that is gone is never given to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ControlId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

impl ControlId {
    /// The control without function that is as large as the window and parent of all.
    pub const ROOT: Self = Self { slot: 0, generation: 0 };
}

/// A rectangle, in points from the top left of the window, y down. Its left and upper edge belong to it, the others not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Area {
    /// Top left.
    pub min: Vec2,
    /// Bottom right.
    pub max: Vec2,
}

impl Area {
    /// From corner to corner. What is not finite, or runs backwards, is empty: nothing is on it.
    pub fn new(min: Vec2, max: Vec2) -> Self {
        if min.is_finite() && max.is_finite() && min.cmple(max).all() {
            Self { min, max }
        } else {
            Self::default()
        }
    }

    /// Is the point on it?
    pub fn holds(&self, point: Vec2) -> bool {
        point.cmpge(self.min).all() && point.cmplt(self.max).all()
    }

    /// Does all of `other` lie on it? Of two equal ones each contains the other.
    pub fn contains(&self, other: &Self) -> bool {
        other.min.cmpge(self.min).all() && other.max.cmple(self.max).all()
    }

    /// Square points.
    pub fn size(&self) -> f64 {
        let size = (self.max - self.min).as_dvec2();
        size.x * size.y
    }
}

/// Who hears of an input when a control has processed it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    /// Nobody else.
    Stop,
    /// The parent too.
    ToParent,
}

/// The thesis's flags: which kinds of input a control's default bodies pass to its parent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PassFlags {
    /// Moves of the mouse and turns of its wheel.
    pub mouse_move: bool,
    /// Buttons of the mouse.
    pub mouse_button: bool,
    /// Keys.
    pub keys: bool,
}

impl PassFlags {
    /// Everything goes on to the parent, as if the control were not there.
    pub const ALL: Self = Self { mouse_move: true, mouse_button: true, keys: true };
    /// Nothing goes on.
    pub const NONE: Self = Self { mouse_move: false, mouse_button: false, keys: false };

    fn pass(on: bool) -> Pass {
        if on { Pass::ToParent } else { Pass::Stop }
    }
}

/// What the mouse does, as a control hears of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mouse {
    /// Points from the top left of the window; outside of the control while it has the mouse captured.
    pub at: Vec2,
    /// What is held besides.
    pub modifiers: Modifiers,
}

/// A control of the scene: default bodies do nothing and pass on what [`Self::flags`] says.
///
/// Its owner keeps it and registers its area in a [`ControlFramework`], which calls the methods below. Each gets the
/// framework, and may register, unregister, move and focus controls there, itself included.
pub trait BaseControl {
    /// What the default bodies pass on.
    fn flags(&self) -> PassFlags {
        PassFlags::ALL
    }

    /// Is the point, which lies on its area, on the control? For controls that are no rectangles.
    fn is_pos_on(&self, point: Vec2) -> bool {
        let _ = point;
        true
    }

    /// Registers a control inside this one, whose name is `own`. An area that does not lie inside is refused.
    fn register_control(
        &self,
        own: ControlId,
        area: Area,
        framework: &mut ControlFramework,
    ) -> Result<ControlId, PlaceError> {
        framework.register_inside(own, area)
    }

    /// Takes a control out again that lies inside this one, whose name is `own`; tells whether there was such a one.
    fn unregister_control(&self, own: ControlId, inner: ControlId, framework: &mut ControlFramework) -> bool {
        inner != own && framework.is_inside(inner, own) && framework.unregister_control(inner)
    }

    /// It has the keyboard from now on.
    fn set_focus(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// It has not the keyboard any more.
    fn null_focus(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// A key went down, or repeats because it is held. Goes to the control that has the mouse captured, else to the one with
    /// the focus, else to the one under the mouse.
    fn key_down(
        &mut self,
        key: Key,
        modifiers: Modifiers,
        repeat: bool,
        framework: &mut ControlFramework,
    ) -> Pass {
        let _ = (key, modifiers, repeat, framework);
        PassFlags::pass(self.flags().keys)
    }

    /// A key came up. Told to who was told that it went down, wherever the mouse and the focus are now.
    fn key_up(&mut self, key: Key, modifiers: Modifiers, framework: &mut ControlFramework) -> Pass {
        let _ = (key, modifiers, framework);
        PassFlags::pass(self.flags().keys)
    }

    /// The mouse is over this control from now on, and over none of those inside it. Not passed on.
    fn mouse_enter(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// The mouse is elsewhere. Follows each [`Self::mouse_enter`] exactly once, unless the control is unregistered.
    fn mouse_leave(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }

    /// The mouse moved, over the control or captured by it.
    fn mouse_move(&mut self, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let _ = (mouse, framework);
        PassFlags::pass(self.flags().mouse_move)
    }

    /// The wheel was turned by so many points.
    fn mouse_wheel(&mut self, by: Vec2, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let _ = (by, mouse, framework);
        PassFlags::pass(self.flags().mouse_move)
    }

    /// A button went down. The mouse is captured until all buttons are up.
    fn mouse_down(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let _ = (button, mouse, framework);
        PassFlags::pass(self.flags().mouse_button)
    }

    /// A button came up, of those that went down on this control.
    fn mouse_up(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let _ = (button, mouse, framework);
        PassFlags::pass(self.flags().mouse_button)
    }

    /// What the control was doing with the mouse ends here, and is to be taken back: the release will never be heard of.
    /// Goes to the control that has the mouse captured and to those that it passed the press on to; when the whole window
    /// lost its input, also to one that grabbed it.
    fn input_lost(&mut self, framework: &mut ControlFramework) {
        let _ = framework;
    }
}

/// Who has the controls: the framework knows their names and places only, so nobody owns anything twice.
pub trait Controls {
    /// The control of this name; `None` where its owner has none (any more), which is as if it had no function.
    fn control(&mut self, id: ControlId) -> Option<&mut dyn BaseControl>;
}
