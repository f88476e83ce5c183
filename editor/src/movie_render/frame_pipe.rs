//! An encoder that works while the next frames are rendered.

use super::error::MovieRenderError;
use super::source::RenderedFrame;
use dragonfly_movie::{Movie, MovieError, MovieReport};
use dragonfly_runtime::{CancelFlag, Job, ThreadHandle};
use flume::{Receiver, Sender};

/// Number of frames that wait for the encoder at most. With the one that is being encoded there are three in memory.
const WAITING: usize = 2;

/// A message to the encoder. When no more comes without the end, the movie is given up.
enum PipeMessage {
    Frame(u64, RenderedFrame),
    End,
}

/// The result of an encoder; `None` where the movie was given up.
type EncodedMovie = Result<Option<MovieReport>, MovieError>;

/// A movie that is being encoded in a job. Dropping it gives the movie up, and waits until its unfinished file is removed.
pub(super) struct FramePipe {
    frames: Option<Sender<PipeMessage>>,
    result: Receiver<EncodedMovie>,
    _job: Job,
}

impl FramePipe {
    /// Starts the job, which belongs to `thread`.
    pub(super) fn start(thread: &ThreadHandle, movie: Movie) -> Result<Self, MovieRenderError> {
        let (frames, to_encode) = flume::bounded(WAITING);
        let (ended, result) = flume::bounded(1);
        let work = move |_: &CancelFlag| {
            // Its caller waits for this result.
            let _ = ended.send(encode(movie, to_encode));
        };
        let (job, _answer) =
            Job::start_oneshot(thread, "encode movie", work).map_err(MovieRenderError::Thread)?;
        Ok(Self { frames: Some(frames), result, _job: job })
    }

    /// Hands a frame to the encoder. Blocks while enough frames wait.
    pub(super) fn frame(&self, number: u64, frame: RenderedFrame) -> Result<(), MovieRenderError> {
        let sent = self.frames.as_ref().map(|frames| frames.send(PipeMessage::Frame(number, frame)));
        match sent {
            Some(Ok(())) => Ok(()),
            Some(Err(_)) | None => self.ended().map(|_| ()),
        }
    }

    /// Completes the movie.
    pub(super) fn end(mut self) -> Result<MovieReport, MovieRenderError> {
        if let Some(frames) = self.frames.take() {
            // An encoder that ended before has its reason in the result.
            let _ = frames.send(PipeMessage::End);
        }
        self.ended()
    }

    /// Waits for the result of an encoder that has ended, or will without another frame.
    fn ended(&self) -> Result<MovieReport, MovieRenderError> {
        match self.result.recv() {
            Ok(Ok(Some(report))) => Ok(report),
            Ok(Err(error)) => Err(error.into()),
            // No result means that the job panicked.
            Ok(Ok(None)) | Err(_) => Err(MovieRenderError::Encoder),
        }
    }
}

impl Drop for FramePipe {
    fn drop(&mut self) {
        self.frames = None;
        let _ = self.result.recv();
    }
}

/// Encodes frames until the end. Frames that wait are encoded before a movie is given up, because a file for each frame is kept.
fn encode(mut movie: Movie, frames: Receiver<PipeMessage>) -> EncodedMovie {
    for message in frames {
        match message {
            PipeMessage::Frame(number, frame) => {
                if movie.next_frame() != number {
                    movie.skip_to(number)?;
                }
                movie.frame(frame.movie_frame())?;
            }
            PipeMessage::End => return movie.end().map(Some),
        }
    }
    Ok(None)
}
