//! Promises of the movie crate: other programs decode the movies to the frames that were given.

mod animations;
mod broken;
mod frames;
#[cfg(feature = "h264")]
mod join;
mod judge;
#[cfg(feature = "h264")]
mod mp4;
mod sequences;
#[cfg(feature = "h264")]
mod sound;
mod stream;
