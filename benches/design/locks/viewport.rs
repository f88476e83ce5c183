//! The viewport, in the graphics thread.

use super::SharedState;
use crate::design::skeleton::{self, Line};

/// Draws each newest version until the editor closes.
pub fn run(shared: &SharedState, mut screen: impl FnMut(&[Line])) {
    let mut seen = 0;
    while let Some(bones) = shared.wait_for_change(&mut seen) {
        let picture = skeleton::draw(&bones);
        shared.keep(picture.clone());
        screen(&picture);
    }
}
