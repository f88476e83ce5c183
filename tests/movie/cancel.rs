//! A movie that is given up in the middle.

use crate::frames::{disc, noise, rate};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::random::Random;
use dragonfly_movie::{
    MOVIE_FORMATS, Movie, MovieError, MovieFormat, MovieFrame, MovieSettings, MovieTarget,
};
use std::path::{Path, PathBuf};

/// So large that the buffer of a file is written between frames.
const LARGE: [u32; 2] = [240, 240];
const SMALL: [u32; 2] = [32, 32];

/// Begins a movie over an old file, and writes frames of noise.
fn begun(format: &MovieFormat, path: &Path, size: [u32; 2], count: u64) -> Movie {
    let settings = MovieSettings { coarseness: 10, ..MovieSettings::new(size, rate("24")) };
    let mut movie = Movie::begin(format, &settings, MovieTarget::path(path)).unwrap();
    let mut random = Random::new(17);
    for _ in 0..count {
        movie.frame(MovieFrame::srgb(size, &noise(size, &mut random))).unwrap();
    }
    assert_eq!(movie.next_frame(), count);
    movie
}

fn names(folder: &Folder) -> Vec<PathBuf> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path()).collect();
    names.sort();
    names
}

#[test]
fn a_cancelled_movie_leaves_the_old_file_and_nothing_else() {
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        for count in [0, 1, 4] {
            let folder = Folder::new("movie-cancel");
            let path = folder.join("it");
            std::fs::write(&path, "old").unwrap();
            let movie = begun(format, &path, LARGE, count);
            assert!(names(&folder).len() > 1, "{}: no temporary file", format.name);
            movie.cancel();
            assert_eq!(names(&folder), std::slice::from_ref(&path), "{}, {count} frames", format.name);
            assert_eq!(std::fs::read(&path).unwrap(), b"old", "{}", format.name);
        }
    }
}

#[test]
fn a_cancelled_sequence_leaves_its_complete_frames_and_nothing_else() {
    for format in MOVIE_FORMATS.iter().filter(|format| format.is_sequence) {
        let folder = Folder::new("movie-cancel-frames");
        begun(format, &folder.join("f.#.x"), SMALL, 2).cancel();
        assert_eq!(names(&folder), ["f.0.x", "f.1.x"].map(|name| folder.join(name)), "{}", format.name);
    }
}

#[test]
fn a_gif_is_cancelled_while_it_is_completed() {
    let folder = Folder::new("movie-cancel-end");
    let path = folder.join("it.gif");
    std::fs::write(&path, "old").unwrap();
    let format = dragonfly_movie::movie_format("gif").unwrap();
    let mut seen = Vec::new();
    let ended = begun(format, &path, SMALL, 4).end_with(&mut |done, all| {
        seen.push((done, all));
        done < 2
    });
    assert!(matches!(ended, Err(MovieError::Cancelled)), "{ended:?}");
    assert_eq!(seen, [(0, 4), (1, 4), (2, 4)]);
    assert_eq!((names(&folder), std::fs::read(&path).unwrap()), (vec![path.clone()], b"old".to_vec()));
    assert_eq!(begun(format, &path, SMALL, 4).end_with(&mut |_, _| true).unwrap().frames, 4);
}

#[cfg(feature = "h264")]
#[test]
fn joining_is_cancelled_between_frames() {
    let folder = Folder::new("movie-cancel-join");
    let [part, path] = ["part.mp4", "it.mp4"].map(|name| folder.join(name));
    std::fs::write(&path, "old").unwrap();
    let settings = MovieSettings::new([16, 16], rate("24"));
    let frames = (0..5).map(|number| disc([16, 16], number, false));
    crate::frames::write("mp4", &settings, MovieTarget::path(&part), frames).unwrap();
    let join = |progress: &mut dyn FnMut(u64, u64) -> bool| {
        let target = MovieTarget::path(&path);
        dragonfly_movie::join_movies_with(std::slice::from_ref(&part), 0..5, target, None, progress)
    };
    let mut seen = Vec::new();
    let joined = join(&mut |done, all| {
        seen.push((done, all));
        done < 3
    });
    assert!(matches!(joined, Err(MovieError::Cancelled)), "{joined:?}");
    assert_eq!(seen, [(0, 5), (1, 5), (2, 5), (3, 5)]);
    assert_eq!(std::fs::read(&path).unwrap(), b"old");
    assert_eq!(names(&folder).len(), 2);
    assert_eq!(join(&mut |_, _| true).unwrap().frames, 5);
}
