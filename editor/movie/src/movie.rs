//! A movie that is being written.

use crate::error::MovieError;
use crate::frame::MovieFrame;
use crate::report::MovieReport;
use crate::settings::MovieSettings;
use crate::sound::MovieSound;
use crate::target::MovieTarget;
use crate::writer::{MovieFormat, MovieWriter};
use std::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A movie that is being written. One that is dropped instead of ended is cancelled.
pub struct Movie {
    writer: Box<dyn MovieWriter>,
    size: [u32; 2],
    is_sequence: bool,
    next: u64,
    failed: bool,
}

impl fmt::Debug for Movie {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "Movie({:?}, frame {})", self.size, self.next)
    }
}

impl Movie {
    /// Begins a movie.
    ///
    /// # Errors
    /// When the settings do not fit the format, or the file cannot be created.
    pub fn begin(
        format: &MovieFormat,
        settings: &MovieSettings,
        target: MovieTarget,
    ) -> Result<Self, MovieError> {
        Self::begin_with(format, settings, target, None)
    }

    /// Begins a movie with sound.
    ///
    /// # Errors
    /// As [`Self::begin`], and when the format has no sound.
    pub fn begin_with_sound(
        format: &MovieFormat,
        settings: &MovieSettings,
        target: MovieTarget,
        sound: MovieSound,
    ) -> Result<Self, MovieError> {
        if !format.has_sound {
            let reason = "cannot have sound; choose MP4".to_owned();
            return Err(MovieError::Settings { format: format.title, reason });
        }
        Self::begin_with(format, settings, target, Some(sound))
    }

    fn begin_with(
        format: &MovieFormat,
        settings: &MovieSettings,
        target: MovieTarget,
        sound: Option<MovieSound>,
    ) -> Result<Self, MovieError> {
        settings.check(format.title, format.side)?;
        let writer = (format.begin)(settings, target, sound)?;
        let is_sequence = format.is_sequence;
        Ok(Self { writer, size: settings.size, is_sequence, next: settings.first, failed: false })
    }

    /// Returns the number of the next frame, counted from the start of the whole movie: how far the movie is.
    pub fn next_frame(&self) -> u64 {
        self.next
    }

    /// Moves on to frame `number` of a format with a file for each frame, without writing the frames before it.
    ///
    /// # Errors
    /// For a format with all frames in one file, and for a frame before the next one.
    pub fn skip_to(&mut self, number: u64) -> Result<(), MovieError> {
        let reason = match (self.is_sequence, number < self.next) {
            (false, _) => "frames can be left out only where each is a file of its own".to_owned(),
            (true, true) => format!("the next frame is {}", self.next),
            (true, false) => {
                self.next = number;
                return Ok(());
            }
        };
        Err(MovieError::Frame { number, reason })
    }

    /// Writes the next frame.
    ///
    /// # Errors
    /// When it has another size, or cannot be written. No later frame can be written then; [`Self::end`] completes the movie with the
    /// frames that were, and dropping the movie removes it.
    pub fn frame(&mut self, frame: MovieFrame<'_>) -> Result<(), MovieError> {
        let number = self.next;
        if self.failed {
            let reason = "an earlier frame was not written".to_owned();
            return Err(MovieError::Frame { number, reason });
        }
        frame.check(self.size, number)?;
        let written = guarded(number, || self.writer.frame(frame, number));
        match written {
            Ok(()) => self.next += 1,
            Err(_) => self.failed = true,
        }
        written
    }

    /// Completes the movie. Where the disk is full, the movie has fewer frames: see [`MovieReport::left_out`].
    ///
    /// # Errors
    /// When there are no frames, or the rest cannot be written; then there is no file, except for frames in files of their own, and a complete
    /// movie that could not replace the old file ([`MovieError::Kept`]).
    pub fn end(self) -> Result<MovieReport, MovieError> {
        self.end_with(&mut |_, _| true)
    }

    /// Completes the movie as [`Self::end`]. Where that takes long, `progress` receives the number of frames that are complete and that of all
    /// frames, and returns whether to continue.
    ///
    /// # Errors
    /// As [`Self::end`], and [`MovieError::Cancelled`] where `progress` returned false; then there is no file.
    pub fn end_with(self, progress: &mut dyn FnMut(u64, u64) -> bool) -> Result<MovieReport, MovieError> {
        let Self { writer, next, .. } = self;
        guarded(next, || writer.end(progress))
    }

    /// Cancels the movie: its temporary file is removed, and the old file stays as it was. Frames in files of their own stay, too: each is complete.
    pub fn cancel(self) {}
}

/// Runs an encoder of another crate. One that panics is like one that fails.
fn guarded<T>(number: u64, work: impl FnOnce() -> Result<T, MovieError>) -> Result<T, MovieError> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err(MovieError::Frame { number, reason: "the encoder failed".to_owned() }))
}
