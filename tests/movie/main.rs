//! Promises of the movie crate: other programs decode the movies to the frames that were given.

mod animations;
mod broken;
mod cancel;
#[cfg(feature = "h264")]
mod copied_sound;
#[cfg(feature = "h264")]
mod environment;
mod frames;
mod full_disk;
#[cfg(feature = "h264")]
mod join;
mod judge;
mod links;
mod memory;
#[cfg(feature = "h264")]
mod mp4;
#[cfg(feature = "h264")]
mod second_decoder;
mod sequences;
#[cfg(feature = "h264")]
mod sound;
#[cfg(feature = "h264")]
mod sound_files;
mod stream;
#[cfg(feature = "h264")]
mod tracks;

#[global_allocator]
static ALLOCATOR: dragonfly_kit::counting::CountingAllocator = dragonfly_kit::counting::CountingAllocator;
