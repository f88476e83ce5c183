//! Disks that fail: an error with the path and the reason, no panic, no half a file under the name of the movie; and what is whole is kept.

use crate::frames::{disc, rate, write};
use dragonfly_kit::folder::Folder;
use dragonfly_kit::store::faulty_files::{Fault, FaultyFiles};
use dragonfly_movie::{
    MOVIE_FORMATS, Movie, MovieFormat, MovieFrame, MovieSettings, MovieTarget, movie_format,
};
use std::path::PathBuf;
use std::sync::Arc;

const SIZE: [u32; 2] = [64, 48];

fn settings() -> MovieSettings {
    MovieSettings::new(SIZE, rate("24"))
}

fn target(files: &FaultyFiles, folder: &Folder, format: &MovieFormat) -> MovieTarget {
    MovieTarget::Path {
        files: Arc::new(files.clone()),
        path: folder.join(&format!("it.{}", format.extensions[0])),
    }
}

fn names(folder: &Folder) -> Vec<PathBuf> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path()).collect();
    names.sort();
    names
}

#[test]
fn every_call_that_fails_is_an_error_with_the_path_and_leaves_no_half_a_file() {
    for format in MOVIE_FORMATS {
        let frames = || (0..3).map(|number| disc(SIZE, number, true));
        let folder = Folder::new("movie-faults");
        let files = FaultyFiles::once(u64::MAX, Fault::Io);
        write(format.name, &settings(), target(&files, &folder, format), frames()).unwrap();
        let whole: Vec<(PathBuf, Vec<u8>)> =
            names(&folder).into_iter().map(|path| (path.clone(), std::fs::read(path).unwrap())).collect();
        let calls = files.calls();
        assert!(calls > 8, "{}: {calls} calls", format.name);
        // A movie of fewer frames, for a disk that is full at the end.
        let fewer = |count: u64| {
            let folder = Folder::new("movie-fewer");
            let target = MovieTarget::path(folder.join("it"));
            let report = write(format.name, &settings(), target, frames().take(count as usize)).unwrap();
            std::fs::read(report.path.unwrap()).unwrap()
        };
        let mut errors = 0;
        for call in 1..=calls {
            for fault in Fault::ALL {
                names(&folder).iter().for_each(|path| std::fs::remove_file(path).unwrap());
                let files = FaultyFiles::once(call, fault);
                let about = format!("{}, call {call}, {fault:?}", format.name);
                let mut shorter = None;
                match write(format.name, &settings(), target(&files, &folder, format), frames()) {
                    Ok(report) => {
                        assert!(whole.iter().all(|(path, _)| path.exists()), "{about}");
                        assert_eq!(report.frames + report.left_out, 3, "{about}");
                        assert!(report.left_out == 0 || fault == Fault::Full, "{about}");
                        shorter = (report.left_out > 0).then_some(report.frames);
                    }
                    Err(error) => {
                        errors += 1;
                        assert!(!fault.is_harmless(), "{about}: {error}");
                        assert!(error.to_string().contains("it."), "{about}: {error}");
                        assert!(
                            fault != Fault::Full || error.to_string().contains("the disk is full"),
                            "{about}: {error}"
                        );
                    }
                }
                for path in names(&folder) {
                    // A temporary file that cannot be removed may stay, and a complete movie that could not get its name has another.
                    let temporary = path.extension().is_some_and(|end| end == "part");
                    let kept = path.file_stem().is_some_and(|name| name == "it (1)");
                    let known = whole.iter().find(|(name, _)| kept || *name == path);
                    let found = std::fs::read(&path).unwrap();
                    let is_right = match (known, shorter) {
                        // The palette of a GIF is that of all its frames.
                        (Some(_), Some(_)) if format.name == "gif" => true,
                        (Some(_), Some(count)) => found == fewer(count),
                        (Some((_, bytes)), None) => *bytes == found,
                        (None, _) => false,
                    };
                    assert!(temporary || is_right, "{about}: {}", path.display());
                }
            }
        }
        assert!(errors > 8, "{}: {errors} errors", format.name);
    }
}

#[test]
fn a_movie_is_completed_with_the_frames_before_the_disk_was_full() {
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        // Noise, so that the buffer of the file is written between frames.
        let mut random = dragonfly_kit::random::Random::new(7);
        let size = [240, 240];
        let frames: Vec<Vec<u8>> = (0..12).map(|_| crate::frames::noise(size, &mut random)).collect();
        let settings = MovieSettings { coarseness: 10, ..MovieSettings::new(size, rate("24")) };
        let mut kept = Vec::new();
        for full in 1..40 {
            let folder = Folder::new("movie-full");
            // Some room becomes free again before the movie is ended.
            let files = FaultyFiles::between(full, full, Fault::Full);
            let Ok(mut movie) = Movie::begin(format, &settings, target(&files, &folder, format)) else {
                continue;
            };
            let written =
                frames.iter().take_while(|frame| movie.frame(MovieFrame::srgb(size, frame)).is_ok()).count();
            if written == frames.len() {
                continue;
            }
            let refused = movie.frame(MovieFrame::srgb(size, &frames[0])).unwrap_err().to_string();
            assert!(refused.contains("an earlier frame"), "{refused}");
            assert_eq!(movie.next_frame(), written as u64);
            let ended = movie.end();
            if written == 0 {
                assert!(ended.is_err());
                assert_eq!(names(&folder).len(), 0);
                continue;
            }
            let report = ended.unwrap();
            assert_eq!(report.frames, written as u64, "{}", format.name);
            // As if the movie had only these frames.
            let whole = folder.join("whole");
            write(format.name, &settings, MovieTarget::path(&whole), frames[..written].to_vec()).unwrap();
            assert!(
                std::fs::read(report.path.unwrap()).unwrap() == std::fs::read(whole).unwrap(),
                "{}",
                format.name
            );
            kept.push(written);
            if kept.len() == 2 {
                break;
            }
        }
        assert!(!kept.is_empty(), "{}: the disk was never full between frames", format.name);
    }
}

#[test]
fn a_movie_that_is_dropped_leaves_the_old_file() {
    for format in MOVIE_FORMATS.iter().filter(|format| !format.is_sequence) {
        let folder = Folder::new("movie-dropped");
        let path = folder.join("it");
        std::fs::write(&path, "old").unwrap();
        let mut movie = Movie::begin(format, &settings(), MovieTarget::path(&path)).unwrap();
        movie.frame(MovieFrame::srgb(SIZE, &disc(SIZE, 0, false))).unwrap();
        drop(movie);
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(names(&folder), [path], "{}", format.name);
    }
}

#[test]
fn every_format_is_found_by_its_name() {
    for format in MOVIE_FORMATS {
        assert_eq!(movie_format(format.name).unwrap().title, format.title);
        assert!(!format.extensions.is_empty());
    }
    assert!(movie_format("avi").is_none());
}
