//! What lies over the picture and is not for the scene.

use crate::control::base::{BaseControl, Mouse, Pass, PassFlags};
use crate::control::framework::ControlFramework;
use crate::control::viewport::Button;

/// A tool of the panels over the picture: the mouse is its, keys go on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shield;

impl BaseControl for Shield {
    fn flags(&self) -> PassFlags {
        PassFlags { mouse_move: false, mouse_button: false, keys: true }
    }

    fn mouse_down(&mut self, _: Button, _: Mouse, _: &mut ControlFramework) -> Pass {
        Pass::Stop
    }
}
