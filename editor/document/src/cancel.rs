//! Cancellation and progress of long work on another thread.

#[doc(inline)]
pub use dragonfly_runtime::CancelFlag as Cancel;

/// A stage of loading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadStage {
    /// Reading the file.
    Reading,
    /// Parsing the bytes.
    Understanding,
    /// Reading the headers of the textures, which are decoded when the model is drawn.
    Decoding,
    /// Copying the files that a scene needs into another folder.
    Copying,
}

impl LoadStage {
    /// Returns the text for the status line.
    pub fn title(self) -> &'static str {
        match self {
            Self::Reading => "Reading",
            Self::Understanding => "Understanding",
            Self::Decoding => "Decoding textures",
            Self::Copying => "Copying files",
        }
    }
}

/// The progress of loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The present stage.
    pub stage: LoadStage,
    /// Fraction of the whole work, 0 to 1; never decreases.
    pub done: f32,
}
