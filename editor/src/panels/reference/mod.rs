//! The reference picture: its settings, and the frames that were found and decoded so far. The program around the panels reads the files.

pub mod dialog;
pub mod settings;
pub mod timing;

pub use settings::{ReferenceSettings, ReferenceView};
pub use timing::ReferenceTiming;

use dragonfly_picture::ReferencePicture;

/// The frames that were found in the files of a reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceInfo {
    /// Number of frames.
    pub frames: usize,
    /// Its own frame rate; `None` where the files have none.
    pub rate: Option<f32>,
    /// Width and height of the first frame, pixels.
    pub size: [u32; 2],
}

/// The reference picture of the model that is open.
#[derive(Debug, Default)]
pub struct ReferenceTrack {
    settings: ReferenceSettings,
    /// Grows with every change of the settings.
    version: u64,
    info: Option<ReferenceInfo>,
    problem: Option<String>,
    /// The frame that was decoded last for the time shown.
    picture: Option<ReferencePicture>,
}

impl ReferenceTrack {
    /// Returns the settings.
    pub fn settings(&self) -> &ReferenceSettings {
        &self.settings
    }

    /// Returns a number that grows with every change of the settings.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Returns what was found in its files; `None` until then.
    pub fn info(&self) -> Option<&ReferenceInfo> {
        self.info.as_ref()
    }

    /// Returns the reason why it is not shown.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// Returns the frame that is shown.
    pub fn picture(&self) -> Option<&ReferencePicture> {
        self.picture.as_ref()
    }

    /// Sets the settings. Of other files nothing is known yet.
    pub(super) fn set(&mut self, settings: ReferenceSettings) {
        let settings = settings.sanitized();
        if settings == self.settings {
            return;
        }
        if (&settings.file, settings.sequence) != (&self.settings.file, self.settings.sequence) {
            (self.info, self.problem, self.picture) = (None, None, None);
        }
        self.settings = settings;
        self.version += 1;
    }

    /// Notes what was found in its files, or why nothing was.
    pub fn found(&mut self, found: Result<ReferenceInfo, String>) {
        match found {
            Ok(info) => (self.info, self.problem) = (Some(info), None),
            Err(reason) => (self.info, self.picture, self.problem) = (None, None, Some(reason)),
        }
    }

    /// Shows a frame, or none.
    pub fn show(&mut self, picture: Option<ReferencePicture>) {
        self.picture = picture;
    }

    /// Notes why a frame cannot be shown.
    pub fn fail(&mut self, reason: String) {
        self.problem = Some(reason);
    }
}
