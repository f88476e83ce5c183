//! Graphics devices for tests, which are skipped where there is no Vulkan adapter.

use super::complaints::NoComplaints;
use crate::skip::{TestNeed, skip};
use dragonfly_picture::{DeviceParameters, GraphicsError, Studio};
use std::ops::{Deref, DerefMut};

/// A studio whose use must cause no validation error.
pub struct CheckedStudio {
    studio: Studio,
    // Dropped last, when the device is gone.
    _watch: NoComplaints,
}

impl Deref for CheckedStudio {
    type Target = Studio;

    fn deref(&self) -> &Studio {
        &self.studio
    }
}

impl DerefMut for CheckedStudio {
    fn deref_mut(&mut self) -> &mut Studio {
        &mut self.studio
    }
}

/// Returns a studio on the adapter of the machine; skips the test where there is none.
pub fn studio() -> Option<CheckedStudio> {
    studio_with(DeviceParameters::default())
}

/// Does the same as [`studio`] with other parameters.
pub fn studio_with(parameters: DeviceParameters) -> Option<CheckedStudio> {
    let watch = NoComplaints::expect();
    match Studio::with(parameters) {
        Ok(studio) => Some(CheckedStudio { studio, _watch: watch }),
        Err(GraphicsError::NoAdapter(reason)) => {
            skip(TestNeed::Adapter, reason);
            None
        }
        Err(error) => panic!("{error}"),
    }
}
