//! Which bone lies under a pointer that moves over the picture, asked one question at a time.
//!
//! The pointer reports far more places than anybody can answer: while a question is on its way none follows, and then only
//! the newest place is asked for. Where nothing changes nothing is asked, so a pointer at rest costs nothing.

use dragonfly_picture::camera::Camera;

/// A place in a picture: what the answer depends on, besides the time of the take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Physical pixels from the window's top left.
    pub position: [f32; 2],
    /// From where the model is seen.
    pub camera: Camera,
    /// Which model.
    pub generation: u64,
}

/// See the module.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hover {
    /// What was asked last.
    asked: Option<Place>,
    /// The question on its way.
    ticket: Option<u64>,
}

impl Hover {
    /// Must `place` be asked for now? Then it is to be asked with `ticket`, and no other until it is answered.
    pub fn asks(&mut self, place: Option<Place>, ticket: u64) -> bool {
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

    /// Takes an answer. Is it one to a question asked here, about a pointer that is still over the picture?
    pub fn answered(&mut self, ticket: u64) -> bool {
        let own = self.ticket == Some(ticket);
        if own {
            self.ticket = None;
        }
        own && self.asked.is_some()
    }
}
