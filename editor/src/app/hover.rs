//! Finds the bone under a pointer that moves over the viewport, with one question at a time.
//!
//! The pointer reports far more positions than can be answered. So while a question is pending no other is
//! sent, and afterwards only the newest position is asked for. No question is sent if nothing has changed,
//! so a pointer at rest costs nothing.

use dragonfly_picture::camera::Camera;

/// A position in the viewport, and the state on which the bone there depends, except the time of the take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoverPoint {
    /// Physical pixels from the window's top left.
    pub position: [f32; 2],
    /// The camera.
    pub camera: Camera,
    /// Generation of the view.
    pub generation: u64,
}

/// The question that was asked last, and whether its answer is pending.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hover {
    /// The position that was asked for last.
    asked: Option<HoverPoint>,
    /// Ticket of the pending question.
    ticket: Option<u64>,
}

impl Hover {
    /// Returns whether to ask for `place` now, as question `ticket`. No other question is asked until this
    /// one is answered.
    pub fn asks(&mut self, place: Option<HoverPoint>, ticket: u64) -> bool {
        let Some(place) = place else {
            self.asked = None;
            return false;
        };
        if self.ticket.is_some() || self.asked == Some(place) {
            return false;
        }
        (self.asked, self.ticket) = (Some(place), Some(ticket));
        true
    }

    /// Records the answer to question `ticket`. Returns whether it was asked here and the pointer is still
    /// over the viewport.
    pub fn answered(&mut self, ticket: u64) -> bool {
        let own = self.ticket == Some(ticket);
        if own {
            self.ticket = None;
        }
        own && self.asked.is_some()
    }
}
