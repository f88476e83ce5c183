//! A format of movies, and a movie of one that is being written.

use crate::error::MovieError;
use crate::frame::MovieFrame;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::sound::MovieSound;
use crate::target::MovieTarget;

/// Begins to write a movie; only formats that have sound receive any.
type BeginMovie =
    fn(&MovieSettings, MovieTarget, Option<MovieSound>) -> Result<Box<dyn MovieWriter>, MovieError>;

/// Receives the number of frames that are complete and that of all frames; returns whether to continue.
pub(crate) type EndProgress<'a> = &'a mut dyn FnMut(u64, u64) -> bool;

/// A format of movies.
#[derive(Clone, Copy, Debug)]
pub struct MovieFormat {
    /// Name for the command line.
    pub name: &'static str,
    /// Title for the user.
    pub title: &'static str,
    /// Extensions of file names, lower case.
    pub extensions: &'static [&'static str],
    /// Whether the format keeps alpha; frames are put over black otherwise.
    pub has_alpha: bool,
    /// Whether frames are wanted in linear light before the tone map, brighter than white where the scene is; any are accepted.
    pub is_linear: bool,
    /// Whether the movie can have sound.
    pub has_sound: bool,
    /// Whether each frame is a file of its own.
    pub is_sequence: bool,
    /// Whether the movie can go to a stream.
    pub can_stream: bool,
    /// Largest width and height in pixels.
    pub side: u32,
    pub(crate) begin: BeginMovie,
}

/// A movie of one format in the middle of being written.
pub(crate) trait MovieWriter: Send {
    /// Writes the next frame, which has the size of the movie. After an error, [`Self::end`] still completes the movie with the frames before.
    fn frame(&mut self, frame: MovieFrame<'_>, number: u64) -> Result<(), MovieError>;

    /// Writes the rest. Calls `progress` with the number of frames that are complete and that of all, where this takes long; an error where it
    /// returns false.
    fn end(self: Box<Self>, progress: EndProgress<'_>) -> Result<MovieReport, MovieError>;
}
