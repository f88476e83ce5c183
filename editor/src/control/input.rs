//! What reaches the controls.

use super::key::{Key, Modifiers};
use super::viewport::Button;
use glam::Vec2;

/// What happened. Places are points from the top left of the window, y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InputEvent {
    /// The mouse is there now.
    MouseMove(Vec2),
    /// The mouse left the window. While a button is held the window system goes on telling places outside.
    MouseGone,
    /// A button went down, where the mouse is.
    MouseDown(Button),
    /// A button came up.
    MouseUp(Button),
    /// The wheel was turned, points.
    Wheel(Vec2),
    /// A key went down, or repeats.
    KeyDown(Key),
    /// A key came up.
    KeyUp(Key),
    /// What is held besides changed.
    Modifiers(Modifiers),
    /// The window lost the keyboard, a device was unplugged: releases will not be heard of.
    Lost,
}

/// Why a control has no place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PlaceError {
    /// It must lie inside of a control, and does not.
    #[error("the area is not inside its parent")]
    NotInside,
    /// There is no such control.
    #[error("the parent is not registered")]
    NoParent,
}
