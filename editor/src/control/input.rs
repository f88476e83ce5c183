//! The inputs of the controls.

use super::key::{Key, Modifiers};
use glam::Vec2;

/// A mouse button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// Clicks and draws boxes; with Alt it orbits, with Ctrl and Alt it draws a lasso.
    Left,
    /// Orbits; with Shift or Alt it pans.
    Middle,
    /// With Alt it zooms.
    Right,
}

/// An input. Positions are points from the top left of the window, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputEvent {
    /// The mouse moved to a position.
    MouseMove(Vec2),
    /// The mouse left the window. While a button is held, the window system still reports positions outside.
    MouseGone,
    /// A button went down at the position of the mouse.
    MouseDown(Button),
    /// A button went up.
    MouseUp(Button),
    /// The wheel was turned, points.
    Wheel(Vec2),
    /// A key went down, or repeats.
    KeyDown(Key),
    /// A key came up.
    KeyUp(Key),
    /// The modifier keys changed.
    Modifiers(Modifiers),
    /// The window lost the keyboard, or a device was unplugged: releases will not arrive.
    Lost,
}

/// Why a control cannot be registered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlaceError {
    /// Its area is not inside the control that is to be its parent.
    #[error("the area is not inside its parent")]
    NotInside,
    /// The parent does not exist.
    #[error("the parent is not registered")]
    NoParent,
}
