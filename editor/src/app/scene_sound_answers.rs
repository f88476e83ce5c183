//! The receiver of the sounds of a scene in the main thread.

use super::interface::Interface;
use super::scene_sounds::SceneSoundAnswer;
use dragonfly_runtime::{Context, Receiver};
use std::cell::RefCell;
use std::rc::Rc;

/// Passes the answers of the jobs on.
pub(super) struct SceneSoundAnswers(pub Rc<RefCell<Interface>>);

impl Receiver for SceneSoundAnswers {
    type Message = SceneSoundAnswer;

    fn receive(&mut self, answer: SceneSoundAnswer, _main: &mut Context) {
        let mut interface = self.0.borrow_mut();
        interface.scene_sound_answered(answer);
        interface.redraw();
    }
}
