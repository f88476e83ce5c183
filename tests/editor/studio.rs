//! A device for tests; without any Vulkan adapter they say so and pass.

use dragonfly::graphics::{DeviceParameters, GraphicsError, Studio};

/// A studio on the machine's adapter.
pub(crate) fn studio() -> Option<Studio> {
    match Studio::with(DeviceParameters::default()) {
        Ok(studio) => Some(studio),
        Err(GraphicsError::NoAdapter(reason)) => {
            eprintln!("skipped: no graphics adapter ({reason})");
            None
        }
        Err(error) => panic!("{error}"),
    }
}
