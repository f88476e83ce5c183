//! Errors of rendering a movie, in words for the user.

use dragonfly_movie::MovieError;
use dragonfly_picture::GraphicsError;
use std::io;

/// Reasons why a movie was not rendered.
#[derive(Debug, thiserror::Error)]
pub enum MovieRenderError {
    /// The movie cannot be written.
    #[error(transparent)]
    Movie(#[from] MovieError),
    /// A frame cannot be drawn.
    #[error(transparent)]
    Graphics(#[from] GraphicsError),
    /// The folder of parts cannot be created; contains the folder and the reason.
    #[error("{0}")]
    Folder(String),
    /// The system gave no thread for the encoder.
    #[error("no thread could be started: {0}")]
    Thread(#[source] io::Error),
    /// The disk was full when the movie was completed.
    #[error("the disk is full: the last {0} frames are missing in what was written")]
    Full(u64),
    /// The encoder ended without a result: a bug.
    #[error("the encoder failed")]
    Encoder,
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
}
