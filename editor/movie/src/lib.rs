//! Movies made of frames: each [`MovieFormat`] turns pixels into the bytes of a file, of a file for each frame, or of a stream. There is no device
//! and no window here.
//!
//! ```text
//! MovieFrame ── Movie ──▶ MovieWriter of a MovieFormat ──▶ MovieFile (a temporary file, renamed at the end), files of frames, stream
//!                                                   join_movies: parts of an MP4 ──▶ the movie that one pass writes
//! ```
//!
//! No movie is in memory as a whole, and the same frames give the same bytes.

mod changed;
mod error;
mod files;
mod format;
mod frame;
mod frame_ends;
mod frame_label;
mod frame_pair;
mod gif;
#[cfg(feature = "h264")]
mod h264;
mod linked;
mod movie;
mod mp4;
mod report;
mod settings;
mod sound;
mod spool;
mod srgb;
mod target;
mod timing;
mod writer;
mod yuv;

pub use error::MovieError;
pub use format::{MOVIE_FORMATS, movie_format};
pub use frame::{LARGEST_SIDE, MovieFrame};
pub use movie::Movie;
pub use mp4::inspect::{has_movie, part_frames};
pub use mp4::join::{join_movies, join_movies_with};
pub use report::MovieReport;
pub use settings::{GROUP, MovieSettings, movie_parts};
pub use sound::{MovieSound, ReadSamples};
pub use target::{MovieTarget, SequenceName};
pub use writer::MovieFormat;
