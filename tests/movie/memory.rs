//! Memory: a long movie needs no more than a short one.

use crate::frames::{disc, noise, rate};
use dragonfly_kit::counting::peak;
use dragonfly_kit::folder::{Folder, takes_long};
use dragonfly_kit::random::Random;
use dragonfly_movie::{MOVIE_FORMATS, Movie, MovieFormat, MovieFrame, MovieSettings, MovieTarget};

const SIZE: [u32; 2] = [160, 96];

/// Returns the most memory that a movie of `count` frames had in use at once.
fn most(format: &MovieFormat, count: u64, size: [u32; 2], frames: &[Vec<u8>]) -> u64 {
    let folder = Folder::new("movie-memory");
    let settings = MovieSettings::new(size, rate("24"));
    let write = || {
        let mut movie = Movie::begin(format, &settings, MovieTarget::path(folder.join("f.mov"))).unwrap();
        for frame in frames.iter().cycle().take(count as usize) {
            movie.frame(MovieFrame::srgb(size, frame)).unwrap();
        }
        movie.end().unwrap();
    };
    peak(write).0
}

#[test]
fn a_movie_of_three_hundred_frames_needs_hardly_more_memory_than_one_of_fifty() {
    // A corner of noise, so that each frame has some thousand bytes when it is encoded.
    let mut random = Random::new(5);
    let mut frame = |number| {
        let mut pixels = disc(SIZE, number, false);
        for row in pixels.chunks_mut(SIZE[0] as usize * 4).take(32) {
            row[..128].copy_from_slice(&noise([32, 1], &mut random));
        }
        pixels
    };
    let frames: Vec<Vec<u8>> = (0..25).map(&mut frame).collect();
    // Sequences keep nothing of a frame, and wait for the disk after each.
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        let [short, long] = [50, 300].map(|count| most(format, count, SIZE, &frames));
        // The tables of an MP4 have some bytes for each frame.
        assert!(long < short + 100_000, "{}: {short} bytes for 50 frames, {long} for 300", format.name);
    }
}

#[test]
fn an_hour_needs_some_bytes_for_each_frame_and_no_more() {
    if !takes_long() {
        return;
    }
    let size = [8, 8];
    let mut random = Random::new(6);
    let frames: Vec<Vec<u8>> = (0..25).map(|_| noise(size, &mut random)).collect();
    // An hour of 24 frames per second.
    let hour = 24 * 3600;
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        let [short, long] = [50, hour].map(|count| most(format, count, size, &frames));
        let limit = match format.name {
            // Its tables are in memory twice while they are encoded.
            "mp4" => 40 * hour,
            // The durations of the frames that are shown.
            "gif" => 64 * hour,
            // The ends of frames in the last half megabyte.
            _ => 300_000,
        };
        assert!(long < short + limit, "{}: {short} bytes for 50 frames, {long} for an hour", format.name);
    }
}
