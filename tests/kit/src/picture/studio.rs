//! A device for tests; without any Vulkan adapter they say so and pass.

use super::complaints::NoComplaints;
use dragonfly_picture::{DeviceParameters, GraphicsError, Studio};
use std::ops::{Deref, DerefMut};

/// A studio in which nothing may be done wrong.
pub struct Watched {
    studio: Studio,
    // Dropped last, when the device is gone.
    _watch: NoComplaints,
}

impl Deref for Watched {
    type Target = Studio;

    fn deref(&self) -> &Studio {
        &self.studio
    }
}

impl DerefMut for Watched {
    fn deref_mut(&mut self) -> &mut Studio {
        &mut self.studio
    }
}

/// A studio on the machine's adapter.
pub fn studio() -> Option<Watched> {
    let watch = NoComplaints::expect();
    match Studio::with(DeviceParameters::default()) {
        Ok(studio) => Some(Watched { studio, _watch: watch }),
        Err(GraphicsError::NoAdapter(reason)) => {
            eprintln!("skipped: no graphics adapter ({reason})");
            None
        }
        Err(error) => panic!("{error}"),
    }
}
