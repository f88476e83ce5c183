//! The sound of the model that is open: a file, the frame at which it starts, and its peaks once they are read. It is shown in the
//! timeline, and played where there is an audio device.

use dragonfly_document::SoundPeaks;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::Arc;

/// The settings of a sound, remembered for each file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct SoundSettings {
    /// The file; empty for none.
    pub file: PathBuf,
    /// The frame of the take at which it starts.
    pub start: i32,
}

impl SoundSettings {
    /// Largest number of a frame.
    pub const LATEST: i32 = 10_000_000;

    /// Returns the nearest valid settings.
    fn sanitized(self) -> Self {
        Self { start: self.start.clamp(-Self::LATEST, Self::LATEST), ..self }
    }

    /// Returns whether a sound was chosen.
    pub fn is_chosen(&self) -> bool {
        !self.file.as_os_str().is_empty()
    }
}

/// The sound.
#[derive(Debug, Default)]
pub struct SoundTrack {
    settings: SoundSettings,
    /// Grows with every change of the settings.
    version: u64,
    peaks: Option<Arc<SoundPeaks>>,
    problem: Option<String>,
}

impl SoundTrack {
    /// Returns the settings.
    pub fn settings(&self) -> &SoundSettings {
        &self.settings
    }

    /// Returns a number that grows with every change of the settings.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns its peaks; `None` until they are read.
    pub fn peaks(&self) -> Option<&Arc<SoundPeaks>> {
        self.peaks.as_ref()
    }

    /// Returns the reason why it is not shown.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Sets the settings. Of another file nothing is known yet.
    pub(super) fn set(&mut self, settings: SoundSettings) {
        let settings = settings.sanitized();
        if settings == self.settings {
            return;
        }
        if settings.file != self.settings.file {
            (self.peaks, self.problem) = (None, None);
        }
        self.settings = settings;
        self.version += 1;
    }

    /// Notes the peaks of its file, or why there are none.
    pub fn read(&mut self, peaks: Result<SoundPeaks, String>) {
        match peaks {
            Ok(peaks) => (self.peaks, self.problem) = (Some(Arc::new(peaks)), None),
            Err(reason) => (self.peaks, self.problem) = (None, Some(reason)),
        }
    }
}
