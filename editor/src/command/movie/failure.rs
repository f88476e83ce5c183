//! Failures of movies with their exit codes.

use super::super::Failure;
use super::super::render::refusal;
use crate::movie_render::MovieRenderError;
use dragonfly_movie::MovieError;
use std::io;

impl From<MovieRenderError> for Failure {
    fn from(error: MovieRenderError) -> Self {
        match error {
            MovieRenderError::Movie(error) => error.into(),
            MovieRenderError::Graphics(error) => refusal(error),
            MovieRenderError::Folder(reason) => Self::Input(reason),
            MovieRenderError::Full(_)
            | MovieRenderError::Thread(_)
            | MovieRenderError::Encoder
            | MovieRenderError::Cancelled => Self::Machine(error.to_string()),
        }
    }
}

impl From<MovieError> for Failure {
    fn from(error: MovieError) -> Self {
        match error {
            MovieError::Stream(error) if error.kind() == io::ErrorKind::BrokenPipe => Self::OutputClosed,
            MovieError::Stream(error) => Self::Machine(format!("standard output: {error}")),
            MovieError::Frame { .. } | MovieError::Cancelled => Self::Machine(error.to_string()),
            MovieError::File(_)
            | MovieError::Kept { .. }
            | MovieError::Settings { .. }
            | MovieError::Part { .. }
            | MovieError::Sound(_)
            | MovieError::Empty => Self::Input(error.to_string()),
        }
    }
}
