//! Areas of the viewport that panels cover.

use crate::control::base::{BaseControl, InputFlow, Mouse, PassFlags};
use crate::control::framework::ControlFramework;
use crate::control::input::Button;

/// A toolbar of the panels over the viewport: it stops the mouse, and passes keys on.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shield;

impl BaseControl for Shield {
    fn flags(&self) -> PassFlags {
        PassFlags { mouse_move: false, mouse_button: false, keys: true }
    }

    fn mouse_down(&mut self, _: Button, _: Mouse, _: &mut ControlFramework) -> InputFlow {
        InputFlow::Stop
    }
}
